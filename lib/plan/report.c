#include "plan/report.h"
#include "core/names.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- overlaps
 * ---------------------------------------------------------------------------------------------------- */

static skg_status place_solid(const skg_scene_part_data *part, skg_solid *solid, double **positions) {
    const skg_mesh *mesh = part->mesh;
    *solid = (skg_solid){.inside = part->inside};
    if (!mesh->closed) return SKG_OK;
    SKG_TRY(skg_alloc(mesh->vertices * 3, sizeof **positions, "overlap check", positions));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        double at[3];
        skg_mesh_vertex(mesh, v, at);
        for (int k = 0; k < 3; k++) {
            const double *row = part->pose + 4 * k;
            (*positions)[3 * v + k] = row[0] * at[0] + row[1] * at[1] + row[2] * at[2] + row[3];
        }
    }
    *solid = (skg_solid){mesh->vertices, mesh->triangles, *positions, mesh->corners, part->inside};
    return SKG_OK;
}

/* Of the pairs that nothing settles. */
static void warn_of_overlaps(skg_plan *plan) {
    const skg_overlap_pair *worst = NULL;
    const skg_scene *scene = plan->scene;
    double volume = 0;
    int64_t count = 0;
    for (int64_t i = 0; i < plan->overlap_count; i++) {
        const skg_overlap_pair *pair = &plan->overlaps[i];
        if (skg_priority_settles(scene, plan->options.clip, pair)) continue;
        if (!worst) worst = pair;
        volume += pair->volume;
        count++;
    }
    if (!worst) return;
    skg_log(
        plan->context, SKG_LOG_WARNING,
        "%" PRId64 " %s, %.3g ml in all; worst: %s %s %s, %.3g ml, up to "
        "%.3g mm along z at (%.1f, %.1f, %.1f) mm; their lengths add (or subtract the parent), nothing is clamped",
        count,
        skg_plural(count, "pair of parts overlaps, or a part leaves its parent",
                   "pairs of parts overlap or leave their parent"),
        volume / 1000, scene->parts[worst->part].label,
        worst->kind == SKG_OVERLAP_SIBLINGS ? "with" : "leaves", scene->parts[worst->other].label,
        worst->volume / 1000, worst->longest, worst->place[0], worst->place[1], worst->place[2]);
}

skg_status skg_report_overlaps(skg_plan *plan) {
    const skg_scene *scene = plan->scene;
    skg_solid *solids = NULL;
    double **positions = NULL;
    skg_status status = SKG_OK;
    if (!plan->options.overlaps || scene->count < 2) return SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *solids, "overlap check", &solids));
    SKG_TRY_CLEANUP(skg_alloc(scene->count, sizeof *positions, "overlap check", &positions));
    for (int64_t i = 0; i < scene->count; i++)
        SKG_TRY_CLEANUP(place_solid(&scene->parts[i], &solids[i], &positions[i]));
    SKG_TRY_CLEANUP(skg_overlaps_find(scene->count, solids, &plan->overlap_count, &plan->overlaps));
    warn_of_overlaps(plan);
cleanup:
    for (int64_t i = 0; positions && i < scene->count; i++) skg_free(&positions[i]);
    skg_free(&positions);
    skg_free(&solids);
    return status;
}

void skg_overlap_init(skg_overlap *overlap) {
    if (overlap) *overlap = (skg_overlap){.size = (int32_t)sizeof *overlap};
}

skg_status skg_plan_overlap_count(const skg_plan *plan, int64_t *count) {
    if (!plan || !count) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_overlap_count: no plan or no result");
    *count = plan->overlap_count;
    return SKG_OK;
}

skg_status skg_plan_overlap_get(const skg_plan *plan, int64_t index, skg_overlap *overlap) {
    if (!plan) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_overlap_get: no plan");
    if (index < 0 || index >= plan->overlap_count)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_overlap_get: pair %" PRId64 " of %" PRId64, index,
                        plan->overlap_count);
    const skg_overlap_pair *pair = &plan->overlaps[index];
    skg_overlap ours = {.size = sizeof ours,
                        .protrudes = pair->kind == SKG_OVERLAP_PROTRUDES,
                        .part = pair->part,
                        .other = pair->other,
                        .volume = pair->volume,
                        .longest = pair->longest};
    memcpy(ours.place, pair->place, sizeof ours.place);
    return skg_struct_write(&ours, sizeof ours, "skg_overlap", overlap);
}

/* --- after a job
 * ------------------------------------------------------------------------------------------------- */

static void add_stage(skg_plan *plan, const char *name, double ns) {
    int64_t i = 0;
    while (i < plan->stage_count && strcmp(plan->stages[i].name, name) != 0) i++;
    if (i == SKG_MOST_STAGES) return;
    if (i == plan->stage_count) plan->stages[plan->stage_count++] = (skg_stage_time){.name = name};
    plan->stages[i].ns += ns;
}

static skg_status add_stages(skg_job *job) {
    if (!job->log.on) return SKG_OK;
    job->plan->stage_count = 0;
    for (int64_t i = 0; i < job->log.count; i++) {
        const cl_event event = job->log.events[i];
        cl_ulong start = 0, end = 0;
        SKG_CL_TRY(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof start, &start, NULL));
        SKG_CL_TRY(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL));
        add_stage(job->plan, job->log.names[i], (double)(end - start));
    }
    return SKG_OK;
}

static void tell_negative(skg_plan *plan, int32_t pixels) {
    plan->report.negative_pixels = pixels;
    if (pixels > 0)
        skg_log(plan->context, SKG_LOG_WARNING,
                "%" PRId32 " %s a negative exponent: more was subtracted for children than their parent "
                "has there; see the overlaps that the plan lists",
                pixels, skg_plural(pixels, "pixel has", "pixels have"));
}

/* Whether so many bad pixels are worth a warning: ten times as many as in any before, from 1 on. */
static int is_news(skg_plan *plan, int64_t open, int32_t bad) {
    int32_t class = 0;
    for (int64_t most = 1; most <= bad; most *= 10) class ++;
    if (class <= plan->told[open]) return 0;
    plan->told[open] = class;
    return 1;
}

/* bad: of one open part, as skg_raster_bad_pixels leaves it. */
static void tell_bad(skg_plan *plan, int64_t open, const int32_t *bad) {
    static const char *const done[] = {
        [SKG_REPAIR_NONE] = "it is left out there",
        [SKG_REPAIR_NEIGHBOURS] = "it has the mean of its nearest valid pixels there",
        [SKG_REPAIR_EXACT] = "these rays were cast anew through the mesh with its holes capped",
    };
    const int64_t columns = plan->view.columns, all = columns * plan->view.rows;
    const int hopeless = plan->options.repair == SKG_REPAIR_NEIGHBOURS && bad[0] == all;
    const int32_t repair = hopeless ? SKG_REPAIR_NONE : plan->options.repair;
    plan->report.bad_pixels += bad[0];
    if (repair != SKG_REPAIR_NONE) plan->report.repaired_pixels += bad[0];
    if (!is_news(plan, open, bad[0])) return;
    char places[32 * SKG_FIRST_BAD] = "";
    size_t length = 0;
    for (int32_t k = 0; k < bad[0] && k < SKG_FIRST_BAD; k++)
        length += (size_t)snprintf(places + length, sizeof places - length, "%s(%" PRId64 ", %" PRId64 ")",
                                   k ? ", " : "", bad[1 + k] % columns, bad[1 + k] / columns);
    skg_log(plan->context, SKG_LOG_WARNING,
            "part %s is open: at %" PRId32
            " %s its rays do not leave it as often as they enter it; %s; first at (column, row) %s; close "
            "its mesh",
            plan->scene->parts[plan->open[open]].label, bad[0], skg_plural(bad[0], "pixel", "pixels"),
            done[repair], places);
}

static skg_status tell_broken(const skg_plan *plan, int32_t vertex) {
    int64_t part = 0, of_mesh = 0;
    if (vertex == INT32_MAX) return SKG_OK;
    skg_geometry_find(&plan->geometry, vertex, &part, &of_mesh);
    return skg_fail(SKG_ERR_MESH,
                    "part %s: vertex %" PRId64 " cannot be projected: it is not finite in this pose",
                    plan->scene->parts[part].label, of_mesh);
}

static skg_status tell_outside(skg_plan *plan, int32_t pixels) {
    plan->report.outside_pixels = pixels;
    if (pixels == 0) return SKG_OK;
    return skg_fail(
        SKG_RANGE,
        "at %" PRId32 " %s the lengths leave the range that the error bound of %.2g was verified "
        "for; the image is valid, the bound is not stated there; plan for this view and these poses, or with "
        "tolerance 0",
        pixels, skg_plural(pixels, "pixel", "pixels"), plan->model.bound);
}

skg_status skg_report_job(skg_job *job) {
    skg_plan *plan = job->plan;
    SKG_TRY(add_stages(job));
    SKG_TRY(tell_broken(plan, *job->broken));
    tell_negative(plan, *job->negative);
    const double listings = (double)job->listed[0] + (double)job->listed[1] * (double)plan->report.tiles;
    plan->report.triangles_per_tile = plan->strategy == SKG_STRATEGY_TILES
                                          ? listings / (double)plan->report.tiles
                                          : (double)plan->report.triangles;
    plan->report.bad_pixels = plan->report.repaired_pixels = 0;
    if (!plan->told) SKG_TRY(skg_alloc(plan->open_count, sizeof *plan->told, "open parts", &plan->told));
    for (int64_t k = 0; k < job->bad_count; k++) {
        const int32_t *bad = job->bad + k * (1 + SKG_FIRST_BAD);
        if (bad[0] > 0) tell_bad(plan, job->bad_open[k], bad);
    }
    return tell_outside(plan, job->negative[1]);
}

void skg_plan_report_init(skg_plan_report *report) {
    if (report) *report = (skg_plan_report){.size = (int32_t)sizeof *report};
}

skg_status skg_plan_report_get(const skg_plan *plan, skg_plan_report *report) {
    if (!plan) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_report_get: no plan");
    skg_plan_report ours = plan->report;
    ours.device_bytes = skg_geometry_bytes(&plan->geometry) + plan->image.bytes + plan->negative.bytes +
                        plan->bad.bytes + plan->gaps.bytes + plan->field.image.bytes +
                        skg_priority_memory_bytes(&plan->priority_memory) +
                        plan->attenuation.coefficients.bytes + plan->attenuation.weights.bytes +
                        plan->attenuation.variances.bytes + plan->attenuation.range.bytes +
                        plan->lengths.coefficients.bytes + plan->lengths.weights.bytes;
    if (plan->blur) ours.device_bytes += skg_blur_bytes(plan->blur);
    if (plan->detector) ours.device_bytes += skg_detector_bytes(plan->detector);
    for (int32_t i = 0; i < plan->raster_count; i++) ours.device_bytes += skg_raster_bytes(plan->rasters[i]);
    return skg_struct_write(&ours, sizeof ours, "skg_plan_report", report);
}

skg_status skg_plan_node_get(const skg_plan *plan, int64_t index, double *energy_kev, double *photons,
                             double *weights) {
    if (!plan) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_node_get: no plan");
    const skg_model *model = &plan->model;
    if (index < 0 || index >= model->nodes)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_node_get: node %" PRId64 " of %" PRId32, index,
                        model->nodes);
    if (energy_kev) *energy_kev = model->node_kev[index];
    if (photons) *photons = model->node_photons[index];
    if (weights)
        memcpy(weights, model->weights + index * model->channels, (size_t)model->channels * sizeof *weights);
    return SKG_OK;
}

void skg_stage_init(skg_stage *stage) {
    if (stage) *stage = (skg_stage){.size = (int32_t)sizeof *stage};
}

skg_status skg_plan_stage_count(const skg_plan *plan, int64_t *count) {
    if (!plan || !count) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_stage_count: no plan or no result");
    *count = plan->stage_count;
    return SKG_OK;
}

skg_status skg_plan_stage_get(const skg_plan *plan, int64_t index, skg_stage *stage) {
    if (!plan) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_stage_get: no plan");
    if (index < 0 || index >= plan->stage_count)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_stage_get: stage %" PRId64 " of %" PRId64, index,
                        plan->stage_count);
    skg_stage ours = {.size = sizeof ours, .name = plan->stages[index].name, .ns = plan->stages[index].ns};
    return skg_struct_write(&ours, sizeof ours, "skg_stage", stage);
}
