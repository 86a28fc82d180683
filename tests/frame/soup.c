/* Spheres whose triangles may be changed, and their path lengths and attenuations. */
#include "frame/soup.h"

#include <math.h>

static const double RADIUS = 40;

skg_context *context;
skg_material *water;
skg_spectrum *beam;
skg_view view;

void open_context(void) {
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_material_create_mu("water", 0.2, &water));
    ck_skg(skg_spectrum_create_mono(60, 1, &beam));
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[2] = -1000;
    view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = 0.55;
}

void close_context(void) {
    skg_material_release(&water);
    skg_spectrum_release(&beam);
    skg_context_release(&context);
}

void fill_sphere(soup *s) {
    skg_mesh *sphere = NULL;
    ck_skg(skg_mesh_create_sphere(RADIUS, 24, &sphere));
    ck_skg(skg_mesh_count(sphere, &s->vertices, &s->triangles));
    ck_assert_int_lt(s->vertices, LIMIT - 8);
    ck_assert_int_lt(s->triangles, LIMIT - 8);
    ck_skg(skg_mesh_positions_get(sphere, s->positions, 3));
    ck_skg(skg_mesh_triangles_get(sphere, s->corners, 3));
    skg_mesh_release(&sphere);
}

skg_mesh *mesh_of(const soup *s) {
    skg_mesh *mesh = NULL;
    ck_skg(
        skg_mesh_create(context, "sphere",
                        &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                           .as_wound = 1, /* a turned triangle stays, as with Repair none */
                                           .vertices = s->vertices,
                                           .positions = s->positions,
                                           .position_stride = 3,
                                           .triangles = s->triangles,
                                           .corners = s->corners,
                                           .triangle_stride = 3,
                                           .unit_mm = 1},
                        &mesh));
    return mesh;
}

/* The triangle whose middle is nearest a place. */
int64_t triangle_at(const soup *s, double x, double y, double z) {
    const double place[3] = {x, y, z};
    double best = HUGE_VAL;
    int64_t found = 0;
    for (int64_t t = 0; t < s->triangles; t++) {
        double square = 0;
        for (int k = 0; k < 3; k++) {
            double middle = 0;
            for (int c = 0; c < 3; c++) middle += s->positions[3 * s->corners[3 * t + c] + k] / 3;
            square += (middle - place[k]) * (middle - place[k]);
        }
        if (square < best) best = square, found = t;
    }
    return found;
}

void remove_triangle(soup *s, int64_t t) {
    s->triangles--;
    memmove(s->corners + 3 * t, s->corners + 3 * (t + 1),
            (size_t)(s->triangles - t) * 3 * sizeof *s->corners);
}

void flip_triangle(soup *s, int64_t t) {
    const int32_t swap = s->corners[3 * t];
    s->corners[3 * t] = s->corners[3 * t + 1];
    s->corners[3 * t + 1] = swap;
}

/* Lengths of the one part, or the attenuation of two. */
void take(const soup *a, const soup *b, const wish *w, picture *result) {
    const soup *soups[2] = {a, b};
    skg_scene *scene = NULL;
    skg_plan *plan = NULL;
    skg_job *job = NULL;
    skg_plan_options options;
    skg_output output;
    ck_skg(skg_scene_create(context, &scene));
    for (int i = 0; i < (b ? 2 : 1); i++) {
        skg_part part;
        skg_part_init(&part);
        part.mesh = mesh_of(soups[i]), part.material = water;
        part.label = i ? "second" : "first";
        part.pose[11] = w->z[i];
        ck_skg(skg_scene_part_add(scene, &part, NULL));
        skg_mesh_release(&part.mesh);
    }
    skg_plan_options_init(&options);
    ck_assert_int_eq(options.repair, SKG_REPAIR_NEIGHBOURS);
    options.repair = w->repair, options.strategy = w->strategy, options.precision = w->precision;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = result->mm;
    if (b) {
        ck_skg(skg_plan_image(plan, &output));
    } else {
        output.kind = SKG_OUTPUT_LENGTHS;
        ck_skg(skg_plan_submit(plan, 1, NULL, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
    }
    skg_plan_report_init(&result->report);
    ck_skg(skg_plan_report_get(plan, &result->report));
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}

double worst(const picture *a, const picture *b) {
    double largest = 0;
    for (int r = 0; r < SIDE; r++)
        for (int c = 0; c < SIDE; c++) largest = fmax(largest, fabs(a->mm[r][c] - b->mm[r][c]));
    return largest;
}

int64_t count_different(const picture *a, const picture *b) {
    int64_t count = 0;
    for (int r = 0; r < SIDE; r++) /* mm: more than rounding in double. */
        for (int c = 0; c < SIDE; c++) count += fabs(a->mm[r][c] - b->mm[r][c]) > 1e-6;
    return count;
}
