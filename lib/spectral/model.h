/* How path lengths become an image: which planes parts add to, and with which coefficients and weights planes
 * become exponents and channels. Private.
 *
 * Materials whose attenuation is proportional over the energies share a plane, each with its factor; so a
 * beam of one energy has one plane for any number of materials (numerics.md 5). A part adds what it has more
 * than the parent that it displaces (Vidal and Villard 2016, Eq. 9, for any depth). */
#ifndef SKG_MODEL_H
#define SKG_MODEL_H

#include "scene/scene.h"
#include "spectral/contribution.h"

#include <skiagraph/plan.h>

typedef struct {
    int32_t planes, nodes, channels, reserved;
    int64_t *first_contribution;     /* [parts + 1] into contributions */
    skg_contribution *contributions; /* what a mm of a part's path adds; a part without any does not show */
    double *coefficients;            /* [nodes][planes] 1/mm per mm of a plane */
    double *weights; /* [nodes][channels]: of the quantity; per mm2 for fluence, of I/I0 for ratios */
    double
        *variances; /* [nodes][channels] with noise: sum of squares of what single photons add; else NULL */
    double *flat_field;  /* [channels] sum of the weights before they were made those of a ratio */
    int64_t world_plane; /* that a mm of the world's path adds world_weight to; -1: vacuum */
    double world_weight;
    double *node_photons; /* [nodes] of an open beam that would weigh as much */
    double *node_kev;     /* [nodes] */
    int32_t bins;         /* of the spectrum that have photons */
    int32_t materials;    /* that differ: planes without compression */
    double *range;        /* [planes][2] mm: what planes may hold for the bound to hold; NULL: no matter */
    double bound;         /* of the error that fewer nodes and planes make, stated; 0: every bin is used */
    int64_t verified;     /* points of the range of lengths on which it was found */
} skg_model;

/* options: quantity, response, world, bands, tolerance, noise (variances, too; weights are those of
 * photons in a pixel, not of a ratio). view, and options->views: whose lengths a compression has to hold for.
 */
skg_status skg_model_create(const skg_scene *scene, const skg_view *view, const skg_spectrum *spectrum,
                            const skg_plan_options *options, skg_model *model);
void skg_model_release(skg_model *model);

#endif
