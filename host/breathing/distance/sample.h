/* Points of a surface and the areas that they stand for. Private. */
#ifndef SKG_DISTANCE_SAMPLE_H
#define SKG_DISTANCE_SAMPLE_H

#include <skiagraph/distance.h>

typedef struct {
    int64_t count;
    double *points;    /* rows of x, y, z, mm */
    double *weights;   /* not negative; their sum is above 0 */
    double spacing_mm; /* the longest side of what a sample stands for; 0 at vertices */
} skg_samples;

/* A surface: rows of x, y, z in mm, and of three vertices. */
typedef struct {
    const char *name;
    int64_t vertices, triangles;
    double *positions;
    int32_t *corners;
} skg_surface;

/* Copies a mesh, whose vertices have to be finite. The caller frees it. */
skg_status skg_surface_create(const skg_mesh *mesh, skg_surface *surface);
void skg_surface_free(skg_surface *surface);

/* Samples a surface as the options say. The caller frees the samples. */
skg_status skg_samples_create(const skg_surface *surface, const skg_distance_options *options,
                              skg_samples *samples);
void skg_samples_free(skg_samples *samples);

#endif
