/* Makes the model of a plan: planes, nodes, weights. */
#include "spectral/model.h"

#include "beam/counter.h"
#include "beam/spectrum.h"
#include "material/material.h"
#include "spectral/compression.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Attenuations that differ from proportional ones by less than this share are proportional: tables and sums are
 * rounded. */
static const double PROPORTIONAL = 1e-13;

/* The state of making a model. */
typedef struct {
    const skg_scene *scene;
    const skg_spectrum *spectrum;
    const skg_plan_options *options;
    int64_t bodies; /* the parts, the world, then the curves of volumes */
    int64_t *bins;  /* [nodes] bins of the spectrum that have photons */
    double *mu;     /* [bodies][nodes] 1/mm */
    double *bases;  /* [planes][nodes] 1/mm, the attenuation of a mm of a plane */
    int64_t *plane; /* [bodies] -1: the body attenuates nothing */
    double *factor; /* [bodies] by which a mm of the body adds to its plane */
} making;

static skg_status choose_nodes(making *m, skg_model *model) {
    SKG_TRY(skg_alloc(m->spectrum->count, sizeof *m->bins, "nodes", &m->bins));
    for (int64_t i = 0; i < m->spectrum->count; i++)
        if (m->spectrum->photons[i] > 0) m->bins[model->nodes++] = i;
    model->bins = model->nodes;
    SKG_TRY(skg_alloc(model->nodes, sizeof *model->node_kev, "nodes", &model->node_kev));
    SKG_TRY(skg_alloc(model->nodes, sizeof *model->node_photons, "nodes", &model->node_photons));
    for (int32_t n = 0; n < model->nodes; n++) {
        model->node_kev[n] = m->spectrum->energy_kev[m->bins[n]];
        model->node_photons[n] = m->spectrum->photons[m->bins[n]];
    }
    return model->nodes > 0 ? SKG_OK : skg_fail(SKG_ERR_BEAM, "the beam has no photons at any energy");
}

/* The material of a curve, numbered over all volumes. */
static const skg_material *curve_of(const skg_scene *scene, int64_t curve) {
    int64_t p = 0;
    for (; !scene->parts[p].volume || curve >= scene->parts[p].volume->curve_count; p++)
        if (scene->parts[p].volume) curve -= scene->parts[p].volume->curve_count;
    return scene->parts[p].volume->curves[curve];
}

static const skg_material *material_of(const making *m, int64_t body) {
    const int64_t parts = m->scene->count;
    return body < parts    ? m->scene->parts[body].material
           : body == parts ? m->options->world
                           : curve_of(m->scene, body - parts - 1);
}

/* Scenes have many parts of few materials: a part takes what one of the last RECENT materials got. */
enum { RECENT = 32 };

/* The part among the recent ones that has this material, or -1. */
static int64_t same_material(const making *m, const skg_material *material, const int64_t *recent,
                             int64_t count) {
    for (int64_t k = 0; k < count && k < RECENT; k++)
        if (material_of(m, recent[k]) == material) return recent[k];
    return -1;
}

static skg_status look_up(making *m, const skg_model *model) {
    int64_t recent[RECENT], count = 0;
    skg_section_table sections = {.count = model->nodes, .energy_kev = model->node_kev};
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(m->bodies * model->nodes, sizeof *m->mu, "attenuation of the parts", &m->mu));
    for (int64_t p = 0; p < m->bodies; p++) {
        double *mu = m->mu + p * model->nodes;
        const skg_material *material = material_of(m, p);
        if (!material) continue; /* vacuum */
        const int64_t known = same_material(m, material, recent, count);
        if (known >= 0) {
            memcpy(mu, m->mu + known * model->nodes, (size_t)model->nodes * sizeof *mu);
            continue;
        }
        recent[count++ % RECENT] = p;
        SKG_TRY_CLEANUP(skg_attenuation_tabulate(material, &sections, mu));
        for (int32_t n = 0; n < model->nodes; n++) mu[n] *= 0.1; /* 1/cm to 1/mm */
    }
cleanup:
    skg_section_table_release(&sections);
    return status;
}

/* Half precision sums distances without weights: each material has a plane, to which parts add 1 or -1 times
 * theirs. */
static int is_unweighted(const making *m) {
    return m->options->precision == SKG_PRECISION_HALF;
}

/* The factor between mu and a basis; 0 if they are not proportional. */
static double factor_of(const making *m, const double *mu, const double *basis, int32_t nodes) {
    const double factor = mu[0] / basis[0];
    if (is_unweighted(m) && memcmp(mu, basis, (size_t)nodes * sizeof *mu) != 0) return 0;
    for (int32_t n = 1; n < nodes; n++)
        if (!(fabs(mu[n] - factor * basis[n]) <= PROPORTIONAL * mu[n])) return 0;
    return factor;
}

/* A new basis is the attenuation of the material. With one energy it is 1/mm, so that the plane is the exponent. */
static void start_basis(const making *m, const double *mu, int32_t nodes, double *basis) {
    memcpy(basis, mu, (size_t)nodes * sizeof *basis);
    if (nodes == 1 && !is_unweighted(m)) basis[0] = 1;
}

static skg_status choose_planes(making *m, skg_model *model) {
    const int32_t nodes = model->nodes;
    int64_t capacity = 0;
    SKG_TRY(skg_alloc(m->bodies, sizeof *m->plane, "planes of the parts", &m->plane));
    SKG_TRY(skg_alloc(m->bodies, sizeof *m->factor, "planes of the parts", &m->factor));
    for (int64_t p = 0; p < m->bodies; p++) {
        const double *mu = m->mu + p * nodes;
        m->plane[p] = -1;
        if (!(mu[0] > 0)) continue; /* no attenuation at one energy means none at any */
        for (int32_t k = 0; k < model->planes && m->plane[p] < 0; k++) {
            m->factor[p] = factor_of(m, mu, m->bases + (int64_t)k * nodes, nodes);
            if (m->factor[p] > 0) m->plane[p] = k;
        }
        if (m->plane[p] >= 0) continue;
        if (model->planes == capacity) {
            capacity = 2 * capacity + 8;
            SKG_TRY(skg_realloc(capacity * nodes, sizeof *m->bases, "planes", &m->bases));
        }
        start_basis(m, mu, nodes, m->bases + (int64_t)model->planes * nodes);
        m->factor[p] = mu[0] / m->bases[(int64_t)model->planes * nodes];
        m->plane[p] = model->planes++;
    }
    return SKG_OK;
}

static void add_contribution(skg_model *model, int64_t first, int64_t *count, int64_t plane, double weight) {
    for (int64_t w = first; w < *count; w++)
        if (model->contributions[w].plane == plane) {
            model->contributions[w].weight += weight;
            return;
        }
    model->contributions[(*count)++] = (skg_contribution){.plane = plane, .weight = weight};
}

/* The planes of the curves of a volume, with weight 0. */
static void add_curves(const making *m, skg_model *model, int64_t part, int64_t first, int64_t *count) {
    const skg_volume *volume = m->scene->parts[part].volume;
    const int64_t body = m->scene->count + 1 + skg_scene_curves(m->scene, part);
    for (int64_t c = 0; volume && c < volume->curve_count; c++)
        if (m->plane[body + c] >= 0) add_contribution(model, first, count, m->plane[body + c], 0);
}

static skg_status list_contributions(const making *m, skg_model *model) {
    const int64_t parts = m->scene->count;
    int64_t count = 0;
    SKG_TRY(skg_alloc(parts + model->curves + 1, sizeof *model->first_contribution, "planes of the parts",
                      &model->first_contribution));
    SKG_TRY(skg_alloc(2 * (parts + model->curves), sizeof *model->contributions, "planes of the parts",
                      &model->contributions));
    for (int64_t p = 0; p < parts; p++) {
        const int64_t inside = m->scene->parts[p].inside, parent = inside >= 0 ? inside : parts;
        const int64_t first = count;
        model->first_contribution[p] = first;
        if (m->plane[p] >= 0) add_contribution(model, first, &count, m->plane[p], m->factor[p]);
        if (m->plane[parent] >= 0)
            add_contribution(model, first, &count, m->plane[parent], -m->factor[parent]);
        if (count > first && model->contributions[first].weight == 0)
            count = first; /* the material of its parent: it is not seen */
        add_curves(m, model, p, first, &count);
    }
    for (int64_t c = 0; c < model->curves; c++) {
        const int64_t body = parts + 1 + c;
        model->first_contribution[parts + c] = count;
        if (m->plane[body] >= 0) add_contribution(model, count, &count, m->plane[body], m->factor[body]);
    }
    model->first_contribution[parts + model->curves] = count;
    return SKG_OK;
}

static int in_band(const making *m, int64_t channel, double energy) {
    const double *edges = m->options->band_kev;
    return m->options->bands == 0 || (energy >= edges[channel] && energy < edges[channel + 1]);
}

static skg_status check_bands(const making *m) {
    const skg_plan_options *options = m->options;
    for (int64_t c = 0; c < options->bands; c++)
        if (!(options->band_kev[c] < options->band_kev[c + 1]))
            return skg_fail(SKG_ERR_BEAM, "band %" PRId64 " runs from %g to %g keV; edges have to rise", c,
                            options->band_kev[c], options->band_kev[c + 1]);
    return SKG_OK;
}

/* The share of what a photon of an energy adds that each layer has. */
static skg_status share_out(const making *m, double energy, int32_t layers, double *shares) {
    const skg_depth_blur *depths = m->options->depth_blur;
    shares[0] = 1;
    for (int32_t l = 0; depths && l < layers; l++)
        SKG_TRY(skg_response_depth_share(m->options->response, energy, 1, l ? depths->to[l - 1] : 0,
                                         depths->to[l], &shares[l]));
    return SKG_OK;
}

/* Scales the variances so that the flat field has the DQE at frequency 0 that was measured: mean^2 / (photons variance). */
static skg_status scale_noise(const making *m, skg_model *model) {
    const skg_dqe *dqe = m->options->dqe;
    double photons = 0, variance = 0;
    if (!dqe || !m->options->noise) return SKG_OK;
    for (int32_t n = 0; n < model->nodes; n++)
        photons += model->node_photons[n], variance += model->variances[n];
    const double most = variance > 0 ? model->flat_field[0] * model->flat_field[0] / (photons * variance) : 0;
    /* Measured values and tables have some digits. */
    if (!(dqe->dqe[0] <= most * 1.01))
        return skg_fail(
            SKG_ERR_BEAM,
            "a DQE of %g at frequency 0 is more than the detector's response allows for this beam, %.3g; "
            "give a lower DQE, or a response that records more",
            dqe->dqe[0], most);
    model->noise_scale = most / dqe->dqe[0];
    for (int32_t n = 0; n < model->nodes; n++) model->variances[n] *= model->noise_scale;
    return SKG_OK;
}

static int shows_ratio(const making *m) {
    return skg_quantity_is_ratio(m->options) && !skg_quantity_is_absolute(m->options);
}

/* Sets the weights of a node: of photons that count in each window. Each adds 1, so that the variance is the mean. */
static void weigh_counts(const making *m, const skg_counter_row *row, int32_t n, skg_model *model) {
    for (int32_t c = 0; c < model->channels; c++) {
        const double counts = m->spectrum->photons[m->bins[n]] * row->counts[c];
        model->weights[n * model->channels + c] = counts;
        if (m->options->noise) model->variances[n * model->channels + c] = counts;
        model->flat_field[c] += counts;
    }
}

static skg_status weigh_all_counts(const making *m, skg_model *model) {
    const skg_counter_row **rows = NULL;
    SKG_TRY(skg_alloc(model->nodes, sizeof *rows, "nodes", &rows));
    const skg_status status = skg_counter_rows_get(m->options->counter, model->nodes, model->node_kev, rows);
    for (int32_t n = 0; status == SKG_OK && n < model->nodes; n++) weigh_counts(m, rows[n], n, model);
    skg_free(&rows);
    return status;
}

/* Sets the weights of a node: what each band records of the photons in each depth. */
static skg_status weigh_node(const making *m, int32_t n, skg_model *model) {
    const int noise = m->options->noise;
    const int32_t channels = model->channels;
    const int64_t bin = m->bins[n];
    const double energy = m->spectrum->energy_kev[bin];
    double worth = 0, variance = 0, shares[SKG_DEPTHS_MAX];
    SKG_TRY(skg_signal_get(m->options, energy, &worth));
    SKG_TRY(share_out(m, energy, model->layers, shares));
    if (noise) SKG_TRY(skg_signal_variance_get(m->options, energy, worth, &variance));
    for (int32_t c = 0; c < channels; c++)
        for (int32_t l = 0; in_band(m, c, energy) && l < model->layers; l++) {
            const int32_t at = n * skg_model_sums(model) + l * channels + c;
            const double photons = m->spectrum->photons[bin] * shares[l];
            model->weights[at] = photons * worth;
            model->flat_field[c] += photons * worth;
            if (noise) model->variances[at] = photons * variance;
        }
    return SKG_OK;
}

static int32_t channels_of(const skg_plan_options *options) {
    if (options->counter) return (int32_t)options->counter->counting.count;
    return options->bands > 0 ? (int32_t)options->bands : 1;
}

static skg_status weigh(const making *m, skg_model *model) {
    const int noise = m->options->noise;
    const int is_ratio = shows_ratio(m);
    SKG_TRY(check_bands(m));
    model->channels = channels_of(m->options);
    model->layers = m->options->depth_blur ? (int32_t)m->options->depth_blur->count : 1;
    const int32_t channels = model->channels, sums = skg_model_sums(model);
    SKG_TRY(skg_alloc((int64_t)model->nodes * sums, sizeof *model->weights, "nodes", &model->weights));
    SKG_TRY(skg_alloc(channels, sizeof *model->flat_field, "nodes", &model->flat_field));
    if (noise)
        SKG_TRY(
            skg_alloc((int64_t)model->nodes * sums, sizeof *model->variances, "nodes", &model->variances));
    if (m->options->counter) return weigh_all_counts(m, model);
    for (int32_t n = 0; n < model->nodes; n++) SKG_TRY(weigh_node(m, n, model));
    SKG_TRY(scale_noise(m, model));
    for (int32_t c = 0; c < channels && is_ratio; c++) {
        if (!(model->flat_field[c] > 0))
            return skg_fail(
                SKG_ERR_BEAM,
                "channel %" PRId32 " records nothing of the flat field, so there is no ratio to it", c);
        for (int32_t k = 0; k < model->nodes * model->layers; k++)
            model->weights[k * channels + c] /= model->flat_field[c];
    }
    return SKG_OK;
}

/* Appends the losses of the shades to the bases. */
static skg_status add_shades(making *m, const skg_view *view, skg_model *model) {
    const int64_t planes = model->planes, nodes = model->nodes;
    skg_shades *shades = &model->shades;
    SKG_TRY(skg_shades_find(view, m->spectrum, m->options, shades));
    if (shades->count == 0) return SKG_OK;
    SKG_TRY(skg_realloc((planes + shades->count) * nodes, sizeof *m->bases, "planes", &m->bases));
    for (int32_t k = 0; k < shades->count; k++)
        for (int32_t n = 0; n < nodes; n++)
            m->bases[(planes + k) * nodes + n] = shades->losses[k * m->spectrum->count + m->bins[n]];
    return SKG_OK;
}

static skg_status list_coefficients(const making *m, skg_model *model) {
    const int32_t planes = model->planes > 0 ? model->planes : 1; /* an empty plane if nothing attenuates */
    const int64_t width = planes + model->shades.count;
    SKG_TRY(skg_alloc(model->nodes * width, sizeof *model->coefficients, "nodes", &model->coefficients));
    for (int32_t n = 0; n < model->nodes; n++) {
        double *row = model->coefficients + n * width;
        for (int32_t k = 0; k < model->planes; k++) row[k] = m->bases[(int64_t)k * model->nodes + n];
        for (int32_t k = 0; k < model->shades.count; k++)
            row[planes + k] = m->bases[(int64_t)(model->planes + k) * model->nodes + n];
    }
    model->materials = model->planes;
    model->planes = planes;
    model->world_plane = m->plane[m->scene->count];
    model->world_weight = m->factor[m->scene->count];
    return SKG_OK;
}

skg_status skg_model_begin(const skg_scene *scene, const skg_view *view, const skg_spectrum *spectrum,
                           const skg_plan_options *options, skg_model *model) {
    making m = {.scene = scene, .spectrum = spectrum, .options = options};
    skg_status status = SKG_OK;
    *model = (skg_model){.noise_scale = 1, .curves = skg_scene_curves(scene, scene->count)};
    m.bodies = scene->count + 1 + model->curves;
    SKG_TRY_CLEANUP(choose_nodes(&m, model));
    SKG_TRY_CLEANUP(look_up(&m, model));
    SKG_TRY_CLEANUP(choose_planes(&m, model));
    SKG_TRY_CLEANUP(list_contributions(&m, model));
    SKG_TRY_CLEANUP(add_shades(&m, view, model));
    SKG_TRY_CLEANUP(list_coefficients(&m, model));
    SKG_TRY_CLEANUP(weigh(&m, model));
    if (options->tolerance > 0 && !is_unweighted(&m) && model->nodes > 2 && model->materials > 0)
        SKG_TRY_CLEANUP(skg_compress_begin(scene, view, options, &m.bases, model));
cleanup:
    skg_free(&m.bins);
    skg_free(&m.mu);
    skg_free(&m.bases);
    skg_free(&m.plane);
    skg_free(&m.factor);
    return status;
}

skg_status skg_model_end(skg_model *model, int *changed) {
    return skg_compress_end(model, changed);
}

void skg_model_release(skg_model *model) {
    skg_compress_drop(model);
    skg_free(&model->first_contribution);
    skg_free(&model->contributions);
    skg_free(&model->coefficients);
    skg_free(&model->weights);
    skg_free(&model->variances);
    skg_free(&model->flat_field);
    skg_free(&model->node_kev);
    skg_free(&model->range);
    skg_free(&model->node_photons);
    skg_shades_release(&model->shades);
}
