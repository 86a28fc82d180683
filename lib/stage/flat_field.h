/* The flat field of a view: what the beam gives without parts and noise. Noisy images are divided by it if a world or
 * falloff make it differ from pixel to pixel. Private. */
#ifndef SKG_FLAT_FIELD_H
#define SKG_FLAT_FIELD_H

#include "geometry/samples.h"
#include "stage/layers.h"

typedef struct {
    int32_t known; /* 1: for this view and type */
    int32_t is_double;
    skg_view view;
    skg_buffer image; /* [channels][rows][columns] */
} skg_flat_field;

/* What a flat field is made with. */
typedef struct {
    const skg_samples
        *samples; /* of source and pixel; NULL: the source is a point, and rays go to the pixels' centres */
    const skg_sums *sums; /* of a frame of the same shape; not read */
    skg_attenuator *attenuator;
    const skg_attenuation *attenuation;
    skg_layers *layers; /* and their blurs */
    cl_mem negative;    /* counters, which it leaves as they are */
    double exposure;    /* what intensities are multiplied by for the view */
} skg_flat_field_work;

/* Enqueues the flat field of a view as float or double, if it is not known. */
skg_status skg_flat_field_find(skg_flat_field *field, const skg_flat_field_work *work, const skg_view *view,
                               int32_t is_double, skg_staging *staging);

#endif
