/* Scatter as images: per pixel, in the units of the stages and of the plan's quantity. Private. */
#ifndef SKG_SCATTER_SHOWN_H
#define SKG_SCATTER_SHOWN_H

#include "scatter/scatterer.h"
#include "scatter/smooth.h"

typedef struct {
    const skg_scatter_work *work;
    const skg_cosines *mean, *variance; /* variance: NULL without noise */
    double photons;       /* that a sum of 1 stands for, of a pixel: photons of the spectrum per pixel */
    double signal, power; /* what a photon of 1 in the tables adds to the image and to its variance */
} skg_shown_scatter;

/* Fills the images of the scatterer, and the report's mean and sigma. */
skg_status skg_shown_scatter_send(skg_context *context, const skg_shown_scatter *shown,
                                  skg_scatterer *scatterer);

/* The same where nothing scatters. */
skg_status skg_shown_nothing_send(skg_context *context, const skg_scatter_work *work,
                                  skg_scatterer *scatterer);

#endif
