/* Scatter as images: per pixel, in the units of the stages and of the plan's quantity. Private. */
#ifndef SKG_SCATTER_SHOWN_H
#define SKG_SCATTER_SHOWN_H

#include "scatter/object.h"
#include "scatter/smooth.h"
#include "stage/kernels.h"

typedef struct {
    const skg_scatter_work *work;
    const skg_cosines *mean;     /* [channels]; NULL: nothing scatters */
    const skg_cosines *staged;   /* [layers][channels] */
    const skg_cosines *variance; /* [layers][channels]; NULL: without noise */
    double photons;              /* that a sum of 1 stands for: photons of the spectrum per pixel */
    double signal, power;        /* what a photon of 1 in the tables adds to the image and to its variance */
} skg_shown_scatter;

/* [channels][rows][columns] floats on the device each, and what they are on average. All zero: none. */
typedef struct {
    skg_buffer mean,
        variance; /* what each layer of images gets, before detector and quantity; variance: with noise alone */
    skg_buffer shown, sigma; /* in the plan's quantity */
    skg_buffer component;    /* likewise; the one that was asked for last */
    double average;          /* of `shown`, over the channels */
    double error;            /* root mean square of sigma */
} skg_scatter_images;

/* Fills the images, but for the component. */
skg_status skg_shown_scatter_send(skg_context *context, const skg_shown_scatter *shown,
                                  skg_scatter_images *images);
/* Fills images->component. shown->mean: [channels][SKG_SCATTER_KINDS] */
skg_status skg_shown_component_send(skg_context *context, const skg_shown_scatter *shown, int component,
                                    skg_scatter_images *images);
void skg_scatter_images_release(skg_scatter_images *images);
int64_t skg_scatter_images_bytes(const skg_scatter_images *images);

#endif
