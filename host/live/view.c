/* Source, beam and detector as a page draws them. */
#include "live/inside.h"

#include "core/maths.h"
#include "core/text.h"
#include "show/drawing.h"

#include <math.h>
#include <string.h>

/* Flat strips that a page draws of a curved detector, side by side: an odd number, so that the ends of each are those of a narrower
 * detector about the same middle. */
enum { STRIPS = 23 };

/* The ends of columns that stand side by side from edge to edge, low row and high row: two columns of a flat detector. */
static skg_status strips_json(const skg_view *view, json_t *strips) {
    const int count = view->radius > 0 ? STRIPS : 1;
    for (int s = -count; s <= count; s += 2) {
        skg_view part = *view;
        double corners[4][3];
        part.columns = 1;
        skg_scale_vector(fabs((double)s) / count * (double)view->columns, view->column_step,
                         part.column_step);
        SKG_TRY(skg_collimation_corners_get(NULL, &part, 0, corners[0]));
        json_array_append_new(strips, json_pack("[o,o]", skg_live_numbers(corners[s < 0 ? 0 : 1], 3),
                                                skg_live_numbers(corners[s < 0 ? 3 : 2], 3)));
    }
    return SKG_OK;
}

/* Columns of the detector and its steps, the corners of the beam on its plane and in the jaws, one after the other, and where the beam to
 * each of these starts. */
skg_status skg_live_view_json(const skg_view *view, const skg_collimation *collimation, const double *box,
                              json_t *object) {
    static const char *const names[] = {"point", "parallel", "parallel"};
    double source[3], up[3], field[4][3], opening[4][3];
    json_t *strips = json_array(), *ends = json_array(), *starts = json_array(), *jaws = json_array();
    skg_status status = skg_collimation_corners_get(collimation, view, 0, field[0]);
    if (status == SKG_OK) status = skg_collimation_corners_get(collimation, view, 1, opening[0]);
    if (status == SKG_OK) status = strips_json(view, strips);
    memcpy(source, view->source, sizeof source);
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        skg_show_beam_start(view, box, box + 3, view->centre, source);
    skg_scale_vector(-1, view->row_step, up);
    for (int i = 0; status == SKG_OK && i < 4; i++) {
        double start[3];
        skg_show_beam_start(view, box, box + 3, field[i], start);
        json_array_append_new(ends, skg_live_numbers(field[i], 3));
        json_array_append_new(starts, skg_live_numbers(start, 3));
        if (collimation && collimation->kind == SKG_COLLIMATION_RECTANGLE)
            json_array_append_new(jaws, skg_live_numbers(opening[i], 3));
    }
    json_object_set_new(object, "projection",
                        json_string(names[status == SKG_OK ? view->projection : SKG_PROJECTION_POINT]));
    json_object_set_new(object, "source", skg_live_numbers(source, 3));
    json_object_set_new(object, "centre", skg_live_numbers(view->centre, 3));
    json_object_set_new(object, "up", skg_live_numbers(up, 3));
    json_object_set_new(object, "columns", json_integer(view->columns));
    json_object_set_new(object, "rows", json_integer(view->rows));
    json_object_set_new(object, "strips", strips);
    json_object_set_new(
        object, "steps",
        json_pack("[o,o]", skg_live_numbers(view->column_step, 3), skg_live_numbers(view->row_step, 3)));
    json_object_set_new(object, "starts", starts);
    json_object_set_new(object, "field", ends);
    json_object_set_new(object, "jaws", jaws);
    return status;
}

skg_status skg_live_view_write(const skg_view *theirs, const skg_collimation *collimation, const double *box,
                               skg_live_letter **letter) {
    SKG_PLAIN;
    skg_view view;
    SKG_NEEDS(box);
    SKG_NEEDS(letter);
    *letter = NULL;
    skg_view_init(&view);
    SKG_TRY(skg_struct_read(theirs, "skg_view", &view, sizeof view));
    json_t *object = json_object();
    const skg_status status = skg_live_view_json(&view, collimation, box, object);
    if (status == SKG_OK) return skg_live_text_letter(object, letter);
    json_decref(object);
    return status;
}
