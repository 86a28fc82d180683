/* The spectral model of a plan. Private. */
#ifndef SKG_MODEL_H
#define SKG_MODEL_H

#include "core/core.h"
#include "scene/scene.h"
#include "spectral/shading.h"

#include <skiagraph/plan.h>

#include <stdint.h>

/* --- The contribution of a part to a plane. */

/* A hit adds weight times the path parameter, plus bias in units of the accumulator. The weight is mm per mm of
 * path, or a coefficient of a basis. A count plane has weight 0 and bias 1. */
typedef struct {
    int64_t plane;
    double weight, bias;
} skg_contribution;

/* --- The model of a plan: the planes that parts add to, and the coefficients and weights with which planes become
 * exponents and channels of the image. *
 * Materials whose attenuation is proportional over the energies share a plane, each with its factor. A beam of
 * one energy therefore has one plane for any number of materials (docs/numerics.md, Planes and nesting). A part
 * adds its attenuation less that of the parent that it displaces (Vidal and Villard 2016, Eq. 9, for any depth). */

typedef struct {
    int32_t planes, nodes;
    int32_t channels;            /* of the image */
    int32_t layers;              /* images that add up to that of a channel, each blurred by itself; 1: one */
    int64_t *first_contribution; /* [parts + curves + 1] into contributions */
    /* Curves of volumes (scene/volume.h), numbered over all volumes in the order of their parts; they stand behind the parts. A volume's own
     * part contributes with weight 0 to each plane of its curves, beside what it displaces. */
    int64_t curves;
    /* Contributions of a mm of a part's path to the planes. A part without any is invisible. */
    skg_contribution *contributions;
    /* [nodes][planes + shades.count] 1/mm per mm of a plane, then the loss for a unit of a shade */
    double *coefficients;
    double *weights; /* [nodes][layers][channels] of the quantity: per mm2 for fluence, of I/I0 for ratios */
    /* [nodes][layers][channels] with noise: the sum of squares of what single photons add; otherwise NULL. */
    double *variances;
    double noise_scale;  /* by which the variances of single photons were multiplied for a DQE; 1: not */
    double *flat_field;  /* [channels] the sum of the weights before they were made those of a ratio */
    int64_t world_plane; /* the plane to which a mm of the world's path adds world_weight; -1: vacuum */
    double world_weight;
    skg_shades shades;
    double *node_photons; /* [nodes] photons of the flat field that would have the same weight */
    double *node_kev;     /* [nodes] */
    int32_t bins;         /* bins of the spectrum that have photons */
    int32_t materials;    /* that differ: the number of planes without compression */
    /* [planes + shades.count][2] mm, the values of planes and shades for which the bound holds; NULL: any */
    double *range;
    struct skg_compressing *search; /* for fewer nodes, under way (compression.h); NULL: none */
    double bound; /* stated bound of the error by fewer nodes and planes; 0: every bin is used */
    /* If -ln(I/I0) is shown: its absolute error, at most, and the smallest transmission, on the rays that were traced. */
    double log_error, least;
    int64_t verified; /* points of the range of lengths on which the bound was verified */
} skg_model;

/* Planes and shades: what exponents are made of. */
static inline int32_t skg_model_width(const skg_model *model) {
    return model->planes + model->shades.count;
}

/* Begins to make the model (create.c): its planes and contributions, the channels and the shades are known, but not yet the
 * nodes.
 *
 * view      a compression holds for the lengths of this view and of options->views
 * options   quantity, response, world, bands, tolerance; with noise there are variances, and the weights are those of
 *           photons in a pixel, not of a ratio */
skg_status skg_model_begin(const skg_scene *scene, const skg_view *view, const skg_spectrum *spectrum,
                           const skg_plan_options *options, skg_model *model);

/* Completes the model. *changed: 1: planes and contributions are others than before, because fewer nodes do not meet the
 * tolerance. */
skg_status skg_model_end(skg_model *model, int *changed);
void skg_model_release(skg_model *model);

/* Weights of a node: layers times channels. */
static inline int32_t skg_model_sums(const skg_model *model) {
    return model->layers * model->channels;
}

/* --- Accumulators that parts with proportional contributions share. *
 * A part inside another adds to two or more planes: with a positive weight to that of its own material, and with
 * a negative one to that of its parent. Parts whose lists of contributions are proportional (all bones in fat,
 * all vessels in a liver) may add to one accumulator, each with its factor. The list of the accumulator is then
 * applied once for each pixel, not for each hit; a hit is one addition, and its kernel needs no lists. */

typedef struct {
    int32_t sums; /* number of accumulators; 0: parts add to planes by their lists */
    int32_t reserved;
    double *lists;                   /* [sums][planes] what a unit of an accumulator adds to the planes */
    skg_contribution *contributions; /* at most one for each part, to an accumulator */
    int64_t *first_contribution;     /* [parts + 1] */
} skg_mix;

/* Finds the accumulators of these lists. mix->sums is 0 if more than `most` were needed. */
skg_status skg_mix_find(int64_t parts, int32_t planes, const skg_contribution *contributions,
                        const int64_t *first_contribution, int32_t most, skg_mix *mix);
void skg_mix_release(skg_mix *mix);

/* The number of accumulators that these lists need; 0 if it is more than `most`, or if no part adds to more than one plane. */
skg_status skg_mix_choose(int64_t parts, int32_t planes, const skg_contribution *contributions,
                          const int64_t *first_contribution, int32_t most, int32_t *sums);

/* --- The kind of quantity that the images of a plan hold. */

/* Whether images have noise or steps. */
int skg_quantity_has_noise(const skg_plan_options *options);

/* Whether values have to be keV or photons in a pixel until noise has been added, or until a blurred image is divided by its blurred flat
 * field. */
int skg_quantity_is_absolute(const skg_plan_options *options);

/* Whether photons count alike, whatever their energy: where they are counted, and in ratios of bands unless these are
 * weighted by energy. */
int skg_quantity_counts(const skg_plan_options *options);

/* Whether the quantity is a ratio to the flat field. */
int skg_quantity_is_ratio(const skg_plan_options *options);

/* --- Contribution of one photon to an image, by its energy */

/* To the image: the recorded energy, keV, or 1 if photons are counted, times the efficiency of the response. */
skg_status skg_signal_get(const skg_plan_options *options, double energy_kev, double *signal);

/* To the image, likewise, of a photon that crosses the layer of a scintillator along `oblique` times its thickness. */
skg_status skg_signal_oblique_get(const skg_plan_options *options, double energy_kev, double oblique,
                                  double *signal);

/* To the variance, of a photon that adds `signal` (docs/physics.md, Noise). */
skg_status skg_signal_variance_get(const skg_plan_options *options, double energy_kev, double signal,
                                   double *variance);

#endif
