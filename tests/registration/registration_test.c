/* A body is found again in radiographs of its scene; what is wrong with radiographs is named. */
#include "registration/types.h"
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 96, VIEWS = 2, PIXELS = SIDE * SIDE };

static skg_context *context;
static skg_spectrum *mono;
static int32_t lung_priority; /* not 0: attenuations do not add */

static void set_up(void) {
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_spectrum_create_mono(60, 1e5, &mono));
}

static void tear_down(void) {
    skg_spectrum_release(&mono);
    skg_context_release(&context);
}

/* Takes the mesh. */
static int64_t add(skg_scene *scene, skg_mesh *mesh, double mu, const char *label, int64_t inside, double x,
                   double y, double z) {
    skg_part part;
    int64_t id;
    skg_part_init(&part);
    ck_skg(skg_material_create_mu(label, mu, &part.material));
    part.mesh = mesh, part.label = label, part.inside = inside;
    part.priority = strcmp(label, "lung") ? 0 : lung_priority;
    skg_pose_translation(x, y, z, part.pose);
    ck_skg(skg_scene_part_add(scene, &part, &id));
    skg_mesh_release(&mesh);
    skg_material_release(&part.material);
    return id;
}

enum { SKIN, LUNG, BLOCK, KNOB, ARM, PARTS };

/* A cube of cells that differ, 160 mm wide. */
static int64_t add_cells(skg_scene *scene, const char *label) {
    enum { CELLS = 8 };
    static float cells[CELLS * CELLS * CELLS];
    skg_volume_source source;
    skg_part part;
    int64_t id;
    for (int c = 0; c < CELLS * CELLS * CELLS; c++) cells[c] = 0.1F + 0.02F * (float)(c * 7 % 11);
    skg_volume_source_init(&source);
    source.columns = source.rows = source.slices = CELLS;
    source.cells = cells, source.type = SKG_VOLUME_FLOAT32, source.values = SKG_VOLUME_MU;
    for (int k = 0; k < 3; k++) source.affine[5 * k] = 20, source.affine[4 * k + 3] = -70;
    skg_part_init(&part);
    ck_skg(skg_volume_create(&source, &part.volume));
    part.label = label;
    ck_skg(skg_scene_part_add(scene, &part, &id));
    skg_volume_release(&part.volume);
    return id;
}

/* Attenuation, 1/cm: of the model, and of radiographs in which the skin is denser, the lung lighter, and the body's contrast 0.7 of the model's. */
static const double modelled[PARTS] = {0.2, 0.05, 0.5, 0.6, 0.5},
                    others[PARTS] = {0.23, 0.02, 0.44, 0.51, 0.44};

/* A body of three parts without symmetry, inside a sphere or a cube of cells that holds something light as well. */
static skg_scene *make_scene_in(int of_cells, const double *mu) {
    skg_scene *scene;
    skg_mesh *skin, *lung, *block, *knob, *arm;
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_mesh_create_sphere(20, 24, &lung));
    ck_skg(skg_mesh_create_cuboid(18, 26, 40, &block));
    ck_skg(skg_mesh_create_sphere(9, 24, &knob));
    ck_skg(skg_mesh_create_cuboid(34, 6, 8, &arm));
    if (of_cells) {
        ck_assert_int_eq(add_cells(scene, "skin"), SKIN);
    } else {
        ck_skg(skg_mesh_create_sphere(80, 48, &skin));
        ck_assert_int_eq(add(scene, skin, mu[SKIN], "skin", -1, 0, 0, 0), SKIN);
    }
    ck_assert_int_eq(add(scene, lung, mu[LUNG], "lung", SKIN, -42, 10, 8), LUNG);
    ck_assert_int_eq(add(scene, block, mu[BLOCK], "body block", SKIN, 3, -2, 4), BLOCK);
    ck_assert_int_eq(add(scene, knob, mu[KNOB], "body knob", SKIN, 14, 20, 28), KNOB);
    ck_assert_int_eq(add(scene, arm, mu[ARM], "body arm", SKIN, 20, -18, -14), ARM);
    return scene;
}

static skg_scene *make_scene(void) {
    return make_scene_in(0, modelled);
}

/* From the front and from the side; the detector is square. */
static skg_view view_from(int which) {
    skg_view view;
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[1 - which] = which == 0 ? -600 : 600;
    view.centre[1 - which] = which == 0 ? 200 : -200;
    view.column_step[which] = 2;
    view.row_step[2] = -2;
    return view;
}

static void render(skg_scene *scene, const skg_view *view, int32_t quantity, int noise, int rays,
                   double *values) {
    skg_plan_options options;
    skg_plan *plan;
    skg_output output;
    static float image[PIXELS];
    skg_plan_options_init(&options);
    options.quantity = quantity, options.supersampling = rays, options.noise = noise;
    ck_skg(skg_plan_create(context, scene, view, mono, &options, &plan));
    skg_output_init(&output);
    output.data = image;
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_release(&plan);
    for (int p = 0; p < PIXELS; p++) values[p] = (double)image[p];
}

static void add_image(skg_registration *r, const skg_view *view, const double *values) {
    skg_radiograph image;
    skg_radiograph_init(&image);
    image.view = view, image.values = values, image.quantity = SKG_QUANTITY_ATTENUATION;
    ck_skg(skg_registration_image_add(r, &image));
}

/* A square of pixels near the body that attenuates more in the first radiograph than the scene does. */
enum { LUMP = 7, LUMP_ROW = 62, LUMP_COLUMN = 66 };

/* Changes of a test to the usual run: two views, from a start some mm and degrees off. */
typedef struct {
    int views, noise, of_cells, other;
    double shift, turn, lump;
    skg_registration_options options;
} run_of;

static run_of usual(void) {
    run_of run = {.views = VIEWS, .shift = 6, .turn = 6 * SKG_PI / 180};
    skg_registration_options_init(&run.options);
    return run;
}

static skg_registration *prepare(run_of *run, skg_scene *scene) {
    static double values[PIXELS];
    skg_registration *r;
    const double start[6] = {0.6 * run->shift, -0.64 * run->shift, 0.48 * run->shift,
                             0.48 * run->turn, 0.6 * run->turn,    -0.64 * run->turn};
    memcpy(run->options.start, start, sizeof start);
    ck_skg(skg_registration_create(context, scene, mono, NULL, &run->options, &r));
    for (int64_t p = BLOCK; p <= ARM; p++) ck_skg(skg_registration_part_add(r, p));
    skg_scene *shown = run->other ? make_scene_in(0, others) : scene;
    for (int v = 0; v < run->views; v++) {
        const skg_view view = view_from(v);
        render(shown, &view, SKG_QUANTITY_ATTENUATION, run->noise, 2, values);
        for (int p = 0; p < LUMP * LUMP && v == 0; p++)
            values[(LUMP_ROW + p / LUMP - LUMP / 2) * SIDE + LUMP_COLUMN + p % LUMP - LUMP / 2] += run->lump;
        add_image(r, &view, values);
    }
    if (run->other) skg_scene_release(&shown);
    return r;
}

static skg_registration_result result_of(skg_registration *r) {
    skg_registration_result result;
    skg_registration_result_init(&result);
    ck_skg(skg_registration_result_get(r, &result));
    return result;
}

/* How far the corners of a box about the body are from where they are in the scene, at most. */
static double error_of(const skg_registration_result *result) {
    double motion[16], most = 0;
    reg_motion_of(result->twist, motion);
    for (int corner = 0; corner < 8; corner++) {
        const double at[3] = {corner & 1 ? 30 : -10, corner & 2 ? 30 : -20, corner & 4 ? 35 : -20};
        double moved[3];
        skg_pose_point(motion, at, moved);
        skg_add_scaled(moved, -1, at, moved);
        most = fmax(most, skg_length(moved));
    }
    return most;
}

static skg_registration_result run(run_of *run, double bar) {
    skg_scene *scene = make_scene_in(run->of_cells, modelled);
    skg_registration *r = prepare(run, scene);
    ck_skg(skg_registration_run(r));
    const skg_registration_result result = result_of(r);
    ck_assert_msg(error_of(&result) < bar, "%g mm instead of less than %g (loss %g -> %g, verdict %s)",
                  error_of(&result), bar, result.loss_start, result.loss, r->verdict);
    ck_assert(result.loss < result.loss_start);
    skg_registration_release(&r);
    skg_scene_release(&scene);
    return result;
}

START_TEST(twists_are_their_own_inverse) {
    static const double twists[][6] = {{1, 2, 3, 0, 0, 0},
                                       {4, -5, 6, 1e-7, -2e-7, 3e-7},
                                       {4, -5, 6, 0.3, -0.2, 0.1},
                                       {10, 0, -3, 0.02, 3.1, 0.03},
                                       {-7, 8, 1, -1.2, -1.9, 2.0}};
    for (size_t t = 0; t < sizeof twists / sizeof *twists; t++) {
        double motion[16], back[6];
        reg_motion_of(twists[t], motion);
        ck_assert_double_eq_tol(skg_pose_determinant(motion), 1, 64 * DBL_EPSILON);
        reg_twist_of(motion, back);
        for (int k = 0; k < 6; k++) /* near pi the axis has the square root of an epsilon's part */
            ck_assert_double_eq_tol(back[k], twists[t][k], 1e-9);
    }
}
END_TEST

START_TEST(every_loss_finds_the_body) {
    /* a hundredth of a pixel at the body, which is 1.5 mm; the samples of model and radiograph are the same there */
    static const struct {
        int32_t loss, polish;
        double bar;
    } ways[] = {{SKG_REGISTRATION_LOSS_LSQ, 0, 0.015},
                {SKG_REGISTRATION_LOSS_NCC, 0, 0.03},
                {SKG_REGISTRATION_LOSS_GRADIENT_NCC, 0, 0.03},
                {SKG_REGISTRATION_LOSS_LSQ, 1, 0.015}};
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        run_of one = usual();
        one.options.loss = ways[k].loss, one.options.polish = ways[k].polish;
        const skg_registration_result result = run(&one, ways[k].bar);
        ck_assert_int_eq(result.verdict, SKG_REGISTRATION_VERDICT_AGREES);
        ck_assert(result.agreement > 0.99 && result.explained > 0.99);
        for (int d = 0; d < 6; d++) ck_assert(result.determined[d] && result.sigma[d] < 0.1);
    }
}
END_TEST

/* Parts that displace the cells of a volume, which does not move itself. */
START_TEST(a_body_in_a_volume_of_cells_is_found) {
    run_of one = usual();
    one.of_cells = 1;
    const skg_registration_result result = run(&one, 0.015); /* a hundredth of a pixel, as above */
    ck_assert_int_eq(result.verdict, SKG_REGISTRATION_VERDICT_AGREES);
    skg_scene *scene = make_scene_in(1, modelled);
    skg_registration *r = prepare(&one, scene);
    ck_skg(skg_registration_part_add(r, SKIN));
    ck_skg_fails(skg_registration_run(r), SKG_ERR_UNSUPPORTED, "skin is a volume of cells");
    skg_registration_release(&r);
    skg_scene_release(&scene);
}
END_TEST

/* The parts around the body, light parts, and the body's own contrast have gains. */
START_TEST(other_densities_are_found) {
    run_of one = usual();
    one.other = 1;
    for (lung_priority = 0; lung_priority < 2; lung_priority++) {
        /* A pixel is a mean of transmissions, and so is each share of it: at borders they neither add nor scale. A tenth of a pixel. */
        const skg_registration_result clean = run(&one, 0.15);
        ck_assert_int_eq(clean.verdict, SKG_REGISTRATION_VERDICT_AGREES);
        ck_assert(clean.agreement > 0.99);
        ck_assert_double_lt(clean.residual,
                            0.001); /* for the same reason; 0.006 without a gain of the body */
    }
    lung_priority = 0;
    one.noise = 1;
    ck_assert_int_eq(run(&one, 0.25).verdict, SKG_REGISTRATION_VERDICT_AGREES); /* the same, and noise */
}
END_TEST

/* Structure that the scene lacks is shown where it is, and noise is not. */
START_TEST(structure_is_shown_where_it_is) {
    static double picture[PIXELS];
    for (int lumps = 0; lumps < 2; lumps++) {
        run_of one = usual();
        one.noise = 1, one.lump = 0.3 * lumps;
        int64_t shown = 0;
        double beside = 0;
        skg_scene *scene = make_scene();
        skg_registration *r = prepare(&one, scene);
        ck_skg(skg_registration_run(r));
        const skg_registration_result result = result_of(r);
        ck_assert_int_eq(result.verdict == SKG_REGISTRATION_VERDICT_STRUCTURE, lumps);
        ck_skg(skg_registration_picture_get(r, 0, SKG_REGISTRATION_PICTURE_STRUCTURE, picture));
        for (int p = 0; p < PIXELS; p++) {
            const int row = abs(p / SIDE - LUMP_ROW), column = abs(p % SIDE - LUMP_COLUMN);
            shown += picture[p] != 0;
            if (row > LUMP / 2 + 1 || column > LUMP / 2 + 1) beside = fmax(beside, fabs(picture[p]));
        }
        if (lumps) {
            /* the polynomials and the body's pose take some of it */
            ck_assert_double_eq_tol(picture[LUMP_ROW * SIDE + LUMP_COLUMN], -one.lump, 0.2 * one.lump);
            ck_assert_int_eq(result.worst_image, 0);
            ck_assert_int_eq(result.worst_row, 66); /* middle of rows 60 to 72 */
            ck_assert_int_eq(result.worst_column, 66);
        } else { /* three standard deviations of what is nearly normal: a hundredth, at most, of neighbours that are alike */
            ck_assert_int_lt(shown, PIXELS / 100);
        }
        ck_assert_double_lt(beside,
                            0.1); /* a third of the lump: what polynomials leave that bend towards it */
        skg_registration_release(&r);
        skg_scene_release(&scene);
    }
}
END_TEST

/* With noise the error is that of sigma: within five of them, which less than one of a million exceed. */
START_TEST(noise_displaces_as_sigma_says) {
    run_of one = usual();
    one.noise = 1;
    const skg_registration_result result = run(&one, 0.5);
    ck_assert_int_eq(result.verdict, SKG_REGISTRATION_VERDICT_AGREES);
    double moved[3], motion[16];
    reg_motion_of(result.twist, motion);
    skg_pose_point(motion, result.middle, moved);
    for (int k = 0; k < 3; k++) { /* five of them, as above */
        ck_assert(result.sigma[k] > 0);
        ck_assert_double_le(fabs(moved[k] - result.middle[k]), 5 * result.sigma_structure[k]);
        /* five of them, as above */
        ck_assert_double_le(fabs(result.twist[3 + k]), 5 * result.sigma_structure[3 + k]);
    }
}
END_TEST

/* One view sees little along its beam, and says so. */
START_TEST(the_beam_of_one_view_is_the_least_certain) {
    run_of one = usual();
    skg_scene *scene = make_scene();
    skg_registration_direction worst;
    const char *sentence;
    one.views = 1, one.noise = 1, one.shift = 3, one.turn = 0.03;
    one.options.need_mm = 0.05;
    skg_registration *r = prepare(&one, scene);
    ck_skg(skg_registration_run(r));
    skg_registration_direction_init(&worst);
    ck_skg(skg_registration_direction_get(r, 0, &worst));
    ck_assert_str_eq(worst.name, "shift along the beam of view 1");
    ck_assert_int_eq(worst.determined, 0);
    ck_assert_int_eq(result_of(r).verdict, SKG_REGISTRATION_VERDICT_UNDETERMINED);
    ck_assert_int_eq(result_of(r).determined[1], 0); /* along y */
    ck_skg(skg_registration_verdict_get(r, &sentence));
    ck_assert_ptr_nonnull(strstr(sentence, "not determined: shift along the beam of view 1"));
    skg_registration_release(&r);
    skg_scene_release(&scene);
}
END_TEST

/* A needle, 0.8 mm across pixels of 1.5 mm at its place: more rays see how much of a pixel it covers. */
START_TEST(a_needle_thinner_than_a_pixel_is_found) {
    static double values[PIXELS];
    skg_registration_options options;
    skg_registration *r;
    skg_scene *scene;
    skg_mesh *needle;
    int64_t id;
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_mesh_create_cylinder(0.4, 70, 24, &needle));
    id = add(scene, needle, 6, "needle", -1, 4, -3, 2);
    double pose[16], turned[16];
    const double askew[6] = {0, 0, 0, 0.5, 0.4, 0};
    reg_motion_of(askew, turned);
    skg_pose_translation(4, -3, 2, pose);
    skg_pose_multiply(pose, turned, pose);
    ck_skg(skg_scene_part_pose_set(scene, id, pose));
    skg_registration_options_init(&options);
    const double start[6] = {0.8, 0.6, -0.5, 0.01, -0.012, 0};
    memcpy(options.start, start, sizeof start);
    ck_skg(skg_registration_create(context, scene, mono, NULL, &options, &r));
    ck_skg(skg_registration_part_add(r, id));
    for (int v = 0; v < VIEWS; v++) {
        const skg_view view = view_from(v);
        render(scene, &view, SKG_QUANTITY_ATTENUATION, 1, 7, values);
        add_image(r, &view, values);
    }
    ck_skg(skg_registration_run(r));
    const skg_registration_result result = result_of(r);
    double motion[16];
    reg_motion_of(result.twist, motion);
    for (int end = -1; end <= 1; end += 2) {
        const double along[3] = {0, 0, 35.0 * end};
        double at[3], moved[3];
        skg_pose_point(pose, along, at);
        skg_pose_point(motion, at, moved);
        skg_add_scaled(moved, -1, at, moved);
        ck_assert_double_lt(skg_length(moved), 0.15); /* a tenth of a pixel at the body */
    }
    skg_registration_release(&r);
    skg_scene_release(&scene);
}
END_TEST

START_TEST(restarts_find_it_from_afar) {
    run_of one = usual();
    one.shift = 30, one.turn = 25 * SKG_PI / 180;
    one.options.restarts = 40, one.options.spread_mm = 40, one.options.spread_rad = 0.6;
    one.options.margin_mm = 60;
    run(&one, 0.03);
}
END_TEST

static int32_t stop_after(int64_t done, int64_t total, void *user) {
    ck_assert(done <= total);
    return done >= *(int64_t *)user;
}

START_TEST(a_cancelled_one_keeps_the_best) {
    int64_t limit = 3;
    run_of one = usual();
    skg_scene *scene = make_scene();
    ck_skg(skg_progress_create(stop_after, &limit, &one.options.progress));
    skg_registration *r = prepare(&one, scene);
    skg_progress_release(&one.options.progress);
    ck_skg_fails(skg_registration_run(r), SKG_ERR_CANCELLED, "the best pose so far stands");
    const skg_registration_result result = result_of(r);
    ck_assert_int_eq(result.verdict, SKG_REGISTRATION_VERDICT_STOPPED);
    ck_assert(result.loss <= result.loss_start);
    skg_registration_release(&r);
    skg_scene_release(&scene);
}
END_TEST

/* Twelve balls whose place is known give the nine numbers of a view. */
START_TEST(a_phantom_calibrates_a_view) {
    skg_scene *scene;
    skg_registration *r;
    skg_registration_options options;
    static double values[PIXELS];
    ck_skg(skg_scene_create(context, &scene));
    for (int b = 0; b < 12; b++) {
        char label[16];
        skg_mesh *ball;
        snprintf(label, sizeof label, "ball %d", b);
        ck_skg(skg_mesh_create_sphere(4, 24, &ball));
        add(scene, ball, 2, label, -1, 35 * cos(1.9 * b), 35 * sin(1.9 * b), -44 + 8.0 * b);
    }
    const skg_view truth = view_from(0);
    skg_view wrong = truth, found;
    render(scene, &truth, SKG_QUANTITY_ATTENUATION, 0, 2, values);
    skg_registration_options_init(&options);
    options.free = SKG_REGISTRATION_FREE_SOURCE | SKG_REGISTRATION_FREE_DETECTOR;
    options.steps = 60, options.margin_mm = 8;
    wrong.source[0] += 3, wrong.source[1] -= 4, wrong.source[2] += 2;
    wrong.centre[0] -= 2, wrong.centre[1] += 2, wrong.centre[2] += 1.5;
    ck_skg(skg_registration_create(context, scene, mono, NULL, &options, &r));
    for (int64_t p = 0; p < 12; p++) ck_skg(skg_registration_part_add(r, p));
    add_image(r, &wrong, values);
    ck_skg(skg_registration_run(r));
    skg_view_init(&found);
    ck_skg(skg_registration_view_get(r, 0, &found));
    for (int k = 0; k < 3; k++) { /* the least step of the search, a thousandth of the pixel of 2 mm */
        ck_assert_double_eq_tol(found.centre[k], truth.centre[k], 0.002);
        ck_assert_double_eq_tol(found.source[k], truth.source[k], 0.002);
    }
    ck_assert_int_eq(result_of(r).directions, 9);
    skg_registration_release(&r);
    skg_scene_release(&scene);
}
END_TEST

static void check_image(skg_registration *r, skg_radiograph *image, const char *text) {
    ck_skg_fails(skg_registration_image_add(r, image), SKG_ERR_ARGUMENT, text);
}

START_TEST(wrong_radiographs_are_named) {
    run_of one = usual();
    skg_scene *scene = make_scene();
    skg_registration *r;
    static double values[PIXELS], mask[PIXELS], flat[PIXELS];
    const skg_view view = view_from(0);
    skg_radiograph image;
    ck_skg(skg_registration_create(context, scene, mono, NULL, &one.options, &r));
    ck_skg_fails(skg_registration_run(r), SKG_ERR_ARGUMENT, "there is no radiograph");
    skg_radiograph_init(&image);
    image.view = &view, image.values = values, image.name = "a.mha";
    check_image(r, &image, "a.mha: every value is 0");
    for (int p = 0; p < PIXELS; p++) values[p] = flat[p] = 1 + p % 7;
    values[2 * SIDE + 5] = (double)NAN;
    check_image(r, &image, "row 2, column 5 is not finite");
    values[2 * SIDE + 5] = 1;
    image.mask = mask;
    check_image(r, &image, "the mask hides every pixel");
    image.mask = NULL, image.flat = flat, flat[3] = 0;
    check_image(r, &image, "the flat field is 0 in row 0, column 3");
    image.flat = NULL, image.flat_field = -1;
    check_image(r, &image, "the flat field is -1");
    image.flat_field = 0;
    ck_skg(skg_registration_image_add(r, &image));
    ck_skg_fails(skg_registration_run(r), SKG_ERR_ARGUMENT, "no part was chosen");
    ck_skg_fails(skg_registration_part_add(r, PARTS), SKG_ERR_ARGUMENT, "is not below 5");
    ck_skg(skg_registration_part_add(r, KNOB));
    ck_skg_fails(skg_registration_part_add(r, KNOB), SKG_ERR_ARGUMENT, "was added before");
    skg_registration_result result;
    skg_registration_result_init(&result);
    ck_skg_fails(skg_registration_result_get(r, &result), SKG_ERR_ARGUMENT,
                 "call skg_registration_run first");
    skg_registration_release(&r);
    skg_scene_release(&scene);
}
END_TEST

START_TEST(parts_out_of_sight_are_named) {
    static const struct {
        double shift[3];
        const char *text;
    } cases[] = {{{500, 0, 0}, "body knob is not seen in this view"},
                 {{0, 400, 0}, "body knob lies behind the detector"},
                 {{0, -900, 0}, "body knob lies behind the source"}};
    skg_scene *scene = make_scene();
    static double values[PIXELS];
    const skg_view view = view_from(0);
    render(scene, &view, SKG_QUANTITY_ATTENUATION, 0, 2, values);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        run_of one = usual();
        skg_registration *r;
        memcpy(one.options.start, cases[k].shift, sizeof cases[k].shift);
        ck_skg(skg_registration_create(context, scene, mono, NULL, &one.options, &r));
        ck_skg(skg_registration_part_add(r, KNOB));
        add_image(r, &view, values);
        ck_skg_fails(skg_registration_run(r), SKG_ERR_ARGUMENT, cases[k].text);
        skg_registration_release(&r);
    }
    skg_scene_release(&scene);
}
END_TEST

START_TEST(wrong_options_are_named) {
    skg_scene *scene = make_scene();
    skg_registration *r;
    skg_registration_options options;
    skg_registration_options_init(&options);
    options.free = SKG_REGISTRATION_FREE_POSE | SKG_REGISTRATION_FREE_SOURCE;
    ck_skg_fails(skg_registration_create(context, scene, mono, NULL, &options, &r), SKG_ERR_ARGUMENT,
                 "cannot be told apart");
    options.free = SKG_REGISTRATION_FREE_SOURCE, options.restarts = 3;
    ck_skg_fails(skg_registration_create(context, scene, mono, NULL, &options, &r), SKG_ERR_ARGUMENT,
                 "restarts are of a pose");
    skg_registration_options_init(&options);
    options.margin_mm = -1;
    ck_skg_fails(skg_registration_create(context, scene, mono, NULL, &options, &r), SKG_ERR_ARGUMENT,
                 "margin_mm");
    ck_assert_ptr_null(r);
    skg_scene_release(&scene);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, twists_are_their_own_inverse);
    tcase_add_test(tests, every_loss_finds_the_body);
    tcase_add_test(tests, a_body_in_a_volume_of_cells_is_found);
    tcase_add_test(tests, other_densities_are_found);
    tcase_add_test(tests, structure_is_shown_where_it_is);
    tcase_add_test(tests, noise_displaces_as_sigma_says);
    tcase_add_test(tests, the_beam_of_one_view_is_the_least_certain);
    tcase_add_test(tests, a_needle_thinner_than_a_pixel_is_found);
    tcase_add_test(tests, restarts_find_it_from_afar);
    tcase_add_test(tests, a_cancelled_one_keeps_the_best);
    tcase_add_test(tests, a_phantom_calibrates_a_view);
    tcase_add_test(tests, wrong_radiographs_are_named);
    tcase_add_test(tests, parts_out_of_sight_are_named);
    tcase_add_test(tests, wrong_options_are_named);
}

SKG_SUITE_MAIN("registration", add_tests)
