/* skiagraph cost: what was found, as a table, .csv and JSON. */
#include "cost.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void cost_describe(const cost_setting *setting, char *text, size_t size) {
    char bins[48] = "", samples[48] = "";
    if (setting->bins == COST_FINEST_BINS)
        snprintf(bins, sizeof bins, ", bins of 1 keV");
    else if (setting->bins > 0)
        snprintf(bins, sizeof bins, ", %" PRId64 " bins", setting->bins);
    if (setting->samples > 0) snprintf(samples, sizeof samples, ", %" PRId64 " samples", setting->samples);
    snprintf(text, size, "%s, tolerance %.3g%s%s, %d x %d rays", cli_precision_names[setting->precision],
             setting->tolerance, bins, samples, (int)setting->supersampling, (int)setting->supersampling);
}

static void print_point(const cost_point *point) {
    char text[160], mm[16] = "";
    cost_describe(&point->setting, text, sizeof text);
    if (!isnan(point->max_mm)) snprintf(mm, sizeof mm, "%.1e", point->max_mm);
    printf("%c %-14s %-52s %4" PRId64 " %9.3f %9.3f  %8.1e %8.1e  %8.1e %8.1e  %s\n",
           point->on_frontier ? '*' : ' ', cost_dial_names[point->dial], text, point->nodes, point->min_ms,
           point->median_ms, point->max_open, point->rms_open, point->max_ref, point->rms_ref, mm);
}

static void print_reference(const char *dials, const cost_setting *setting) {
    char text[160];
    cost_describe(setting, text, sizeof text);
    printf("  %s: %s\n", dials, text);
}

static void print_sampling(const cost_study *study, const cost_advice *advice) {
    static const char *const states[] = {"", "", "; it was not run together: it takes too long"};
    double worst = 0;
    if (advice->samples >= 0) worst = study->points[advice->samples].rms_open;
    if (advice->supersampling >= 0) worst = fmax(worst, study->points[advice->supersampling].rms_open);
    printf("  with source and pixels' areas%s (root mean square %.1e of the open beam)",
           advice->sampling_met ? "" : ", NOT reached; the best tried", worst);
    if (advice->whole_state == COST_WHOLE_MEASURED) printf(", %.3f ms", advice->whole.min_ms);
    printf("%s:\n", states[advice->whole_state]);
    printf("    %s\n", advice->whole_command);
}

static void print_advice(const cost_study *study, const cost_advice *advice) {
    const cost_point *rays = &study->points[advice->rays];
    printf("\nfor an error of %g%s: largest %.1e of the open beam, %.3f ms\n    %s\n", advice->tolerance,
           advice->rays_met ? "" : ", NOT reached; the best tried", rays->max_open, rays->min_ms,
           advice->rays_command);
    if (advice->whole_state == COST_WHOLE_IS_RAYS)
        printf("  which resolves source and pixels' areas as well%s\n",
               advice->sampling_met ? "" : " as any setting tried, but NOT to that error");
    else
        print_sampling(study, advice);
}

void cost_print(const cost_study *study) {
    const skg_view *view = &study->session.view;
    printf("%s: %" PRId64 " x %" PRId64 " pixels, open beam %.6g keV per pixel, on %s\n", study->session.path,
           view->columns, view->rows, study->open, study->session.device.name);
    printf("compared with\n");
    print_reference("precision, tolerance, bins", &study->references[0].setting);
    if (study->has_spot) print_reference("source samples", &study->references[1].setting);
    print_reference("supersampling", &study->references[2].setting);
    printf("\n  %-14s %-52s %4s %9s %9s  %8s %8s  %8s %8s  %s\n", "", "", "", "ms", "ms", "of open",
           "of open", "of pixel", "of pixel", "mm");
    printf("  %-14s %-52s %4s %9s %9s  %8s %8s  %8s %8s  %s\n", "dial", "setting", "keV", "minimum", "median",
           "largest", "rms", "largest", "rms", "largest");
    for (int i = 0; i < study->count; i++) print_point(&study->points[i]);
    printf("  * frontier: none of the same rays is both faster and better; keV: energies used; mm: path "
           "lengths\n");
    if (study->noise > 0)
        printf(
            "  noise: root mean square %.1e of the open beam; errors below a tenth of it are not asked for\n",
            study->noise);
    for (int i = 0; i < study->note_count; i++) printf("  %s\n", study->notes[i]);
    for (int i = 0; i < COST_TOLERANCES; i++) print_advice(study, &study->advice[i]);
}

static json_t *setting_json(const cost_setting *setting) {
    char text[160];
    json_t *object = json_object();
    cost_describe(setting, text, sizeof text);
    json_object_set_new(object, "text", cli_json_text(text));
    json_object_set_new(object, "precision", cli_json_text(cli_precision_names[setting->precision]));
    json_object_set_new(object, "tolerance", cli_json_number(setting->tolerance));
    json_object_set_new(object, "bins", setting->bins > 0 ? json_integer(setting->bins) : json_null());
    json_object_set_new(object, "samples",
                        setting->samples > 0 ? json_integer(setting->samples) : json_null());
    json_object_set_new(object, "supersampling", json_integer(setting->supersampling));
    return object;
}

static json_t *point_json(const cost_point *point) {
    json_t *object = json_object();
    json_object_set_new(object, "dial", cli_json_text(cost_dial_names[point->dial]));
    json_object_set_new(object, "setting", setting_json(&point->setting));
    json_object_set_new(object, "reference", json_integer(point->reference));
    json_object_set_new(object, "frontier", json_boolean(point->on_frontier));
    json_object_set_new(object, "nodes", json_integer(point->nodes));
    json_object_set_new(object, "planes", json_integer(point->planes));
    json_object_set_new(object, "runs", json_integer(point->runs));
    json_object_set_new(object, "plan_ms", cli_json_number(point->plan_ms));
    json_object_set_new(object, "min_ms", cli_json_number(point->min_ms));
    json_object_set_new(object, "median_ms", cli_json_number(point->median_ms));
    json_object_set_new(object, "max_open", cli_json_number(point->max_open));
    json_object_set_new(object, "rms_open", cli_json_number(point->rms_open));
    json_object_set_new(object, "max_ref", cli_json_number(point->max_ref));
    json_object_set_new(object, "rms_ref", cli_json_number(point->rms_ref));
    json_object_set_new(object, "max_mm", cli_json_number(point->max_mm));
    return object;
}

static json_t *index_json(int index) {
    return index >= 0 ? json_integer(index) : json_null();
}

static json_t *advice_json(const cost_advice *advice) {
    json_t *object = json_object();
    json_object_set_new(object, "tolerance", cli_json_number(advice->tolerance));
    json_object_set_new(object, "bar", cli_json_number(advice->bar));
    json_object_set_new(object, "rays", index_json(advice->rays));
    json_object_set_new(object, "rays_met", json_boolean(advice->rays_met));
    json_object_set_new(object, "rays_command", cli_json_text(advice->rays_command));
    json_object_set_new(object, "samples", index_json(advice->samples));
    json_object_set_new(object, "supersampling", index_json(advice->supersampling));
    json_object_set_new(object, "sampling_met", json_boolean(advice->sampling_met));
    json_object_set_new(object, "whole_command", cli_json_text(advice->whole_command));
    json_object_set_new(object, "whole",
                        advice->whole_state == COST_WHOLE_MEASURED ? point_json(&advice->whole)
                                                                   : json_null());
    return object;
}

json_t *cost_json(const cost_study *study) {
    json_t *object = json_object(), *references = json_array(), *points = json_array(),
           *advice = json_array(), *notes = json_array();
    for (int i = 0; i < 3; i++)
        json_array_append_new(references, study->references[i].image
                                              ? setting_json(&study->references[i].setting)
                                              : json_null());
    for (int i = 0; i < study->count; i++) json_array_append_new(points, point_json(&study->points[i]));
    for (int i = 0; i < COST_TOLERANCES; i++) json_array_append_new(advice, advice_json(&study->advice[i]));
    for (int i = 0; i < study->note_count; i++) json_array_append_new(notes, cli_json_text(study->notes[i]));
    json_object_set_new(object, "scene", cli_json_text(study->session.path));
    json_object_set_new(object, "device", cli_json_text(study->session.device.name));
    json_object_set_new(object, "columns", json_integer(study->session.view.columns));
    json_object_set_new(object, "rows", json_integer(study->session.view.rows));
    json_object_set_new(object, "open_keV", cli_json_number(study->open));
    json_object_set_new(object, "noise", study->noise > 0 ? cli_json_number(study->noise) : json_null());
    json_object_set_new(object, "references", references);
    json_object_set_new(object, "points", points);
    json_object_set_new(object, "advice", advice);
    json_object_set_new(object, "notes", notes);
    return object;
}

char *cost_csv(const cost_study *study) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    fputs(
        "dial,precision,tolerance,max_bins,samples,supersampling,nodes,planes,runs,plan_ms,min_ms,median_ms,"
        "max_open,rms_open,max_ref,rms_ref,max_mm,frontier\n",
        stream);
    for (int i = 0; i < study->count; i++) {
        const cost_point *p = &study->points[i];
        fprintf(stream, "%s,%s,%.6g,", cost_dial_names[p->dial], cli_precision_names[p->setting.precision],
                p->setting.tolerance);
        fprintf(stream, "%" PRId64 ",%" PRId64 ",%d,%" PRId64 ",%" PRId64 ",%" PRId64, p->setting.bins,
                p->setting.samples, (int)p->setting.supersampling, p->nodes, p->planes, p->runs);
        fprintf(stream, ",%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,", p->plan_ms, p->min_ms, p->median_ms,
                p->max_open, p->rms_open, p->max_ref, p->rms_ref);
        if (!isnan(p->max_mm)) fprintf(stream, "%.6g", p->max_mm); /* empty: not looked at */
        fprintf(stream, ",%d\n", p->on_frontier);
    }
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}
