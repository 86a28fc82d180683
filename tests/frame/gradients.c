/* Shared code of tests of gradients: a scene of a few parts, directions in which it moves, and its gradient. */
#include "gradients.h"
#include "support/doubles.h"

#include <math.h>
#include <string.h>

skg_scene *scene;
skg_mesh *meshes[PARTS];
int64_t parts;

static void add_part(const char *label, solid s, const char *material, double turn, const double at[3],
                     int64_t inside, int32_t priority) {
    skg_part part;
    skg_part_init(&part);
    part.mesh = meshes[parts] = run_mesh(&s);
    part.label = label, part.inside = inside, part.priority = priority;
    part.pose[0] = part.pose[5] = cos(turn), part.pose[1] = -sin(turn), part.pose[4] = sin(turn);
    for (int k = 0; k < 3; k++) part.pose[4 * k + 3] = at[k];
    ck_skg(skg_material_create_named(material, &part.material));
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_material_release(&part.material);
    solid_free(&s);
    parts++;
}

void make_scene(const setting *set) {
    const double middle[3] = {1.3, -0.7, 4.1}, left[3] = {-3.7, 2.2, 9.3}, aside[3] = {11.2, 8.4, -20.6};
    ck_skg(skg_scene_create(run_context, &scene));
    parts = 0;
    add_part("body", solid_blob(30, 14, 9, 7), set->world ? "Al" : "Water", 0.3, middle, -1, 0);
    if (set->nested) {
        add_part("bone", solid_blob(14, 10, 7, 3), "Bone, Cortical (ICRU-44)", 1.1, left, 0, 0);
        add_part("marrow", solid_blob(6, 8, 5, 5), "Water", 0.2, left, 1, 0);
        if (set->nested > 1) add_part("core", solid_blob(3, 7, 5, 9), "Al", 0.4, left, 2, 0);
    } else {
        add_part("bone", solid_blob(17, 12, 7, 3), "Bone, Cortical (ICRU-44)", 1.1, aside, -1, set->priority);
    }
    /* A hole has the world's matter, so that it contributes nothing but displaces the body. */
    if (set->priority) add_part("rod", solid_blob(9, 9, 6, 11), set->hole ? "Water" : "Al", 0.7, left, -1, 2);
}

skg_view make_view(const setting *set) {
    skg_view view = run_view(SIDE, 4.1);
    view.source[0] = 17, view.source[1] = -23;
    view.column_step[2] = 0.21, view.row_step[0] = 0.13;
    view.centre[0] = 3.3;
    if (set->parallel)
        view.projection = set->infinity ? SKG_PROJECTION_PARALLEL_FROM_INFINITY : SKG_PROJECTION_PARALLEL;
    if (set->infinity) view.source[0] = 0.03, view.source[1] = -0.07, view.source[2] = 2;
    return view;
}

skg_plan *make_plan(const setting *set, const skg_view *view, int32_t precision, int32_t strategy) {
    static const double energies[3] = {40, 60, 90}, photons[3] = {50, 80, 30}, edges[3] = {10, 55, 100};
    static const double line[3] = {0.2, 1, 0.4}, other[3] = {0.1, 1, 0.3};
    static const double point[9] = {0, 1, 0, 0.5, 4, 2, 0, 1, 0.3};
    skg_plan_options options;
    skg_detector_blur blur;
    skg_spot spot;
    skg_heel heel;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    skg_plan_options_init(&options);
    skg_detector_blur_init(&blur);
    skg_spot_init(&spot);
    skg_heel_init(&heel);
    options.precision = precision, options.strategy = strategy, options.overlaps = 0;
    options.quantity = set->quantity, options.falloff = set->falloff, options.tolerance = set->tolerance;
    options.bands = set->bands, options.band_kev = edges, options.noise = set->noise;
    if (set->supersampling) options.supersampling = set->supersampling;
    if (set->world) ck_skg(skg_material_create_named("Water", &options.world));
    blur.columns = blur.rows = 3, blur.along_row = line, blur.along_column = other;
    if (set->blur == 2) blur.along_row = blur.along_column = NULL, blur.point = point;
    if (set->blur) options.blur = &blur;
    spot.shape = SKG_SPOT_RECTANGLE, spot.extent[0] = 3, spot.extent[1] = 2, spot.samples = 4;
    if (set->spot) options.spot = &spot;
    heel.kvp = 100, heel.direction[1] = 1;
    if (set->heel) options.heel = &heel;
    ck_skg(skg_spectrum_create_bins(set->colours ? 3 : 1, energies, photons, &beam));
    ck_skg(skg_plan_create(run_context, scene, view, beam, &options, &plan));
    skg_spectrum_release(&beam);
    skg_material_release(&options.world);
    return plan;
}

/* --- differences */

static void turn_point(const double twist[6], double step, const double *from, int is_vector, double *to) {
    /* exp(twist) of a point: Rodrigues' formula; the translation is that of the exponential, too. */
    double w[3], t[3], angle = 0;
    for (int k = 0; k < 3; k++)
        w[k] = step * twist[3 + k], t[k] = is_vector ? 0 : step * twist[k], angle += w[k] * w[k];
    angle = sqrt(angle);
    const double a = angle > 0 ? sin(angle) / angle : 1;
    const double b = angle > 0 ? 2 * pow(sin(angle / 2) / angle, 2) : 0.5;
    const double c = angle > 0 ? (angle - sin(angle)) / pow(angle, 3) : 0;
    const double wx[3] = {w[1] * from[2] - w[2] * from[1], w[2] * from[0] - w[0] * from[2],
                          w[0] * from[1] - w[1] * from[0]};
    const double wwx[3] = {w[1] * wx[2] - w[2] * wx[1], w[2] * wx[0] - w[0] * wx[2],
                           w[0] * wx[1] - w[1] * wx[0]};
    const double wt[3] = {w[1] * t[2] - w[2] * t[1], w[2] * t[0] - w[0] * t[2], w[0] * t[1] - w[1] * t[0]};
    const double wwt[3] = {w[1] * wt[2] - w[2] * wt[1], w[2] * wt[0] - w[0] * wt[2],
                           w[0] * wt[1] - w[1] * wt[0]};
    double turned[3];
    for (int k = 0; k < 3; k++)
        turned[k] = from[k] + a * wx[k] + b * wwx[k] + t[k] + (angle > 0 ? b * wt[k] + c * wwt[k] : 0);
    memcpy(to, turned, sizeof turned);
}

/* A movement of vertices: each by a wave of its place, in the mesh's axes. */
static void wave(const double at[3], double by[3]) {
    for (int k = 0; k < 3; k++) by[k] = sin(0.11 * at[(k + 1) % 3] + 0.07 * at[k] + k);
}

static double *saved[PARTS];

static void move_vertices(int64_t p, double step) {
    int64_t vertices, triangles;
    ck_skg(skg_mesh_count(meshes[p], &vertices, &triangles));
    double *moved = calloc((size_t)(3 * vertices), sizeof *moved), by[3];
    for (int64_t v = 0; v < vertices; v++) {
        wave(saved[p] + 3 * v, by);
        for (int k = 0; k < 3; k++) moved[3 * v + k] = saved[p][3 * v + k] + step * by[k];
    }
    ck_skg(skg_mesh_positions_set(meshes[p], moved, 3));
    free(moved);
}

void render(skg_plan *plan, const skg_view *view, const direction *d, double step, double *image) {
    skg_frame frame;
    skg_output output;
    skg_job *job = NULL;
    skg_view moved = *view;
    int64_t ids[PARTS];
    double poses[PARTS][16], densities[PARTS];
    skg_frame_init(&frame);
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    for (int64_t p = 0; p < parts; p++) {
        skg_part part;
        skg_part_init(&part);
        ck_skg(skg_scene_part_get(scene, p, &part));
        ids[p] = p;
        memcpy(poses[p], part.pose, sizeof poses[p]);
        for (int c = 0; c < 4; c++) {
            double column[3] = {part.pose[c], part.pose[4 + c], part.pose[8 + c]};
            turn_point(d->poses[p], step, column, c < 3, column);
            for (int k = 0; k < 3; k++) poses[p][4 * k + c] = column[k];
        }
        move_vertices(p, step * d->vertices[p]);
        densities[p] = 1 + step * d->densities[p];
    }
    for (int k = 0; k < 3; k++) moved.source[k] += step * d->source[k];
    turn_point(d->detector, step, view->centre, 0, moved.centre);
    turn_point(d->detector, step, view->column_step, 1, moved.column_step);
    turn_point(d->detector, step, view->row_step, 1, moved.row_step);
    frame.view = &moved;
    frame.pose_count = parts, frame.pose_parts = ids, frame.poses = poses[0];
    frame.override_count = parts, frame.override_parts = ids, frame.density_ratios = densities;
    ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    for (int64_t p = 0; p < parts; p++) move_vertices(p, 0);
}

void make_gradient(skg_plan *plan, const setting *set, const double *adjoint, result *r) {
    skg_gradient gradient;
    skg_adjoint given;
    skg_gradient_init(&gradient);
    skg_adjoint_init(&given);
    given.channels = set->bands ? set->bands : 1, given.rows = given.columns = SIDE;
    given.data = adjoint;
    gradient.poses = r->poses[0], gradient.vertices = r->vertices, gradient.densities = r->densities;
    if (!set->parts_only) gradient.source = r->source, gradient.detector = r->detector;
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
}

double along(const result *r, const direction *d) {
    double sum = 0, by[3];
    for (int64_t p = 0; p < parts; p++) {
        int64_t vertices, triangles;
        ck_skg(skg_mesh_count(meshes[p], &vertices, &triangles));
        for (int k = 0; k < 6; k++) sum += r->poses[p][k] * d->poses[p][k];
        sum += r->densities[p] * d->densities[p];
        for (int64_t v = 0; v < vertices; v++) {
            wave(saved[p] + 3 * v, by);
            for (int k = 0; k < 3; k++) sum += d->vertices[p] * r->vertices[p][3 * v + k] * by[k];
        }
    }
    for (int k = 0; k < 3; k++) sum += r->source[k] * d->source[k];
    for (int k = 0; k < 6; k++) sum += r->detector[k] * d->detector[k];
    return sum;
}

void allocate(result *r) {
    *r = (result){.source = {0}};
    for (int64_t p = 0; p < parts; p++) {
        int64_t vertices, triangles;
        ck_skg(skg_mesh_count(meshes[p], &vertices, &triangles));
        r->vertices[p] = calloc((size_t)(3 * vertices), sizeof(double));
        saved[p] = calloc((size_t)(3 * vertices), sizeof(double));
        ck_skg(skg_mesh_positions_get(meshes[p], saved[p], 3));
    }
}

void forget(result *r) {
    for (int64_t p = 0; p < parts; p++) {
        free(r->vertices[p]);
        free(saved[p]);
    }
}

void release_scene(void) {
    for (int64_t p = 0; p < parts; p++) skg_mesh_release(&meshes[p]);
    skg_scene_release(&scene);
}

void release(result *r) {
    forget(r);
    release_scene();
}

void fill_adjoint(int64_t count, double *adjoint) {
    uint64_t state = 5;
    for (int64_t p = 0; p < count; p++) adjoint[p] = draw(&state, -0.5, 0.5);
}

skg_adjoint adjoint_of(const double *values) {
    skg_adjoint adjoint;
    skg_adjoint_init(&adjoint);
    adjoint.channels = 1, adjoint.rows = adjoint.columns = SIDE, adjoint.data = values;
    return adjoint;
}

void make_derivative(skg_plan *plan, const direction *d, double *derivative) {
    double *moves[PARTS] = {NULL};
    const double *vertices[PARTS] = {NULL};
    skg_direction given;
    int64_t saturated = -1;
    for (int64_t p = 0; p < parts; p++) {
        int64_t count, triangles;
        ck_skg(skg_mesh_count(meshes[p], &count, &triangles));
        vertices[p] = moves[p] = calloc((size_t)(3 * count), sizeof(double));
        for (int64_t v = 0; v < count; v++) {
            wave(saved[p] + 3 * v, moves[p] + 3 * v);
            for (int k = 0; k < 3; k++) moves[p][3 * v + k] *= d->vertices[p];
        }
    }
    double moves_view = 0;
    for (int k = 0; k < 3; k++) moves_view += fabs(d->source[k]);
    for (int k = 0; k < 6; k++) moves_view += fabs(d->detector[k]);
    skg_direction_init(&given);
    given.poses = d->poses[0], given.vertices = vertices;
    if (moves_view > 0) given.source = d->source, given.detector = d->detector;
    for (int64_t p = 0; p < parts; p++)
        if (d->densities[p] != 0) given.densities = d->densities;
    ck_skg(skg_plan_derivatives(plan, NULL, 1, &given, DOUBLES(derivative), &saturated));
    ck_assert_int_eq(saturated, 0);
    for (int64_t p = 0; p < parts; p++) free(moves[p]);
}

void differentiate(skg_plan *plan, const skg_view *view, const direction *d, int64_t count, double *slope) {
    static double ahead[2][CHANNELS_MAX * PIXELS], behind[2][CHANNELS_MAX * PIXELS];
    static double here[CHANNELS_MAX * PIXELS];
    const double h = 1e-3;
    double largest = 0;
    render(plan, view, d, 0, here);
    for (int s = 0; s < 2; s++) {
        render(plan, view, d, s ? h / 2 : h, ahead[s]);
        render(plan, view, d, s ? -h / 2 : -h, behind[s]);
    }
    for (int64_t p = 0; p < count; p++) largest = fmax(largest, fabs(ahead[0][p] - behind[0][p]) / (2 * h));
    for (int64_t p = 0; p < count; p++) {
        const double whole = (ahead[0][p] - behind[0][p]) / (2 * h), half = (ahead[1][p] - behind[1][p]) / h;
        const double bend = (ahead[0][p] - 2 * here[p] + behind[0][p]) / h;
        const double half_bend = 2 * (ahead[1][p] - 2 * here[p] + behind[1][p]) / h;
        /* Rounding is 1e-9 of a slope, a bend's share h^2 of it; hits that change do so by much more. */
        const int is_smooth =
            fabs(half - whole) <= 3e-6 * largest && fabs(bend - 2 * half_bend) <= 3e-6 * largest;
        slope[p] = is_smooth ? (4 * half - whole) / 3 : (double)NAN;
    }
}
