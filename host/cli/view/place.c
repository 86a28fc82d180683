/* Where parts, source and detector stand in a view, and how far apart. */
#include "view/picture.h"

#include "common/say.h"
#include "core/maths.h"

#include <math.h>
#include <stdlib.h>

/* Centre and box of the vertices of a part, in the world. */
static int measure_part(const skg_part *part, view_part *to) {
    int64_t vertices = 0, triangles = 0;
    skg_status status = skg_mesh_count(part->mesh, &vertices, &triangles);
    if (status != SKG_OK) return cli_fail(status);
    double *positions = malloc((size_t)vertices * 3 * sizeof *positions + 1);
    if (!positions) return cli_error(CLI_DEVICE, "out of host memory");
    for (int k = 0; k < 3; k++) to->low[k] = HUGE_VAL, to->high[k] = -HUGE_VAL;
    status = skg_mesh_positions_get(part->mesh, positions, 3);
    for (int64_t v = 0; v < vertices && status == SKG_OK; v++) {
        double at[3];
        skg_pose_point(part->pose, positions + 3 * v, at);
        skg_add_scaled(to->centre, 1 / (double)vertices, at, to->centre);
        for (int k = 0; k < 3; k++)
            to->low[k] = fmin(to->low[k], at[k]), to->high[k] = fmax(to->high[k], at[k]);
    }
    free(positions);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static skg_status find_in_picture(const cli_session *session, const skg_look *look, view_part *part) {
    double points[9][3], seen[9][2];
    for (int k = 0; k < 3; k++) points[8][k] = part->centre[k];
    for (int corner = 0; corner < 8; corner++)
        for (int k = 0; k < 3; k++) points[corner][k] = corner >> k & 1 ? part->high[k] : part->low[k];
    const skg_status status =
        skg_scene_places_get(session->scene, &session->view, look, 9, points[0], seen[0]);
    if (status != SKG_OK) return status;
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int corner = 0; corner < 8; corner++)
        for (int k = 0; k < 2; k++)
            low[k] = fmin(low[k], seen[corner][k]), high[k] = fmax(high[k], seen[corner][k]);
    part->area = (high[0] - low[0]) * (high[1] - low[1]);
    part->low_column = low[0], part->high_column = high[0];
    part->at[0] = seen[8][0], part->at[1] = seen[8][1];
    return SKG_OK;
}

static void find_distances(const skg_view *view, view_places *places) {
    double axis[3], object[3];
    places->magnification = 1;
    places->source_detector = places->source_object = (double)NAN;
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY) return;
    skg_add_scaled(view->centre, -1, view->source, axis);
    places->source_detector = skg_length(axis);
    for (int k = 0; k < 3; k++) object[k] = 0.5 * (places->low[k] + places->high[k]) - view->source[k];
    places->source_object = skg_dot(object, axis) / places->source_detector;
    if (view->projection == SKG_PROJECTION_POINT)
        places->magnification = places->source_detector / places->source_object;
}

void view_source(const skg_view *view, const view_places *places, double source[3]) {
    double along[3], farthest = 0;
    memcpy(source, view->source, 3 * sizeof *source);
    if (view->projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY) return;
    skg_scale_vector(-1 / skg_length(view->source), view->source, along);
    for (int corner = 0; corner < 8; corner++) {
        double from[3];
        for (int k = 0; k < 3; k++)
            from[k] = (corner >> k & 1 ? places->high[k] : places->low[k]) - view->centre[k];
        farthest = fmax(farthest, skg_dot(along, from));
    }
    skg_add_scaled(view->centre, 1.1 * farthest, along, source);
}

int view_find_places(const cli_session *session, const skg_look *look, view_places *places) {
    *places = (view_places){0};
    skg_status status = skg_scene_part_count(session->scene, &places->count);
    if (status != SKG_OK) return cli_fail(status);
    places->parts = calloc((size_t)places->count + 1, sizeof *places->parts);
    if (!places->parts) return cli_error(CLI_DEVICE, "out of host memory");
    for (int k = 0; k < 3; k++) places->low[k] = HUGE_VAL, places->high[k] = -HUGE_VAL;
    for (int64_t i = 0; i < places->count; i++) {
        view_part *to = places->parts + i;
        skg_part part;
        skg_part_init(&part);
        status = skg_scene_part_get(session->scene, i, &part);
        if (status != SKG_OK) return cli_fail(status);
        to->label = part.label;
        const int exit_status = measure_part(&part, to);
        if (exit_status != CLI_DONE) return exit_status;
        status = find_in_picture(session, look, to);
        if (status != SKG_OK) return cli_fail(status);
        for (int k = 0; k < 3; k++) {
            places->low[k] = fmin(places->low[k], to->low[k]);
            places->high[k] = fmax(places->high[k], to->high[k]);
        }
    }
    find_distances(&session->view, places);
    return CLI_DONE;
}
