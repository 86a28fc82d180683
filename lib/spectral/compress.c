/* Finds few energies that stand for a spectrum, within a tolerance. */
#include "spectral/compression.h"

#include "core/threads.h"
#include "spectral/model.h"
#include "spectral/verification.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The number of nodes that a plane is multiplied for, while it is not known: most beams need 8 to 24. */
static const double LIKELY_NODES = 12;
/* The share of the tolerance that the error of the planes may have. An error that is found is doubled to a bound, so
 * this leaves three quarters of the tolerance to the nodes. */
static const double SHARE_OF_PLANES = 0.125;
/* Points by which planes are chosen: corners of the range, random points, and lengths that rays meet. A few hundred
 * points suffice for a choice; the verification uses thousands. */
static const skg_sampling CHOICE = {.corners = 64, .draws = 160, .rays = 96, .seed = 3};

/* Planes and contributions of a model before its planes are rewritten. */
typedef struct {
    int32_t planes, reserved;
    int64_t world_plane;
    int64_t *first_contribution;
    skg_contribution *contributions;
} original_planes;

typedef struct skg_compressing {
    const skg_scene *scene;
    double *mu;
    double tolerance, errors;
    int is_ratio, is_log;
    double log_error, least; /* of -ln, and of transmissions, on the rays that were traced */
    skg_polychromatic beam;
    skg_ranges ranges;
    double *shares, *sums; /* [nodes][sets], [sets] */
    skg_basis basis;
    original_planes before;
    skg_async async; /* searches: */
    skg_compression found;
    skg_status status;
    char message[512];
} compressing;

/* Errors are relative from this transmission on. A ratio to the flat field in a world that transmits little, or behind a
 * filter, shows small transmissions, so it needs a lower limit. */
static skg_status find_floor(compressing *c, const skg_model *model) {
    double *lengths = NULL, *exact = NULL, *exponents = NULL;
    skg_status status = SKG_OK;
    c->beam.floor = SKG_RELATIVE_FROM;
    if (!c->is_ratio || (model->world_plane < 0 && model->shades.count == 0)) return SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(c->beam.materials, sizeof *lengths, "nodes", &lengths));
    SKG_TRY_CLEANUP(skg_alloc(c->beam.sets, sizeof *exact, "nodes", &exact));
    SKG_TRY_CLEANUP(skg_alloc(c->beam.bins, sizeof *exponents, "nodes", &exponents));
    if (model->world_plane >= 0) lengths[model->world_plane] = c->ranges.way;
    for (int32_t k = 0; k < model->shades.count; k++) lengths[model->planes + k] = model->shades.high[k];
    skg_transmit_exact(&c->beam, lengths, exact, exponents);
    for (int32_t s = 0; s < c->beam.sets; s++)
        if (c->sums[s] > 0)
            c->beam.floor = fmin(c->beam.floor, SKG_RELATIVE_FROM * fmax(exact[s], exp(-SKG_EXPONENT_MAX)));
cleanup:
    skg_free(&lengths);
    skg_free(&exact);
    skg_free(&exponents);
    return status;
}

/* The sets of weights: the means of layers and channels and, with noise, their variances. */
static int32_t sets_of(const skg_model *model) {
    return model->variances ? 2 * skg_model_sums(model) : skg_model_sums(model);
}

/* The table that holds the weights of set s. */
static double *table_of(const skg_model *model, int32_t s) {
    return s < skg_model_sums(model) ? model->weights : model->variances;
}

/* The weight of node n in set s. */
static double *weight_at(const skg_model *model, int32_t n, int32_t s) {
    const int32_t sums = skg_model_sums(model);
    return &table_of(model, s)[n * sums + s % sums];
}

static skg_status describe(compressing *c, const skg_model *model) {
    const int32_t bins = model->nodes, sets = sets_of(model);
    SKG_TRY(skg_alloc((int64_t)bins * sets, sizeof *c->shares, "nodes", &c->shares));
    SKG_TRY(skg_alloc(sets, sizeof *c->sums, "nodes", &c->sums));
    for (int32_t k = 0; k < bins * sets; k++) c->sums[k % sets] += *weight_at(model, k / sets, k % sets);
    for (int32_t k = 0; k < bins * sets; k++)
        c->shares[k] = c->sums[k % sets] > 0 ? *weight_at(model, k / sets, k % sets) / c->sums[k % sets] : 0;
    c->beam = (skg_polychromatic){.bins = bins,
                                  .materials = skg_model_width(model),
                                  .sets = sets,
                                  .paired = model->variances != NULL,
                                  .mu = c->mu,
                                  .shares = c->shares,
                                  .low = c->ranges.low,
                                  .high = c->ranges.high};
    return find_floor(c, model);
}

/* Shades have ranges of their own. Over the rays, each goes once from end to end. */
static void add_shades(const skg_model *model, skg_ranges *ranges) {
    const skg_shades *shades = &model->shades;
    for (int32_t k = 0; k < shades->count; k++) {
        const int32_t at = model->planes + k;
        const double low = shades->low[k], high = shades->high[k];
        ranges->low[at] = low, ranges->high[at] = high;
        for (int64_t r = 0; r < ranges->rays; r++)
            ranges->lengths[r * ranges->planes + at] =
                low + (high - low) * (double)r / (double)(ranges->rays - 1);
    }
}

/* Adds the shades behind the planes of the basis, which stay as they are: no part adds to a shade. */
static skg_status extend_basis(const compressing *c, const skg_model *model, skg_basis *basis) {
    const int32_t shades = model->shades.count, materials = model->planes, planes = basis->planes;
    const int64_t bins = c->beam.bins, width = planes + shades;
    double *mix = NULL;
    if (shades == 0) return SKG_OK;
    SKG_TRY(skg_realloc(width, sizeof *basis->material, "basis", &basis->material));
    SKG_TRY(skg_realloc((materials + shades) * bins, sizeof *basis->mu, "basis", &basis->mu));
    SKG_TRY(skg_alloc((materials + shades) * width, sizeof *mix, "basis", &mix));
    for (int32_t m = 0; m < materials; m++)
        memcpy(mix + m * width, basis->mix + (int64_t)m * planes, (size_t)planes * sizeof *mix);
    for (int32_t k = 0; k < shades; k++) {
        basis->material[planes + k] = materials + k;
        mix[(materials + k) * width + planes + k] = 1;
    }
    memcpy(basis->mu + materials * bins, c->mu + materials * bins, (size_t)(shades * bins) * sizeof *mix);
    skg_free(&basis->mix);
    basis->mix = mix;
    basis->planes = (int32_t)width;
    return SKG_OK;
}

/* --- planes --- */

/* Sets weights [planes] to what a mm of a part adds to the planes of a basis. */
static void mix_contributions(const skg_model *model, const skg_basis *basis, int64_t part, double *weights) {
    memset(weights, 0, (size_t)basis->planes * sizeof *weights);
    for (int64_t w = model->first_contribution[part]; w < model->first_contribution[part + 1]; w++)
        for (int32_t k = 0; k < basis->planes; k++)
            weights[k] += model->contributions[w].weight *
                          basis->mix[model->contributions[w].plane * basis->planes + k];
}

static double cost_of(const compressing *c, const skg_model *model, const skg_basis *basis, double *weights) {
    double cost = basis->planes * (SKG_COST_OF_PLANE + LIKELY_NODES);
    for (int64_t p = 0; p < c->scene->count; p++) {
        mix_contributions(model, basis, p, weights);
        for (int32_t k = 0; k < basis->planes; k++)
            if (weights[k] != 0) cost += SKG_COST_OF_CONTRIBUTION * c->ranges.hits[p];
    }
    return cost;
}

/* Chooses the cheapest of the layouts that the tolerance allows, from one plane for each material downwards. */
static skg_status choose_planes(compressing *c, const skg_model *model) {
    const int32_t materials = model->planes;
    skg_polychromatic beam = c->beam; /* without shades, which are its last materials */
    skg_lengths points = {0};
    skg_basis trial = {0};
    int32_t *order = NULL;
    const skg_rays rays = {c->ranges.rays, c->ranges.planes, c->ranges.lengths};
    double *weights = NULL, *bin_weight = NULL, least = HUGE_VAL;
    skg_status status = SKG_OK;
    beam.materials = materials;
    SKG_TRY_CLEANUP(skg_alloc(materials, sizeof *order, "basis", &order));
    SKG_TRY_CLEANUP(skg_alloc(materials, sizeof *weights, "basis", &weights));
    SKG_TRY_CLEANUP(skg_alloc(beam.bins, sizeof *bin_weight, "basis", &bin_weight));
    SKG_TRY_CLEANUP(skg_lengths_fill(&beam, &CHOICE, &rays, &points));
    SKG_TRY_CLEANUP(skg_basis_weigh(&beam, &points, bin_weight));
    SKG_TRY_CLEANUP(skg_basis_order(&beam, bin_weight, (int32_t)model->world_plane, order));
    for (int32_t planes = materials; planes >= 1; planes--) {
        SKG_TRY_CLEANUP(skg_basis_make(&beam, &points, bin_weight, order, planes, &trial));
        if (planes < materials && trial.error > SHARE_OF_PLANES * c->tolerance) break;
        const double cost = cost_of(c, model, &trial, weights);
        if (cost < least) {
            const skg_basis better = trial;
            trial = c->basis, c->basis = better, least = cost;
        }
        skg_basis_release(&trial);
    }
    status = extend_basis(c, model, &c->basis);
cleanup:
    skg_basis_release(&trial);
    skg_lengths_release(&points);
    skg_free(&order);
    skg_free(&weights);
    skg_free(&bin_weight);
    return status;
}

/* --- the model with fewer --- */

/* Marks the planes that the curves of a volume add to. */
static void mark_planes(const compressing *c, const skg_model *model, int64_t part, double *weights,
                        char *seen) {
    const skg_volume *volume = part < c->scene->count ? c->scene->parts[part].volume : NULL;
    const int64_t first = c->scene->count + (volume ? skg_scene_curves(c->scene, part) : 0);
    memset(seen, 0, (size_t)c->basis.planes);
    for (int64_t k = 0; volume && k < volume->curve_count; k++) {
        mix_contributions(model, &c->basis, first + k, weights);
        for (int32_t p = 0; p < c->basis.planes; p++) seen[p] |= weights[p] != 0;
    }
}

static skg_status rewrite_contributions(compressing *c, skg_model *model) {
    const int32_t planes = c->basis.planes;
    const int64_t parts = c->scene->count + model->curves;
    char *seen = NULL;
    int64_t *first = NULL, count = 0;
    skg_contribution *contributions = NULL;
    double *weights = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(parts + 1, sizeof *first, "planes of the parts", &first));
    SKG_TRY_CLEANUP(skg_alloc(parts * planes, sizeof *contributions, "planes of the parts", &contributions));
    SKG_TRY_CLEANUP(skg_alloc(planes, sizeof *weights, "planes of the parts", &weights));
    SKG_TRY_CLEANUP(skg_alloc(planes, sizeof *seen, "planes of the parts", &seen));
    for (int64_t p = 0; p < parts; p++) {
        first[p] = count;
        mark_planes(c, model, p, weights, seen);
        mix_contributions(model, &c->basis, p, weights);
        for (int32_t k = 0; k < planes; k++)
            if (weights[k] != 0 || seen[k])
                contributions[count++] = (skg_contribution){.plane = k, .weight = weights[k]};
    }
    first[parts] = count;
    c->before = (original_planes){.planes = model->planes,
                                  .world_plane = model->world_plane,
                                  .first_contribution = model->first_contribution,
                                  .contributions = model->contributions};
    model->first_contribution = first, model->contributions = contributions;
    first = NULL, contributions = NULL;
    int32_t world = 0;
    while (world < planes && c->basis.material[world] != model->world_plane) world++;
    if (model->world_plane >= 0) model->world_plane = world; /* the basis took its material first */
    model->planes = planes - model->shades.count;
cleanup:
    skg_free(&first);
    skg_free(&contributions);
    skg_free(&weights);
    skg_free(&seen);
    return status;
}

/* The values that planes take over the range of lengths, widened by the rounding of their sums in single
 * precision. */
static skg_status find_range(const compressing *c, skg_model *model) {
    const int32_t planes = c->basis.planes;
    SKG_TRY(skg_alloc(2 * (int64_t)planes, sizeof *model->range, "planes", &model->range));
    for (int32_t k = 0; k < planes; k++) {
        double low = 0, high = 0;
        for (int32_t m = 0; m < c->beam.materials; m++) {
            const double mix = c->basis.mix[m * planes + k];
            const double ends[2] = {mix * c->beam.low[m], mix * c->beam.high[m]};
            low += fmin(ends[0], ends[1]), high += fmax(ends[0], ends[1]);
        }
        const double rounding = 1e-5 * (high - low) + 1e-3;
        model->range[2 * k] = low - rounding, model->range[2 * k + 1] = high + rounding;
    }
    return SKG_OK;
}

static void rewrite_nodes(const compressing *c, skg_model *model) {
    const skg_nodes *nodes = &c->found.nodes;
    const int32_t sets = c->beam.sets, bins = c->beam.bins, planes = c->basis.planes;
    for (int32_t n = 0; n < nodes->count; n++) {
        const int32_t bin = nodes->bin[n]; /* at least n, so that nothing is overwritten before it is read */
        double before = 0, after = 0;
        for (int32_t s = 0; s < sets; s++) {
            const double weight = nodes->shares[n * sets + s] * c->sums[s];
            *weight_at(model, n, s) = weight;
            if (s >= skg_model_sums(model)) continue;
            before += c->shares[bin * sets + s] * c->sums[s];
            after += weight;
        }
        model->node_kev[n] = model->node_kev[bin];
        model->node_photons[n] = before > 0 ? model->node_photons[bin] * (after / before) : 0;
        for (int32_t k = 0; k < planes; k++)
            model->coefficients[n * planes + k] = c->mu[(int64_t)c->basis.material[k] * bins + bin];
    }
    model->nodes = nodes->count;
    model->bound = c->found.bound;
    model->verified = c->found.verified;
    model->log_error = c->errors * c->log_error;
    model->least = c->least;
}

/* The planes from before; those of the basis go. */
static void restore_planes(compressing *c, skg_model *model) {
    skg_free(&model->range);
    skg_free(&model->first_contribution);
    skg_free(&model->contributions);
    model->planes = c->before.planes;
    model->world_plane = c->before.world_plane;
    model->first_contribution = c->before.first_contribution;
    model->contributions = c->before.contributions;
    c->before = (original_planes){0};
}

/* --- the search beside the caller --- */

static void release(compressing **compressed) {
    compressing *c = *compressed;
    if (!c) return;
    skg_async_end(&c->async);
    skg_ranges_release(&c->ranges);
    skg_basis_release(&c->basis);
    skg_nodes_release(&c->found.nodes);
    skg_free(&c->before.first_contribution);
    skg_free(&c->before.contributions);
    skg_free(&c->shares);
    skg_free(&c->sums);
    skg_free(&c->mu);
    skg_free(compressed);
}

static void find_nodes(void *user) {
    compressing *c = user;
    c->status =
        skg_nodes_find(&c->beam, c->basis.mu, c->tolerance, c->ranges.rays, c->ranges.lengths, &c->found);
    const skg_rays rays = {c->ranges.rays, c->beam.materials, c->ranges.lengths};
    if (c->status == SKG_OK && c->is_log && c->found.nodes.count > 0)
        c->status =
            skg_nodes_log_error(&c->beam, c->basis.mu, &c->found.nodes, &rays, &c->log_error, &c->least);
    if (c->status != SKG_OK) snprintf(c->message, sizeof c->message, "%s", skg_last_error());
}

skg_status skg_compress_begin(const skg_scene *scene, const skg_view *view, const skg_plan_options *options,
                              double **mu, skg_model *model) {
    const int is_ratio = skg_quantity_is_ratio(options);
    compressing *c = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *c, "nodes", &c));
    /* A ratio to the transmission of the world and the shades has the errors of both. */
    c->errors = is_ratio && (model->world_plane >= 0 || model->shades.count > 0) ? 2 : 1;
    c->scene = scene, c->tolerance = options->tolerance / c->errors, c->is_ratio = is_ratio;
    c->is_log = options->quantity == SKG_QUANTITY_ATTENUATION;
    c->mu = *mu, *mu = NULL;
    SKG_TRY_CLEANUP(skg_ranges_find(scene, view, options->view_count, options->views, model, &c->ranges));
    add_shades(model, &c->ranges);
    SKG_TRY_CLEANUP(describe(c, model));
    SKG_TRY_CLEANUP(choose_planes(c, model));
    SKG_TRY_CLEANUP(find_range(c, model));
    SKG_TRY_CLEANUP(rewrite_contributions(c, model));
    skg_async_begin(&c->async, find_nodes, c);
    model->search = c;
    return SKG_OK;
cleanup:
    release(&c);
    return status;
}

skg_status skg_compress_end(skg_model *model, int *restored) {
    compressing *c = model->search;
    *restored = 0;
    if (!c) return SKG_OK;
    skg_async_end(&c->async);
    const skg_status status = c->status == SKG_OK ? SKG_OK : skg_fail(c->status, "%s", c->message);
    if (status == SKG_OK && c->found.nodes.count > 0) {
        c->found.bound *= c->errors;
        rewrite_nodes(c, model);
    } else {
        restore_planes(c, model);
        *restored = 1;
    }
    release(&model->search);
    return status;
}

void skg_compress_drop(skg_model *model) {
    release(&model->search);
}
