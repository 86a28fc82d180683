/* The verb `parts`: a table of the parts of a scene, for a report. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"
#include "core/maths.h"
#include "session/explain.h"
#include "session/session.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* NAN: not known. */
typedef struct {
    const char *label, *material;
    int64_t inside;
    double surface_mm3;                   /* of its mesh, with what lies inside */
    double density, volume_mm3, mass_g;   /* density in g/cm3 */
    double mean_path_mm, exponent, share; /* exponent: 1/cm times mm, summed over all rays */
} row;

typedef struct {
    cli_session session;
    skg_plan *plan;
    double kev;
    int64_t count;
    row *rows;
} table;

/* The mean density of the cells of a volume. Its share of the attenuation is not known, and so no other part's is. */
static skg_status read_volume(const skg_part *part, row *r) {
    skg_volume_contents contents;
    skg_volume_contents_init(&contents);
    const skg_status status = skg_volume_contents_get(part->volume, &contents);
    const double ml = r->surface_mm3 * 1e-3;
    if (status == SKG_OK && contents.mass > 0)
        r->density = contents.mass * fabs(skg_pose_determinant(part->pose)) / ml;
    return status;
}

/* What the scene says of a part, and its mesh. */
static skg_status read_part(const table *t, int64_t number, row *r) {
    skg_part part;
    skg_mesh_health health;
    double per_cm = 0;
    skg_part_init(&part);
    skg_mesh_health_init(&health);
    skg_status status = skg_scene_part_get(t->session.scene, number, &part);
    if (status == SKG_OK) status = skg_mesh_health_get(part.mesh, &health);
    if (status == SKG_OK) status = skg_material_name_get(part.material, &r->material);
    if (status == SKG_OK) status = skg_material_density_get(part.material, &r->density);
    if (status == SKG_OK) status = skg_material_attenuation_get(part.material, t->kev, &per_cm);
    if (status != SKG_OK) return status;
    r->label = part.label;
    r->inside = part.inside;
    if (!(r->density > 0)) r->density = (double)NAN;
    r->surface_mm3 = health.closed ? health.volume * fabs(skg_pose_determinant(part.pose)) : (double)NAN;
    r->exponent = part.volume ? (double)NAN : per_cm;
    return part.volume ? read_volume(&part, r) : SKG_OK;
}

/* The lengths of a part for all rays. */
static skg_status measure_paths(const table *t, int64_t number, float *lengths, row *r) {
    const int64_t pixels = t->session.view.columns * t->session.view.rows;
    skg_output output;
    skg_frame frame;
    skg_job *job = NULL;
    double sum = 0;
    int64_t met = 0;
    skg_output_init(&output);
    skg_frame_init(&frame);
    output.kind = SKG_OUTPUT_LENGTHS;
    output.part = number;
    output.data = lengths;
    skg_status status = skg_plan_submit(t->plan, 1, &frame, &output, &job);
    if (status == SKG_OK) status = skg_job_wait(&job);
    if (status != SKG_OK && status != SKG_RANGE) return status;
    for (int64_t i = 0; i < pixels; i++) {
        met += lengths[i] > 0;
        sum += lengths[i] > 0 ? (double)lengths[i] : 0;
    }
    r->mean_path_mm = met > 0 ? sum / (double)met : 0;
    r->exponent *= sum;
    return SKG_OK;
}

/* Volumes without the parts inside, masses and shares. */
static void finish(table *t) {
    double all = 0;
    for (int64_t i = 0; i < t->count; i++) t->rows[i].volume_mm3 = t->rows[i].surface_mm3;
    for (int64_t i = 0; i < t->count; i++) {
        const row *r = &t->rows[i];
        if (r->inside >= 0) t->rows[r->inside].volume_mm3 -= r->surface_mm3;
        all += r->exponent;
    }
    for (int64_t i = 0; i < t->count; i++) {
        row *r = &t->rows[i];
        r->mass_g = r->density * r->volume_mm3 * 1e-3;
        r->share = all > 0 ? r->exponent / all : (double)NAN;
    }
}

static int fill(table *t) {
    skg_quality quality;
    float *lengths = calloc((size_t)(t->session.view.columns * t->session.view.rows), sizeof *lengths);
    skg_quality_init(&quality);
    skg_status status = skg_scene_part_count(t->session.scene, &t->count);
    t->rows = calloc((size_t)t->count + 1, sizeof *t->rows);
    if (!lengths || !t->rows) {
        free(lengths);
        return cli_error(CLI_DEVICE, "out of host memory for the parts");
    }
    if (status == SKG_OK) status = cli_flat_field_quality(&t->session, &quality);
    t->kev = quality.mean_kev;
    for (int64_t i = 0; i < t->count && status == SKG_OK; i++) status = read_part(t, i, &t->rows[i]);
    for (int64_t i = 0; i < t->count && status == SKG_OK; i++)
        status = measure_paths(t, i, lengths, &t->rows[i]);
    free(lengths);
    if (status != SKG_OK) return cli_fail(status);
    finish(t);
    return CLI_DONE;
}

static json_t *table_json(const table *t) {
    json_t *object = json_object(), *rows = json_array();
    json_object_set_new(object, "energy_keV", cli_json_number(t->kev));
    for (int64_t i = 0; i < t->count; i++) {
        const row *r = &t->rows[i];
        json_t *one = json_object();
        json_object_set_new(one, "label", cli_json_text(r->label));
        json_object_set_new(one, "material", cli_json_text(r->material));
        json_object_set_new(one, "density_g_cm3", cli_json_number(r->density));
        json_object_set_new(one, "volume_mm3", cli_json_number(r->volume_mm3));
        json_object_set_new(one, "mass_g", cli_json_number(r->mass_g));
        json_object_set_new(one, "mean_path_mm", cli_json_number(r->mean_path_mm));
        json_object_set_new(one, "share", cli_json_number(r->share));
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
        const double cells[] = {r->density, r->volume_mm3, r->mass_g, r->mean_path_mm, r->share};
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
        print_number(r->density);
        print_number(r->volume_mm3);
        print_number(r->mass_g);
        print_number(r->mean_path_mm);
        if (isfinite(r->share))
            printf(" %6.2f %%\n", 100 * r->share);
        else
            printf(" %8s\n", "-");
    }
    printf("mean paths in mm; shares of the attenuation at %.4g keV, the mean energy of the beam\n", t->kev);
}

int cli_parts(const cli_arguments *arguments) {
    table t = {.count = 0};
    double plan_ms;
    const char *path = cli_value(arguments, &cli_flag_parts_output);
    if (path && !cli_has_extension(path, ".csv"))
        return cli_error(CLI_USAGE, "-o %s: the table is written as .csv", path);
    int exit_status = path ? cli_file_check(path) : CLI_DONE;
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, 0, &t.session);
    t.session.options.scatter = NULL; /* lengths have none, and it is not for every scene */
    t.session.options.precision = SKG_PRECISION_SINGLE;
    if (exit_status == CLI_DONE) exit_status = cli_make_plan(&t.session, &t.plan, &plan_ms);
    if (exit_status == CLI_DONE) exit_status = fill(&t);
    if (exit_status == CLI_DONE && path) exit_status = write_csv(&t, path);
    if (exit_status == CLI_DONE && cli_given(arguments, &cli_flag_json)) {
        exit_status = cli_json_print(table_json(&t));
    } else if (exit_status == CLI_DONE && !cli_is_quiet()) {
        print_table(&t);
        if (path) cli_print("wrote %s\n", path);
    }
    free(t.rows);
    skg_plan_release(&t.plan);
    cli_close_session(&t.session);
    return exit_status;
}
