/* Derivatives by the places of meshes in a volume of cells, and beside it, and by all densities, against differences of images. */
#include "suite.h"
#include "support/doubles.h"
#include "support/random.h"
#include "support/run.h"

#include <skiagraph/gradient.h>
#include <skiagraph/volume.h>

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    SIDE = 32,
    PIXELS = SIDE * SIDE,
    CELLS = 5,
    CELL_MM = 12,
    ALL = CELLS * CELLS * CELLS,
    PARTS = 5,
    VOLUME = 0,
    ROD,
    HOLE,
    WINNER,
    BESIDE
};

static skg_scene *scene;
static double factors[PARTS] = {1, 1, 1, 1, 1}; /* of the densities */

/* A cube of 60 mm about the origin. */
static void add_volume(const double *cells, int32_t values) {
    skg_volume_source source;
    skg_part part;
    skg_volume_source_init(&source);
    source.columns = source.rows = source.slices = CELLS;
    source.cells = cells, source.type = SKG_VOLUME_FLOAT64, source.values = values;
    for (int k = 0; k < 3; k++) source.affine[5 * k] = CELL_MM, source.affine[4 * k + 3] = -2 * CELL_MM;
    if (values == SKG_VOLUME_DENSITY) ck_skg(skg_material_create_named("Water", &source.material));
    skg_part_init(&part);
    ck_skg(skg_volume_create(&source, &part.volume));
    part.label = "volume";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_volume_release(&part.volume);
    skg_material_release(&source.material);
}

static void add_box(const char *label, double x, double y, double z, const char *material, double turn,
                    const double at[3], int64_t inside, int32_t priority) {
    skg_part part;
    skg_part_init(&part);
    part.label = label, part.inside = inside, part.priority = priority;
    /* About y, and then about x, so that all faces are seen */
    const double c = cos(turn), d = sin(turn), e = cos(0.6), f = sin(0.6);
    const double turned[9] = {c, 0, d, f * d, e, -f * c, -e * d, f, e * c};
    for (int k = 0; k < 9; k++) part.pose[4 * (k / 3) + k % 3] = turned[k];
    for (int k = 0; k < 3; k++) part.pose[4 * k + 3] = at[k];
    ck_skg(skg_mesh_create_cuboid(x, y, z, &part.mesh));
    skg_material *nominal = NULL;
    double density = 0;
    int64_t id = 0;
    ck_skg(skg_scene_part_count(scene, &id));
    ck_skg(skg_material_create_named(material, &nominal));
    const int is_vacuum = strcmp(material, "Vacuum") == 0; /* has no density */
    if (is_vacuum) ck_skg(skg_material_retain(part.material = nominal));
    if (!is_vacuum) ck_skg(skg_material_density_get(nominal, &density));
    if (!is_vacuum) ck_skg(skg_material_create_at_density(nominal, density * factors[id], &part.material));
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    skg_material_release(&nominal);
}

static skg_plan *make(int wide, int parallel) {
    static const double rod[3] = {3.3, -4.1, 2.2}, hole[3] = {-11.7, 8.9, -6.3},
                        winner[3] = {27.1, 11.3, 5.2}, beside[3] = {-2.9, -38.3, 1.7};
    static const double kev[2] = {50, 80}, photons[2] = {60, 40};
    double cells[ALL];
    uint64_t state = 7;
    skg_spectrum *beam = NULL;
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_view view = run_view(SIDE, 3.3);
    view.source[0] = 17, view.source[1] = -23;
    view.column_step[2] = 0.21, view.row_step[0] = 0.13;
    if (parallel) view.projection = SKG_PROJECTION_PARALLEL;
    ck_skg(skg_scene_create(run_context, &scene));
    for (int c = 0; c < ALL; c++)
        cells[c] = factors[VOLUME] * (wide ? draw(&state, 0, 2) : floor(draw(&state, 0, 3)));
    add_volume(cells, SKG_VOLUME_DENSITY);
    add_box("rod", 8, 26, 9, "Al", 0.4, rod, VOLUME, 0);
    add_box("hole", 14, 12, 13, "Vacuum", 0.7, hole, VOLUME, 0);
    add_box("winner", 15, 14, 16, "Al", 0.3, winner, -1, 1);
    add_box("beside", 20, 10, 15, "Al", 0.6, beside, -1, 0);
    skg_plan_options_init(&options);
    options.overlaps = 0, options.precision = SKG_PRECISION_DOUBLE,
    options.quantity = SKG_QUANTITY_ATTENUATION;
    ck_skg(skg_spectrum_create_bins(2, kev, photons, &beam));
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
    skg_spectrum_release(&beam);
    return plan;
}

/* The image with a part moved along an entry of a twist. */
static void render(skg_plan *plan, int64_t id, int way, double step, double *image) {
    skg_frame frame;
    skg_output output;
    skg_job *job = NULL;
    skg_part part;
    double pose[16], c = cos(step), s = sin(step);
    const int a = (way + 1) % 3, b = (way + 2) % 3;
    skg_part_init(&part);
    skg_frame_init(&frame);
    skg_output_init(&output);
    ck_skg(skg_scene_part_get(scene, id, &part));
    memcpy(pose, part.pose, sizeof pose);
    if (way < 3) pose[4 * way + 3] += step;
    for (int k = 0; k < 4 && way >= 3; k++) {
        pose[4 * a + k] = c * part.pose[4 * a + k] - s * part.pose[4 * b + k];
        pose[4 * b + k] = s * part.pose[4 * a + k] + c * part.pose[4 * b + k];
    }
    frame.pose_count = 1, frame.pose_parts = &id, frame.poses = pose;
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
}

/* Central differences. A crossing of a slice of cells is known to 2^-23 of it, so that steps are large; NAN where hits change their face or
 * their cell within the step, and so the differences at half of it are others. */
static void differentiate(skg_plan *plan, int64_t id, int way, double *slope) {
    static double image[2][PIXELS];
    const double steps[2] = {way < 3 ? 0.04 : 0.002, way < 3 ? 0.02 : 0.001};
    double largest = 0, half[PIXELS];
    for (int s = 0; s < 2; s++) {
        render(plan, id, way, steps[s], image[0]);
        render(plan, id, way, -steps[s], image[1]);
        for (int p = 0; p < PIXELS; p++) (s ? half : slope)[p] = (image[0][p] - image[1][p]) / (2 * steps[s]);
    }
    for (int p = 0; p < PIXELS; p++) largest = fmax(largest, fabs(half[p]));
    for (int p = 0; p < PIXELS; p++)
        /* Roundings of crossings make 1e-4 of the difference at the smaller step */
        slope[p] = fabs(slope[p] - half[p]) <= 3e-4 * largest ? (4 * half[p] - slope[p]) / 3 : (double)NAN;
}

START_TEST(derivatives_are_those_of_differences) {
    static double slope[PIXELS], derivative[PIXELS], adjoint[PIXELS], poses[PARTS][6], twists[PARTS][6];
    skg_plan *plan = NULL;
    uint64_t state = 3;
    if (!run_has_double()) return;
    plan = make(_i & 1, _i & 2);
    for (int p = 0; p < PIXELS; p++) adjoint[p] = draw(&state, -0.5, 0.5);
    skg_adjoint given;
    skg_gradient gradient;
    skg_adjoint_init(&given);
    skg_gradient_init(&gradient);
    given.channels = 1, given.rows = given.columns = SIDE, given.data = adjoint, gradient.poses = poses[0];
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    for (int k = 0; k < 6; k++) ck_assert(isnan(poses[VOLUME][k]));
    for (int64_t part = ROD; part < PARTS; part++)
        for (int way = 0; way < 6; way++) {
            skg_direction direction;
            double largest = 0, sum = 0, size = 0;
            int used = 0;
            memset(twists, 0, sizeof twists);
            twists[part][way] = 1;
            skg_direction_init(&direction);
            direction.poses = twists[0];
            ck_skg(skg_plan_derivatives(plan, NULL, 1, &direction, DOUBLES(derivative), NULL));
            differentiate(plan, part, way, slope);
            for (int p = 0; p < PIXELS; p++) {
                largest = isnan(slope[p]) ? largest : fmax(largest, fabs(slope[p]));
                used += !isnan(slope[p]) && slope[p] != 0;
                sum += adjoint[p] * derivative[p], size += fabs(adjoint[p] * derivative[p]);
            }
            ck_assert_int_gt(used, 12);
            for (int p = 0; p < PIXELS; p++) /* as far as the differences are known */
                ck_assert_msg(isnan(slope[p]) || fabs(derivative[p] - slope[p]) <= 1e-3 * largest,
                              "part %d, entry %d, pixel %d: %.9g, by differences %.9g of %.3g", (int)part,
                              way, p, derivative[p], slope[p], largest);
            ck_assert_double_eq_tol(poses[part][way], sum, 1e-9 * size); /* sums in integers of 2^-50 */
        }
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}
END_TEST

/* --- rays along faces */

static const double box_at[3] = {1, 2, -1.5}, box_size[3] = {20, 16, 22};

/* The area of a cell's section across an axis that a face of the box has, mm2. */
static double shared_area(const int at[3], int axis) {
    double area = 1;
    for (int k = 0; k < 3; k++) {
        const double low = (at[k] - 0.5 * CELLS) * CELL_MM;
        const double from = fmax(low, box_at[k] - 0.5 * box_size[k]),
                     to = fmin(low + CELL_MM, box_at[k] + 0.5 * box_size[k]);
        if (k != axis) area *= fmax(to - from, 0);
    }
    return area;
}

/* Gain of the integral of the attenuation when the box moves along an axis: the cells behind it, less those before it. all: of both */
static double gain_along(const double *cells, int axis, double *all) {
    double gain = 0;
    *all = 0;
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < CELLS * CELLS; c++) {
            int at[3] = {0, 0, c / CELLS};
            at[axis] = (int)floor((box_at[axis] + (k - 0.5) * box_size[axis]) / CELL_MM + 0.5 * CELLS);
            at[1 - axis] = c % CELLS;
            const double cell = 0.1 * cells[(at[2] * CELLS + at[1]) * CELLS + at[0]] * shared_area(at, axis);
            gain += k ? -cell : cell, *all += cell; /* 0.1: from 1/cm */
        }
    return gain;
}

/* The faces of a box along parallel rays. */
START_TEST(faces_along_rays_lose_the_cells_behind_them) {
    static double adjoint[PIXELS], poses[2][6], cells[ALL];
    const double pitch =
        3; /* planes between cells are between pixels, too: a pixel takes those that its middle sees */
    skg_view view = run_view(SIDE, pitch);
    skg_spectrum *beam = NULL;
    skg_plan_options options;
    skg_plan *plan = NULL;
    uint64_t state = 5;
    if (!run_has_double()) return;
    for (int c = 0; c < ALL; c++) cells[c] = draw(&state, 0, 1);
    for (int p = 0; p < PIXELS; p++) adjoint[p] = pitch * pitch;
    ck_skg(skg_scene_create(run_context, &scene));
    add_volume(cells, SKG_VOLUME_MU);
    add_box("box", box_size[0], box_size[1], box_size[2], "Al", 0, box_at, VOLUME, 0);
    const double upright[16] = {1, 0, 0, box_at[0], 0, 1, 0, box_at[1], 0, 0, 1, box_at[2], 0, 0, 0, 1};
    ck_skg(skg_scene_part_pose_set(scene, ROD, upright));
    view.projection = SKG_PROJECTION_PARALLEL;
    skg_plan_options_init(&options);
    options.overlaps = 0, options.precision = SKG_PRECISION_DOUBLE,
    options.quantity = SKG_QUANTITY_ATTENUATION;
    ck_skg(skg_spectrum_create_mono(60, 1, &beam));
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
    skg_adjoint given;
    skg_gradient gradient;
    skg_adjoint_init(&given);
    skg_gradient_init(&gradient);
    given.channels = 1, given.rows = given.columns = SIDE, given.data = adjoint, gradient.poses = poses[0];
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    for (int axis = 0; axis < 2; axis++) {
        double all;
        const double gain = gain_along(cells, axis, &all);
        ck_assert_double_eq_tol(poses[ROD][axis], gain, 1e-6 * all); /* weights of cells are floats */
    }
    skg_plan_release(&plan);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
}
END_TEST

/* --- densities */

/* The image of the scene with the density of a part changed by a share. */
static void render_denser(int wide, int parallel, int64_t part, double share, double *image) {
    factors[part] = 1 + share;
    skg_plan *plan = make(wide, parallel);
    factors[part] = 1;
    render(plan, ROD, 0, 0, image);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}

/* The derivative by each density, by differences: of the volume, which meshes displace; of those; of the mesh that wins over it; and of
 * one beside it. Weights of cells are floats, so that steps are large; the next order in the step is taken out. */
START_TEST(densities_have_the_derivatives_of_differences) {
    static double image[2][PIXELS], derivative[PIXELS], adjoint[PIXELS], densities[PARTS];
    static const double steps[2] = {0.02, 0.01};
    uint64_t state = 3;
    if (!run_has_double()) return;
    for (int p = 0; p < PIXELS; p++) adjoint[p] = draw(&state, -0.5, 0.5);
    for (int64_t part = 0; part < PARTS; part++) {
        double by_differences[2][PIXELS], change[PARTS] = {0}, largest = 0, sum = 0, size = 0;
        skg_adjoint given;
        skg_gradient gradient;
        skg_direction direction;
        for (int s = 0; s < 2; s++) {
            render_denser(_i & 1, _i & 2, part, steps[s], image[0]);
            render_denser(_i & 1, _i & 2, part, -steps[s], image[1]);
            for (int p = 0; p < PIXELS; p++)
                by_differences[s][p] = (image[0][p] - image[1][p]) / (2 * steps[s]);
        }
        skg_plan *plan = make(_i & 1, _i & 2);
        skg_adjoint_init(&given);
        skg_gradient_init(&gradient);
        skg_direction_init(&direction);
        change[part] = 1, direction.densities = change;
        ck_skg(skg_plan_derivatives(plan, NULL, 1, &direction, DOUBLES(derivative), NULL));
        given.channels = 1, given.rows = given.columns = SIDE, given.data = adjoint;
        gradient.densities = densities;
        ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
        for (int p = 0; p < PIXELS; p++) {
            largest = fmax(largest, fabs(by_differences[1][p]));
            sum += adjoint[p] * derivative[p], size += fabs(adjoint[p] * derivative[p]);
        }
        if (part == HOLE)
            ck_assert_double_eq(largest, 0);
        else
            ck_assert_double_gt(largest, 0.1);
        for (int p = 0; p < PIXELS; p++) { /* differences of images whose weights are floats, over the step */
            const double slope = (4 * by_differences[1][p] - by_differences[0][p]) / 3;
            ck_assert_double_le(fabs(derivative[p] - slope), 64 * (double)FLT_EPSILON / steps[1] * largest);
        }
        ck_assert_double_le(fabs(densities[part] - sum), 1e-9 * size); /* sums in integers of 2^-50 */
        skg_plan_release(&plan);
        skg_scene_release(&scene);
    }
}
END_TEST

/* A density changes all coefficients of its material alike: the derivative by it is the sum of those by coefficients times these. */
START_TEST(coefficients_add_up_to_densities) {
    enum { NODES_MAX = 8 };
    static double adjoint[PIXELS], densities[PARTS], attenuations[PARTS * NODES_MAX];
    skg_adjoint given;
    skg_gradient gradient;
    uint64_t state = 3;
    if (!run_has_double()) return;
    skg_plan *plan = make(_i & 1, _i & 2);
    skg_adjoint_init(&given);
    skg_gradient_init(&gradient);
    for (int p = 0; p < PIXELS; p++) adjoint[p] = draw(&state, -0.5, 0.5);
    given.channels = 1, given.rows = given.columns = SIDE, given.data = adjoint;
    ck_skg(skg_plan_node_count(plan, &gradient.nodes));
    ck_assert_int_le(gradient.nodes, NODES_MAX);
    gradient.densities = densities, gradient.attenuations = attenuations;
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    for (int64_t part = 0; part < PARTS; part++) {
        skg_part of;
        double sum = 0, size = 0;
        skg_part_init(&of);
        ck_skg(skg_scene_part_get(scene, part, &of));
        for (int64_t n = 0; n < gradient.nodes; n++) {
            double kev = 0, mu = 0;
            if (part == VOLUME) ck_assert(isnan(attenuations[n]));
            if (part == VOLUME) continue;
            ck_skg(skg_plan_node_get(plan, n, &kev, NULL, NULL));
            ck_skg(skg_material_attenuation_get(of.material, kev, &mu));
            sum += mu * attenuations[part * gradient.nodes + n];
            size += fabs(mu * attenuations[part * gradient.nodes + n]);
        }
        if (part != VOLUME)
            ck_assert_double_le(fabs(densities[part] - sum), 1e-6 * size); /* weights are floats */
    }
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}
END_TEST

START_TEST(what_has_no_derivative_is_refused) {
    static double adjoint[PIXELS], poses[PARTS][6], more[PARTS * 6], derivative[PIXELS];
    double *vertices[PARTS] = {NULL};
    if (!run_has_double()) return;
    skg_plan *plan = make(0, 0);
    skg_adjoint given;
    skg_gradient gradient;
    skg_direction direction;
    skg_adjoint_init(&given);
    given.channels = 1, given.rows = given.columns = SIDE, given.data = adjoint;
    skg_gradient_init(&gradient);
    gradient.source = more;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &given, &gradient), SKG_ERR_UNSUPPORTED, "source or detector");
    skg_gradient_init(&gradient);
    vertices[VOLUME] = more, gradient.vertices = vertices;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &given, &gradient), SKG_ERR_UNSUPPORTED,
                 "no vertices of its own");
    skg_direction_init(&direction);
    poses[VOLUME][1] = 1, direction.poses = poses[0];
    ck_skg_fails(skg_plan_derivatives(plan, NULL, 1, &direction, DOUBLES(derivative), NULL),
                 SKG_ERR_UNSUPPORTED, "no derivative by its place");
    skg_direction_init(&direction);
    ck_skg(skg_plan_node_count(plan, &direction.nodes));
    ck_assert_int_le(PARTS * direction.nodes, PARTS * 6);
    more[VOLUME] = 1, direction.attenuations = more;
    ck_skg_fails(skg_plan_derivatives(plan, NULL, 1, &direction, DOUBLES(derivative), NULL),
                 SKG_ERR_UNSUPPORTED, "no common attenuation coefficient");
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, derivatives_are_those_of_differences, 0, 4);
    tcase_add_test(tests, faces_along_rays_lose_the_cells_behind_them);
    tcase_add_loop_test(tests, densities_have_the_derivatives_of_differences, 0, 4);
    tcase_add_loop_test(tests, coefficients_add_up_to_densities, 0, 4);
    tcase_add_test(tests, what_has_no_derivative_is_refused);
}

SKG_SUITE_MAIN("gradient/volume", add_tests)
