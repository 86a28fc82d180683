/* The triangles that a 3D view draws. */
#include "show/drawing.h"

#include <inttypes.h>
#include <math.h>

/* Kernels index three numbers per vertex and triangle with int. */
static const int64_t LIMIT = INT32_MAX / 3;

void skg_show_model_free(skg_show_model *model) {
    skg_free(&model->positions);
    skg_free(&model->corners);
    skg_free(&model->normals);
    skg_free(&model->colours);
}

skg_status skg_show_model_reserve(skg_show_model *model, int64_t vertices, int64_t triangles) {
    if (vertices > LIMIT - model->vertices || triangles > LIMIT - model->triangles)
        return skg_fail(SKG_ERR_SCENE,
                        "the parts have more than %" PRId64
                        " vertices or triangles, which the 3D view cannot draw",
                        LIMIT);
    if (model->vertices + vertices > model->vertex_capacity) {
        const int64_t capacity = 2 * model->vertex_capacity + vertices;
        SKG_TRY(skg_realloc(capacity, 3 * sizeof *model->positions, "vertices of the 3D view",
                            &model->positions));
        model->vertex_capacity = capacity;
    }
    if (model->triangles + triangles > model->triangle_capacity) {
        const int64_t capacity = 2 * model->triangle_capacity + triangles;
        SKG_TRY(
            skg_realloc(capacity, 3 * sizeof *model->corners, "triangles of the 3D view", &model->corners));
        SKG_TRY(
            skg_realloc(capacity, 12 * sizeof *model->normals, "normals of the 3D view", &model->normals));
        SKG_TRY(skg_realloc(capacity, sizeof *model->colours, "colours of the 3D view", &model->colours));
        model->triangle_capacity = capacity;
    }
    return SKG_OK;
}

void skg_show_model_add_vertex(skg_show_model *model, const double position[3]) {
    for (int k = 0; k < 3; k++)
        model->positions[3 * model->vertices + k] = (float)(position[k] - model->centre[k]);
    model->vertices++;
}

void skg_show_model_add_triangle(skg_show_model *model, const int64_t corners[3], double normals[3][3],
                                 uint32_t colour) {
    SKG_ASSERT(model->triangles < model->triangle_capacity);
    for (int k = 0; k < 3; k++) {
        model->corners[3 * model->triangles + k] = (int32_t)corners[k];
        int16_t *normal = model->normals + 12 * model->triangles + 4 * k;
        for (int axis = 0; axis < 3; axis++)
            normal[axis] = (int16_t)(32767 * normals[k][axis] + copysign(0.5, normals[k][axis]));
        normal[3] = 0;
    }
    model->colours[model->triangles] = colour;
    model->triangles++;
}

void skg_show_model_add_image(skg_show_model *model, const int64_t corners[3], double places[3][2]) {
    double none[3][3] = {{0}};
    int16_t *normals = model->normals + 12 * model->triangles;
    skg_show_model_add_triangle(model, corners, none, SKG_SHOW_COLOUR(255, 255, 255, 255));
    for (int i = 0; i < 6; i++) normals[4 * (i / 2) + i % 2] = (int16_t)lround(16384 * places[i / 2][i % 2]);
    model->images++;
}
