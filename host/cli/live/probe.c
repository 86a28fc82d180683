/* Answers a page that asks what lies along the ray of a pixel. */
#include "live/ask.h"

#include "common/encode.h"
#include "core/maths.h"
#include "live/frame.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static int fail(char *sentence) {
    snprintf(sentence, LIVE_SENTENCE, "%s", skg_last_error());
    return 0;
}

/* A detector of one pixel, which is that pixel of the view. */
static void aim(const double at[2], skg_view *view) {
    const double column = floor(at[0]) + 0.5 - 0.5 * (double)view->columns,
                 row = floor(at[1]) + 0.5 - 0.5 * (double)view->rows;
    skg_add_scaled(view->centre, column, view->column_step, view->centre);
    skg_add_scaled(view->centre, row, view->row_step, view->centre);
    view->columns = view->rows = 1;
}

static int measure(const live_scene *scene, const live_wish *wish, const skg_view *view, float *lengths,
                   skg_output *outputs, char *sentence) {
    skg_plan_options options;
    skg_plan *plan = NULL;
    int dropped, is_outside;
    skg_plan_options_init(&options);
    options.overlaps = 0;
    options.precision = scene->session.options.precision;
    for (int64_t i = 0; i < scene->parts; i++) {
        skg_output_init(outputs + i);
        outputs[i].kind = SKG_OUTPUT_LENGTHS;
        outputs[i].part = i;
        outputs[i].data = lengths + i;
    }
    const skg_status status = skg_plan_create(scene->session.context, scene->session.scene, view,
                                              scene->session.spectrum, &options, &plan);
    const int is_made = status == SKG_OK ? live_frame_render(scene, wish, plan, view, NULL, outputs,
                                                             scene->parts, &dropped, &is_outside, sentence)
                                         : fail(sentence);
    skg_plan_release(&plan);
    return is_made;
}

static json_t *list_parts(const live_scene *scene, const float *lengths) {
    json_t *parts = json_array();
    for (int64_t i = 0; i < scene->parts; i++) {
        skg_part part;
        skg_part_init(&part);
        if (!(fabsf(lengths[i]) > 1e-4F) || skg_scene_part_get(scene->session.scene, i, &part) != SKG_OK)
            continue; /* a tenth of a micrometre is what rounding leaves of a part that the ray misses */
        json_t *pair = json_array();
        json_array_append_new(pair, cli_json_text(part.label));
        json_array_append_new(pair, cli_json_number((double)lengths[i]));
        json_array_append_new(parts, pair);
    }
    return parts;
}

json_t *live_probe(const live_base *base, const live_scene *scene, const live_wish *wish, const double at[2],
                   char *sentence) {
    skg_view view;
    json_t *object = NULL;
    if (!live_scene_view(base, scene, wish, &view, sentence)) return NULL;
    if (!(at[0] >= 0 && at[0] < (double)view.columns && at[1] >= 0 && at[1] < (double)view.rows)) {
        snprintf(sentence, LIVE_SENTENCE, "\"probe\": the detector has no such pixel");
        return NULL;
    }
    aim(at, &view);
    float *lengths = calloc((size_t)scene->parts + 1, sizeof *lengths);
    skg_output *outputs = calloc((size_t)scene->parts + 1, sizeof *outputs);
    if (!lengths || !outputs)
        snprintf(sentence, LIVE_SENTENCE, "out of host memory");
    else if (measure(scene, wish, &view, lengths, outputs, sentence)) {
        object = json_object();
        json_object_set_new(object, "probed", cli_json_numbers(at, 2));
        json_object_set_new(object, "parts", list_parts(scene, lengths));
    }
    free(lengths);
    free(outputs);
    return object;
}
