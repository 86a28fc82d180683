/* The points of a study as JSON, for --json and for the page. */
#include "cost/output.h"

#include "common/encode.h"
#include "cost/clock.h"
#include "cost/dial.h"
#include "cost/findings.h"
#include "cost/measuring.h"

#include <time.h>

static json_t *setting_json(const cost_study *study, const cost_setting *setting) {
    char text[160];
    json_t *object = json_object();
    cost_describe(study, setting, text, sizeof text);
    json_object_set_new(object, "text", cli_json_text(text));
    for (int dial = COST_PRECISION; dial < COST_DIALS; dial++)
        json_object_set_new(object, cost_dials[dial].key, cost_value_json(study, setting, dial));
    return object;
}

/* Adds the price of an image on an idle machine, its clock, and the time that one waits for it now. */
static void add_price(const cost_study *study, const cost_shot *shot, json_t *object) {
    json_t *price = json_object();
    json_object_set_new(price, "ms", cli_json_number(shot->price_ms));
    json_object_set_new(price, "uncertainty", cli_json_number(shot->uncertainty_ms));
    json_object_set_new(price, "clock", cli_json_text(cost_clock_name(study)));
    json_object_set_new(object, "price", price);
    json_object_set_new(object, "wall_now_ms", cli_json_number(shot->wall_now_ms));
}

static json_t *point_json(const cost_study *study, const cost_point *point) {
    json_t *object = json_object();
    json_object_set_new(object, "dial", cli_json_text(cost_dial_name(point->dial)));
    json_object_set_new(object, "setting", setting_json(study, &point->setting));
    json_object_set_new(object, "reference", json_integer(point->reference));
    json_object_set_new(object, "settings_index", json_integer(point->shot));
    json_object_set_new(object, "frontier", json_boolean(point->on_frontier));
    add_price(study, &study->measured.shots[point->shot], object);
    cost_add_numbers(study, point, object);
    return object;
}

/* A shot as the page needs it. Times in ms, errors as fractions of the flat field against the best of all dials. */
static json_t *shot_json(const cost_study *study, const cost_shot *shot) {
    const int dial = cost_changed_dial(study, &shot->setting);
    char value[160];
    json_t *object = json_object();
    cost_describe_dial(study, &shot->setting, dial, value, sizeof value);
    json_object_set_new(object, "dial", cli_json_text(cost_dial_name(dial)));
    json_object_set_new(object, "value", cli_json_text(value));
    json_object_set_new(object, "setting", setting_json(study, &shot->setting));
    json_object_set_new(object, "best", json_boolean(shot->on_frontier));
    json_object_set_new(object, "runs", json_integer(shot->runs));
    json_object_set_new(object, "visits", json_integer(shot->visits));
    add_price(study, shot, object);
    json_object_set_new(object, "rms", cli_json_number(shot->total_rms));
    json_object_set_new(object, "max", cli_json_number(shot->total_max));
    json_object_set_new(object, "command", cli_json_text(shot->command));
    return object;
}

static const char *const states[] = {[COST_ABSENT] = "absent",
                                     [COST_NOT_KNOWN] = "not known",
                                     [COST_NOT_MEASURED] = "not measured",
                                     [COST_COARSE] = "coarse",
                                     [COST_FINE] = "measured"};

static json_t *source_json(const cost_study *study, int number) {
    const cost_source *source = &study->judged.sources[number];
    char today[160];
    json_t *object = json_object();
    cost_describe_source(study, number, today, sizeof today);
    json_object_set_new(object, "name", cli_json_text(cost_sources[number].name));
    json_object_set_new(object, "state", cli_json_text(states[source->state]));
    json_object_set_new(object, "error", cli_json_number(source->error));
    json_object_set_new(object, "max", cli_json_number(source->max));
    json_object_set_new(object, "today", *today ? cli_json_text(today) : json_null());
    json_object_set_new(object, "halving_ms", cli_json_number(source->halving_ms));
    json_object_set_new(object, "halving_uncertainty_ms", cli_json_number(source->halving_uncertainty_ms));
    json_object_set_new(object, "halving", source->halving < 0 ? json_null() : cli_json_text(source->buys));
    json_object_set_new(object, "command", source->command ? cli_json_text(source->command) : json_null());
    json_object_set_new(object, "reason", *source->reason ? cli_json_text(source->reason) : json_null());
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
    for (int dial = COST_SAMPLES; dial <= COST_TRIANGLES; dial++)
        json_object_set_new(object, cost_dials[dial].key, index_json(advice->chosen[dial]));
    json_object_set_new(object, "sampling_met", json_boolean(advice->sampling_met));
    json_object_set_new(object, "reason", *advice->reason ? cli_json_text(advice->reason) : json_null());
    json_object_set_new(object, "settings_index", index_json(cost_find_shot(study, &advice->whole.setting)));
    json_object_set_new(object, "whole_command", cli_json_text(advice->whole_command));
    json_object_set_new(object, "whole",
                        advice->whole_state == COST_WHOLE_MEASURED ? point_json(study, &advice->whole)
                                                                   : json_null());
    return object;
}

/* The dials that are compared with a reference: "precision, tolerance, bins". */
static json_t *dials_json(int reference) {
    char text[96] = "";
    for (int dial = COST_PRECISION; dial < COST_DIALS; dial++)
        if (cost_dials[dial].reference == reference)
            cost_append(text, sizeof text, "%s%s", *text ? ", " : "", cost_dials[dial].name);
    return cli_json_text(*text ? text : "all dials together");
}

static json_t *references_json(const cost_study *study) {
    json_t *references = json_array();
    for (int i = 0; i < COST_REFERENCES; i++) {
        json_t *reference = study->measured.references[i].image
                                ? setting_json(study, &study->measured.references[i].setting)
                                : json_null();
        if (json_is_object(reference)) json_object_set_new(reference, "dials", dials_json(i));
        json_array_append_new(references, reference);
    }
    return references;
}

/* Adds the conditions of the run: scene, version, date, device, and how well times could be measured. */
static void add_run(const cost_study *study, json_t *object) {
    char date[32];
    const time_t now = time(NULL);
    strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", gmtime(&now));
    json_object_set_new(object, "scene", cli_json_text(study->session.path));
    json_object_set_new(object, "version", cli_json_text(skg_version()));
    json_object_set_new(object, "date", cli_json_text(date));
    json_object_set_new(object, "device", cli_json_text(study->session.device.name));
    json_object_set_new(object, "columns", json_integer(study->session.view.columns));
    json_object_set_new(object, "rows", json_integer(study->session.view.rows));
    json_object_set_new(object, "triangles", json_integer(study->subject.triangles));
    json_object_set_new(object, "frames", json_integer(study->frames));
    json_object_set_new(object, "within_s", cli_json_number(1e-3 * study->within_ms));
    json_object_set_new(object, "seconds", cli_json_number(1e-3 * (study->ended_ms - study->begun_ms)));
    json_object_set_new(object, "stopped", json_boolean(study->stopped));
    json_object_set_new(object, "left_out", json_integer(study->left_out));
    json_object_set_new(object, "unrest", cli_json_number(study->judged.unrest));
    json_object_set_new(object, "reference_error", cli_json_number(study->judged.reference_error));
    json_object_set_new(object, "grey_levels",
                        study->judged.grey_levels > 0 ? cli_json_number(study->judged.grey_levels)
                                                      : json_null());
    json_object_set_new(object, "open_keV", cli_json_number(study->subject.flat_field));
    json_object_set_new(object, "noise",
                        study->subject.noise > 0 ? cli_json_number(study->subject.noise) : json_null());
}

json_t *cost_json(const cost_study *study) {
    json_t *object = json_object(), *points = json_array(), *advice = json_array(), *notes = json_array(),
           *sources = json_array(), *shots = json_array();
    for (int i = 0; i < COST_SOURCES; i++) json_array_append_new(sources, source_json(study, i));
    for (int i = 0; i < study->measured.shot_count; i++)
        json_array_append_new(shots, shot_json(study, &study->measured.shots[i]));
    for (int i = 0; i < study->measured.count; i++)
        json_array_append_new(points, point_json(study, &study->measured.points[i]));
    for (int i = 0; i < COST_TOLERANCES; i++)
        json_array_append_new(advice, advice_json(study, &study->judged.advice[i]));
    for (int i = 0; i < study->note_count; i++) json_array_append_new(notes, cli_json_text(study->notes[i]));
    json_object_set_new(object, "summary", cli_json_text(study->judged.summary));
    json_object_set_new(object, "sources", sources);
    json_object_set_new(object, "scatter", cost_scatter_json(study));
    json_object_set_new(object, "interpolation", cost_between_json(study));
    json_object_set_new(object, "sensitivity", cost_sensitivity_json(study));
    add_run(study, object);
    json_object_set_new(object, "here", json_integer(study->measured.here));
    json_object_set_new(object, "buy", index_json(study->judged.buy));
    json_object_set_new(object, "saving", index_json(study->judged.saving));
    json_object_set_new(object, "settings", shots);
    json_object_set_new(object, "references", references_json(study));
    json_object_set_new(object, "points", points);
    json_object_set_new(object, "advice", advice);
    json_object_set_new(object, "notes", notes);
    return object;
}
