/* Makes the thorax and its radiographs. */
#include "register/subject.h"

#include <skiagraph/breathing.h>

#include <dirent.h>
#include <fnmatch.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double photons = 2e5, field_mm = 560;

/* HU of an organ by the beginning of its file's name; soft tissue where none fits. An assumption: round values of adults. */
static double hounsfield(const char *name) {
    static const struct {
        const char *begin;
        double hu;
    } known[] = {{"vertebra", 350},  {"rib", 500},   {"scapula", 500},  {"clavicle", 500}, {"sternum", 300},
                 {"cartilage", 110}, {"lung", -750}, {"trachea", -950}, {"liver", 60},     {"spleen", 50}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (!strncmp(name, known[k].begin, strlen(known[k].begin))) return known[k].hu;
    return 40;
}

static int by_name(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* A head of steel, whose attenuation is 40 from the front, and a stem. What they overlap is added, in radiographs and model alike. */
static const char implant[] =
    ", {\"Label\": \"implant head\", \"Cuboid\": [26, 42, 20, \"mm\"], \"Parent\": \"soft\", \"Material\": \"Steel 304\", "
    "\"Transform\": [[\"Translation\", 60, -98, 1190, \"mm\"], [\"Rotation\", 8, 0, 0, 1]]}, {\"Label\": \"implant stem\", "
    "\"Cylinder\": [32, 90, 6, \"mm\"], \"Parent\": \"soft\", \"Material\": \"Steel 304\", \"Transform\": "
    "[[\"Translation\", 48, -90, 1135, \"mm\"], [\"Rotation\", 75, 1, 0.3, 0]]}";

/* The scene of the organs in a folder, inside an elliptic cylinder of soft tissue. */
static char *text_of_folder(const char *data, const char *part) {
    enum { MOST = 256 };
    char *names[MOST], *text = NULL;
    size_t size = 0, count = 0;
    DIR *folder = opendir(data);
    FILE *stream = open_memstream(&text, &size);
    if (!folder || !stream) bench_die("%s: cannot be read", data);
    for (struct dirent *entry; (entry = readdir(folder)) && count < MOST;) {
        const char *dot = strrchr(entry->d_name, '.');
        if (dot && !strcmp(dot, ".obj")) names[count++] = strdup(entry->d_name);
    }
    closedir(folder);
    qsort(names, count, sizeof *names, by_name);
    fputs(
        "{\"Source\": {\"Position\": [0, -1000, 1150, \"mm\"], \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": "
        "1}]}, \"Detector\": {\"Position\": [0, 500, 1150, \"mm\"], \"UpVector\": [0, 0, -1], \"NumberOfPixels\": [64, 64], "
        "\"Size\": [560, 560, \"mm\"]}, \"Samples\": [{\"Label\": \"soft\", \"Cylinder\": [60, 600, 1, \"mm\"], "
        "\"Parent\": null, \"Material\": [\"HU\", 30], \"Transform\": [[\"Translation\", 0, -98, 1150, \"mm\"], "
        "[\"Scaling\", 175, 125, 1], [\"Rotation\", 90, 1, 0, 0]]}",
        stream);
    for (size_t k = 0; k < count; k++) {
        fprintf(stream,
                ", {\"Label\": \"%.*s\", \"Path\": \"%s/%s\", \"Unit\": \"mm\", \"Parent\": \"soft\", "
                "\"Material\": [\"HU\", %g]}",
                (int)(strlen(names[k]) - 4), names[k], data, names[k], hounsfield(names[k]));
        free(names[k]);
    }
    if (part && !strncmp(part, "implant", 7)) fputs(implant, stream);
    fputs("]}", stream);
    fclose(stream);
    return text;
}

/* The generated thorax goes through its files, as a user's does. */
static void load_generated(subject *s) {
    char folder[] = "/tmp/skg-register-XXXXXX", path[300];
    skg_thorax_options options;
    skg_thorax *thorax;
    skg_thorax_options_init(&options);
    bench_try(skg_thorax_create(&options, &thorax), "thorax");
    if (!mkdtemp(folder)) bench_die("%s: cannot be made", folder);
    bench_try(skg_thorax_save(thorax, folder), "thorax");
    skg_thorax_release(&thorax);
    snprintf(path, sizeof path, "%s/thorax.json", folder);
    bench_try(skg_setup_load(s->context, path, 0, NULL, &s->setup), path);
    DIR *files = opendir(folder);
    for (struct dirent *entry; files && (entry = readdir(files));) {
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] != '.') unlink(path);
    }
    if (files) closedir(files);
    rmdir(folder);
}

static int is_body(const char *label, const char *part, int real) {
    if (part) return !fnmatch(part, label, 0);
    return real ? !strncmp(label, "vertebra", 8) : !strcmp(label, "spine");
}

static void add_vertices(subject *s, const skg_part *part) {
    int64_t vertices, triangles;
    bench_try(skg_mesh_count(part->mesh, &vertices, &triangles), part->label);
    s->positions = realloc(s->positions, (size_t)(3 * (s->vertices + vertices)) * sizeof *s->positions);
    if (!s->positions) bench_die("out of host memory");
    double *own = s->positions + 3 * s->vertices;
    bench_try(skg_mesh_positions_get(part->mesh, own, 0), part->label);
    for (int64_t v = 0; v < vertices; v++) {
        const double x[3] = {own[3 * v], own[3 * v + 1], own[3 * v + 2]};
        for (int k = 0; k < 3; k++)
            own[3 * v + k] = part->pose[4 * k] * x[0] + part->pose[4 * k + 1] * x[1] +
                             part->pose[4 * k + 2] * x[2] + part->pose[4 * k + 3];
    }
    s->vertices += vertices;
}

static void find_body(subject *s, const char *part, int real) {
    int64_t count;
    bench_try(skg_scene_part_count(s->scene, &count), "scene");
    for (int64_t p = 0; p < count; p++) {
        skg_part one;
        skg_part_init(&one);
        bench_try(skg_scene_part_get(s->scene, p, &one), "scene");
        if (!is_body(one.label, part, real)) continue;
        s->parts[s->part_count++] = p;
        add_vertices(s, &one);
    }
    if (s->part_count == 0) bench_die("no part %s", part ? part : "of the spine");
    for (int64_t v = 0; v < s->vertices; v++)
        for (int k = 0; k < 3; k++) s->middle[k] += s->positions[3 * v + k] / (double)s->vertices;
}

/* From the front and from the left, 1 m before and .5 m behind the body. */
static void set_views(subject *s, long side) {
    const double pixel = field_mm / (double)side;
    for (int v = 0; v < SUBJECT_VIEWS; v++) {
        skg_view *view = &s->views[v];
        const double beam[3] = {v == 1 ? -1 : 0, v == 0 ? 1 : 0, 0};
        skg_view_init(view);
        view->columns = view->rows = side;
        for (int k = 0; k < 3; k++) {
            view->source[k] = s->middle[k] - 1000 * beam[k];
            view->centre[k] = s->middle[k] + 500 * beam[k];
        }
        view->column_step[v == 0 ? 0 : 1] = pixel;
        view->row_step[2] = -pixel;
    }
}

/* 90 kV behind 3 mm of aluminium, scaled to the photons of a pixel. */
static skg_spectrum *make_tube(void) {
    skg_tube tube;
    skg_spectrum *made, *scaled;
    skg_material *aluminium;
    double sum = 0;
    int64_t bins;
    skg_tube_init(&tube);
    bench_try(skg_material_create_named("Al", &aluminium), "filter");
    skg_filter filter;
    skg_filter_init(&filter);
    filter.material = aluminium, filter.thickness_mm = 3;
    tube.kvp = 90, tube.filters = &filter, tube.filter_count = 1;
    bench_try(skg_spectrum_create_tube(&tube, &made), "tube");
    bench_try(skg_spectrum_bin_count(made, &bins), "tube");
    for (int64_t b = 0; b < bins; b++) {
        double kev, count;
        bench_try(skg_spectrum_bin_get(made, b, &kev, &count), "tube");
        sum += count;
    }
    bench_try(skg_spectrum_create_scaled(made, photons / sum, &scaled), "tube");
    skg_spectrum_release(&made);
    skg_material_release(&aluminium);
    return scaled;
}

void subject_make(const char *data, const char *part, long side, subject *out) {
    *out = (subject){.context = bench_context(NULL)};
    if (data) {
        skg_setup_source source;
        char *text = text_of_folder(data, part);
        skg_setup_source_init(&source);
        source.text = text;
        bench_try(skg_setup_create(out->context, &source, &out->setup), data);
        free(text);
    } else {
        load_generated(out);
    }
    bench_try(skg_setup_scene_get(out->setup, &out->scene), "scene");
    find_body(out, part, data != NULL);
    set_views(out, side);
    bench_try(skg_spectrum_create_mono(60, photons, &out->mono), "beam");
    out->tube = make_tube();
}

void subject_free(subject *s) {
    free(s->positions);
    skg_spectrum_release(&s->mono);
    skg_spectrum_release(&s->tube);
    skg_setup_release(&s->setup);
    skg_context_release(&s->context);
}

/* More of what the body's first part lies inside; if it lies inside nothing, of everything else. */
static void add_tissue(const subject *s, int64_t *parts, double *ratios, skg_frame *frame) {
    skg_part part;
    skg_part_init(&part);
    bench_try(skg_scene_part_get(s->scene, s->parts[0], &part), "body");
    if (part.inside < 0) return;
    *parts = part.inside, *ratios = 1.1;
    frame->override_count = 1, frame->override_parts = parts, frame->density_ratios = ratios;
}

/* Prints the mean of scattered over direct photons in a radiograph. */
static void tell_scatter(skg_plan *plan, const skg_frame *frame, int view, int64_t count,
                         const double *whole) {
    skg_output output;
    skg_job *job;
    float *scattered = bench_alloc((size_t)count, sizeof *scattered);
    double sum = 0;
    skg_output_init(&output);
    output.kind = SKG_OUTPUT_SCATTER;
    output.data = scattered;
    bench_try(skg_plan_submit(plan, 1, frame, 1, &output, &job), "scatter");
    bench_try(skg_job_wait(&job), "scatter");
    for (int64_t p = 0; p < count; p++)
        sum += (double)scattered[p] / fmax(whole[p] - (double)scattered[p], 1e-4) / (double)count;
    printf("view %d: scatter to primary %.2g, mean over pixels\n", view + 1, sum);
    free(scattered);
}

double *subject_radiograph(const subject *s, int view, int kind) {
    const int64_t count = s->views[view].rows * s->views[view].columns;
    skg_plan_options options;
    skg_scatter scatter;
    skg_plan *plan;
    skg_frame frame;
    skg_output output;
    skg_job *job;
    int64_t part;
    double ratio;
    float *values = bench_alloc((size_t)count, sizeof *values);
    double *transmission = bench_alloc((size_t)count, sizeof *transmission);
    skg_plan_options_init(&options);
    skg_scatter_init(&scatter);
    skg_frame_init(&frame);
    scatter.tolerance = 0.02;
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    options.supersampling = 3; /* another number than a registration's */
    options.overlaps = 0;
    options.noise = (kind & SUBJECT_NOISE) != 0;
    options.tolerance = 1e-3; /* of the spectrum */
    if (kind & SUBJECT_SCATTER) options.scatter = &scatter;
    if (kind & SUBJECT_TISSUE) add_tissue(s, &part, &ratio, &frame);
    frame.index = view;
    bench_try(skg_plan_create(s->context, s->scene, &s->views[view],
                              kind & SUBJECT_SPECTRUM ? s->tube : s->mono, &options, &plan),
              "radiograph");
    skg_output_init(&output);
    output.data = values;
    bench_try(skg_plan_submit(plan, 1, &frame, 1, &output, &job), "radiograph");
    bench_try(skg_job_wait(&job), "radiograph");
    for (int64_t p = 0; p < count; p++) transmission[p] = (double)values[p];
    if (kind & SUBJECT_SCATTER) tell_scatter(plan, &frame, view, count, transmission);
    skg_plan_release(&plan);
    free(values);
    return transmission;
}

double subject_error(const subject *s, const double *twist) {
    const double *t = twist, *w = twist + 3, angle = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    const double a = angle > 1e-9 ? sin(angle) / angle : 1,
                 b = angle > 1e-9 ? (1 - cos(angle)) / (angle * angle) : 0.5,
                 c = angle > 1e-9 ? (1 - a) / (angle * angle) : 1.0 / 6;
    double sum = 0;
    for (int64_t v = 0; v < s->vertices; v++) {
        const double *x = s->positions + 3 * v;
        double square = 0;
        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            const double wx = w[l] * x[m] - w[m] * x[l], wt = w[l] * t[m] - w[m] * t[l];
            const double wwx = w[k] * (w[0] * x[0] + w[1] * x[1] + w[2] * x[2]) - angle * angle * x[k],
                         wwt = w[k] * (w[0] * t[0] + w[1] * t[1] + w[2] * t[2]) - angle * angle * t[k];
            const double d = a * wx + b * wwx + t[k] + b * wt + c * wwt;
            square += d * d;
        }
        sum += sqrt(square);
    }
    return sum / (double)s->vertices;
}
