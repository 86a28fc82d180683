/* The verb `parts`: a table of the parts of a scene, for a report. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"
#include "session/explain.h"
#include "session/session.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A part and what was measured of it; NAN: not known. */
typedef struct {
    const char *label, *material;
    skg_part_row its;
} row;

typedef struct {
    cli_session session;
    skg_plan *plan;
    skg_part_table *measured;
    double kev;
    int64_t count;
    row *rows;
} table;

static skg_status read_row(const table *t, int64_t number, row *r) {
    skg_part part;
    skg_part_init(&part);
    skg_part_row_init(&r->its);
    skg_status status = skg_scene_part_get(t->session.scene, number, &part);
    if (status == SKG_OK) status = skg_material_name_get(part.material, &r->material);
    r->label = part.label;
    return status == SKG_OK ? skg_part_row_get(t->measured, number, &r->its) : status;
}

static int fill(table *t) {
    skg_status status = skg_part_table_create(t->plan, &t->measured);
    if (status == SKG_OK) status = skg_part_table_energy_get(t->measured, &t->kev);
    if (status == SKG_OK) status = skg_part_row_count(t->measured, &t->count);
    if (status != SKG_OK) return cli_fail(status);
    t->rows = calloc((size_t)t->count + 1, sizeof *t->rows);
    if (!t->rows) return cli_error(CLI_DEVICE, "out of host memory for the parts");
    for (int64_t i = 0; i < t->count && status == SKG_OK; i++) status = read_row(t, i, &t->rows[i]);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static json_t *table_json(const table *t) {
    json_t *object = json_object(), *rows = json_array();
    json_object_set_new(object, "energy_keV", cli_json_number(t->kev));
    for (int64_t i = 0; i < t->count; i++) {
        const row *r = &t->rows[i];
        json_t *one = json_object();
        json_object_set_new(one, "label", cli_json_text(r->label));
        json_object_set_new(one, "material", cli_json_text(r->material));
        json_object_set_new(one, "density_g_cm3", cli_json_number(r->its.density_g_cm3));
        json_object_set_new(one, "volume_mm3", cli_json_number(r->its.volume_mm3));
        json_object_set_new(one, "mass_g", cli_json_number(r->its.mass_g));
        json_object_set_new(one, "mean_path_mm", cli_json_number(r->its.mean_path_mm));
        json_object_set_new(one, "share", cli_json_number(r->its.share));
        json_array_append_new(rows, one);
    }
    json_object_set_new(object, "parts", rows);
    return object;
}

static int write_csv(const table *t, const char *path) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return cli_error(CLI_DEVICE, "out of host memory for the table");
    fprintf(stream, "label,material,density (g/cm3),volume (mm3),mass (g),mean path (mm),share at %.6g keV\n",
            t->kev);
    for (int64_t i = 0; i < t->count; i++) {
        const row *r = &t->rows[i];
        const double cells[] = {r->its.density_g_cm3, r->its.volume_mm3, r->its.mass_g, r->its.mean_path_mm,
                                r->its.share};
        cli_csv_text(r->label, stream);
        fputc(',', stream);
        cli_csv_text(r->material, stream);
        for (size_t c = 0; c < sizeof cells / sizeof *cells; c++)
            fprintf(stream, isfinite(cells[c]) ? ",%.9g" : ",", cells[c]);
        fputc('\n', stream);
    }
    const int exit_status = fclose(stream) == 0 ? cli_write_file(path, text, size)
                                                : cli_error(CLI_DEVICE, "out of host memory for the table");
    free(text);
    return exit_status;
}

static void print_number(double value) {
    if (isfinite(value))
        printf(" %11.5g", value);
    else
        printf(" %11s", "-");
}

static void print_table(const table *t) {
    printf("%-20s %-28s %11s %11s %11s %11s %8s\n", "part", "material", "g/cm3", "volume mm3", "mass g",
           "mean path", "share");
    for (int64_t i = 0; i < t->count; i++) {
        const row *r = &t->rows[i];
        cli_print("%-20s %-28s", r->label, r->material);
        print_number(r->its.density_g_cm3);
        print_number(r->its.volume_mm3);
        print_number(r->its.mass_g);
        print_number(r->its.mean_path_mm);
        if (isfinite(r->its.share))
            printf(" %6.2f %%\n", 100 * r->its.share);
        else
            printf(" %8s\n", "-");
    }
    printf("mean paths in mm; shares of the attenuation at %.4g keV, the mean energy of the beam\n", t->kev);
}

int cli_parts(const cli_arguments *arguments) {
    table t = {.count = 0};
    double plan_ms;
    const char *path = cli_value(arguments, "-o");
    if (path && !cli_has_extension(path, ".csv"))
        return cli_error(CLI_USAGE, "-o %s: the table is written as .csv", path);
    int exit_status = path ? cli_file_check(path) : CLI_DONE;
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, 0, &t.session);
    t.session.options.scatter = NULL; /* lengths have none, and it is not for every scene */
    t.session.options.precision = SKG_PRECISION_SINGLE;
    if (exit_status == CLI_DONE) exit_status = cli_make_plan(&t.session, &t.plan, &plan_ms);
    if (exit_status == CLI_DONE) exit_status = fill(&t);
    if (exit_status == CLI_DONE && path) exit_status = write_csv(&t, path);
    if (exit_status == CLI_DONE && cli_given(arguments, "--json")) {
        exit_status = cli_json_print(table_json(&t));
    } else if (exit_status == CLI_DONE && !cli_is_quiet()) {
        print_table(&t);
        if (path) cli_print("wrote %s\n", path);
    }
    free(t.rows);
    skg_part_table_release(&t.measured);
    skg_plan_release(&t.plan);
    cli_close_session(&t.session);
    return exit_status;
}
