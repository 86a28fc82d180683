#include "cost/data.h"

#include "common/json.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static int32_t repair_of(const cost_study *study, const cost_setting *setting) {
    return setting->repair >= 0 ? setting->repair : study->session.options.repair;
}

static int64_t triangles_of(const cost_study *study, const cost_setting *setting) {
    return setting->meshing >= 0 ? study->meshings[setting->meshing].triangles : study->triangles;
}

static json_t *setting_json(const cost_study *study, const cost_setting *setting) {
    const int breathes = setting->relaxation >= 0;
    char text[160];
    json_t *object = json_object();
    cost_describe(study, setting, text, sizeof text);
    json_object_set_new(object, "text", cli_json_text(text));
    json_object_set_new(object, "precision", cli_json_text(cost_precision_name(setting)));
    json_object_set_new(object, "tolerance", cli_json_number(setting->tolerance));
    json_object_set_new(object, "bins", setting->bins > 0 ? json_integer(setting->bins) : json_null());
    json_object_set_new(object, "samples",
                        setting->samples > 0 ? json_integer(setting->samples) : json_null());
    json_object_set_new(object, "supersampling", json_integer(setting->supersampling));
    json_object_set_new(object, "repair",
                        study->has_leaky ? cli_json_text(cost_repair_names[repair_of(study, setting)])
                                         : json_null());
    json_object_set_new(object, "triangles", json_integer(triangles_of(study, setting)));
    json_object_set_new(object, "relaxation", breathes ? json_integer(setting->relaxation) : json_null());
    json_object_set_new(object, "hysteresis", breathes ? json_real(setting->hysteresis) : json_null());
    return object;
}

static json_t *point_json(const cost_study *study, const cost_point *point) {
    json_t *object = json_object();
    json_object_set_new(object, "dial", cli_json_text(cost_dial_names[point->dial]));
    json_object_set_new(object, "setting", setting_json(study, &point->setting));
    json_object_set_new(object, "reference", json_integer(point->reference));
    json_object_set_new(object, "frontier", json_boolean(point->on_frontier));
    json_object_set_new(object, "nodes", json_integer(point->nodes));
    json_object_set_new(object, "planes", json_integer(point->planes));
    json_object_set_new(object, "runs", json_integer(point->runs));
    json_object_set_new(object, "plan_ms", cli_json_number(point->plan_ms));
    json_object_set_new(object, "min_ms", cli_json_number(point->min_ms));
    json_object_set_new(object, "median_ms", cli_json_number(point->median_ms));
    json_object_set_new(object, "max_open", cli_json_number(point->max_flat));
    json_object_set_new(object, "rms_open", cli_json_number(point->rms_flat));
    json_object_set_new(object, "max_ref", cli_json_number(point->max_ref));
    json_object_set_new(object, "rms_ref", cli_json_number(point->rms_ref));
    json_object_set_new(object, "max_mm", cli_json_number(point->max_mm));
    json_object_set_new(object, "rms_mm", cli_json_number(point->rms_mm));
    return object;
}

static json_t *index_json(int index) {
    return index >= 0 ? json_integer(index) : json_null();
}

static json_t *advice_json(const cost_study *study, const cost_advice *advice) {
    json_t *object = json_object();
    json_object_set_new(object, "tolerance", cli_json_number(advice->tolerance));
    json_object_set_new(object, "bar", cli_json_number(advice->bar));
    json_object_set_new(object, "rays", index_json(advice->rays));
    json_object_set_new(object, "rays_met", json_boolean(advice->rays_met));
    json_object_set_new(object, "rays_command", cli_json_text(advice->rays_command));
    json_object_set_new(object, "samples", index_json(advice->samples));
    json_object_set_new(object, "supersampling", index_json(advice->supersampling));
    json_object_set_new(object, "triangles", index_json(advice->triangles));
    json_object_set_new(object, "repair", index_json(advice->repair));
    json_object_set_new(object, "sampling_met", json_boolean(advice->sampling_met));
    json_object_set_new(object, "whole_command", cli_json_text(advice->whole_command));
    json_object_set_new(object, "whole",
                        advice->whole_state == COST_WHOLE_MEASURED ? point_json(study, &advice->whole)
                                                                   : json_null());
    return object;
}

json_t *cost_json(const cost_study *study) {
    char date[32];
    const time_t now = time(NULL);
    strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", gmtime(&now));
    json_t *object = json_object(), *references = json_array(), *points = json_array(),
           *advice = json_array(), *notes = json_array();
    for (int i = 0; i < COST_REFERENCES; i++) {
        json_t *reference =
            study->references[i].image ? setting_json(study, &study->references[i].setting) : json_null();
        if (json_is_object(reference))
            json_object_set_new(reference, "dials", cli_json_text(cost_reference_names[i]));
        json_array_append_new(references, reference);
    }
    for (int i = 0; i < study->count; i++)
        json_array_append_new(points, point_json(study, &study->points[i]));
    for (int i = 0; i < COST_TOLERANCES; i++)
        json_array_append_new(advice, advice_json(study, &study->advice[i]));
    for (int i = 0; i < study->note_count; i++) json_array_append_new(notes, cli_json_text(study->notes[i]));
    json_object_set_new(object, "scene", cli_json_text(study->session.path));
    json_object_set_new(object, "version", cli_json_text(skg_version()));
    json_object_set_new(object, "date", cli_json_text(date));
    json_object_set_new(object, "device", cli_json_text(study->session.device.name));
    json_object_set_new(object, "columns", json_integer(study->session.view.columns));
    json_object_set_new(object, "rows", json_integer(study->session.view.rows));
    json_object_set_new(object, "triangles", json_integer(study->triangles));
    json_object_set_new(object, "open_keV", cli_json_number(study->flat_field));
    json_object_set_new(object, "noise", study->noise > 0 ? cli_json_number(study->noise) : json_null());
    json_object_set_new(object, "references", references);
    json_object_set_new(object, "points", points);
    json_object_set_new(object, "advice", advice);
    json_object_set_new(object, "notes", notes);
    return object;
}

static void put_setting(FILE *stream, const cost_study *study, const cost_setting *setting) {
    fprintf(stream, "%s,%.6g,", cost_precision_name(setting), setting->tolerance);
    fprintf(stream, "%" PRId64 ",%" PRId64 ",%d,", setting->bins, setting->samples,
            (int)setting->supersampling);
    fprintf(stream, "%s,%" PRId64 ",", study->has_leaky ? cost_repair_names[repair_of(study, setting)] : "",
            triangles_of(study, setting));
    if (setting->relaxation < 0)
        fputs(",,", stream); /* empty: the setting has no breath */
    else
        fprintf(stream, "%d,%g,", (int)setting->relaxation, setting->hysteresis);
}

char *cost_csv(const cost_study *study) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    fputs("dial,precision,tolerance,max_bins,samples,supersampling,repair,triangles,relaxation,hysteresis,"
          "nodes,planes,runs,plan_ms,min_ms,median_ms,max_open,rms_open,max_ref,rms_ref,max_mm,rms_mm,"
          "frontier\n",
          stream);
    for (int i = 0; i < study->count; i++) {
        const cost_point *p = &study->points[i];
        fprintf(stream, "%s,", cost_dial_names[p->dial]);
        put_setting(stream, study, &p->setting);
        fprintf(stream, "%" PRId64 ",%" PRId64 ",%" PRId64, p->nodes, p->planes, p->runs);
        fprintf(stream, ",%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,", p->plan_ms, p->min_ms, p->median_ms,
                p->max_flat, p->rms_flat, p->max_ref, p->rms_ref);
        if (!isnan(p->max_mm)) fprintf(stream, "%.6g", p->max_mm); /* empty: not measured */
        fputc(',', stream);
        if (!isnan(p->rms_mm)) fprintf(stream, "%.6g", p->rms_mm);
        fprintf(stream, ",%d\n", p->on_frontier);
    }
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}
