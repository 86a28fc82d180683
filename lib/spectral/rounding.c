/* Bounds the error of intensities by the rounding of planes and exponents. */
#include "spectral/verification.h"

#include "core/maths.h"
#include "mesh/mesh.h"

#include <math.h>

enum { RAYS = SKG_TRACED_SIDE * SKG_TRACED_SIDE };

/* By how much a precision may be wrong (docs/numerics.md, Precision). */
typedef struct {
    double longest, deepest; /* lengths: shares of the part's longest and of its extent along the rays */
    double exponential;      /* an exponential and the sum of a few hundred of them; an image in 16 bits */
    /* by its own size: rounded coefficients, planes and sums, half a unit in the last place each */
    double exponent;
    double image; /* absolute: the least step of an image, in its unit */
} share;

static const share shares[] = {
    [SKG_PRECISION_SINGLE] = {3e-5, 2e-6, 1e-6, 3 * 0x1p-24, 0},
    /* A face counts as steep by the same share of the extent, but its coordinates have 29 bits more. */
    [SKG_PRECISION_DOUBLE] = {1e-11, 2e-6 * 0x1p-29, 1e-14, 3 * 0x1p-53, 0},
    [SKG_PRECISION_HALF] = {3e-5, 2e-6, 0x1p-11, 3 * 0x1p-24, 0x1p-25},
};

/* A part is thin if its lengths may be wrong by this share of the longest. */
static const double THIN = 0.01;

typedef struct {
    const skg_model *model;
    const double *seams; /* [parts] or NULL */
    share by;
    int is_half;
    double *exponents; /* [RAYS][nodes] */
    double *errors;    /* [RAYS][nodes] of the exponents, of lengths alone */
    double *mu;        /* [nodes] of one part less that of its parent, 1/mm */
    double *alone;     /* [2][nodes] exponents and errors of one part */
    double worst;
    double greatest, greatest_alone; /* attenuation of a ray, and of a part by itself */
    skg_rounding *found;
} rounding;

/* The relative error of an intensity with these exponents and errors: [nodes] each. greatest:
 * raised to the attenuation. */
static double error_of(const rounding *r, const double *exponents, const double *errors, double *greatest) {
    const skg_model *model = r->model;
    double worst = 0;
    for (int32_t c = 0; c < skg_model_sums(model); c++) {
        double flat = 0, passed = 0, wrong = 0;
        for (int32_t n = 0; n < model->nodes; n++) {
            const double weight = model->weights[(int64_t)n * skg_model_sums(model) + c];
            const double intensity = weight * exp(-exponents[n]);
            flat += weight;
            passed += intensity;
            wrong += intensity * expm1(errors[n] + fabs(exponents[n]) * r->by.exponent);
        }
        if (!(flat > 0)) continue;
        worst = fmax(worst, (wrong + r->by.image) / fmax(passed, SKG_RELATIVE_FROM * flat));
        *greatest = fmax(*greatest, -log(fmax(passed / flat, SKG_RELATIVE_FROM)));
    }
    return worst + r->by.exponential;
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

/* Half a step of binary16 at a distance, mm: the distance in metres has 11 bits, and 2^-24 is the least step. */
static double half_step(double mm) {
    int exponent = 0;
    frexp(mm * 1e-3, &exponent);
    return 0.5 * fmax(0x1p-24, ldexp(1, exponent - 11)) * 1e3;
}

/* mm by which the lengths of a part may be wrong. */
static double bar_of(const rounding *r, const skg_trace *trace) {
    const double bar =
        fmax(r->by.longest * SKG_TRACED_MARGIN * trace->longest, r->by.deepest * trace->deepest);
    return r->is_half ? bar + trace->met * half_step(trace->farthest) : bar;
}

static void note_thin(skg_rounding *found, const skg_trace *trace, double bar) {
    if (!(bar > THIN * trace->longest) || !(trace->longest > 0)) return;
    found->thin_count++;
    if (found->thin_count > 1 && bar * found->thin_longest <= found->thin_error * trace->longest) return;
    found->thin = trace->part;
    found->thin_error = bar;
    found->thin_longest = trace->longest;
}

static void add_part(void *user, const skg_trace *trace) {
    rounding *r = user;
    const int32_t nodes = r->model->nodes;
    const double own = bar_of(r, trace), bar = own + (r->seams ? r->seams[trace->part] * trace->deepest : 0);
    note_thin(r->found, trace, own);
    if (!r->exponents) return; /* thin parts alone */
    find_mu(r, trace->part);
    for (int64_t ray = 0; ray < RAYS; ray++)
        for (int32_t n = 0; trace->lengths[ray] != 0 && n < nodes; n++) {
            r->exponents[ray * nodes + n] += r->mu[n] * trace->lengths[ray];
            r->errors[ray * nodes + n] += fabs(r->mu[n]) * bar;
        }
    /* A part that is too small for the rays counts by itself. */
    for (int32_t n = 0; n < nodes; n++) {
        r->alone[n] = fabs(r->mu[n]) * SKG_TRACED_MARGIN * trace->longest;
        r->alone[nodes + n] = fabs(r->mu[n]) * bar;
    }
    r->worst = fmax(r->worst, error_of(r, r->alone, r->alone + nodes, &r->greatest_alone));
}

static rounding begin(const skg_model *model, const skg_plan_options *options, skg_rounding *found) {
    *found = (skg_rounding){.thin = -1};
    rounding r = {.model = model, .by = shares[options->precision], .found = found};
    r.is_half = options->precision == SKG_PRECISION_HALF;
    if (options->quantity == SKG_QUANTITY_ENERGY)
        r.by.image *= 1e3; /* energies of an image in 16 bits are in MeV */
    return r;
}

skg_status skg_rounding_find(const skg_scene *scene, const skg_view *view, const skg_model *model,
                             const skg_plan_options *options, const double *seams, skg_rounding *found) {
    static const char what[] = "bound of the precision";
    rounding r = begin(model, options, found);
    r.seams = seams;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc((int64_t)RAYS * model->nodes, sizeof *r.exponents, what, &r.exponents));
    SKG_TRY_CLEANUP(skg_alloc((int64_t)RAYS * model->nodes, sizeof *r.errors, what, &r.errors));
    SKG_TRY_CLEANUP(skg_alloc(model->nodes, sizeof *r.mu, what, &r.mu));
    SKG_TRY_CLEANUP(skg_alloc(2 * (int64_t)model->nodes, sizeof *r.alone, what, &r.alone));
    r.worst = r.by.exponential;
    SKG_TRY_CLEANUP(skg_ranges_trace(scene, view, model, NULL, add_part, &r));
    for (int64_t ray = 0; ray < RAYS; ray++)
        r.worst = fmax(r.worst, error_of(&r, r.exponents + ray * model->nodes, r.errors + ray * model->nodes,
                                         &r.greatest));
    found->bound = r.worst;
    /* An error of -ln(I) is the relative error of I, and a larger share of the attenuation where that is small. */
    if (!(r.greatest > 0)) r.greatest = r.greatest_alone / SKG_TRACED_MARGIN;
    if (options->quantity == SKG_QUANTITY_ATTENUATION && r.greatest > 0) found->bound /= fmin(r.greatest, 1);
cleanup:
    skg_free(&r.exponents);
    skg_free(&r.errors);
    skg_free(&r.mu);
    skg_free(&r.alone);
    return status;
}

/* Whether a part may be thin: its volume over the largest area of the box around it is less than its longest path, and the
 * box's diagonal more than its extent. */
static int may_be_thin(const skg_scene_part_data *part, const share *by) {
    const float *low = part->mesh->lowest, *high = part->mesh->highest;
    double edge[3];
    for (int k = 0; k < 3; k++) edge[k] = (double)high[k] - (double)low[k];
    const double area = edge[0] * edge[1] + edge[1] * edge[2] + edge[2] * edge[0];
    /* Rays to the rim of a detector are longer than that to its middle: at most twice as long. */
    return 2 * by->deepest * skg_length(edge) * area > THIN * fabs(part->mesh->health.volume);
}

skg_status skg_rounding_find_thin(const skg_scene *scene, const skg_view *view, const skg_model *model,
                                  const skg_plan_options *options, skg_rounding *found) {
    rounding r = begin(model, options, found);
    unsigned char *wanted = NULL;
    int64_t count = 0;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(scene->count, sizeof *wanted, "thin parts", &wanted));
    for (int64_t p = 0; p < scene->count; p++)
        count += wanted[p] = (unsigned char)may_be_thin(&scene->parts[p], &r.by);
    if (count) status = skg_ranges_trace(scene, view, model, wanted, add_part, &r);
    skg_free(&wanted);
    return status;
}
