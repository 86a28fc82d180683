#include "spectral/rounding.h"

#include "spectral/ranges.h"
#include "spectral/verify.h"

#include <math.h>

enum { RAYS = SKG_TRACED_SIDE * SKG_TRACED_SIDE };

/* By how much a length may be wrong, as a share of the part's longest (docs/numerics.md, Precision). */
static const double LENGTH_SINGLE = 3e-5, LENGTH_DOUBLE = 1e-11;

/* Of an exponential and the sum of a few hundred of them, and of an exponent by its own size: rounded coefficients,
 * planes and sums, each by half a unit in the last place of 24 or 53 bits. */
static const double EXPONENTIAL_SINGLE = 1e-6, EXPONENTIAL_DOUBLE = 1e-14;
static const double EXPONENT_SINGLE = 3 * 0x1p-24, EXPONENT_DOUBLE = 3 * 0x1p-53;

typedef struct {
    const skg_model *model;
    double length, exponential, exponent; /* shares by which each may be wrong */
    double *exponents;                    /* [RAYS][nodes] */
    double *errors;                       /* [RAYS][nodes] of the exponents, of lengths alone */
    double *mu;                           /* [nodes] of one part less that of its parent, 1/mm */
    double *alone;                        /* [2][nodes] exponents and errors of one part */
    double worst;
} rounding;

/* The relative error of an intensity with these exponents and errors: [nodes] each. */
static double error_of(const rounding *r, const double *exponents, const double *errors) {
    const skg_model *model = r->model;
    double worst = 0;
    for (int32_t c = 0; c < skg_model_sums(model); c++) {
        double flat = 0, passed = 0, wrong = 0;
        for (int32_t n = 0; n < model->nodes; n++) {
            const double weight = model->weights[(int64_t)n * skg_model_sums(model) + c];
            const double intensity = weight * exp(-exponents[n]);
            flat += weight;
            passed += intensity;
            wrong += intensity * (errors[n] + fabs(exponents[n]) * r->exponent);
        }
        if (flat > 0) worst = fmax(worst, wrong / fmax(passed, SKG_RELATIVE_FROM * flat));
    }
    return worst + r->exponential;
}

static void find_mu(rounding *r, int64_t part) {
    const skg_model *model = r->model;
    for (int32_t n = 0; n < model->nodes; n++) {
        r->mu[n] = 0;
        for (int64_t w = model->first_contribution[part]; w < model->first_contribution[part + 1]; w++)
            r->mu[n] +=
                model->contributions[w].weight *
                model->coefficients[(int64_t)n * skg_model_width(model) + model->contributions[w].plane];
    }
}

static void add_part(void *user, int64_t part, const double *lengths, double longest) {
    rounding *r = user;
    const int32_t nodes = r->model->nodes;
    find_mu(r, part);
    for (int64_t ray = 0; ray < RAYS; ray++)
        for (int32_t n = 0; lengths[ray] != 0 && n < nodes; n++) {
            r->exponents[ray * nodes + n] += r->mu[n] * lengths[ray];
            r->errors[ray * nodes + n] += fabs(r->mu[n]) * r->length * longest;
        }
    /* A part that is too small for the rays counts by itself. */
    for (int32_t n = 0; n < nodes; n++) {
        r->alone[n] = fabs(r->mu[n]) * longest;
        r->alone[nodes + n] = r->alone[n] * r->length;
    }
    r->worst = fmax(r->worst, error_of(r, r->alone, r->alone + nodes));
}

skg_status skg_rounding_bound(const skg_scene *scene, const skg_view *view, const skg_model *model,
                              int is_double, double *bound) {
    static const char what[] = "bound of the precision";
    rounding r = {.model = model,
                  .length = is_double ? LENGTH_DOUBLE : LENGTH_SINGLE,
                  .exponential = is_double ? EXPONENTIAL_DOUBLE : EXPONENTIAL_SINGLE,
                  .exponent = is_double ? EXPONENT_DOUBLE : EXPONENT_SINGLE};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc((int64_t)RAYS * model->nodes, sizeof *r.exponents, what, &r.exponents));
    SKG_TRY_CLEANUP(skg_alloc((int64_t)RAYS * model->nodes, sizeof *r.errors, what, &r.errors));
    SKG_TRY_CLEANUP(skg_alloc(model->nodes, sizeof *r.mu, what, &r.mu));
    SKG_TRY_CLEANUP(skg_alloc(2 * (int64_t)model->nodes, sizeof *r.alone, what, &r.alone));
    r.worst = r.exponential;
    SKG_TRY_CLEANUP(skg_ranges_trace(scene, view, model, add_part, &r));
    for (int64_t ray = 0; ray < RAYS; ray++)
        r.worst =
            fmax(r.worst, error_of(&r, r.exponents + ray * model->nodes, r.errors + ray * model->nodes));
    *bound = r.worst;
cleanup:
    skg_free(&r.exponents);
    skg_free(&r.errors);
    skg_free(&r.mu);
    skg_free(&r.alone);
    return status;
}
