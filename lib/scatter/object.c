/* Builds the scattering object of a frame: the physics of its materials, and its cells. */
#include "scatter/voxels.h"

#include "beam/spectrum.h"
#include "core/maths.h"
#include "geometry/overlaps.h"
#include "material/material.h"
#include "plan/decisions.h"

#include <math.h>
#include <string.h>

/* Photons are followed down to this share of the lowest energy of the beam, and at least down to LOWEST_KEV: of more than 500 keV Compton
 * scattering straight back leaves less than a third, and of more than 1 MeV less than a fifth. Below it water absorbs more than it scatters. */
static const double LOWEST = 0.25, LOWEST_KEV = 30;

/* A way through m cells whose depth is off by up to d each, evenly, passes m d^2 / 24 too much on average; a third of the tolerance
 * for the two or three of them that matter most. */
static const double SMEARED = 3, LEAST_LIMIT = 0.02;

/* Cells that hold mixtures by choice may add so much to what those where parts compete are off by. */
static const double SETTLED_MORE = 1.1;

/* Where a number of histories is given. */
static const double DEFAULT_TOLERANCE = 0.01;

const double *skg_scatter_pose(const skg_scatter_work *work, int64_t part) {
    SKG_ASSERT(0 <= part && part < work->recipe->scene->count);
    return work->poses && work->poses[part] ? work->poses[part] : work->recipe->scene->parts[part].pose;
}

/* The materials of a scene, each once, but for voids. */
typedef struct {
    int64_t count;
    skg_material **materials; /* [parts + curves of volumes + 1] borrowed */
    int64_t *of_part;         /* [parts] -1: void */
    int64_t of_world;         /* likewise */
    int64_t *of_curve;        /* [curves of volumes] those of the first volume, then of the next */
} palette;

static int64_t place_in(palette *p, skg_material *material) {
    int64_t m = 0;
    if (skg_material_is_void(material)) return -1;
    while (m < p->count && p->materials[m] != material) m++;
    if (m == p->count) p->materials[p->count++] = material;
    return m;
}

static skg_status find_palette(const skg_recipe *recipe, palette *p) {
    const skg_scene *scene = recipe->scene;
    const int64_t curves = skg_scene_curves(scene, scene->count);
    SKG_TRY(skg_alloc(scene->count + curves + 1, sizeof *p->materials, "materials", &p->materials));
    SKG_TRY(skg_alloc(scene->count, sizeof *p->of_part, "materials", &p->of_part));
    SKG_TRY(skg_alloc(curves, sizeof *p->of_curve, "materials", &p->of_curve));
    for (int64_t i = 0; i < scene->count; i++) p->of_part[i] = place_in(p, scene->parts[i].material);
    skg_material *world = skg_scatter_world(recipe);
    p->of_world = world ? place_in(p, world) : -1;
    int64_t *of_curve = p->of_curve;
    for (int64_t i = 0; i < scene->count; i++) {
        const skg_volume *volume = scene->parts[i].volume;
        for (int64_t c = 0; volume && c < volume->curve_count; c++)
            *of_curve++ = place_in(p, volume->curves[c]);
    }
    return SKG_OK;
}

static skg_status make_physics(const skg_scatter_work *work, const palette *p, skg_scatter_object *object) {
    const skg_recipe *recipe = work->recipe;
    const skg_spectrum *spectrum = recipe->spectrum;
    double low = HUGE_VAL, high = 0, least = 1;
    for (int64_t i = 0; i < spectrum->count; i++)
        if (spectrum->photons[i] > 0)
            low = fmin(low, spectrum->energy_kev[i]), high = spectrum->energy_kev[i];
    /* Photons below the lowest energy of the response add no signal, and photons only lose energy. */
    if (recipe->options.response) least = fmax(least, skg_response_lowest(recipe->options.response));
    SKG_TRY(skg_emitters_find(p->count, p->materials, recipe->options.scatter->fluorescence, least, high,
                              &object->emitters));
    low = fmax(fmin(fmin(low * LOWEST, LOWEST_KEV), object->emitters.lowest_kev), least);
    return skg_scatter_physics_make(p->count, p->materials, &object->emitters, low, fmax(high, low * 1.001),
                                    &object->physics);
}

static double coefficient(const double (*of)[SKG_SCATTER_RANK], int64_t material, int k) {
    return material < 0 ? 0 : of[material][k];
}

/* Coefficients that a mm of each part adds: those of its own material less its parent's, as in frame/overrides.c. of: coefficients of the
 * palette's materials per mm; base: those of the world */
static void find_differences(const skg_scatter_work *work, const palette *p,
                             const double (*of)[SKG_SCATTER_RANK], const double base[SKG_SCATTER_RANK],
                             double (*differences)[SKG_SCATTER_RANK]) {
    const skg_scene *scene = work->recipe->scene;
    for (int64_t i = 0; i < scene->count; i++) {
        const int64_t parent = scene->parts[i].inside;
        const double density = work->density ? work->density[i] : 1, fill = work->fill ? work->fill[i] : 1;
        const double around = parent >= 0 && work->density ? work->density[parent] : 1;
        for (int k = 0; k < SKG_SCATTER_RANK; k++) {
            const double own = density * coefficient(of, p->of_part[i], k);
            const double outside = parent < 0 ? base[k] : around * coefficient(of, p->of_part[parent], k);
            differences[i][k] = fill * (own - outside);
        }
    }
}

typedef struct {
    skg_solid *solids;  /* [parts] */
    double **positions; /* [parts] */
    int32_t *sign, *priority;
    double (*differences)[SKG_SCATTER_RANK]; /* coefficients */
    double (*lines)[SKG_SCATTER_RANK];       /* attenuation of the beam's lines */
    int64_t volume_count;
    skg_cell_volume volumes[SKG_SCATTER_VOLUMES_MAX];
} placed;

static skg_status place(const skg_scatter_work *work, placed *to) {
    const skg_scene *scene = work->recipe->scene;
    SKG_TRY(skg_alloc(scene->count, sizeof *to->solids, "cells", &to->solids));
    SKG_TRY(skg_alloc(scene->count, sizeof *to->positions, "cells", &to->positions));
    SKG_TRY(skg_alloc(scene->count, sizeof *to->sign, "cells", &to->sign));
    SKG_TRY(skg_alloc(scene->count, sizeof *to->priority, "cells", &to->priority));
    SKG_TRY(skg_alloc(scene->count, sizeof *to->differences, "cells", &to->differences));
    SKG_TRY(skg_alloc(scene->count, sizeof *to->lines, "cells", &to->lines));
    for (int64_t i = 0; i < scene->count; i++) {
        const skg_mesh *mesh = scene->parts[i].mesh;
        const double *pose = skg_scatter_pose(work, i);
        SKG_TRY(skg_solid_place(mesh, pose, scene->parts[i].inside, &to->solids[i], &to->positions[i]));
        to->priority[i] = scene->parts[i].priority;
        to->sign[i] = (skg_pose_determinant(pose) < 0 ? -1 : 1) * mesh->orientation;
    }
    return SKG_OK;
}

static void drop(int64_t count, placed *p) {
    for (int64_t i = 0; p->positions && i < count; i++) skg_free(&p->positions[i]);
    skg_free(&p->positions);
    skg_free(&p->solids);
    skg_free(&p->sign);
    skg_free(&p->priority);
    skg_free(&p->differences);
    skg_free(&p->lines);
    for (int64_t v = 0; v < p->volume_count; v++) {
        skg_free(&p->volumes[v].times);
        skg_free(&p->volumes[v].coefficients);
        skg_free(&p->volumes[v].lines);
    }
}

/* Coefficients of each composition of a volume, per mm. of: those of the palette's materials */
static skg_status fill_curves(const palette *p, const skg_cell_volume *volume,
                              const double (*of)[SKG_SCATTER_RANK], double (**to)[SKG_SCATTER_RANK]) {
    const int64_t *of_curve = p->of_curve + volume->first_curve;
    SKG_TRY(skg_alloc(volume->volume->curve_count, sizeof **to, "cells", to));
    for (int64_t c = 0; c < volume->volume->curve_count; c++) memcpy((*to)[c], of[of_curve[c]], sizeof **to);
    return SKG_OK;
}

static skg_status place_volume(const skg_scatter_work *work, int64_t part, skg_cell_volume *to) {
    const skg_scene *scene = work->recipe->scene;
    to->volume = scene->parts[part].volume;
    to->first_curve = skg_scene_curves(scene, part);
    skg_volume_to_cells(to->volume, skg_scatter_pose(work, part), to->to_cells);
    SKG_TRY(skg_alloc(scene->count, sizeof *to->times, "cells", &to->times));
    for (int64_t i = 0; i < scene->count; i++)
        to->times[i] = i == part ? 1 : scene->parts[i].inside == part ? -1 : 0;
    return SKG_OK;
}

static skg_status place_volumes(const skg_scatter_work *work, const palette *p,
                                const skg_scatter_physics *physics, placed *to) {
    const skg_scene *scene = work->recipe->scene;
    for (int64_t i = 0; i < scene->count; i++) {
        if (!scene->parts[i].volume) continue;
        skg_cell_volume *volume = &to->volumes[to->volume_count++];
        SKG_TRY(place_volume(work, i, volume));
        SKG_TRY(fill_curves(p, volume, (const double(*)[SKG_SCATTER_RANK])physics->coefficients,
                            &volume->coefficients));
    }
    return SKG_OK;
}

/* 1/mm per coefficient at the mean energy of the beam. */
static void find_typical(const skg_spectrum *spectrum, const skg_scatter_physics *p,
                         double mu[SKG_SCATTER_RANK]) {
    double photons = 0, energy = 0;
    for (int64_t i = 0; i < spectrum->count; i++)
        photons += spectrum->photons[i], energy += spectrum->photons[i] * spectrum->energy_kev[i];
    const double at =
        log(energy / photons / p->low_kev) / log(p->high_kev / p->low_kev) * (double)(p->energies - 1);
    const int64_t row = (int64_t)fmin(fmax(at, 0), (double)(p->energies - 1));
    for (int k = 0; k < SKG_SCATTER_RANK; k++) mu[k] = (double)p->total[row][k];
}

/* Attenuation of the parts and volumes for each line of the beam. */
static skg_status find_lines(const skg_scatter_work *work, const palette *p, placed *parts,
                             skg_beam_lines *lines) {
    static const double none[SKG_SCATTER_RANK];
    double(*mu)[SKG_SCATTER_RANK] = NULL;
    SKG_TRY(skg_alloc(p->count, sizeof *mu, "cells", &mu));
    skg_beam_lines_find(work->recipe->spectrum, lines);
    skg_beam_lines_attenuated(lines, p->count, p->materials, mu);
    memcpy(lines->world, p->of_world < 0 ? none : mu[p->of_world], sizeof lines->world);
    find_differences(work, p, (const double(*)[SKG_SCATTER_RANK])mu, lines->world, parts->lines);
    lines->parts = (const double(*)[SKG_SCATTER_RANK])parts->lines;
    skg_status status = SKG_OK;
    for (int64_t v = 0; v < parts->volume_count && status == SKG_OK; v++)
        status = fill_curves(p, &parts->volumes[v], (const double(*)[SKG_SCATTER_RANK])mu,
                             &parts->volumes[v].lines);
    skg_free(&mu);
    return status;
}

/* Above this, every line to the detector is followed through the object. Below, rough cells stand for eight or nine of ten, which pays: .63 for a
 * thorax, whose scatter costs two thirds of what it did. At 2.6 (an iron cube before a table) the noise was ten times as large. */
static const double ROUGH_MOST = 0.8;

/* Plants to a limit, and judges what has come of it. */
static skg_status plant(skg_planting *planting, skg_judging *judging, double limit,
                        skg_scatter_object *object) {
    SKG_TRY(skg_planting_to(planting, limit));
    return skg_judging_of(judging, &object->judged);
}

/* Error of the cells in which parts compete or volumes lie, which no limit lowers. Its tree is not kept: photons would not meet most of
 * it. */
static skg_status find_settled_error(const skg_cell_parts *parts, const double mu[SKG_SCATTER_RANK],
                                     skg_judging *judging, skg_scatter_object *object) {
    if (!parts->priority && parts->volume_count == 0) return SKG_OK;
    SKG_TRY(skg_cells_trace(parts, mu, 0, &object->cells));
    SKG_TRY(skg_judging_of(judging, &object->judged));
    object->settled_error = object->judged.cells;
    return SKG_OK;
}

/* The next lower limit at which fewer cells are smeared, by a tenth at least: with nearly the same cells the error is the same. */
static double lower(const skg_planting *planting, const skg_cells *cells, double limit) {
    const int64_t enough = cells->smeared - cells->smeared / 10;
    do limit = limit > LEAST_LIMIT ? limit / 1.4 : 0;
    while (limit > 0 && skg_planting_smears(planting, limit) > enough);
    return limit;
}

/* Smears no more of the cells than leaves histories their part of the tolerance: faces cost more than histories. */
static skg_status trace(const skg_scatter_work *work, const skg_cell_parts *parts,
                        const skg_beam_lines *lines, skg_scatter_object *object) {
    const double asked = work->recipe->options.scatter->tolerance,
                 tolerance = asked > 0 ? asked : DEFAULT_TOLERANCE;
    skg_planting *planting = NULL;
    skg_judging *judging = NULL;
    double limit = sqrt(tolerance * SMEARED), mu[SKG_SCATTER_RANK];
    skg_status status = SKG_OK;
    find_typical(work->recipe->spectrum, &object->physics, mu);
    SKG_TRY_CLEANUP(skg_judging_begin(parts, &object->physics, lines, work->view, &object->cells, &judging));
    SKG_TRY_CLEANUP(find_settled_error(parts, mu, judging, object));
    SKG_TRY_CLEANUP(skg_planting_begin(parts, mu, &object->cells, &planting));
    SKG_TRY_CLEANUP(plant(planting, judging, limit, object));
    const double most = fmax(SKG_SCATTER_MOST * tolerance, SETTLED_MORE * object->settled_error);
    while (limit > 0 && object->cells.smeared > 0 && object->judged.cells > most) {
        limit = lower(planting, &object->cells, limit);
        SKG_TRY_CLEANUP(plant(planting, judging, limit, object));
    }
    if (object->judged.rough > ROUGH_MOST) object->cells.rough = 0;
cleanup:
    skg_planting_end(&planting);
    skg_judging_end(&judging);
    return status;
}

skg_status skg_scatter_object_make(const skg_scatter_work *work, skg_scatter_object *object) {
    palette p = {0};
    placed parts = {0};
    skg_beam_lines lines;
    skg_status status = SKG_OK;
    *object = (skg_scatter_object){0};
    SKG_TRY_CLEANUP(find_palette(work->recipe, &p));
    if (p.count == 0) goto cleanup; /* nothing scatters */
    SKG_TRY_CLEANUP(make_physics(work, &p, object));
    SKG_TRY_CLEANUP(place(work, &parts));
    for (int k = 0; k < SKG_SCATTER_RANK && p.of_world >= 0; k++)
        object->world[k] = object->physics.coefficients[p.of_world][k];
    find_differences(work, &p, (const double(*)[SKG_SCATTER_RANK])object->physics.coefficients, object->world,
                     parts.differences);
    SKG_TRY_CLEANUP(place_volumes(work, &p, &object->physics, &parts));
    SKG_TRY_CLEANUP(find_lines(work, &p, &parts, &lines));
    const skg_cell_parts to_fill = {
        .count = work->recipe->scene->count,
        .solids = parts.solids,
        .sign = parts.sign,
        .base = object->world,
        .coefficients = (const double(*)[SKG_SCATTER_RANK])parts.differences,
        .priority = work->recipe->priority_possible ? parts.priority : NULL,
        .clip = work->recipe->options.clip,
        .unite = work->recipe->options.unite,
        .volume_count = parts.volume_count,
        .volumes = parts.volumes,
    };
    SKG_TRY_CLEANUP(skg_cells_make(&to_fill, work->recipe->options.scatter->voxel_mm, &object->cells));
    status = trace(work, &to_fill, &lines, object);
cleanup:
    drop(work->recipe->scene->count, &parts);
    skg_free(&p.materials);
    skg_free(&p.of_part);
    skg_free(&p.of_curve);
    return status;
}

void skg_scatter_object_free(skg_scatter_object *object) {
    skg_scatter_physics_free(&object->physics);
    skg_emitters_free(&object->emitters);
    skg_cells_free(&object->cells);
}
