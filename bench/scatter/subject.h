/* Scenes that scatter, their frames, and what is counted before it is smoothed. */
#ifndef BENCH_SCATTER_SUBJECT_H
#define BENCH_SCATTER_SUBJECT_H

#include "common/bench.h"

typedef struct {
    const char *name;
    skg_context *context;
    skg_scene *scene;
    skg_spectrum *beam;
    skg_material *world; /* NULL: vacuum */
    skg_view view;
    int32_t rays;         /* rays x rays in a pixel */
    int32_t fluorescence; /* enum skg_fluorescence */
} subject;

/* 20 cm of water at 60 keV, 32 x 32 pixels, the detector `plane` mm behind the slab's middle. density: g/cm3 */
subject subject_water(skg_context *context, const char *name, double plane, double density);

/* bench/mc/cube.json with tissues that scatter. exact: 1: of densities that give the attenuation of the reference */
subject subject_cube(skg_context *context, const char *file, int exact);

/* The generated thorax at 80 kV, size x size pixels. */
subject subject_thorax(skg_context *context, long size);

void subject_close(subject *s);

/* A frame, [rows][columns]: energy without noise, of one photon per pixel if the beam is of one energy. */
typedef struct {
    int64_t count, places;
    double *image, *scatter, *sigma;
    int64_t *sums; /* tests/scatter/sums.h */
    skg_scatter_report report;
    double cpu_s; /* of the scatter, all threads together */
} taken;

/* Takes a frame to a tolerance, or with so many histories if the tolerance is 0, after one that warms up. */
taken subject_take(const subject *s, double tolerance, int64_t histories, int64_t seed);
void taken_free(taken *t);

#endif
