/* Histories of photons on the host, in batches whose spread is the error. */
#include "dose/photons.h"

#include "beam/spectrum.h"
#include "core/maths.h"
#include "core/threads.h"
#include "material/material.h"
#include "material/scattering.h"
#include "plan/decisions.h"
#include "scene/scene.h"
#include "scene/volume.h"

#include <string.h>

/* Rounds of the histories, between which progress is reported. */
enum { ROUNDS = 16 };

/* Fails unless the cells have elements: coefficients alone do not say how much energy stays. */
static skg_status check_cells(const skg_scene_part_data *part) {
    const skg_volume *volume = part->volume;
    if (volume->values == SKG_VOLUME_MU)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: the values of its cells are attenuation coefficients, which do not say what stays "
            "in them; give densities or Hounsfield numbers",
            part->label);
    for (int64_t c = 0; c < volume->curve_count; c++) SKG_TRY(skg_scattering_check(volume->curves[c]));
    return SKG_OK;
}

skg_status skg_dose_walk_check(const skg_recipe *recipe) {
    const skg_scene *scene = recipe->scene;
    skg_material *world = skg_scatter_world(recipe);
    for (int64_t i = 0; i < scene->count; i++) {
        const skg_scene_part_data *part = &scene->parts[i];
        if (part->volume) SKG_TRY(check_cells(part));
        if (!part->mesh->closed)
            return skg_fail(SKG_ERR_UNSUPPORTED,
                            "%s: its mesh is not closed, so what lies inside is not known", part->label);
        if (skg_material_is_void(part->material)) continue;
        SKG_TRY(skg_scattering_check(part->material));
        if (!(part->material->density > 0))
            return skg_fail(SKG_ERR_MATERIAL, "%s: its density is not known; give one in g/cm3", part->label);
    }
    if (world && !skg_material_is_void(world)) SKG_TRY(skg_scattering_check(world));
    return SKG_OK;
}

/* --- what all batches read */

static int32_t number_of(const skg_dose_hall *h, const skg_material *material, skg_material **materials) {
    int32_t m = 0;
    while (m < h->matter_count && materials[m] != material) m++;
    return m;
}

static skg_status add_matter(skg_dose_hall *h, skg_material *material, skg_material **materials,
                             int32_t *number) {
    const skg_recipe *recipe = h->walk->beam->recipe;
    const int32_t fluorescence =
        recipe->options.scatter ? recipe->options.scatter->fluorescence : SKG_FLUORESCENCE_AUTO;
    *number = number_of(h, material, materials);
    if (*number < h->matter_count) return SKG_OK;
    materials[h->matter_count] = material;
    return skg_dose_matter_make(material, fluorescence, h->walk->beam->high_kev,
                                &h->matter[h->matter_count++]);
}

/* Of a volume: each of its curves, at 1 g/cm3, one after the other. */
static skg_status add_curves(skg_dose_hall *h, const skg_volume *volume, skg_material **materials,
                             int32_t *first) {
    int32_t number;
    SKG_TRY(add_matter(h, volume->curves[0], materials, first));
    for (int64_t c = 1; c < volume->curve_count; c++)
        SKG_TRY(add_matter(h, volume->curves[c], materials, &number));
    return SKG_OK;
}

static int64_t count_matter(const skg_scene *scene) {
    int64_t count = 1; /* the world's */
    for (int64_t i = 0; i < scene->count; i++)
        count += scene->parts[i].volume ? scene->parts[i].volume->curve_count : 1;
    return count;
}

static skg_status find_matter(skg_dose_hall *h) {
    const skg_recipe *recipe = h->walk->beam->recipe;
    const skg_scene *scene = recipe->scene;
    skg_material **materials = NULL, *world = skg_scatter_world(recipe);
    SKG_TRY(skg_alloc(scene->count, sizeof *h->of_part, "dose", &h->of_part));
    SKG_TRY(skg_alloc(count_matter(scene), sizeof *h->matter, "dose", &h->matter));
    SKG_TRY(skg_alloc(count_matter(scene), sizeof *materials, "dose", &materials));
    h->of_world = -1;
    skg_status status = SKG_OK;
    for (int64_t i = 0; i < scene->count && status == SKG_OK; i++)
        status = scene->parts[i].volume ? add_curves(h, scene->parts[i].volume, materials, &h->of_part[i])
                                        : add_matter(h, scene->parts[i].material, materials, &h->of_part[i]);
    if (status == SKG_OK && world) status = add_matter(h, world, materials, &h->of_world);
    skg_free(&materials);
    return status;
}

static void widen(skg_dose_hall *h, const double place[3]) {
    for (int k = 0; k < 3; k++)
        h->low[k] = fmin(h->low[k], place[k]), h->high[k] = fmax(h->high[k], place[k]);
}

static void find_box(skg_dose_hall *h) {
    const skg_dose_walk *walk = h->walk;
    for (int k = 0; k < 3; k++) h->low[k] = HUGE_VAL, h->high[k] = -HUGE_VAL;
    for (int64_t i = 0; i < walk->tree->count; i++)
        for (int c = 0; c < 3; c++) widen(h, walk->tree->corners[i] + 3 * c);
    if (walk->beam->recipe->view.projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        widen(h, walk->beam->recipe->view.source);
}

static skg_status open_hall(const skg_dose_walk *walk, skg_dose_hall *h) {
    const skg_recipe *recipe = walk->beam->recipe;
    const skg_spectrum *spectrum = recipe->spectrum;
    double sum = 0, all = 0;
    *h = (skg_dose_hall){.walk = walk, .rules = skg_rules_of(recipe)};
    skg_kerma_table_fill(walk->beam->high_kev, &h->kerma);
    find_box(h);
    SKG_TRY(skg_alloc(spectrum->count, sizeof *h->bins, "dose", &h->bins));
    for (int64_t i = 0; i < spectrum->count; i++) all += spectrum->photons[i];
    for (int64_t i = 0; i < spectrum->count; i++) h->bins[i] = (sum += spectrum->photons[i]) / all;
    SKG_TRY(skg_dose_aims_find(h));
    return find_matter(h);
}

static void close_hall(skg_dose_hall *h) {
    for (int64_t m = 0; m < h->matter_count; m++) skg_dose_matter_free(&h->matter[m]);
    skg_free(&h->matter);
    skg_free(&h->of_part);
    skg_free(&h->bins);
    skg_free(&h->aims);
}

/* --- batches */

typedef struct {
    skg_dose_batch *batches; /* [SKG_DOSE_BATCHES] */
    int64_t each;            /* histories of a batch in this round */
} round_work;

static skg_status run_batch(void *user, int64_t item) {
    const round_work *work = user;
    for (int64_t i = 0; i < work->each; i++) SKG_TRY(skg_dose_follow(&work->batches[item]));
    return SKG_OK;
}

/* Streams of random numbers begin far apart. */
static uint64_t seed_of(int64_t seed, int64_t batch) {
    uint64_t state = (uint64_t)seed * 0x9E3779B97F4A7C15u + (uint64_t)batch;
    for (int k = 0; k < 2; k++) state = (uint64_t)(skg_draw(&state) * 0x1p53) << 11 ^ state;
    return state;
}

static skg_status open_batches(const skg_dose_hall *h, skg_dose_batch *batches) {
    for (int64_t b = 0; b < SKG_DOSE_BATCHES; b++) {
        batches[b] = (skg_dose_batch){.hall = h, .seed = seed_of(h->walk->seed, b)};
        SKG_TRY(skg_alloc(h->rules.scene->count, sizeof(double), "dose", &batches[b].energy));
        SKG_TRY(skg_alloc(h->walk->points, sizeof(double), "dose", &batches[b].kerma));
    }
    return SKG_OK;
}

static void close_batches(skg_dose_batch *batches) {
    for (int64_t b = 0; b < SKG_DOSE_BATCHES; b++) {
        skg_way_free(&batches[b].way);
        skg_way_free(&batches[b].sight);
        skg_free(&batches[b].energy);
        skg_free(&batches[b].kerma);
    }
}

/* Histories of a batch up to the end of a round: as even as whole numbers are. */
static int64_t until(int64_t histories, int64_t round) {
    return histories / SKG_DOSE_BATCHES * (round + 1) / ROUNDS;
}

static skg_status run_rounds(const skg_dose_walk *walk, skg_dose_batch *batches) {
    for (int64_t r = 0; r < ROUNDS; r++) {
        const round_work work = {batches,
                                 until(walk->histories, r) - (r ? until(walk->histories, r - 1) : 0)};
        SKG_TRY(skg_progress_step(walk->progress, r, ROUNDS));
        SKG_TRY(skg_parallel(SKG_DOSE_BATCHES, run_batch, (void *)&work));
    }
    return skg_progress_step(walk->progress, ROUNDS, ROUNDS);
}

/* Energy that the batches were given, to which their scores are scaled. */
typedef struct {
    double given[SKG_DOSE_BATCHES]; /* keV of photons from the source */
    double known;                   /* all of it, as the beam says; 0: no ratios */
} tally;

/* The sum of the batches; with `known` its ratio to the energy from the source, times that of the beam, whose noise both have. */
static double add_up(const tally *t, const double values[SKG_DOSE_BATCHES], double *sigma) {
    double sum = 0, given = 0, squares = 0;
    for (int b = 0; b < SKG_DOSE_BATCHES; b++) sum += values[b], given += t->given[b];
    const int is_ratio = t->known > 0 && given > 0;
    const double factor = is_ratio ? t->known / given : 1;
    for (int b = 0; b < SKG_DOSE_BATCHES; b++) {
        const double off = values[b] - (is_ratio ? sum / given * t->given[b] : sum / SKG_DOSE_BATCHES);
        squares += off * off;
    }
    *sigma = factor * sqrt(squares * SKG_DOSE_BATCHES / (SKG_DOSE_BATCHES - 1));
    return factor * sum;
}

static void collect(const skg_dose_walk *walk, const skg_dose_batch *batches, skg_dose_found *found) {
    const int64_t parts = walk->beam->recipe->scene->count;
    double values[SKG_DOSE_BATCHES], sigma;
    tally t = {.known = skg_dose_beam_energy(walk->beam)};
    const tally plain = {.known = 0};
    for (int b = 0; b < SKG_DOSE_BATCHES; b++) t.given[b] = batches[b].incident;
    for (int64_t p = 0; p < parts; p++) {
        for (int b = 0; b < SKG_DOSE_BATCHES; b++) values[b] = batches[b].energy[p];
        found->energy[p] = add_up(&t, values, &found->sigma[p]);
    }
    for (int64_t p = 0; p < walk->points; p++) {
        for (int b = 0; b < SKG_DOSE_BATCHES; b++) values[b] = batches[b].kerma[p];
        found->kerma[p] = add_up(&plain, values, &found->kerma_sigma[p]);
    }
    found->incident = t.known;
    for (int b = 0; b < SKG_DOSE_BATCHES; b++) values[b] = batches[b].around;
    found->around = add_up(&t, values, &sigma);
    for (int b = 0; b < SKG_DOSE_BATCHES; b++) values[b] = batches[b].escaped;
    found->escaped = add_up(&t, values, &found->escaped_sigma);
    /* Standard error of the absorbed energy, from the balance of each batch: single photons keep energy only in expectation. */
    for (int b = 0; b < SKG_DOSE_BATCHES; b++) {
        values[b] = batches[b].incident - batches[b].escaped - batches[b].around;
        for (int64_t p = 0; p < parts; p++) values[b] -= batches[b].energy[p];
    }
    add_up(&t, values, &found->absorbed_sigma);
}

skg_status skg_dose_walk_run(const skg_dose_walk *given, skg_dose_found *found) {
    skg_dose_walk walk = *given;
    const int64_t parts = walk.beam->recipe->scene->count;
    skg_dose_batch *batches = NULL;
    skg_dose_hall hall;
    skg_status status = SKG_OK;
    walk.histories = skg_round_up(walk.histories, SKG_DOSE_BATCHES);
    *found = (skg_dose_found){.histories = walk.histories};
    SKG_TRY_CLEANUP(open_hall(&walk, &hall));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof(double), "dose", &found->energy));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof(double), "dose", &found->sigma));
    SKG_TRY_CLEANUP(skg_alloc(walk.points, sizeof(double), "dose", &found->kerma));
    SKG_TRY_CLEANUP(skg_alloc(walk.points, sizeof(double), "dose", &found->kerma_sigma));
    SKG_TRY_CLEANUP(skg_alloc(SKG_DOSE_BATCHES, sizeof *batches, "dose", &batches));
    SKG_TRY_CLEANUP(open_batches(&hall, batches));
    SKG_TRY_CLEANUP(run_rounds(&walk, batches));
    collect(&walk, batches, found);
cleanup:
    if (batches) close_batches(batches);
    skg_free(&batches);
    close_hall(&hall);
    return status;
}

void skg_dose_found_free(skg_dose_found *found) {
    skg_free(&found->energy);
    skg_free(&found->sigma);
    skg_free(&found->kerma);
    skg_free(&found->kerma_sigma);
}
