/* Drawn scenes. The variant of a number decides which kernels are compiled, and the rest of them only numbers, so that a run
 * meets all kernels early and its memory can be compared afterwards. */
#include "soak.h"

#include "common/shapes.h"
#include "support/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS_MAX = 5 };

/* Which effects a variant has. */
typedef struct {
    int32_t precision, quantity, projection;
    int energies, noise, is_leaky, is_nested, supersampling;
    double tolerance;
    int64_t columns, rows;
} variant;

static const variant variants[SOAK_VARIANTS] = {
    {.quantity = SKG_QUANTITY_ENERGY, .energies = 1, .columns = 64, .rows = 48, .is_nested = 1},
    {.quantity = SKG_QUANTITY_TRANSMISSION,
     .energies = 6,
     .tolerance = 1e-4,
     .columns = 64,
     .rows = 48,
     .is_nested = 1},
    {.quantity = SKG_QUANTITY_ATTENUATION, .energies = 1, .columns = 97, .rows = 31, .is_leaky = 1},
    {.quantity = SKG_QUANTITY_PHOTONS, .energies = 3, .noise = 1, .columns = 40, .rows = 40, .is_nested = 1},
    {.quantity = SKG_QUANTITY_ENERGY,
     .energies = 2,
     .projection = SKG_PROJECTION_PARALLEL,
     .columns = 33,
     .rows = 65,
     .is_nested = 1},
    {.quantity = SKG_QUANTITY_ENERGY, .energies = 1, .supersampling = 2, .columns = 32, .rows = 32},
    {.quantity = SKG_QUANTITY_TRANSMISSION,
     .energies = 1,
     .precision = SKG_PRECISION_DOUBLE,
     .columns = 48,
     .rows = 48},
    {.quantity = SKG_QUANTITY_ENERGY, .energies = 4, .noise = 1, .is_leaky = 1, .columns = 64, .rows = 64},
};

uint64_t soak_hash(const void *bytes, size_t count) {
    const unsigned char *at = bytes;
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < count; i++) hash = (hash ^ at[i]) * 0x100000001b3u;
    return hash ? hash : 1;
}

uint64_t soak_hash_file(const char *path) {
    enum { LIMIT = 1 << 25 };
    FILE *file = fopen(path, "rb");
    if (!file) bench_die("%s cannot be read", path);
    char *bytes = bench_alloc(LIMIT, 1);
    const size_t count = fread(bytes, 1, LIMIT, file);
    fclose(file);
    if (count == LIMIT) bench_die("%s is larger than expected", path);
    const uint64_t hash = soak_hash(bytes, count);
    free(bytes);
    return hash;
}

static uint64_t state_of(const soak *s, int64_t number) {
    uint64_t state = s->seed ^ (uint64_t)number * 0xd1342543de82ef95u;
    draw_bits(&state);
    return state;
}

static skg_mesh *make_mesh(skg_context *context, uint64_t *state, int is_leaky) {
    bench_shape shape;
    skg_mesh *mesh = NULL;
    const int kind = (int)draw_below(state, SHAPE_COUNT);
    const double radius = draw(state, 15, 45);
    shape_make(kind, radius, 72 + 8 * draw_below(state, 200), &shape);
    if (is_leaky) shape_cut(&shape);
    bench_try(skg_mesh_create(context, shape_name(kind),
                              &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                 .vertices = shape.vertices,
                                                 .floats = shape.positions,
                                                 .triangles = shape.triangles,
                                                 .corners = shape.corners,
                                                 .unit_mm = 1},
                              &mesh),
              "mesh");
    shape_free(&shape);
    return mesh;
}

/* Parts beside each other, and inside the first of them. */
static void add_parts(const variant *v, skg_context *context, uint64_t *state, skg_scene *scene) {
    const int64_t parts = 1 + draw_below(state, PARTS_MAX);
    for (int64_t k = 0; k < parts; k++) {
        skg_material *material = NULL;
        skg_part part;
        char label[32];
        snprintf(label, sizeof label, "part %lld", (long long)k);
        skg_part_init(&part);
        part.label = label;
        part.mesh = make_mesh(context, state, v->is_leaky && k == 0);
        bench_try(skg_material_create_mu(label, draw(state, 0.02, 0.5), &material), "material");
        part.material = material;
        for (int i = 0; i < 3; i++) part.pose[4 * i + 3] = draw(state, -40, 40);
        if (v->is_nested && k == 0) /* around all others */
            for (int i = 0; i < 3; i++) part.pose[5 * i] = 5, part.pose[4 * i + 3] = 0;
        part.inside = v->is_nested && k > 0 ? 0 : -1;
        bench_try(skg_scene_part_add(scene, &part, NULL), "part");
        skg_material_release(&material);
        skg_mesh_release(&part.mesh);
    }
}

static void draw_beam(const variant *v, uint64_t *state, skg_spectrum **beam) {
    double energies[8], photons[8];
    for (int k = 0; k < v->energies; k++) energies[k] = 25 + 10 * k, photons[k] = draw(state, 50, 1000);
    bench_try(skg_spectrum_create_bins(v->energies, energies, photons, beam), "beam");
}

static void draw_scan(const variant *v, uint64_t *state, soak_case *out) {
    skg_scan_options options;
    skg_view view;
    const double width = draw(state, 300, 500);
    skg_view_init(&view);
    view.projection = v->projection;
    view.columns = v->columns, view.rows = v->rows;
    view.source[1] = -draw(state, 500, 1200);
    view.centre[1] = draw(state, 250, 400);
    view.column_step[0] = width / (double)v->columns;
    view.row_step[2] = -width / (double)v->rows;
    skg_scan_options_init(&options);
    options.projections = SOAK_PROJECTIONS;
    options.step_rad = 2 * BENCH_PI / SOAK_PROJECTIONS;
    options.start_rad = draw(state, 0, 1);
    options.pitch_mm = draw(state, -20, 20);
    bench_try(skg_scan_create(&view, &options, &out->scan), "scan");
    for (int64_t k = 0; k < SOAK_PROJECTIONS; k++) {
        skg_view_init(&out->views[k]);
        bench_try(skg_scan_view_get(out->scan, k, &out->views[k]), "view");
    }
    out->pixels = v->columns * v->rows;
}

static int has_double(skg_context *context) {
    skg_device_info info;
    skg_device_info_init(&info);
    bench_try(skg_context_device_get(context, &info), "device");
    return info.double_precision;
}

void soak_case_make(const soak *s, int64_t number, skg_context *context, soak_case *out) {
    const variant *v = &variants[number % SOAK_VARIANTS];
    uint64_t state = state_of(s, number);
    memset(out, 0, sizeof *out);
    bench_try(skg_scene_create(context, &out->scene), "scene");
    add_parts(v, context, &state, out->scene);
    draw_beam(v, &state, &out->beam);
    draw_scan(v, &state, out);
    skg_plan_options_init(&out->options);
    if (has_double(context)) out->options.precision = v->precision;
    out->options.quantity = v->quantity;
    out->options.noise = v->noise;
    out->options.tolerance = v->tolerance;
    out->options.supersampling = v->supersampling ? v->supersampling : 1;
    out->options.overlaps = 0; /* drawn parts overlap */
    out->options.view_count = SOAK_PROJECTIONS;
}

void soak_case_free(soak_case *c) {
    skg_scan_release(&c->scan);
    skg_spectrum_release(&c->beam);
    skg_scene_release(&c->scene);
}

skg_plan *soak_case_plan(const soak_case *c, skg_context *context) {
    skg_plan_options options = c->options;
    skg_plan *plan = NULL;
    options.views = c->views;
    bench_try(skg_plan_create(context, c->scene, &c->views[0], c->beam, &options, &plan), "plan");
    return plan;
}

void soak_scene_write(const soak *s, int64_t number, int projections, const char *path) {
    uint64_t state = state_of(s, number);
    FILE *file = bench_open(path);
    const int64_t parts = 1 + draw_below(&state, PARTS_MAX);
    fprintf(
        file,
        "{\"Source\":{\"Position\":[0,-600,0,\"mm\"],\"Shape\":\"Point\",\"Beam\":[{\"Energy\":60,\"Unit\":\"keV\","
        "\"PhotonCount\":1000}]},\n\"Detector\":{\"Position\":[0,200,0,\"mm\"],\"UpVector\":[0,0,1],\"NumberOfPixels\":[160,120],"
        "\"Spacing\":[1.5,1.5,\"mm\"]},\n\"Scan\":{\"NumberOfProjections\":%d,\"FinalAngle\":360},\n\"Samples\":[",
        projections);
    for (int64_t k = 0; k < parts; k++)
        fprintf(
            file,
            "%s\n{\"Label\":\"part %lld\",\"Sphere\":[24,%.6g,\"mm\"],\"Transform\":[[\"Translation\",%.6g,%.6g,%.6g,\"mm\"]],"
            "\"Material\":[\"mu\",%.6g]}",
            k ? "," : "", (long long)k, draw(&state, 10, 30), draw(&state, -50, 50), draw(&state, -50, 50),
            draw(&state, -50, 50), draw(&state, 0.02, 0.5));
    fprintf(file, "]}\n");
    if (fclose(file) != 0) bench_die("%s could not be written", path);
}
