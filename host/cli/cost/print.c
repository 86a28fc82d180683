#include "cost/print.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int widest_description(const cost_study *study) {
    int widest = 0;
    for (int i = 0; i < study->count; i++) {
        char text[160];
        cost_describe(study, &study->points[i].setting, text, sizeof text);
        if ((int)strlen(text) > widest) widest = (int)strlen(text);
    }
    return widest;
}

static void print_point(const cost_study *study, const cost_point *point, int width) {
    char text[160], mm[32] = "";
    cost_describe(study, &point->setting, text, sizeof text);
    if (!isnan(point->max_mm)) snprintf(mm, sizeof mm, "  %8.1e %8.1e", point->max_mm, point->rms_mm);
    printf("%c %-14s %-*s %4" PRId64 " %6" PRId64 " %9.3f %9.3f  %8.1e %8.1e  %8.1e %8.1e%s\n",
           point->on_frontier ? '*' : ' ', cost_dial_names[point->dial], width, text, point->nodes,
           point->planes, point->min_ms, point->median_ms, point->max_flat, point->rms_flat, point->max_ref,
           point->rms_ref, mm);
}

static void print_points(const cost_study *study) {
    const int width = widest_description(study);
    printf("\n  %-14s %-*s %4s %6s %9s %9s  %8s %8s  %8s %8s  %8s %8s\n", "", width, "", "", "", "ms", "ms",
           "of flat", "of flat", "of pixel", "of pixel", "mm", "mm");
    printf("  %-14s %-*s %4s %6s %9s %9s  %8s %8s  %8s %8s  %8s %8s\n", "dial", width, "setting", "keV",
           "planes", "minimum", "median", "largest", "rms", "largest", "rms", "largest", "rms");
    for (int i = 0; i < study->count; i++) print_point(study, &study->points[i], width);
    printf(
        "  * frontier: no other setting of the rays is both faster and more accurate; keV: number of energies; "
        "planes: of path lengths, for a basis of the materials or for each\n"
        "  mm: path lengths, rms of rays that meet the part");
    if (study->references[COST_OF_BREATH].image)
        printf("; relaxation and hysteresis: vertices at %d phases, time of a pose and its image",
               COST_PHASES);
    putchar('\n');
}

static void print_references(const cost_study *study) {
    printf("compared with\n");
    for (int i = 0; i < COST_REFERENCES; i++) {
        char text[160];
        if (!study->references[i].image) continue;
        cost_describe(study, &study->references[i].setting, text, sizeof text);
        printf("  %s: %s\n", cost_reference_names[i], text);
    }
}

/* "source samples, supersampling": the scene's dials. *worst: the largest of their root mean square errors. */
static void name_dials(const cost_study *study, const cost_advice *advice, char *text, size_t size,
                       double *worst) {
    const int points[] = {advice->samples, advice->supersampling, advice->triangles};
    *text = '\0';
    *worst = 0;
    for (int k = 0; k < 3; k++) {
        if (points[k] < 0) continue;
        cost_append(text, size, "%s%s", *text ? ", " : "", cost_dial_names[study->points[points[k]].dial]);
        *worst = fmax(*worst, study->points[points[k]].rms_flat);
    }
    if (advice->repair >= 0) cost_append(text, size, "%s%s", *text ? ", " : "", cost_dial_names[COST_REPAIR]);
}

static void print_advice(const cost_study *study, const cost_advice *advice) {
    static const char *const states[] = {", the same command\n", ":\n    ",
                                         "; not measured together, because it takes too long:\n    "};
    const cost_point *rays = &study->points[advice->rays];
    char dials[160];
    double worst;
    printf("\nfor an error of %g%s: largest %.1e of the flat field, %.3f ms\n    %s\n", advice->tolerance,
           advice->rays_met ? "" : ", NOT reached; the best tried", rays->max_flat, rays->min_ms,
           advice->rays_command);
    name_dials(study, advice, dials, sizeof dials, &worst);
    if (!*dials) return;
    printf("  with %s%s: root mean square %.1e of the flat field", dials,
           advice->sampling_met ? "" : ", NOT reached; the best tried", worst);
    if (advice->whole_state == COST_WHOLE_MEASURED) printf(", %.3f ms", advice->whole.min_ms);
    printf("%s", states[advice->whole_state]);
    if (advice->whole_state != COST_WHOLE_IS_RAYS) printf("%s\n", advice->whole_command);
}

void cost_print(const cost_study *study) {
    const skg_view *view = &study->session.view;
    printf("%s: %" PRId64 " x %" PRId64 " pixels, %" PRId64
           " triangles, flat field %.6g keV per pixel, on %s\n",
           study->session.path, view->columns, view->rows, study->triangles, study->flat_field,
           study->session.device.name);
    print_references(study);
    print_points(study);
    if (study->noise > 0)
        printf(
            "  noise: root mean square %.1e of the flat field; errors below a tenth of it are not sought\n",
            study->noise);
    for (int i = 0; i < study->note_count; i++) printf("  %s\n", study->notes[i]);
    for (int i = 0; i < COST_TOLERANCES; i++) print_advice(study, &study->advice[i]);
}
