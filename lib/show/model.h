/* What the 3D view shows, as triangles for the device. Private. */
#ifndef SKG_SHOW_MODEL_H
#define SKG_SHOW_MODEL_H

#include "core/core.h"

/* A red, green, blue and opacity from 0 to 255 in one number, red lowest. */
#define SKG_SHOW_COLOUR(red, green, blue, opacity)                                                           \
    ((uint32_t)(red) | (uint32_t)(green) << 8 | (uint32_t)(blue) << 16 | (uint32_t)(opacity) << 24)

/* Triangles that grow while they are added. All zero: none. */
typedef struct {
    double centre[3]; /* mm; positions are relative to it */
    float *positions; /* [vertices][3] */
    int32_t *corners; /* [triangles][3] */
    int16_t *
        normals; /* [triangles][3][4] of each corner, times 32767; of the detector places in the image, times 16384 */
    uint32_t *colours; /* [triangles] SKG_SHOW_COLOUR */
    int64_t vertices, triangles;
    int64_t sections; /* the first triangles, whose inside is drawn without shading */
    int64_t images;   /* the last triangles, which show the detector's image */
    int64_t vertex_capacity, triangle_capacity;
} skg_show_model;

void skg_show_model_free(skg_show_model *model);

/* Makes room for so many vertices and triangles more. SKG_ERR_SCENE beyond 2^31 / 3 of either. */
skg_status skg_show_model_reserve(skg_show_model *model, int64_t vertices, int64_t triangles);

/* Adds a vertex (mm, in the world), for which there is room. */
void skg_show_model_add_vertex(skg_show_model *model, const double position[3]);

/* Adds a triangle of vertices that are there, for which there is room. normals: [3][3] of length 1 at its corners. */
void skg_show_model_add_triangle(skg_show_model *model, const int64_t corners[3], double normals[3][3],
                                 uint32_t colour);

/* Adds a triangle of the detector's area, likewise. places: [3][2] fractions of the image's width and height at its corners. */
void skg_show_model_add_image(skg_show_model *model, const int64_t corners[3], double places[3][2]);

#endif
