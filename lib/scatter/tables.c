/* The tables of a scene that the kernel of histories reads. */
#include "scatter/interactions.h"
#include "scatter/tracing.h"

#include "beam/grid.h"
#include "beam/spectrum.h"
#include "skg_shared.h"
#include "spectral/model.h"

#include <math.h>
#include <string.h>

/* Columns of the table by energy, as kernels/scatter/scatter.clh has them. */
enum { TOTAL, COMPTON, RAYLEIGH, COMPTON_SHAPE, RAYLEIGH_SHAPE, SIGNAL };

/* Of the table of layers: a share times the cosine bends where the layer is as long as the path that is free, and is linear between
 * 64 cosines within 1e-4. */
enum { COSINES = 65 };

/* The share of photons that is followed as the beam has them, whatever they add. */
static const double AS_THEY_ARE = 0.1;

static skg_status fill_signals(const skg_recipe *recipe, const skg_scatter_physics *p,
                               skg_scatter_tables *t) {
    double *signals = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(2 * p->energies, sizeof *signals, "scatter", &signals));
    double *variances = signals + p->energies;
    for (int64_t i = 0; i < p->energies; i++) {
        const double kev = fmin(fmax(skg_scatter_energy(p, i), p->low_kev), p->high_kev); /* rounding */
        SKG_TRY_CLEANUP(skg_signal_get(&recipe->options, kev, &signals[i]));
        SKG_TRY_CLEANUP(skg_signal_variance_get(&recipe->options, kev, signals[i], &variances[i]));
        if (signals[i] > t->signal) t->signal = signals[i];
        if (variances[i] > t->variance) t->variance = variances[i];
    }
    for (int64_t i = 0; i < p->energies; i++) {
        float *row = t->energies[i * SKG_SCATTER_COLUMNS + SIGNAL];
        row[0] = t->signal > 0 ? (float)(signals[i] / t->signal) : 0;
        row[1] = t->variance > 0 ? (float)(variances[i] / t->variance) : 0;
        double strip = 0, interspace = 0;
        if (recipe->options.grid)
            SKG_TRY_CLEANUP(
                skg_grid_attenuation(recipe->options.grid, skg_scatter_energy(p, i), &strip, &interspace));
        row[2] = (float)strip, row[3] = (float)interspace;
    }
    t->variance *= recipe->model.noise_scale;
cleanup:
    skg_free(&signals);
    return status;
}

static void fill_energies(const skg_scatter_physics *p, skg_scatter_tables *t) {
    const skg_mixture *const columns[] = {p->total, p->compton, p->rayleigh, p->compton_shape,
                                          p->rayleigh_shape};
    for (int64_t i = 0; i < p->energies; i++)
        for (int c = TOTAL; c <= RAYLEIGH_SHAPE; c++)
            memcpy(t->energies[i * SKG_SCATTER_COLUMNS + c], columns[c][i], sizeof *t->energies);
    for (int64_t i = 0; i < p->energies * p->shells; i++)
        memcpy(t->energies[p->energies * SKG_SCATTER_COLUMNS + i], p->emission[i], sizeof *t->energies);
    for (int64_t i = 0; i < p->momenta; i++) {
        memcpy(t->momenta[2 * i], p->incoherent[i], sizeof *t->momenta);
        memcpy(t->momenta[2 * i + 1], p->coherent[i], sizeof *t->momenta);
    }
}

/* Of bins that have photons. */
static skg_status fill_profiles(const skg_spectrum *spectrum, skg_scatter_tables *t) {
    const skg_beam_profile *p = &t->profile;
    const int64_t rows = p->heel ? SKG_HEEL_ROWS : 0, fan = p->bowtie ? p->filter->count : 0;
    t->profile_count = rows * t->bins + 2 * fan;
    if (t->profile_count == 0) return SKG_OK;
    SKG_TRY(skg_alloc(t->profile_count, sizeof *t->profiles, "scatter", &t->profiles));
    float *to = t->profiles;
    for (int64_t r = 0; r < rows; r++)
        for (int64_t b = 0; b < p->bins; b++)
            if (spectrum->photons[b] > 0) *to++ = (float)p->shares[r * p->bins + b];
    for (int64_t k = 0; k < fan; k++)
        to[k] = (float)p->tangents[k], to[fan + k] = (float)p->filter->path_mm[k];
    return SKG_OK;
}

/* Behind the bins. */
static void fill_lines(const skg_emitters *emitters, skg_scatter_tables *t) {
    float(*to)[4] = t->beam + t->bins;
    for (int64_t s = 0; s < emitters->count; s++)
        for (int l = 0; l < SKG_SCATTER_LINES; l++)
            memcpy(to[s * SKG_SCATTER_LINES + l], emitters->of[s].lines[l], sizeof emitters->of[s].lines[l]);
}

/* Photons are drawn with the probability of photons times (signal + a share of the mean signal). */
static skg_status fill_beam(const skg_recipe *recipe, const skg_emitters *emitters, skg_scatter_tables *t) {
    const skg_spectrum *spectrum = recipe->spectrum;
    double signals = 0, sum = 0, share = 0;
    SKG_TRY(skg_alloc(spectrum->count + emitters->count * SKG_SCATTER_LINES, sizeof *t->beam, "scatter",
                      &t->beam));
    for (int64_t i = 0; i < spectrum->count; i++) {
        double signal = 0;
        SKG_TRY(skg_signal_get(&recipe->options, spectrum->energy_kev[i], &signal));
        t->photons += spectrum->photons[i];
        signals += spectrum->photons[i] * signal;
    }
    const double mean = t->photons > 0 ? signals / t->photons : 0;
    for (int64_t pass = 0; pass < 2; pass++)
        for (int64_t i = 0; i < spectrum->count; i++) {
            double signal = 0;
            if (!(spectrum->photons[i] > 0)) continue;
            SKG_TRY(skg_signal_get(&recipe->options, spectrum->energy_kev[i], &signal));
            const double drawn = spectrum->photons[i] * (mean > 0 ? signal + AS_THEY_ARE * mean : 1);
            if (pass == 0) {
                sum += drawn;
                continue;
            }
            share += drawn / sum;
            float *row = t->beam[t->bins++];
            row[0] = (float)spectrum->energy_kev[i];
            row[1] = (float)share;
            row[2] = (float)(spectrum->photons[i] / t->photons / (drawn / sum) / t->profile.mean);
            row[3] = t->profile.bowtie ? (float)t->profile.attenuation[i] : 0;
        }
    fill_lines(emitters, t);
    t->lines = emitters->count * SKG_SCATTER_LINES;
    t->photons *= t->profile.mean; /* weights are about 1, as the roulette has it */
    return t->bins > 0 ? SKG_OK : skg_fail(SKG_ERR_BEAM, "the beam has no photons at any energy");
}

/* Signal of each layer for photons of an energy that arrive at a cosine, over the signal of all layers for photons at right angles. */
static skg_status fill_cosine(const skg_recipe *recipe, const skg_scatter_tables *t, double kev,
                              double cosine, float *shares) {
    const skg_depth_blur *depths = recipe->options.depth_blur;
    double straight = 0, recorded = 0, own = 1;
    SKG_TRY(skg_signal_get(&recipe->options, kev, &straight));
    SKG_TRY(skg_signal_oblique_get(&recipe->options, kev, 1 / cosine, &recorded));
    for (int32_t l = 0; l < t->layers; l++) {
        if (depths)
            SKG_TRY(skg_response_depth_share(recipe->options.response, kev, 1 / cosine,
                                             l ? depths->to[l - 1] : 0, depths->to[l], &own));
        shares[l] = straight > 0 ? (float)(cosine * recorded / straight * own) : 0;
    }
    return SKG_OK;
}

static skg_status fill_layers(const skg_recipe *recipe, const skg_scatter_physics *p, skg_scatter_tables *t,
                              float *table) {
    for (int64_t i = 0; i < p->energies; i++) {
        const double kev = fmin(fmax(skg_scatter_energy(p, i), p->low_kev), p->high_kev); /* rounding */
        float *row = table + i * t->cosines * t->layers;
        if (!t->oblique)
            SKG_TRY(fill_cosine(recipe, t, kev, 1, row));
        else /* at a cosine of 0 it is 0 */
            for (int32_t c = 1; c < t->cosines; c++)
                SKG_TRY(fill_cosine(recipe, t, kev, (double)c / (COSINES - 1), row + c * t->layers));
    }
    return SKG_OK;
}

static skg_status fill_detector(const skg_recipe *recipe, const skg_scatter_physics *p,
                                skg_scatter_tables *t) {
    const skg_plan_options *options = &recipe->options;
    const int64_t edges = options->bands > 0 ? options->bands + 1 : 0;
    t->bands = recipe->model.channels, t->layers = recipe->model.layers;
    t->oblique = options->oblique;
    t->cosines = t->oblique ? COSINES : t->layers > 1 ? 1 : 0;
    t->detector_count = edges + p->energies * t->cosines * t->layers;
    if (t->detector_count == 0) return SKG_OK;
    SKG_TRY(skg_alloc(t->detector_count, sizeof *t->detector, "scatter", &t->detector));
    for (int64_t b = 0; b < edges; b++) t->detector[b] = (float)options->band_kev[b];
    return t->cosines ? fill_layers(recipe, p, t, t->detector + edges) : SKG_OK;
}

skg_status skg_scatter_tables_make(const skg_scatter_work *work, const skg_scatter_object *object,
                                   skg_scatter_tables *t) {
    const skg_recipe *recipe = work->recipe;
    const skg_scatter_physics *p = &object->physics;
    *t = (skg_scatter_tables){0};
    t->energy_rows = p->energies * (SKG_SCATTER_COLUMNS + p->shells);
    SKG_TRY(skg_alloc(t->energy_rows, sizeof *t->energies, "scatter", &t->energies));
    SKG_TRY(skg_alloc(p->momenta * 2, sizeof *t->momenta, "scatter", &t->momenta));
    SKG_TRY(skg_alloc(SKG_ANGLE_ROWS * (SKG_SCATTER_ANGLES + 1), sizeof *t->angles, "scatter", &t->angles));
    fill_energies(p, t);
    SKG_TRY(fill_signals(recipe, p, t));
    SKG_TRY(fill_detector(recipe, p, t));
    SKG_TRY(skg_beam_profile_make(work, &t->profile));
    SKG_TRY(fill_beam(recipe, &object->emitters, t));
    SKG_TRY(fill_profiles(recipe->spectrum, t));
    return skg_angles_make(p, object->cells.mean, t->angles);
}

void skg_scatter_tables_free(skg_scatter_tables *t) {
    skg_free(&t->energies);
    skg_free(&t->momenta);
    skg_free(&t->angles);
    skg_free(&t->beam);
    skg_free(&t->profiles);
    skg_free(&t->detector);
    skg_beam_profile_free(&t->profile);
}
