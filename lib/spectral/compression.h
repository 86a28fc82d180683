/* From a spectrum to few planes and few energies. Private. */
#ifndef SKG_COMPRESSION_H
#define SKG_COMPRESSION_H

#include "beam/spectrum.h"
#include "core/core.h"
#include "spectral/model.h"
#include "spectral/verification.h"

/* --- Least squares with coefficients that are not negative (C. L. Lawson, R. J. Hanson, Solving Least Squares
 * Problems, 1974, chapter 23). Double precision and a fixed order give the same bits on every machine, which a
 * linear algebra library would not. */

/* The problem of minimising |A x - b|. */
typedef struct {
    int64_t rows;
    int32_t columns, reserved;
    double *a;    /* [columns][rows] */
    double *b;    /* [rows] */
    double *work; /* [columns + 1][rows] */
    double *x, *gradient;
    int32_t *list;
} skg_least_squares;

/* Allocates a system. The caller fills a and b. */
skg_status skg_least_squares_create(int64_t rows, int32_t columns, skg_least_squares *system);
void skg_least_squares_release(skg_least_squares *system);

/* A system of at most columns + 1 rows with the same solutions and the same |A x - b|. */
skg_status skg_least_squares_reduce(const skg_least_squares *system, skg_least_squares *reduced);

/* Solves with some of the columns and returns |A x - b|^2.
 *
 * in       [count] the numbers of the columns
 * x        [count] the solution
 * spread   [count] the diagonal of the inverse of A^T A, or NULL if it is not wanted; infinite for a column that
 *          depends on those before it, whose x is 0 */
double skg_least_squares_solve(const skg_least_squares *system, int32_t count, const int32_t *in, double *x,
                               double *spread);

/* Solves the least squares with x >= 0 and returns |A x - b|^2. It starts from the columns with x > 0 on entry; columns that leave may come
 * back.
 *
 * least   columns are added only while |A x - b|^2 exceeds this */
double skg_nnls(const skg_least_squares *system, int32_t count, const int32_t *in, double least, double *x);

/* --- Fewer planes than materials. *
 * Tissues differ little: the attenuation of most is a mixture of that of a few. Those few become the planes, and
 * a plane holds mm of its material. They are taken in the order of Gram and Schmidt with the largest remainder
 * first, where an energy is weighted with the photons that arrive and a material with its thickness. The other
 * materials are mixtures by least squares. */

typedef struct {
    int32_t planes, reserved;
    int32_t *material; /* [planes] the material whose attenuation a plane has */
    double *mix;       /* [materials][planes] what a mm of a material adds to the planes */
    double *mu;        /* [materials][bins] 1/mm, as the planes give it */
    double error;      /* the greatest error of a transmission over the points */
} skg_basis;

void skg_basis_release(skg_basis *basis);

/* Weighs each bin with the root of its mean share of the recorded signal over points and sets, because the error of an
 * exponent counts in proportion to that share. weight: [bins]. */
skg_status skg_basis_weigh(const skg_polychromatic *beam, const skg_lengths *points, double *weight);

/* The order[materials] in which materials become planes. first: a material that has to be a plane, or -1. */
skg_status skg_basis_order(const skg_polychromatic *beam, const double *weight, int32_t first,
                           int32_t *order);

/* The basis of the first `planes` materials in that order, and its error at the points. */
skg_status skg_basis_make(const skg_polychromatic *beam, const skg_lengths *points, const double *weight,
                          const int32_t *order, int32_t planes, skg_basis *basis);

/* --- Few energies with positive weights instead of many. *
 * Transmission is a sum of exponentials over the bins. A few bins with weights of their own reproduce it over the
 * range of lengths that rays meet. Method:
 *
 * 1. Non-negative least squares on relative errors at points of the range finds a first set of bins.
 * 2. Bins are removed one by one, each time the one whose absence costs least; the others are shifted to neighbouring
 *    bins while that lowers the errors.
 * 3. Weights are fitted so that the greatest error becomes small (Lawson's reweighting).
 * 4. The result is checked on other points.
 *
 * Several sets of weights (channels, variances) share the bins. */

typedef struct {
    skg_nodes nodes;
    double bound;     /* the stated bound: twice the worst error found */
    int64_t verified; /* points on which it was verified */
} skg_compression;

/* Finds few nodes whose bound is at most `tolerance`. nodes.count is 0 if only all bins meet it.
 *
 * mu      [materials][bins] 1/mm, as the planes give it; that of the beam if they are exact
 * given   [count][materials] mm, lengths that rays meet */
skg_status skg_nodes_find(const skg_polychromatic *beam, const double *mu, double tolerance, int64_t count,
                          const double *given, skg_compression *compression);

/* --- Fewer planes and energies for a model, within a tolerance. */

/* Rough costs per pixel, in multiply-adds of the attenuation, of a hit that adds to a plane and of a plane that
 * is read. They choose between layouts of the same accuracy and estimate the costs of effects. */
#define SKG_COST_OF_CONTRIBUTION 50.0
#define SKG_COST_OF_PLANE 50.0

/* Begins to compress a model that has a plane for each material and a node for each bin: its planes and contributions are
 * rewritten, and a search for nodes begins in a thread of its own (model->search).
 *
 * mu        [planes][nodes] 1/mm, the attenuation of a mm of a plane; taken over, and NULL afterwards
 * options   tolerance > 0, the quantity, and further views */
skg_status skg_compress_begin(const skg_scene *scene, const skg_view *view, const skg_plan_options *options,
                              double **mu, skg_model *model);

/* Waits for the search and rewrites the nodes. If fewer nodes do not meet the tolerance, the planes are again those from
 * before, and *restored is 1. */
skg_status skg_compress_end(skg_model *model, int *restored);

/* Waits for the search, which ends without a result. */
void skg_compress_drop(skg_model *model);

#endif
