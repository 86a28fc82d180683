/* The 3D view: what covers what, where points appear, colours through translucent parts, and errors. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 240 };

static skg_context *context;
static skg_scene *scene;
static skg_view view;
static skg_look look;
static uint8_t picture[SIDE * SIDE * 4], other[SIDE * SIDE * 4];
static const uint8_t RED = 200, GREEN = 120, BLUE = 40;

/* A detector of 200 x 100 mm behind the origin, seen from the source at -y: columns along x, rows downward. */
static void set_up(void) {
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_scene_create(context, &scene));
    skg_view_init(&view);
    view.columns = 20, view.rows = 10;
    view.source[1] = -1000, view.centre[1] = 500;
    view.column_step[0] = 10, view.row_step[2] = -10;
    skg_look_init(&look);
    look.columns = look.rows = SIDE;
    look.from[1] = -1;
    look.orthographic = 1;
}

static void tear_down(void) {
    skg_scene_release(&scene);
    skg_context_release(&context);
}

/* A cuboid with its centre at (x, y, z), in `inside` or -1. */
static void add_box(const char *label, double length, double x, double y, double z, int64_t inside) {
    skg_part part;
    skg_part_init(&part);
    ck_skg(skg_mesh_create_cuboid(length, length, length, &part.mesh));
    ck_skg(skg_material_create_mu("grey", 0.2, &part.material));
    part.label = label;
    part.inside = inside;
    part.pose[3] = x, part.pose[7] = y, part.pose[11] = z;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
}

static const uint8_t *pixel_at(const uint8_t *rgba, double x, double y, double z) {
    const double point[3] = {x, y, z};
    double place[2];
    ck_skg(skg_scene_places_get(scene, &view, &look, 1, point, place));
    ck_assert(place[0] > -0.5 && place[0] < (double)look.columns - 0.5);
    ck_assert(place[1] > -0.5 && place[1] < (double)look.rows - 0.5);
    return rgba + 4 * (lround(place[1]) * look.columns + lround(place[0]));
}

static void draw(uint8_t *rgba) {
    ck_skg(skg_scene_picture(context, scene, &view, &look, rgba));
}

/* Whether a pixel has the hue of a colour: the channels that are lit have its ratios, give or take rounding and gleam. */
static int has_hue(const uint8_t *pixel, const uint8_t *colour) {
    return abs(pixel[0] * colour[1] - pixel[1] * colour[0]) < 12 * 255 &&
           abs(pixel[1] * colour[2] - pixel[2] * colour[1]) < 12 * 255;
}

/* The scene is 200 mm wide and fills 92 % of the picture: 0.92 * 240 / 200 pixels for a mm. */
START_TEST(places_of_an_orthographic_view) {
    const double points[2][3] = {{0, 0, 0}, {70, 33, -20}}, scale = 0.92 * SIDE / 200,
                 middle = SIDE / 2 - 0.5;
    double places[2][2];
    add_box("box", 20, 0, 0, 0, -1);
    ck_skg(skg_scene_places_get(scene, &view, &look, 2, points[0], places[0]));
    /* positions are float: 1000 mm * 2^-24 * pixels for a mm */
    const double rounding = 1e-3;
    ck_assert_double_eq_tol(places[0][0], middle, rounding);
    ck_assert_double_eq_tol(places[0][1], middle, rounding);
    ck_assert_double_eq_tol(places[1][0], middle + 70 * scale, rounding);
    ck_assert_double_eq_tol(places[1][1], middle + 20 * scale, rounding);
}
END_TEST

/* From any side, in perspective or not: source, corners of the detector and of the box are in the picture. */
START_TEST(everything_is_in_the_picture) {
    static const double sides[][3] = {{0, 0, 0}, {0, -1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {-3, 2, 0.5}};
    const double points[6][3] = {{0, -1000, 0},  {-100, 500, -50}, {100, 500, -50},
                                 {100, 500, 50}, {-100, 500, 50},  {90, 10, 130}};
    add_box("box", 20, 80, 0, 120, -1);
    for (size_t i = 0; i < 2 * sizeof sides / sizeof *sides; i++) {
        double places[6][2];
        memcpy(look.from, sides[i / 2], sizeof look.from);
        look.orthographic = (int32_t)(i % 2);
        ck_skg(skg_scene_places_get(scene, &view, &look, 6, points[0], places[0]));
        for (int p = 0; p < 6; p++)
            for (int k = 0; k < 2; k++)
                ck_assert_msg(places[p][k] > 0 && places[p][k] < SIDE - 1, "side %zu, point %d: %g", i, p,
                              places[p][k]);
    }
}
END_TEST

START_TEST(the_nearer_part_covers_the_farther_one) {
    const uint8_t colours[2][4] = {{RED, GREEN, BLUE, 255}, {BLUE, RED, GREEN, 255}};
    add_box("near", 30, 0, -50, 0, -1);
    add_box("far", 60, 0, 50, 0, -1);
    look.colours = colours[0];
    draw(picture);
    ck_assert(has_hue(pixel_at(picture, 3, -65, 2), colours[0]));
    ck_assert(has_hue(pixel_at(picture, 24, 20, -24), colours[1]));
    look.from[1] = 1; /* from behind the detector, which covers both */
    draw(picture);
    ck_assert(!has_hue(pixel_at(picture, 0, 80, 0), colours[1]));
    look.from[1] = 0, look.from[0] = 1; /* from the side they are beside each other */
    draw(picture);
    ck_assert(has_hue(pixel_at(picture, 15, -50, 3), colours[0]));
    ck_assert(has_hue(pixel_at(picture, 30, 50, 3), colours[1]));
}
END_TEST

/* Opacity a over what is behind: a T + (1 - a) O, of pictures with the part opaque and without it. */
START_TEST(translucent_parts_blend) {
    uint8_t colours[2][4] = {{RED, GREEN, BLUE, 255}, {BLUE, RED, GREEN, 255}};
    const double opacity = 102.0 / 255;
    uint8_t opaque[3], without[3];
    add_box("near", 60, 0, -80, 0, -1);
    add_box("far", 40, 0, 20, 0, -1);
    look.colours = colours[0];
    draw(picture);
    memcpy(opaque, pixel_at(picture, 5, -110, 5), 3);
    colours[0][3] = 0;
    draw(picture);
    memcpy(without, pixel_at(picture, 5, 0, 5), 3);
    colours[0][3] = 102;
    draw(picture);
    const uint8_t *both = pixel_at(picture, 5, -110, 5);
    for (int k = 0; k < 3; k++) { /* its back is seen through its front, with the same colour */
        const double through = (1 - opacity) * (1 - opacity);
        /* each picture is rounded to half a grey level, and so is the shade before it is blended */
        ck_assert_double_eq_tol(both[k], (1 - through) * opaque[k] + through * without[k], 2);
    }
}
END_TEST

/* A sample on the edge of two triangles belongs to one of them: the diagonal of a translucent face cannot be seen. */
START_TEST(edges_of_triangles_do_not_show) {
    const uint8_t colours[4] = {RED, GREEN, BLUE, 70};
    add_box("box", 90, 0, 0, 0, -1);
    look.colours = colours;
    for (int turn = 0; turn < 2; turn++) {
        look.up[0] = turn ? 0.3 : 0, look.up[2] = 1;
        draw(picture);
        const uint8_t *corner = pixel_at(picture, -9, -45, 34);
        for (int k = 0; k < 18;
             k++) /* below the diagonals and between the edges of the beam, which cross in the middle */
            ck_assert_mem_eq(pixel_at(picture, k - 9, -45, 34), corner, 4);
        ck_assert_mem_eq(pixel_at(picture, 34, -45, 34), corner, 4);
        ck_assert_mem_eq(pixel_at(picture, -34, -45, 34), corner, 4);
    }
}
END_TEST

/* A pile of translucent boxes: the order in which parts are added does not matter, nor does the number of threads. */
START_TEST(the_bytes_depend_on_the_scene_alone) {
    uint8_t colours[6][4], turned[6][4];
    skg_context *one = NULL;
    skg_scene *first = NULL;
    char label[6][8];
    for (int i = 0; i < 6; i++) {
        colours[i][0] = (uint8_t)(40 * i), colours[i][1] = 99, colours[i][2] = (uint8_t)(255 - 40 * i);
        colours[i][3] = i == 5 ? 255 : 80;
        memcpy(turned[5 - i], colours[i], 4);
        snprintf(label[i], sizeof label[i], "%d", i);
    }
    for (int i = 0; i < 6; i++) add_box(label[i], 40 + 3 * i, 5 * i, -100 + 31 * i, 3 * i, -1);
    look.from[0] = 0.4, look.orthographic = 0;
    look.colours = colours[0];
    draw(picture);
    first = scene, scene = NULL;
    ck_skg(skg_scene_create(context, &scene));
    for (int i = 5; i >= 0; i--) add_box(label[i], 40 + 3 * i, 5 * i, -100 + 31 * i, 3 * i, -1);
    look.colours = turned[0];
    draw(other);
    ck_assert_mem_eq(picture, other, sizeof picture);
    if (skg_context_create("threads=1", &one) == SKG_OK) { /* not every device can be parted */
        ck_skg(skg_scene_picture(one, scene, &view, &look, other));
        ck_assert_mem_eq(picture, other, sizeof picture);
        skg_context_release(&one);
    }
    skg_scene_release(&first);
}
END_TEST

/* The image lies on the detector as the view says: pixel (row 1, column 2) is bright. */
START_TEST(the_detector_shows_its_image) {
    uint8_t image[10 * 20] = {0};
    const uint8_t colours[4] = {RED, GREEN, BLUE, 255};
    image[1 * 20 + 2] = 250;
    add_box("box", 10, 0, 0, -30, -1);
    look.colours = colours;
    look.image = image;
    for (int perspective = 0; perspective < 2; perspective++) {
        look.orthographic = !perspective;
        look.from[0] = perspective ? 0.3 : 0;
        draw(picture);
        const double x = (2 - 9.5) * 10, z = (1 - 4.5) * -10;
        ck_assert_int_eq(pixel_at(picture, x, 500, z)[1], 250);
        ck_assert_int_eq(pixel_at(picture, x + 10, 500, z)[1], 0);
        ck_assert_int_eq(pixel_at(picture, x, 500, z - 10)[1], 0);
        ck_assert_int_eq(pixel_at(picture, -x, 500, z)[1], 0);
    }
}
END_TEST

/* The edge of a cube is a crease: its faces are flat. A sphere is smooth: its brightness has no steps of facets. */
START_TEST(creases_and_smooth_surfaces) {
    const uint8_t colours[2][4] = {{RED, RED, RED, 255}, {RED, RED, RED, 0}};
    skg_part part;
    add_box("box", 60, 0, 0, 0, -1);
    skg_part_init(&part);
    ck_skg(skg_mesh_create_sphere(40, 24, &part.mesh));
    ck_skg(skg_material_create_mu("grey", 0.2, &part.material));
    part.label = "ball";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    look.colours = colours[0];
    draw(picture);
    ck_assert_int_eq(pixel_at(picture, -20, -30, -20)[0], pixel_at(picture, 22, -30, 25)[0]);
    const uint8_t turned[2][4] = {{RED, RED, RED, 0}, {RED, RED, RED, 255}};
    look.colours = turned[0];
    draw(picture);
    const uint8_t *row = pixel_at(picture, 0, -31, 25) - 4 * 18; /* where no edge of the beam passes */
    for (int k = 1; k < 36; k++) /* 24 facets around would make steps of about 10 */
        ck_assert_int_le(abs(row[4 * k] - row[4 * k - 4]), 4);
}
END_TEST

START_TEST(the_path_of_a_source_is_drawn) {
    const double path[2][3] = {{-60, 0, 80}, {60, 0, 80}};
    add_box("box", 10, 0, 0, 0, -1);
    draw(other);
    look.path = path[0], look.path_count = 2;
    draw(picture);
    const uint8_t *at = pixel_at(picture, 31, 0, 80);
    ck_assert_int_lt(at[1], 130); /* violet over the light background */
    ck_assert_int_gt(at[2], at[1] + 30);
}
END_TEST

static int grey_of(const uint8_t *at) {
    return (at[0] + at[1] + at[2]) / 3;
}

/* Frame and path are dark on a light background, and light on a dark one. */
START_TEST(lines_stand_out_from_the_background) {
    const uint8_t dark[3] = {20, 22, 26}, light[3] = {230, 230, 230};
    const double path[2][3] = {{-60, 0, 80}, {60, 0, 80}};
    double detector[4][3], edge[3];
    add_box("box", 10, 0, 0, 0, -1);
    look.path = path[0], look.path_count = 2;
    ck_skg(skg_collimation_corners_get(NULL, &view, 0, detector[0]));
    for (int k = 0; k < 3; k++) edge[k] = 0.5 * (detector[0][k] + detector[1][k]);
    look.background = light;
    draw(picture);
    look.background = dark;
    draw(other);
    ck_assert_int_lt(grey_of(pixel_at(picture, edge[0], edge[1], edge[2])), 170);
    ck_assert_int_gt(grey_of(pixel_at(other, edge[0], edge[1], edge[2])), 80);
    ck_assert_int_lt(grey_of(pixel_at(picture, 31, 0, 80)), 170);
    ck_assert_int_gt(grey_of(pixel_at(other, 31, 0, 80)), 110);
}
END_TEST

static int is_orange(const uint8_t *at) {
    return at[0] > at[2] + 60 && at[0] > at[1] + 20;
}

/* The edges of the beam go through the corners of the opening, and no longer to those of the detector. */
START_TEST(jaws_leave_a_smaller_beam) {
    skg_collimation jaws;
    double detector[4][3], field[4][3], opening[4][3];
    add_box("box", 10, -60, 0, 0, -1);
    skg_collimation_init(&jaws);
    jaws.kind = SKG_COLLIMATION_RECTANGLE, jaws.distance_mm = 300;
    jaws.low[0] = 2, jaws.high[0] = 12, jaws.low[1] = -2, jaws.high[1] = -1;
    look.from[0] = 1, look.from[1] = 0; /* from the side: 6 mm a pixel */
    ck_skg(skg_collimation_corners_get(NULL, &view, 0, detector[0]));
    ck_skg(skg_collimation_corners_get(&jaws, &view, 0, field[0]));
    const double middle = 0.5 * (view.source[1] + view.centre[1]), height = 0.5 * detector[0][2];
    draw(other);
    ck_assert(is_orange(pixel_at(other, 0.5 * detector[1][0], middle, height)));
    look.collimation = &jaws;
    draw(picture);
    ck_assert(!is_orange(pixel_at(picture, 0.5 * detector[1][0], middle, height)));
    ck_assert(is_orange(pixel_at(picture, 0.5 * field[1][0], middle, 0.5 * field[1][2])));
    look.from[0] = 0, look.from[1] = -1; /* from the source: less than a mm a pixel */
    jaws.low[1] = -8;
    ck_skg(skg_collimation_corners_get(&jaws, &view, 1, opening[0]));
    draw(picture);
    const uint8_t *edge =
        pixel_at(picture, 0.5 * (opening[0][0] + opening[1][0]), opening[0][1], opening[0][2]);
    ck_assert(edge[0] < 150 && edge[1] < 150 && edge[2] < 150); /* the frame of the opening */
    jaws.distance_mm = 2000;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_SCENE,
                 "behind the detector");
}
END_TEST

static int heard;

static void hear(skg_status status, const char *sentence, void *user) {
    (void)status, (void)sentence, (void)user;
    heard++;
}

/* Both calls take the context, so both report. */
START_TEST(failures_are_reported) {
    ck_skg(skg_context_error_set(context, hear, NULL));
    heard = 0;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_SCENE, "no parts");
    ck_assert_int_eq(heard, 1);
    ck_skg_fails(skg_scene_create(context, NULL), SKG_ERR_ARGUMENT, "skg_scene_create");
    ck_assert_int_eq(heard, 2);
}
END_TEST

/* A part that moves does not move the eye while the bounds stay. */
START_TEST(bounds_hold_the_eye) {
    const double bounds[6] = {-30, -30, -30, 30, 30, 30}, point[3] = {100, 500, 50};
    double before[2], after[2], pose[16] = {1, 0, 0, 250, 0, 1, 0, -40, 0, 0, 1, 9, 0, 0, 0, 1};
    add_box("box", 30, 0, 0, 0, -1);
    look.from[0] = 0.5, look.orthographic = 0;
    ck_skg(skg_scene_places_get(scene, &view, &look, 1, point, before));
    ck_skg(skg_scene_part_pose_set(scene, 0, pose));
    ck_skg(skg_scene_places_get(scene, &view, &look, 1, point, after));
    ck_assert_double_ne(before[0], after[0]);
    look.bounds = bounds;
    ck_skg(skg_scene_places_get(scene, &view, &look, 1, point, after));
    ck_skg(skg_scene_part_pose_set(scene, 0,
                                   (const double[16]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
    ck_skg(skg_scene_places_get(scene, &view, &look, 1, point, before));
    ck_assert_mem_eq(before, after, sizeof before);
    draw(picture);
    const double turned[6] = {-30, 30, -30, 30, -30, 30};
    look.bounds = turned;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_ARGUMENT, "along y");
}
END_TEST

/* With a target the eye stands where it is told: places by the formula of a pinhole, with a field of 28 degrees. */
START_TEST(a_target_places_the_eye) {
    const double target[3] = {10, -20, 5}, points[3][3] = {{10, -20, 5}, {30, 40, -12}, {-25, 0, 20}};
    const double half = tan(14 * 3.14159265358979 / 180), distance = 300;
    double places[3][2];
    add_box("box", 20, 0, 0, 0, -1);
    look.target = target, look.distance = distance;
    for (int parallel = 0; parallel < 2; parallel++) {
        look.orthographic = parallel;
        ck_skg(skg_scene_places_get(scene, &view, &look, 3, points[0], places[0]));
        for (int i = 0; i < 3; i++) {
            const double depth = parallel ? distance : distance + points[i][1] - target[1];
            const double scale = 0.5 * SIDE / (half * depth), middle = 0.5 * SIDE - 0.5;
            /* positions are float: 1000 mm * 2^-24 * pixels for a mm */
            ck_assert_double_eq_tol(places[i][0], middle + scale * (points[i][0] - target[0]), 1e-3);
            ck_assert_double_eq_tol(places[i][1], middle - scale * (points[i][2] - target[2]), 1e-3);
        }
    }
    look.distance = 0;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_ARGUMENT, "0 mm from");
    const double nowhere[3] = {0, (double)NAN, 0};
    look.distance = 1, look.target = nowhere;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_ARGUMENT, "target");
}
END_TEST

/* The eye within a box sees its far wall alone, the box beyond it, and the detector, a corner of which is behind the eye. */
START_TEST(what_is_behind_the_eye_is_not_drawn) {
    const uint8_t colours[2][4] = {{0, 0, BLUE, 255}, {RED, 0, 0, 255}}, background[3] = {11, 22, 33};
    const double target[3] = {0, 10, 0};
    uint8_t image[10 * 20];
    memset(image, 99, sizeof image);
    add_box("room", 100, 0, 0, 0, -1);
    add_box("box", 4, 0, 20, 0, 0);
    look.colours = colours[0], look.background = background, look.image = image;
    look.target = target, look.distance = 12, look.orthographic = 0;
    draw(picture);
    ck_assert(pixel_at(picture, 0, 18, 0)[0] > 60 && pixel_at(picture, 0, 18, 0)[2] < 30); /* with gleam */
    ck_assert(pixel_at(picture, 8, 50, 8)[2] > 10 && pixel_at(picture, 8, 50, 8)[0] < 30);
    const uint8_t hidden[2][4] = {{0, 0, 0, 0}, {0, 0, 0, 0}};
    const double bounds[6] = {-50, -50, -50, 50, 50, 50};
    look.colours = hidden[0], look.bounds = bounds;
    draw(picture);
    ck_assert_int_eq(pixel_at(picture, 15, 500, 9)[0], 99); /* the detector, beside the beam's axis */
    look.from[1] = 1;                                       /* away from the detector, towards the source */
    draw(picture);
    ck_assert_int_eq(picture[0], 11);
    ck_assert_int_eq(picture[1], 22);
    ck_assert_int_eq(picture[2], 33);
    /* obliquely along the detector, whose left half is behind the eye */
    const double beside[3] = {50, 490, 0};
    look.target = beside, look.distance = 45;
    look.from[0] = -1, look.from[1] = -0.4;
    draw(picture);
    ck_assert_int_eq(pixel_at(picture, 60, 500, 1)[0], 99);
    ck_assert_int_eq(pixel_at(picture, 80, 500, -4)[1], 99);
}
END_TEST

/* A cut takes the near half of a box away: what is within it is seen, and its inside in one colour. The bytes on the kept side
 * do not change. */
START_TEST(a_cut_opens_parts) {
    const uint8_t colours[2][4] = {{RED, 0, 0, 255}, {0, GREEN, 0, 255}};
    const double cut[4] = {0, -1, 0, 0}; /* kept: y >= 0 */
    add_box("shell", 60, 0, 0, 0, -1);
    add_box("core", 20, 0, 0, 0, 0);
    look.colours = colours[0];
    draw(other);
    ck_assert(pixel_at(other, 8, -30, 8)[1] < 30); /* beside the source */
    look.cut = cut;
    draw(picture);
    /* the core is open too: both show the inside of their far walls, 0.7 of their colour */
    ck_assert_int_eq(pixel_at(picture, 8, 0, 8)[1], lround(0.7 * GREEN));
    ck_assert_int_eq(pixel_at(picture, 20, 0, 14)[0], lround(0.7 * RED));
    ck_assert_int_eq(pixel_at(picture, 20, 0, 14)[1], 0);
    look.from[1] = 1; /* from behind nothing is seen of it */
    draw(picture);
    look.cut = NULL;
    draw(other);
    ck_assert_int_eq(memcmp(pixel_at(picture, 10, 30, 10), pixel_at(other, 10, 30, 10), 4), 0);
    ck_assert(pixel_at(picture, 10, 30, 10)[0] > 60);
    const double nowhere[4] = {0, 1, 0, (double)INFINITY};
    look.cut = nowhere;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_ARGUMENT, "cut");
}
END_TEST

/* Poses of the look are those of the scene, bit for bit, and leave the scene as it is. */
START_TEST(poses_replace_those_of_the_scene) {
    double poses[2][16], pose[16] = {0, -1, 0, 35, 1, 0, 0, -5, 0, 0, 1, 12, 0, 0, 0, 1};
    skg_part part;
    add_box("box", 20, 0, 0, 0, -1);
    add_box("other", 10, 30, 0, 0, -1);
    for (int i = 0; i < 2; i++) {
        skg_part_init(&part);
        ck_skg(skg_scene_part_get(scene, i, &part));
        memcpy(poses[i], part.pose, sizeof poses[i]);
    }
    memcpy(poses[1], pose, sizeof pose);
    look.poses = poses[0];
    draw(picture);
    look.poses = NULL;
    draw(other);
    ck_assert(memcmp(picture, other, sizeof picture) != 0);
    ck_skg(skg_scene_part_pose_set(scene, 1, pose));
    draw(other);
    ck_assert_mem_eq(picture, other, sizeof picture);
    poses[1][7] = (double)NAN;
    look.poses = poses[0];
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_ARGUMENT,
                 "pose of part other");
}
END_TEST

START_TEST(default_colours) {
    uint8_t colours[4][4];
    skg_part part;
    skg_part_init(&part);
    add_box("room", 100, 0, 0, 0, -1);
    add_box("shell", 50, 0, 0, 0, 0);
    add_box("core", 20, 0, 0, 0, 1);
    ck_skg(skg_mesh_create_cuboid(10, 10, 10, &part.mesh));
    ck_skg(skg_material_create_named("Bone, cortical", &part.material));
    part.label = "bone", part.inside = 2;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    ck_skg(skg_look_colours_get(scene, colours[0]));
    ck_assert_int_lt(colours[0][3], 128); /* holds three parts */
    ck_assert_int_lt(colours[1][3], 128); /* holds two */
    ck_assert_int_eq(colours[2][3], 255); /* holds one, and is not the whole scene */
    ck_assert_int_eq(colours[3][3], 255);
    ck_assert(colours[3][0] > 200 && colours[3][0] > colours[3][2]); /* bone is ivory */
    draw(picture);
}
END_TEST

START_TEST(errors_name_the_thing) {
    const uint8_t none[4] = {1, 2, 3, 0};
    float *offsets = NULL;
    const double *origin;
    skg_part part;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_SCENE, "no parts");
    add_box("box", 10, 0, 0, 0, -1);
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, NULL), SKG_ERR_ARGUMENT, "rgba");
    look.colours = none;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_SCENE, "every part");
    look.colours = NULL;
    look.columns = SKG_LOOK_PIXELS_MAX + 1;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_ARGUMENT, "8193 columns");
    look.columns = SIDE;
    look.from[0] = (double)NAN;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_ARGUMENT, "not finite");
    look.from[0] = 0;
    look.path_count = 1;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_ARGUMENT, "path is NULL");
    look.path_count = 0;
    skg_part_init(&part);
    ck_skg(skg_scene_part_get(scene, 0, &part));
    ck_skg(skg_mesh_offsets_get(part.mesh, &offsets, &origin));
    offsets[10] = (float)INFINITY;
    ck_skg(skg_mesh_offsets_moved(part.mesh));
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_SCENE,
                 "part box: vertex 3");
    view.columns = 0;
    ck_skg_fails(skg_scene_picture(context, scene, &view, &look, picture), SKG_ERR_SCENE, "0 columns");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, places_of_an_orthographic_view);
    tcase_add_test(tests, everything_is_in_the_picture);
    tcase_add_test(tests, the_nearer_part_covers_the_farther_one);
    tcase_add_test(tests, translucent_parts_blend);
    tcase_add_test(tests, edges_of_triangles_do_not_show);
    tcase_add_test(tests, the_bytes_depend_on_the_scene_alone);
    tcase_add_test(tests, the_detector_shows_its_image);
    tcase_add_test(tests, creases_and_smooth_surfaces);
    tcase_add_test(tests, the_path_of_a_source_is_drawn);
    tcase_add_test(tests, lines_stand_out_from_the_background);
    tcase_add_test(tests, jaws_leave_a_smaller_beam);
    tcase_add_test(tests, failures_are_reported);
    tcase_add_test(tests, bounds_hold_the_eye);
    tcase_add_test(tests, a_target_places_the_eye);
    tcase_add_test(tests, what_is_behind_the_eye_is_not_drawn);
    tcase_add_test(tests, a_cut_opens_parts);
    tcase_add_test(tests, poses_replace_those_of_the_scene);
    tcase_add_test(tests, default_colours);
    tcase_add_test(tests, errors_name_the_thing);
}

SKG_SUITE_MAIN("3D view", add_tests)
