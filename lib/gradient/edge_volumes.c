/* Volumes of cells along rays that lie in a face: which cells there are, and what they are worth. */
#include "gradient/edge_volumes.h"

#include <math.h>

skg_status skg_edge_plane_read(skg_job *job, int64_t plane, skg_edge_planes *p) {
    const int64_t bytes = p->layout.plane * skg_gradient_real_size(p->pass->kernels.precision);
    if (p->planes[plane].bytes) return SKG_OK;
    return skg_host_view_open(job->machine->context, skg_gradient_of(job)->memory->weights.memory,
                              plane * bytes, bytes, &p->planes[plane]);
}

double skg_edge_plane_at(const skg_edge_planes *p, int64_t plane, int64_t column, int64_t row) {
    const int64_t at = row * p->layout.stride + column;
    const void *bytes = p->planes[plane].bytes;
    SKG_ASSERT(bytes != NULL && 0 <= at && at < p->layout.plane);
    return p->pass->kernels.precision == SKG_PRECISION_DOUBLE ? ((const double *)bytes)[at]
                                                              : (double)((const float *)bytes)[at];
}

/* --- volumes */

static skg_status place(const skg_pass *pass, int64_t part, skg_edge_volume *v) {
    double to_cells[16];
    *v = (skg_edge_volume){.volume = pass->scene->parts[part].volume,
                           .first = pass->scene->count + skg_scene_curves(pass->scene, part)};
    skg_volume_to_cells(v->volume, pass->parts[part].pose, to_cells);
    skg_cell_rays_find(&pass->camera, to_cells, &v->rays);
    SKG_TRY(skg_alloc(skg_priority_slots(&pass->priority) / 32, sizeof *v->displacing, "gradient",
                      &v->displacing));
    v->slot = skg_priority_displacing(pass->scene, &pass->priority, part, v->displacing);
    return SKG_OK;
}

static skg_status find_all(const skg_pass *pass, skg_edge_volumes *v) {
    const skg_priority *priority = &pass->priority;
    SKG_TRY(skg_alloc(priority->count, sizeof *v->of, "gradient", &v->of));
    for (int64_t s = 0; s < priority->count; s++)
        if (pass->scene->parts[priority->parts[s]].volume)
            SKG_TRY(place(pass, priority->parts[s], &v->of[v->count++]));
    return SKG_OK;
}

skg_status skg_edge_volumes_find(skg_job *job, skg_edge_planes *planes, skg_edge_volumes *v) {
    const skg_model *model = &job->recipe->model;
    v->model = model;
    if (!v->of && skg_scene_volumes(planes->pass->scene) > 0) SKG_TRY(find_all(planes->pass, v));
    for (int64_t i = 0; i < v->count; i++) {
        const int64_t *first = model->first_contribution + v->of[i].first;
        for (int64_t c = first[0]; c < first[v->of[i].volume->curve_count]; c++)
            SKG_TRY(skg_edge_plane_read(job, model->contributions[c].plane, planes));
    }
    return SKG_OK;
}

void skg_edge_volumes_release(skg_edge_volumes *v) {
    for (int64_t i = 0; i < v->count; i++) skg_free(&v->of[i].displacing);
    skg_free(&v->of);
    v->count = 0;
}

/* --- rays */

/* A ray along an axis of a volume: at depth h[2] it is at `at` + h[2] way. */
static void along_axis(const skg_camera *camera, const skg_cell_rays *r, int axis, const double middle[2],
                       double *at, double *way) {
    *at = r->base[0][axis] + middle[0] * r->base[1][axis] + middle[1] * r->base[2][axis];
    *way = r->way[0][axis] + middle[0] * r->way[1][axis] + middle[1] * r->way[2][axis];
    if (camera->parallel) *at += *way; /* h[2] is t - 1 */
}

/* The plane between cells number - 1 and number of an axis, behind which the sum is positive. */
static skg_seen_plane plane_of(const skg_camera *camera, const skg_cell_rays *r, int axis, double number,
                               double sign) {
    const double still = r->base[0][axis] - number, deep = r->way[0][axis];
    skg_seen_plane plane = {{r->way[1][axis], r->way[2][axis], deep, still}};
    if (camera->parallel) plane = (skg_seen_plane){{r->base[1][axis], r->base[2][axis], deep, still + deep}};
    for (int k = 0; k < 4; k++) plane.p[k] *= sign;
    return plane;
}

static skg_status append(const skg_crossing *crossing, skg_crossing_list *list) {
    if (list->count == list->capacity) {
        const int64_t capacity = 2 * list->capacity + 64;
        SKG_TRY(skg_realloc(capacity, sizeof *list->at, "gradient", &list->at));
        list->capacity = capacity;
    }
    list->at[list->count++] = *crossing;
    return SKG_OK;
}

skg_status skg_edge_volumes_cross(const skg_edge_volumes *v, const skg_camera *camera, const double middle[2],
                                  skg_crossing_list *list) {
    for (int64_t i = 0; i < 3 * v->count; i++) {
        const skg_edge_volume *of = &v->of[i / 3];
        const int axis = (int)(i % 3);
        double at, way;
        along_axis(camera, &of->rays, axis, middle, &at, &way);
        for (int64_t n = 0; way != 0 && n <= of->volume->size[axis]; n++) {
            const skg_crossing crossing = {.depth = ((double)n - at) / way,
                                           .plane =
                                               plane_of(camera, &of->rays, axis, (double)n, way > 0 ? 1 : -1),
                                           .owner = -1};
            SKG_TRY(append(&crossing, list));
        }
    }
    return SKG_OK;
}

double skg_edge_volume_worth(const skg_edge_volumes *volumes, int64_t number, const skg_edge_planes *planes,
                             const double middle[2], double depth, int64_t column, int64_t row) {
    const skg_edge_volume *v = &volumes->of[number];
    const skg_model *model = volumes->model;
    double amount = 0, sum = 0;
    int64_t cell = 0;
    for (int axis = 2; axis >= 0; axis--) {
        double at, way;
        along_axis(&planes->pass->camera, &v->rays, axis, middle, &at, &way);
        at += depth * way;
        if (!(at >= 0 && at < (double)v->volume->size[axis])) return 0;
        cell = cell * v->volume->size[axis] + (int64_t)at;
    }
    const int64_t curve = v->first + skg_volume_cell(v->volume, cell, &amount);
    for (int64_t c = model->first_contribution[curve]; c < model->first_contribution[curve + 1]; c++)
        sum += model->contributions[c].weight *
               skg_edge_plane_at(planes, model->contributions[c].plane, column, row);
    return sum * amount * planes->pass->scale.scale;
}
