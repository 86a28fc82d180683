/* The inside of a reconstruction, and its two steps for each projection. Private. */
#ifndef SKG_RECONSTRUCTION_H
#define SKG_RECONSTRUCTION_H

#include "reconstruct/fourier.h"
#include "reconstruct/orbit.h"

struct skg_fdk {
    skg_scan *scan;
    skg_fdk_options options;
    skg_orbit orbit;
    skg_row_filter filter;
    int64_t columns, rows, projections, fine;
    int64_t pad[2];    /* columns that are added before the first and behind the last one */
    int64_t added;     /* projections */
    int64_t truncated; /* rows of them */
    float *image;      /* [rows][fine], weighted and filtered */
    float *volume;     /* [z][y][x], 1/cm */
};

/* Whether column 0 is on the side of the near edge of a displaced detector. */
static inline int skg_fdk_near_is_first(const skg_fdk *fdk, const skg_orbit_pose *pose) {
    return fdk->orbit.displaced * skg_orbit_place(pose, fdk->rows / 2, 0) < 0;
}

/* Coordinate of a voxel. */
static inline double skg_fdk_place(const skg_fdk_options *o, int k, int64_t index) {
    return o->middle[k] + ((double)index - 0.5 * (double)(o->voxels[k] - 1)) * o->voxel_mm;
}

/* Weights and filters the rows of a projection, into fdk->image (filter_image.c). */
skg_status skg_fdk_filter(skg_fdk *fdk, const skg_orbit_pose *pose, const float *image);

/* The row in which a projection sees a point, counted from 0, also beyond the detector (back_project.c). */
double skg_fdk_row_of(const skg_orbit_pose *pose, const double *point);

/* Adds the filtered projection to the volume (back_project.c). */
skg_status skg_fdk_back_project(skg_fdk *fdk, const skg_orbit_pose *pose);

#endif
