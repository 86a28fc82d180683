/* Clips triangles by planes. */
#include "show/drawing.h"

#include "core/maths.h"

/* A corner of a triangle that is cut. */
typedef struct {
    int32_t vertex;
    int16_t normal[4];
    double beyond; /* mm */
} corner;

static double beyond(const skg_show_model *model, const double plane[4], int32_t vertex) {
    const float *p = model->positions + 3 * (int64_t)vertex;
    return plane[0] * (double)p[0] + plane[1] * (double)p[1] + plane[2] * (double)p[2] - plane[3];
}

/* The corner on the plane between two, from the one with the lower number, so that both triangles of an edge get the same. */
static corner between(skg_show_model *model, const corner *a, const corner *b) {
    if (b->vertex < a->vertex) {
        const corner *other = a;
        a = b, b = other;
    }
    const double share = a->beyond / (a->beyond - b->beyond);
    const float *p = model->positions + 3 * (int64_t)a->vertex,
                *q = model->positions + 3 * (int64_t)b->vertex;
    float *at = model->positions + 3 * model->vertices;
    corner made = {.vertex = (int32_t)model->vertices++};
    for (int k = 0; k < 3; k++) {
        at[k] = (float)((double)p[k] + share * ((double)q[k] - (double)p[k]));
        made.normal[k] = (int16_t)(a->normal[k] + share * (b->normal[k] - a->normal[k]));
    }
    return made;
}

static void put(skg_show_model *model, int64_t triangle, const corner *a, const corner *b, const corner *c,
                uint32_t colour) {
    const corner *corners[3] = {a, b, c};
    for (int k = 0; k < 3; k++) {
        model->corners[3 * triangle + k] = corners[k]->vertex;
        memcpy(model->normals + 12 * triangle + 4 * k, corners[k]->normal, sizeof corners[k]->normal);
    }
    model->colours[triangle] = colour;
}

/* Writes what is left of a triangle at `to`, and a second triangle at the end if it becomes a quadrilateral. Returns whether
 * anything is left. */
static int cut(skg_show_model *model, int64_t triangle, int64_t to, const double plane[4]) {
    const uint32_t colour = model->colours[triangle];
    corner whole[3], left[4];
    int count = 0;
    for (int k = 0; k < 3; k++) {
        whole[k].vertex = model->corners[3 * triangle + k];
        whole[k].beyond = beyond(model, plane, whole[k].vertex);
        memcpy(whole[k].normal, model->normals + 12 * triangle + 4 * k, sizeof whole[k].normal);
    }
    for (int k = 0; k < 3; k++) {
        const corner *a = whole + k, *b = whole + (k + 1) % 3;
        if (a->beyond <= 0) left[count++] = *a;
        if ((a->beyond <= 0) != (b->beyond <= 0)) left[count++] = between(model, a, b);
    }
    if (count < 3) return 0;
    put(model, to, left, left + 1, left + 2, colour);
    if (count == 4) put(model, model->triangles++, left, left + 2, left + 3, colour);
    return 1;
}

skg_status skg_show_clip(skg_show_model *model, int64_t first, const double plane[4]) {
    const double ours[4] = {plane[0], plane[1], plane[2], plane[3] - skg_dot(plane, model->centre)};
    const int64_t end = model->triangles;
    int64_t to = first;
    for (int64_t t = first; t < end; t++) {
        SKG_TRY(skg_show_model_reserve(model, 2, 1));
        to += cut(model, t, to, ours);
    }
    for (int64_t t = end; t < model->triangles; t++, to++) {
        memmove(model->corners + 3 * to, model->corners + 3 * t, 3 * sizeof *model->corners);
        memmove(model->normals + 12 * to, model->normals + 12 * t, 12 * sizeof *model->normals);
        model->colours[to] = model->colours[t];
    }
    model->triangles = to;
    return SKG_OK;
}

skg_status skg_show_clip_near(skg_show_model *model, const skg_show_camera *camera, int64_t first) {
    const double *toward = camera->axes[2];
    double plane[4] = {toward[0], toward[1], toward[2],
                       skg_dot(toward, camera->centre) + camera->distance - camera->nearest};
    return camera->nearest > 0 ? skg_show_clip(model, first, plane) : SKG_OK;
}
