/* One pass of a frame. The image of a focal spot with several samples, or of pixels with several rays, is the mean of several
 * passes. Each has one sample of the source, and one ray in each pixel or all rays of the pixels together (`fine`). It projects
 * the vertices and adds up path lengths in the planes of a raster. lib/frame fills this struct for the stages. Private. */
#ifndef SKG_PASS_H
#define SKG_PASS_H

#include "geometry/bounds.h"
#include "geometry/priority.h"
#include "spectral/model.h"
#include "stage/place.h"
#include "stage/raster_private.h"

/* Host memory for what a pass knows of its parts, kept from pass to pass: a million parts take as long to allocate as to
 * fill. All NULL: not allocated. */
typedef struct {
    skg_geometry_part *parts;     /* [parts] */
    skg_extent *extents;          /* [parts] */
    skg_scale_part *scales;       /* [parts] of those that contribute */
    skg_touching *touching;       /* [parts] workspace: of those that may touch */
    skg_touching_group *groups;   /* [parts] workspace */
    int32_t *group_of;            /* [parts] of those that may touch: the group, for these poses and meshes */
    double (*poses)[16];          /* [parts] */
    int64_t *versions;            /* [parts] sixteenths of those of their meshes, from 1; 0: not known */
    skg_scale_grid grid;          /* workspace of the scale */
    const skg_geometry *geometry; /* borrowed: of the machine */
    const skg_placement *placement;    /* borrowed: of the machine */
    const struct skg_volumes *volumes; /* borrowed: of the machine */
} skg_pass_memory;

skg_status skg_pass_memory_create(int64_t parts, int64_t columns, int64_t rows, skg_pass_memory *memory);
void skg_pass_memory_release(skg_pass_memory *memory);

typedef struct skg_pass {
    const skg_scene *scene; /* borrowed, as the frame's caller keeps it */
    skg_camera camera;
    skg_kernel_options kernels;
    int64_t planes; /* of the raster: accumulators if planes are mixed from them */
    skg_mix mix;    /* of an image's planes; mix.sums 0: accumulators are planes */
    /* Contributions of every part to the planes, leaky parts included: part p has contributions[first[p]] to contributions[first[p + 1] -
     * 1]. */
    const skg_contribution *contributions;
    const int64_t *first;                /* [parts + 1] */
    skg_contribution *own_contributions; /* those of this pass alone, to be freed; NULL: borrowed */
    int64_t *own_first;
    skg_geometry_part *parts; /* [parts] borrowed; leaky ones without contributions */
    skg_extent *extents;      /* [parts] borrowed */
    skg_scale scale;
    skg_priority priority;             /* closed parts that compete for intervals */
    const struct skg_volumes *volumes; /* borrowed: of the machine; NULL: not known */
    int32_t rules;                     /* SKG_RULE_... */
    int32_t fine;                      /* pixels of the camera along each side of a pixel of the image */
    /* of the camera: the pixels that jaws leave (skg_field_window), of an image with jaws */
    int32_t window[4];
    skg_raster_pin main; /* the raster of the closed parts */
} skg_pass;

/* Releases what the pass owns, and its pin. */
void skg_pass_release(skg_pass *pass);

#endif
