#include "plan/model.h"

#include "beam/spectrum.h"

#include <skiagraph/plan.h>

#include <math.h>
#include <string.h>

/* Attenuation over the nodes that differs by less than this is proportional: rounding of tables and sums. */
static const double PROPORTIONAL = 1e-13;

/* What is known while a model is made. */
typedef struct {
    const skg_scene *scene;
    const skg_spectrum *spectrum;
    int64_t *bins;  /* [nodes] of the spectrum that have photons */
    double *mu;     /* [parts][nodes] 1/mm */
    double *bases;  /* [planes][nodes] 1/mm: what a mm of a plane attenuates */
    int64_t *plane; /* [parts] -1: attenuates nothing */
    double *factor; /* [parts] of its material, in its plane */
} making;

static skg_status choose_nodes(making *m, skg_model *model) {
    SKG_TRY(skg_alloc(m->spectrum->count, sizeof *m->bins, "nodes", &m->bins));
    for (int64_t i = 0; i < m->spectrum->count; i++)
        if (m->spectrum->photons[i] > 0) m->bins[model->nodes++] = i;
    return model->nodes > 0 ? SKG_OK : skg_fail(SKG_ERR_BEAM, "the beam has no photons at any energy");
}

static skg_status look_up(making *m, const skg_model *model) {
    const skg_scene *scene = m->scene;
    SKG_TRY(skg_alloc(scene->count * model->nodes, sizeof *m->mu, "attenuation of the parts", &m->mu));
    for (int64_t p = 0; p < scene->count; p++) {
        double *mu = m->mu + p * model->nodes;
        int64_t same = p - 1; /* neighbours often share a material */
        if (p > 0 && scene->parts[same].material == scene->parts[p].material) {
            memcpy(mu, mu - model->nodes, (size_t)model->nodes * sizeof *mu);
            continue;
        }
        for (int32_t n = 0; n < model->nodes; n++) {
            SKG_TRY(skg_material_attenuation(scene->parts[p].material, m->spectrum->energy_kev[m->bins[n]],
                                             &mu[n]));
            mu[n] *= 0.1; /* 1/cm to 1/mm */
        }
    }
    return SKG_OK;
}

/* The factor by which mu is a basis, or 0 where it is not proportional to it. */
static double factor_of(const double *mu, const double *basis, int32_t nodes) {
    const double factor = mu[0] / basis[0];
    for (int32_t n = 1; n < nodes; n++)
        if (!(fabs(mu[n] - factor * basis[n]) <= PROPORTIONAL * mu[n])) return 0;
    return factor;
}

/* A new basis: with one energy 1/mm, so that plane and exponent are the same; else the material itself. */
static void start_basis(const double *mu, int32_t nodes, double *basis) {
    memcpy(basis, mu, (size_t)nodes * sizeof *basis);
    if (nodes == 1) basis[0] = 1;
}

static skg_status choose_planes(making *m, skg_model *model) {
    const int64_t parts = m->scene->count;
    const int32_t nodes = model->nodes;
    int64_t room = 0;
    SKG_TRY(skg_alloc(parts, sizeof *m->plane, "planes of the parts", &m->plane));
    SKG_TRY(skg_alloc(parts, sizeof *m->factor, "planes of the parts", &m->factor));
    for (int64_t p = 0; p < parts; p++) {
        const double *mu = m->mu + p * nodes;
        m->plane[p] = -1;
        if (!(mu[0] > 0)) continue; /* no attenuation at one energy: none at any */
        for (int32_t k = 0; k < model->planes && m->plane[p] < 0; k++) {
            m->factor[p] = factor_of(mu, m->bases + (int64_t)k * nodes, nodes);
            if (m->factor[p] > 0) m->plane[p] = k;
        }
        if (m->plane[p] >= 0) continue;
        if (model->planes == room) {
            room = 2 * room + 8;
            SKG_TRY(skg_realloc(room * nodes, sizeof *m->bases, "planes", &m->bases));
        }
        start_basis(mu, nodes, m->bases + (int64_t)model->planes * nodes);
        m->factor[p] = nodes == 1 ? mu[0] : 1;
        m->plane[p] = model->planes++;
    }
    return SKG_OK;
}

static void add_write(skg_model *model, int64_t first, int64_t *count, int64_t plane, double weight) {
    for (int64_t w = first; w < *count; w++)
        if (model->writes[w].plane == plane) {
            model->writes[w].weight += weight;
            return;
        }
    model->writes[(*count)++] = (skg_plane_weight){.plane = plane, .weight = weight};
}

static skg_status list_writes(const making *m, skg_model *model) {
    const int64_t parts = m->scene->count;
    int64_t count = 0;
    SKG_TRY(skg_alloc(parts + 1, sizeof *model->first_write, "planes of the parts", &model->first_write));
    SKG_TRY(skg_alloc(2 * parts, sizeof *model->writes, "planes of the parts", &model->writes));
    for (int64_t p = 0; p < parts; p++) {
        const int64_t first = count, parent = m->scene->parts[p].inside;
        model->first_write[p] = first;
        if (m->plane[p] >= 0) add_write(model, first, &count, m->plane[p], m->factor[p]);
        if (parent >= 0 && m->plane[parent] >= 0)
            add_write(model, first, &count, m->plane[parent], -m->factor[parent]);
        if (count > first && model->writes[first].weight == 0) count = first; /* as its parent: not seen */
    }
    model->first_write[parts] = count;
    return SKG_OK;
}

static skg_status weigh(const making *m, int32_t quantity, skg_model *model) {
    const int is_ratio = quantity == SKG_TRANSMISSION || quantity == SKG_ATTENUATION;
    double whole = 0;
    model->channels = 1;
    if (model->planes == 0) model->planes = 1; /* an empty one */
    SKG_TRY(skg_alloc((int64_t)model->nodes * model->planes, sizeof *model->coefficients, "nodes",
                      &model->coefficients));
    SKG_TRY(skg_alloc(model->nodes, sizeof *model->weights, "nodes", &model->weights));
    for (int32_t n = 0; n < model->nodes; n++) {
        const int64_t bin = m->bins[n];
        const double energy = quantity == SKG_PHOTONS ? 1 : m->spectrum->energy_kev[bin];
        model->weights[n] = m->spectrum->photons[bin] * energy;
        whole += model->weights[n];
        for (int32_t k = 0; m->bases && k < model->planes; k++)
            model->coefficients[n * model->planes + k] = m->bases[(int64_t)k * model->nodes + n];
    }
    for (int32_t n = 0; n < model->nodes && is_ratio; n++) model->weights[n] /= whole;
    return SKG_OK;
}

skg_status skg_model_create(const skg_scene *scene, const skg_spectrum *spectrum, int32_t quantity,
                            skg_model *model) {
    making m = {.scene = scene, .spectrum = spectrum};
    skg_status status = SKG_OK;
    *model = (skg_model){0};
    SKG_TRY_CLEANUP(choose_nodes(&m, model));
    SKG_TRY_CLEANUP(look_up(&m, model));
    SKG_TRY_CLEANUP(choose_planes(&m, model));
    SKG_TRY_CLEANUP(list_writes(&m, model));
    SKG_TRY_CLEANUP(weigh(&m, quantity, model));
cleanup:
    skg_free(&m.bins);
    skg_free(&m.mu);
    skg_free(&m.bases);
    skg_free(&m.plane);
    skg_free(&m.factor);
    return status;
}

void skg_model_release(skg_model *model) {
    skg_free(&model->first_write);
    skg_free(&model->writes);
    skg_free(&model->coefficients);
    skg_free(&model->weights);
}
