/* Gradients against differences of images in double precision, with Richardson's step: (4 D(h/2) - D(h)) / 3. Pixels whose
 * hits change within the step are left out: their differences at two steps disagree. */
#include "suite.h"
#include "support/random.h"
#include "support/run.h"

#include <math.h>
#include <string.h>

enum { SIDE = 24, PIXELS = SIDE * SIDE, CHANNELS_MAX = 2, PARTS = 4, WAYS = 6 * PARTS + 9 + 2 * PARTS };

/* What a case sets; 0: not used. */
typedef struct {
    const char *name;
    int32_t quantity, colours, parallel, infinity, nested, priority, world, falloff, supersampling, spot,
        blur, bands, noise, heel, parts_only;
    double tolerance;
} setting;

static const setting settings[] = {
    {.name = "one energy"},
    {.name = "transmission", .quantity = SKG_QUANTITY_TRANSMISSION, .colours = 1},
    {.name = "attenuation of one energy", .quantity = SKG_QUANTITY_ATTENUATION},
    {.name = "attenuation", .quantity = SKG_QUANTITY_ATTENUATION, .colours = 1, .nested = 1},
    {.name = "nested", .nested = 1, .colours = 1},
    {.name = "priority", .priority = 1, .colours = 1},
    {.name = "parallel", .parallel = 1, .nested = 1},
    {.name = "parallel from infinity", .parallel = 1, .infinity = 1, .colours = 1},
    {.name = "parallel, priority", .parallel = 1, .priority = 1},
    {.name = "world", .world = 1, .colours = 1},
    {.name = "world, attenuation",
     .world = 1,
     .colours = 1,
     .quantity = SKG_QUANTITY_ATTENUATION,
     .parts_only = 1},
    {.name = "falloff", .falloff = 1, .colours = 1, .quantity = SKG_QUANTITY_FLUENCE},
    {.name = "supersampling", .supersampling = 3, .quantity = SKG_QUANTITY_ATTENUATION, .colours = 1},
    {.name = "spot", .spot = 1, .quantity = SKG_QUANTITY_TRANSMISSION},
    {.name = "spot, supersampling, falloff", .spot = 1, .supersampling = 2, .falloff = 1, .priority = 1},
    {.name = "blur", .blur = 1, .colours = 1, .quantity = SKG_QUANTITY_ATTENUATION},
    {.name = "point spread", .blur = 2, .nested = 1},
    {.name = "bands", .bands = 2, .colours = 1, .nested = 1},
    {.name = "tolerance", .tolerance = 1e-3, .colours = 1, .nested = 1},
    {.name = "heel", .heel = 1, .colours = 1, .parts_only = 1},
};

static skg_scene *scene;
static skg_mesh *meshes[PARTS];
static int64_t parts;

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

static void make_scene(const setting *set) {
    const double middle[3] = {1.3, -0.7, 4.1}, left[3] = {-3.7, 2.2, 9.3}, aside[3] = {11.2, 8.4, -20.6};
    ck_skg(skg_scene_create(run_context, &scene));
    parts = 0;
    add_part("body", solid_blob(30, 14, 9, 7), set->world ? "Al" : "Water", 0.3, middle, -1, 0);
    if (set->nested) {
        add_part("bone", solid_blob(14, 10, 7, 3), "Bone, Cortical (ICRU-44)", 1.1, left, 0, 0);
        add_part("marrow", solid_blob(6, 8, 5, 5), "Water", 0.2, left, 1, 0);
    } else {
        add_part("bone", solid_blob(17, 12, 7, 3), "Bone, Cortical (ICRU-44)", 1.1, aside, -1, set->priority);
    }
    if (set->priority) add_part("rod", solid_blob(9, 9, 6, 11), "Al", 0.7, left, -1, 2);
}

static skg_view make_view(const setting *set) {
    skg_view view = run_view(SIDE, 4.1);
    view.source[0] = 17, view.source[1] = -23;
    view.column_step[2] = 0.21, view.row_step[0] = 0.13;
    view.centre[0] = 3.3;
    if (set->parallel)
        view.projection = set->infinity ? SKG_PROJECTION_PARALLEL_FROM_INFINITY : SKG_PROJECTION_PARALLEL;
    if (set->infinity) view.source[0] = 0.03, view.source[1] = -0.07, view.source[2] = 2;
    return view;
}

static skg_plan *make_plan(const setting *set, const skg_view *view, int32_t precision, int32_t strategy) {
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

/* A direction in which everything moves: a twist of each part, the source, a twist of the detector, and vertices. */
typedef struct {
    double poses[PARTS][6], source[3], detector[6], vertices[PARTS], densities[PARTS];
} direction;

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
    double result[3];
    for (int k = 0; k < 3; k++)
        result[k] = from[k] + a * wx[k] + b * wwx[k] + t[k] + (angle > 0 ? b * wt[k] + c * wwt[k] : 0);
    memcpy(to, result, sizeof result);
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

/* The image with everything moved by a step. */
static void render(skg_plan *plan, const skg_view *view, const direction *d, double step, double *image) {
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
    ck_skg(skg_plan_submit(plan, 1, &frame, &output, &job));
    ck_skg(skg_job_wait(&job));
    for (int64_t p = 0; p < parts; p++) move_vertices(p, 0);
}

/* The derivative of every pixel along a direction, by differences; NAN where hits change within the step: there the differences
 * at two steps disagree, or those to both sides are not nearer to each other at half the step. */
static void differentiate(skg_plan *plan, const skg_view *view, const direction *d, int64_t count,
                          double *slope) {
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
        const int is_smooth =
            fabs(half - whole) <= 3e-6 * largest && fabs(bend - 2 * half_bend) <= 3e-6 * largest;
        slope[p] = is_smooth ? (4 * half - whole) / 3 : (double)NAN;
    }
}

/* --- gradients */

typedef struct {
    double poses[PARTS][6], source[3], detector[6], densities[PARTS], *vertices[PARTS];
} result;

static void make_gradient(skg_plan *plan, const setting *set, const double *adjoint, result *r) {
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

static double along(const result *r, const direction *d) {
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

static void allocate(result *r) {
    *r = (result){.source = {0}};
    for (int64_t p = 0; p < parts; p++) {
        int64_t vertices, triangles;
        ck_skg(skg_mesh_count(meshes[p], &vertices, &triangles));
        r->vertices[p] = calloc((size_t)(3 * vertices), sizeof(double));
        saved[p] = calloc((size_t)(3 * vertices), sizeof(double));
        ck_skg(skg_mesh_positions_get(meshes[p], saved[p], 3));
    }
}

static void release(result *r) {
    for (int64_t p = 0; p < parts; p++) {
        free(r->vertices[p]);
        free(saved[p]);
        skg_mesh_release(&meshes[p]);
    }
    skg_scene_release(&scene);
}

/* Direction number `way`: a twist of a part, the source, the detector, or the vertices of a part. */
static int make_direction(const setting *set, int way, direction *d) {
    const double mm = set->infinity ? 1e-3 : 1, radian = 1e-2;
    *d = (direction){.source = {0}};
    if (way < 6 * PARTS)
        d->poses[way / 6][way % 6] = way % 6 < 3 ? 1 : radian;
    else if (way < 6 * PARTS + 3)
        d->source[way - 6 * PARTS] = mm;
    else if (way < 6 * PARTS + 9)
        d->detector[way - 6 * PARTS - 3] = way < 6 * PARTS + 6 ? 1 : radian;
    else if (way < 7 * PARTS + 9)
        d->vertices[way - 6 * PARTS - 9] = 1;
    else
        d->densities[way - 7 * PARTS - 9] = 1;
    const int64_t part = way < 6 * PARTS ? way / 6 : way < 6 * PARTS + 9 ? 0 : (way - 6 * PARTS - 9) % PARTS;
    const int of_view = way >= 6 * PARTS && way < 6 * PARTS + 9;
    return part < parts && !(of_view && set->parts_only);
}

/* d loss / d image: a number between -0.5 and 0.5 for every value. */
static void fill_adjoint(int64_t count, double *adjoint) {
    uint64_t state = 5;
    for (int64_t p = 0; p < count; p++) adjoint[p] = draw(&state, -0.5, 0.5);
}

START_TEST(gradients_are_those_of_differences) {
    const setting *set = &settings[_i];
    static double slope[CHANNELS_MAX * PIXELS], adjoint[CHANNELS_MAX * PIXELS];
    const int64_t count = (set->bands ? set->bands : 1) * PIXELS;
    result r;
    direction d;
    if (!run_has_double()) return;
    make_scene(set);
    allocate(&r);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    for (int way = 0; way < WAYS; way++) {
        uint64_t state = 1 + (uint64_t)way;
        double expected = 0, size = 0;
        int64_t used = 0;
        if (!make_direction(set, way, &d)) continue;
        differentiate(plan, &view, &d, count, slope);
        for (int64_t p = 0; p < count; p++) {
            adjoint[p] = isnan(slope[p]) ? 0 : draw(&state, -0.5, 0.5);
            if (isnan(slope[p])) continue;
            expected += adjoint[p] * slope[p];
            size += fabs(adjoint[p] * slope[p]);
            used += slope[p] != 0;
        }
        make_gradient(plan, set, adjoint, &r);
        const double got = along(&r, &d);
        /* Rounding of two images by the step: 1e-12 / 1e-3, over thousands of pixels */
        ck_assert_msg(fabs(got - expected) <= 1e-6 * size,
                      "%s, direction %d: %.12g, by differences %.12g of %.3g", set->name, way, got, expected,
                      size);
        ck_assert_int_gt(used, 5);
    }
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* A setting's gradient with a precision and a strategy. Everything is released but `r`, whose vertices are those of the body. */
static void gradient_of(const setting *set, int32_t precision, int32_t strategy, result *r,
                        double *vertices) {
    static double adjoint[CHANNELS_MAX * PIXELS];
    int64_t count, triangles;
    make_scene(set);
    allocate(r);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, precision, strategy);
    fill_adjoint(CHANNELS_MAX * PIXELS, adjoint);
    make_gradient(plan, set, adjoint, r);
    ck_skg(skg_mesh_count(meshes[0], &count, &triangles));
    memcpy(vertices, r->vertices[0], 3 * (size_t)count * sizeof *vertices);
    skg_plan_release(&plan);
    release(r);
}

enum { VERTICES_MAX = 400 };

static const setting rich = {
    .name = "rich", .priority = 1, .colours = 1, .quantity = SKG_QUANTITY_TRANSMISSION};

/* Sums over hits are integers, whoever has added up the image. */
START_TEST(strategies_give_the_same_bits) {
    static const int32_t strategies[] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES, SKG_STRATEGY_ATOMICS};
    const int32_t precision = _i ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    static double vertices[3][3 * VERTICES_MAX];
    result r[3];
    if (_i && !run_has_double()) return;
    for (int s = 0; s < 3; s++) gradient_of(&rich, precision, strategies[s], &r[s], vertices[s]);
    for (int s = 1; s < 3; s++) {
        ck_assert_mem_eq(r[s].poses, r[0].poses, sizeof r[s].poses);
        ck_assert_mem_eq(r[s].source, r[0].source, sizeof r[s].source);
        ck_assert_mem_eq(r[s].detector, r[0].detector, sizeof r[s].detector);
        ck_assert_mem_eq(vertices[s], vertices[0], sizeof vertices[s]);
    }
}
END_TEST

static double size_of(const double *numbers, int count) {
    double square = 0;
    for (int k = 0; k < count; k++) square += numbers[k] * numbers[k];
    return sqrt(square);
}

static double difference_of(const double *a, const double *b, int count) {
    double square = 0;
    for (int k = 0; k < count; k++) square += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(square);
}

/* Single precision: hits that rounding moves across an edge belong to another face, so that single pixels may differ; the sums
 * over an image agree. */
START_TEST(single_precision_agrees_with_double) {
    static double vertices[2][3 * VERTICES_MAX];
    result r[2];
    if (!run_has_double()) return;
    for (int s = 0; s < 2; s++)
        gradient_of(&rich, s ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO, &r[s],
                    vertices[s]);
    /* Corners are known to 6e-8 of some tens of pixels, a length's slope to as much of the size of a face of a few pixels. */
    const double change = 2e-5;
    for (int p = 0; p < 3; p++) {
        ck_assert_double_le(difference_of(r[0].poses[p], r[1].poses[p], 3),
                            change * size_of(r[1].poses[p], 3));
        ck_assert_double_le(difference_of(r[0].poses[p] + 3, r[1].poses[p] + 3, 3),
                            change * size_of(r[1].poses[p] + 3, 3));
    }
    ck_assert_double_le(difference_of(r[0].source, r[1].source, 3), change * size_of(r[1].source, 3));
    ck_assert_double_le(difference_of(r[0].detector, r[1].detector, 3), change * size_of(r[1].detector, 3));
    ck_assert_double_le(difference_of(r[0].detector + 3, r[1].detector + 3, 3),
                        change * size_of(r[1].detector + 3, 3));
    ck_assert_double_le(difference_of(vertices[0], vertices[1], 3 * VERTICES_MAX),
                        change * size_of(vertices[1], 3 * VERTICES_MAX));
}
END_TEST

/* Noise is constant: the gradient is that of the mean. */
START_TEST(noise_is_constant) {
    static double vertices[2][3 * VERTICES_MAX];
    setting noisy = rich;
    result r[2];
    noisy.noise = 1;
    gradient_of(&rich, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO, &r[0], vertices[0]);
    gradient_of(&noisy, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO, &r[1], vertices[1]);
    for (int p = 0; p < 3; p++) /* Weights of ratios and of photons are rounded to float in another order. */
        ck_assert_double_le(difference_of(r[0].poses[p], r[1].poses[p], 6),
                            64 * 0x1p-23 * size_of(r[0].poses[p], 6));
}
END_TEST

/* All parts, source and detector together move nothing; so does turning all of them. */
START_TEST(a_whole_that_moves_changes_nothing) {
    static double vertices[3 * VERTICES_MAX];
    result r;
    if (!run_has_double()) return;
    const setting set = {
        .colours = 1, .priority = _i == 1, .falloff = _i == 2, .supersampling = 2, .spot = _i == 2};
    gradient_of(&set, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO, &r, vertices);
    const skg_view view = make_view(&set);
    double size = size_of(&r.poses[0][0], 6);
    for (int k = 0; k < 6; k++) {
        const double *s = view.source, *g = r.source;
        double sum = r.detector[k] +
                     (k < 3 ? g[k] : s[(k + 1) % 3] * g[(k + 2) % 3] - s[(k + 2) % 3] * g[(k + 1) % 3]);
        for (int p = 0; p < parts; p++) sum += r.poses[p][k];
        /* Moments are integers of at least 32 bits below the largest hit. A turn has the source's lever of 1000 mm. */
        ck_assert_double_le(fabs(sum), 1e-8 * size * (k < 3 ? 1 : 1000));
    }
}
END_TEST

/* --- silhouettes and faces that contain rays */

static skg_adjoint adjoint_of(const double *values) {
    skg_adjoint adjoint;
    skg_adjoint_init(&adjoint);
    adjoint.channels = 1, adjoint.rows = adjoint.columns = SIDE, adjoint.data = values;
    return adjoint;
}

/* Path lengths are continuous across silhouettes, so that a pixel's value changes by the integral of its derivative, which is not
 * bounded there. */
START_TEST(values_change_by_the_integral_of_the_gradient) {
    enum { STEPS = 4000 };
    const setting set = {.colours = 1, .quantity = SKG_QUANTITY_ATTENUATION};
    static double first[PIXELS], last[PIXELS], adjoint[PIXELS];
    const double pitch = 4.1 * 1000 / 1200; /* about a pixel, where the body is */
    double integral = 0, change = 0, size = 0;
    result r;
    if (!run_has_double()) return;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    const direction d = {.poses = {{pitch}}};
    fill_adjoint(PIXELS, adjoint);
    render(plan, &view, &d, 0, first);
    render(plan, &view, &d, 1, last);
    for (int p = 0; p < PIXELS; p++)
        change += adjoint[p] * (last[p] - first[p]), size += fabs(adjoint[p] * (last[p] - first[p]));
    for (int s = 0; s < STEPS; s++) {
        skg_gradient gradient;
        skg_frame frame;
        skg_part part;
        const int64_t body = 0;
        const skg_adjoint given = adjoint_of(adjoint);
        skg_part_init(&part);
        skg_frame_init(&frame);
        skg_gradient_init(&gradient);
        ck_skg(skg_scene_part_get(scene, 0, &part));
        part.pose[3] += pitch * (s + 0.5) / STEPS;
        frame.pose_count = 1, frame.pose_parts = &body, frame.poses = part.pose;
        gradient.poses = r.poses[0];
        ck_skg(skg_plan_gradient(plan, &frame, &given, &gradient));
        integral += r.poses[0][0] * pitch / STEPS;
    }
    ck_assert_msg(fabs(integral - change) <= 1e-3 * size, "%.10g, integral %.10g of %.3g", change, integral,
                  size);
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* The sides of a box in a parallel beam contain rays. The mean of the pixels changes by depth times edge, exactly. */
START_TEST(sides_of_a_box_change_the_mean) {
    static double adjoint[PIXELS];
    const double x = 21.3, y = 17.9, z = 33, pitch = 4;
    double poses[6], vertices[24];
    double *const of_parts[1] = {vertices};
    skg_gradient gradient;
    solid box = solid_box(x, y, z);
    skg_view view = run_view(SIDE, pitch);
    view.projection = SKG_PROJECTION_PARALLEL;
    scene = run_scene(&box, NULL);
    skg_plan *plan = run_plan(
        scene, &view,
        (run_choice){.precision = _i && run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                     .quantity = SKG_QUANTITY_ATTENUATION});
    skg_gradient_init(&gradient);
    gradient.poses = poses, gradient.vertices = of_parts;
    /* mu is 0.1 per mm; the loss is the sum of the pixels right of the middle, that is 0.1 z y / pitch^2 for each mm */
    for (int p = 0; p < PIXELS; p++) adjoint[p] = p % SIDE >= SIDE / 2;
    const skg_adjoint given = adjoint_of(adjoint);
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    const double expected = 0.1 * z * y / (pitch * pitch);
    ck_assert_double_eq_tol(poses[0], expected, 1e-5 * expected); /* mu of the material in single precision */
    ck_assert_double_eq_tol(poses[1], 0, 1e-5 * expected);        /* the same */
    double right = 0;
    for (int v = 0; v < 8; v++) right += box.positions[3 * v] > 0 ? vertices[3 * v] : 0;
    ck_assert_double_eq_tol(right, expected, 1e-5 * expected); /* the same */
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    solid_free(&box);
}
END_TEST

/* --- what is refused */

START_TEST(bad_adjoints_are_refused) {
    static double values[PIXELS];
    const setting set = {.colours = 1};
    result r;
    skg_gradient gradient;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    skg_gradient_init(&gradient);
    gradient.source = r.source;
    skg_adjoint adjoint = adjoint_of(values);
    ck_skg_fails(skg_plan_gradient(NULL, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "plan");
    ck_skg_fails(skg_plan_gradient(plan, NULL, NULL, &gradient), SKG_ERR_ARGUMENT, "adjoint");
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, NULL), SKG_ERR_ARGUMENT, "gradient");
    adjoint.rows = SIDE + 1;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "25 x 24");
    adjoint = adjoint_of(values);
    adjoint.channels = 2;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "2 channels");
    adjoint = adjoint_of(NULL);
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "NULL");
    adjoint = adjoint_of(values);
    adjoint.type = SKG_TYPE_UINT16;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "type 2");
    adjoint = adjoint_of(values);
    values[SIDE + 3] = (double)NAN;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_ARGUMENT, "row 1, column 3");
    values[SIDE + 3] = 0;
    ck_skg(skg_plan_gradient(plan, NULL, &adjoint, &gradient));
    for (int k = 0; k < 3; k++) ck_assert_double_eq(r.source[k], 0);
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* Makes a plan with options that have no gradient, and tries. */
static void try_options(const skg_plan_options *options, const skg_view *view, const char *text) {
    static const double energies[2] = {40, 80}, photons[2] = {50, 80};
    static const double values[PIXELS];
    double source[3];
    skg_gradient gradient;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    skg_gradient_init(&gradient);
    gradient.source = source;
    const skg_adjoint adjoint = adjoint_of(values);
    ck_skg(skg_spectrum_create_bins(2, energies, photons, &beam));
    ck_skg(skg_plan_create(run_context, scene, view, beam, options, &plan));
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_UNSUPPORTED, text);
    skg_spectrum_release(&beam);
    skg_plan_release(&plan);
}

START_TEST(what_has_no_gradient_is_refused_by_name) {
    const setting set = {.colours = 1};
    skg_plan_options options;
    skg_heel heel;
    skg_grid grid;
    skg_scatter scatter;
    skg_collimation jaws;
    result r;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_view near = view;
    skg_heel_init(&heel);
    skg_grid_init(&grid);
    skg_scatter_init(&scatter);
    skg_collimation_init(&jaws);
    heel.kvp = 100, heel.direction[1] = 1;
    grid.ratio = 8, grid.lines_per_cm = 40, grid.strip_mm = 0.05;
    jaws.kind = SKG_COLLIMATION_DETECTOR, jaws.margin_mm = -20;
    scatter.histories = 32;
    skg_plan_options_init(&options);
    options.precision = SKG_PRECISION_HALF;
    try_options(&options, &view, "precision half");
    skg_plan_options_init(&options);
    options.heel = &heel;
    try_options(&options, &view, "heel");
    skg_plan_options_init(&options);
    options.grid = &grid;
    try_options(&options, &view, "grid");
    skg_plan_options_init(&options);
    options.collimation = &jaws;
    try_options(&options, &view, "collimator");
    skg_plan_options_init(&options);
    options.scatter = &scatter;
    try_options(&options, &view, "scatter");
    skg_plan_options_init(&options);
    options.noise = 1, options.falloff = 1, options.quantity = SKG_QUANTITY_TRANSMISSION;
    try_options(&options, &view, "flat field");
    skg_plan_options_init(&options);
    near.source[0] = near.source[1] = 0, near.source[2] = 0;
    try_options(&options, &near, "part body reaches the plane of the source");
    release(&r);
}
END_TEST

START_TEST(leaky_meshes_are_refused_by_name) {
    static const double values[PIXELS];
    double poses[6];
    skg_gradient gradient;
    skg_gradient_init(&gradient);
    gradient.poses = poses;
    solid box = solid_box(20, 20, 20);
    box.triangles--;
    const skg_adjoint adjoint = adjoint_of(values);
    const skg_view view = run_view(SIDE, 4);
    scene = run_scene(&box, NULL);
    skg_plan *plan = run_plan(scene, &view, (run_choice){0});
    ck_skg_fails(skg_plan_gradient(plan, NULL, &adjoint, &gradient), SKG_ERR_UNSUPPORTED,
                 "the mesh of part solid is not closed");
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    solid_free(&box);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, gradients_are_those_of_differences, 0, sizeof settings / sizeof *settings);
    tcase_add_loop_test(tests, strategies_give_the_same_bits, 0, 2);
    tcase_add_test(tests, single_precision_agrees_with_double);
    tcase_add_test(tests, noise_is_constant);
    tcase_add_loop_test(tests, a_whole_that_moves_changes_nothing, 0, 3);
    tcase_add_test(tests, values_change_by_the_integral_of_the_gradient);
    tcase_add_loop_test(tests, sides_of_a_box_change_the_mean, 0, 2);
    tcase_add_test(tests, bad_adjoints_are_refused);
    tcase_add_test(tests, what_has_no_gradient_is_refused_by_name);
    tcase_add_test(tests, leaky_meshes_are_refused_by_name);
}

SKG_SUITE_MAIN("gradient", add_tests)
