/* Scene files: what is read and what is refused. */
#include "core/maths.h"
#include "setup/setup_files.h"

#include <float.h>
#include <math.h>

static skg_part part_at(int64_t id) {
    skg_part part;
    skg_part_init(&part);
    ck_skg(skg_scene_part_get(setup->scene, id, &part));
    return part;
}

static void check_vector(const double *v, double x, double y, double z) {
    /* Sines and cosines of right angles in degrees are not quite 0, of some 100 mm. */
    ck_assert_double_eq_tol(v[0], x, 2048 * DBL_EPSILON * (1 + fabs(x)));
    ck_assert_double_eq_tol(v[1], y, 2048 * DBL_EPSILON * (1 + fabs(y)));
    ck_assert_double_eq_tol(v[2], z, 2048 * DBL_EPSILON * (1 + fabs(z)));
}

START_TEST(a_scene_file_is_read) {
    skg_view view;
    skg_scene *scene = NULL;
    skg_spectrum *spectrum = NULL;
    double kev = 0, photons = 0, mu = 0;
    int64_t parts = 0;
    write_file("scene.json", good);
    ck_skg(load());
    skg_view_init(&view);
    ck_skg(skg_setup_view_get(setup, &view));
    ck_assert_int_eq(view.projection, SKG_PROJECTION_POINT);
    ck_assert_int_eq(view.columns, 64);
    ck_assert_int_eq(view.rows, 48);
    check_vector(view.source, 0, -400, 0);
    check_vector(view.centre, 0, 100, 0);
    check_vector(view.row_step, 0, 0, -2);
    check_vector(view.column_step, -1, 0, 0); /* up x (source - detector) */
    ck_skg(skg_setup_spectrum_get(setup, &spectrum));
    ck_skg(skg_spectrum_bin_get(spectrum, 0, &kev, &photons));
    ck_assert_double_eq_tol(kev, 60, 16 * DBL_EPSILON * 60);
    ck_assert_double_eq(photons, 1000);
    ck_skg(skg_setup_scene_get(setup, &scene));
    ck_skg(skg_scene_part_count(scene, &parts));
    ck_assert_int_eq(parts, 2);
    skg_part skin = part_at(0), bone = part_at(1);
    ck_assert_str_eq(skin.label, "skin");
    ck_assert_int_eq(skin.inside, -1);
    ck_assert_int_eq(bone.inside, 0); /* the one outer sample is the parent */
    ck_skg(skg_material_attenuation_get(bone.material, 60, &mu));
    ck_assert_double_eq(mu, 0.5);
    skg_mesh_health health;
    skg_mesh_health_init(&health);
    ck_skg(skg_mesh_health_get(bone.mesh, &health));
    ck_assert_double_eq_tol(health.volume, 6000, 64 * DBL_EPSILON * 6000);
    check_vector(health.bounds + 3, 5, 10, 15);
}
END_TEST

START_TEST(set_up_outlives_nothing_it_gave_away) {
    skg_scene *scene = NULL;
    int64_t parts = 0;
    write_file("scene.json", good);
    ck_skg(load());
    ck_skg(skg_setup_scene_get(setup, &scene));
    ck_skg(skg_scene_retain(scene));
    skg_setup_release(&setup);
    ck_assert_ptr_null(setup);
    ck_skg(skg_scene_part_count(scene, &parts));
    ck_assert_int_eq(parts, 2);
    skg_scene_release(&scene);
}
END_TEST

/* Right is up x (source - detector), as gVXR has it: source (0,-100,0), detector (0,100,0), up z gives x. */
START_TEST(right_follows_from_up) {
    write_edited("[0, 0, -1]", "[0, 0, 2.5]"); /* of any length */
    ck_skg(load());
    check_vector(setup->view.row_step, 0, 0, 2);
    check_vector(setup->view.column_step, 1, 0, 0);
    write_edited("[0, 0, -1]", "[0, 0, -1], \"RightVector\": [1, 0, 1]"); /* skewed is fine */
    ck_skg(load());
    check_vector(setup->view.column_step, sqrt(0.5), 0, sqrt(0.5));
    write_edited("\"Size\": [6.4, 9.6, \"cm\"]", "\"Spacing\": [250, 500, \"um\"]");
    ck_skg(load());
    check_vector(setup->view.column_step, -0.25, 0, 0);
    check_vector(setup->view.row_step, 0, 0, -0.5);
}
END_TEST

static const char *const point_shapes[] = {"PointSource", "point", "CONE", "ConeBeam", "Cone beam"};
static const char *const parallel_shapes[] = {"ParallelBeam", "parallel", "PARALLELBEAM"};

START_TEST(shapes_of_sources) {
    char text[64];
    for (int i = 0; i < 5; i++) {
        snprintf(text, sizeof text, "\"%s\"", point_shapes[i]);
        write_edited("\"PointSource\"", text);
        ck_skg(load());
        ck_assert_int_eq(setup->view.projection, SKG_PROJECTION_POINT);
    }
    for (int i = 0; i < 3; i++) {
        snprintf(text, sizeof text, "\"%s\"", parallel_shapes[i]);
        write_edited("\"PointSource\"", text);
        ck_skg(load());
        ck_assert_int_eq(setup->view.projection, SKG_PROJECTION_PARALLEL);
    }
    write_edited("\"Position\": [0, -40, 0, \"cm\"],\n        \"Shape\": \"PointSource\"",
                 "\"Direction\": [0, 3, 0], \"Shape\": \"Parallel\"");
    ck_skg(load());
    ck_assert_int_eq(setup->view.projection, SKG_PROJECTION_PARALLEL_FROM_INFINITY);
    check_vector(setup->view.source, 0, 1, 0);
    check_vector(setup->view.column_step, -1, 0, 0);
}
END_TEST

/* M <- M T: the last entry acts on the vertices first. */
START_TEST(transforms_multiply_from_the_right) {
    double x[3] = {1, 2, 3};
    write_edited("[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [[\"Translation\", 1, 0, 0, \"cm\"],"
                                  "[\"Rotation\", 90, 0, 0, 2], [\"scaling\", 2, 1, 1]]");
    ck_skg(load());
    skg_part bone = part_at(1);
    skg_pose_point(bone.pose, x, x); /* (2,2,3), turned (-2,2,3), moved */
    check_vector(x, 8, 2, 3);
    write_edited("[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [[\"Matrix\", "
                                  "[0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1]]]");
    ck_skg(load());
    bone = part_at(1);
    double y[3] = {1, 2, 3};
    skg_pose_point(bone.pose, y, y);
    check_vector(y, 8, 21, 33);
}
END_TEST

/* Bounds of a part in the world. */
static void world_bounds(int64_t id, double *bounds) {
    skg_part part = part_at(id);
    int64_t vertices = 0, triangles = 0;
    double x[3 * 512];
    ck_skg(skg_mesh_count(part.mesh, &vertices, &triangles));
    ck_assert_int_le(vertices, 512);
    ck_skg(skg_mesh_positions_get(part.mesh, x, 3));
    for (int k = 0; k < 3; k++) bounds[k] = HUGE_VAL, bounds[3 + k] = -HUGE_VAL;
    for (int64_t i = 0; i < vertices; i++) {
        skg_pose_point(part.pose, x + 3 * i, x + 3 * i);
        for (int k = 0; k < 3; k++) {
            bounds[k] = fmin(bounds[k], x[3 * i + k]);
            bounds[3 + k] = fmax(bounds[3 + k], x[3 * i + k]);
        }
    }
}

START_TEST(makers) {
    double bounds[6];
    write_edited("\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Parallelepiped\": [10, 20, 30, \"mm\"]");
    ck_skg(load());
    world_bounds(1, bounds);
    check_vector(bounds + 3, 5, 10, 15);
    /* sectors, height, radius; the axis along y */
    write_edited("\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Cylinder\": [16, 30, 4, \"mm\"]");
    ck_skg(load());
    world_bounds(1, bounds);
    check_vector(bounds, -4, -15, -4);
    check_vector(bounds + 3, 4, 15, 4);
    write_edited("\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Sphere\": [16, 4, \"mm\"]");
    ck_skg(load());
    world_bounds(1, bounds);
    check_vector(bounds, -4, -4, -4);
    write_edited("\"Cuboid\": [1, 2, 3, \"cm\"]",
                 "\"Step Wedge\": {\"NumberOfSteps\": 5, \"TotalLength\": 5, \"Width\": 2, "
                 "\"FirstStepHeight\": 0.5, \"OtherStepHeight\": 0.5, \"Unit\": \"cm\"}");
    ck_skg(load());
    world_bounds(1, bounds);
    check_vector((double[3]){bounds[3] - bounds[0], bounds[4] - bounds[1], bounds[5] - bounds[2]}, 50, 20,
                 25);
}
END_TEST

START_TEST(samples_move_to_the_centre) {
    double bounds[6];
    /* one: before its Transform */
    write_edited("[\"mu\", 0.5]", "[\"mu\", 0.5], \"MoveToCenter\": true, \"Transform\": "
                                  "[[\"Translation\", 0, 0, 7, \"mm\"]]");
    ck_skg(load());
    world_bounds(1, bounds);
    check_vector(bounds + 3, 5, 10, 22);
    /* all together: bounds of both are 40 by 40 by -20..37 */
    write_edited("[\"mu\", 0.5]\n        }", "[\"mu\", 0.5], \"Transform\": [[\"Translation\", 0, 0, 22, "
                                             "\"mm\"]]\n        }, \"MoveToCentre\"");
    ck_skg(load());
    world_bounds(0, bounds);
    check_vector(bounds, -20, -20, -28.5);
    world_bounds(1, bounds);
    check_vector(bounds + 3, 5, 10, 28.5);
}
END_TEST

START_TEST(parents) {
    write_edited("[\"mu\", 0.5]", "[\"mu\", 0.5], \"Parent\": null");
    ck_skg(load());
    ck_assert_int_eq(part_at(1).inside, -1);
    /* a parent may come later in the file, and outer samples may have one */
    write_edited("\"Type\": \"outer\"", "\"Type\": \"outer\", \"Parent\": \"bone\"");
    write_edited("\"Type\": \"outer\"", "\"Parent\": \"bone\"");
    ck_skg(load());
    ck_assert_int_eq(part_at(0).inside, 1);
    ck_assert_int_eq(part_at(1).inside, -1);
    /* without an outer one, all stand in the world */
    write_edited("\"Type\": \"outer\",", "");
    ck_skg(load());
    ck_assert_int_eq(part_at(0).inside, -1);
    ck_assert_int_eq(part_at(1).inside, -1);
}
END_TEST

static void write_box(void) {
    skg_mesh *box = NULL;
    char full[128];
    snprintf(full, sizeof full, "%s/box.stl", folder);
    ck_skg(skg_mesh_create_cuboid(1, 2, 3, &box));
    ck_skg(skg_mesh_save(box, full));
    skg_mesh_release(&box);
}

/* Paths are relative to the scene file; a file used twice with the same unit is loaded once. */
START_TEST(mesh_files) {
    write_box();
    write_edited("\"Cuboid\": [1, 2, 3, \"cm\"],\n            \"Material\": [\"mu\", 0.5]\n        }",
                 "\"Path\": \"box.stl\", \"Unit\": \"cm\", \"Material\": [\"mu\", 0.5] },\n"
                 "{\"Label\": \"again\", \"Path\": \"box.stl\", \"Unit\": \"cm\", \"Material\": [\"mu\", "
                 "\"0.25\"], \"Density\": 1, \"Transform\": [[\"Scaling\", 1, 1, -1]]},\n"
                 "{\"Path\": \"box.stl\", \"Unit\": \"mm\", \"Material\": [\"mu\", 1], "
                 "\"FlipNormals\": true}");
    ck_skg(load());
    skg_part first = part_at(1), again = part_at(2), last = part_at(3);
    double mu = 0;
    ck_assert_ptr_eq(first.mesh, again.mesh);
    ck_assert_ptr_ne(first.mesh, last.mesh);
    ck_assert_str_eq(last.label, "box.stl");
    ck_skg(skg_material_attenuation_get(again.material, 60, &mu));
    ck_assert_double_eq(mu, 0.25);
    skg_mesh_health health;
    skg_mesh_health_init(&health);
    ck_skg(skg_mesh_health_get(first.mesh, &health));
    ck_assert_double_eq_tol(health.volume, 6000, 1e-2); /* float file: 1e-6 of it */
    ck_skg(skg_mesh_health_get(last.mesh, &health));
    ck_assert_double_gt(health.volume, 0); /* a closed mesh stays outward */
}
END_TEST

/* An open mesh is turned where the file says so, in every spelling, and not where it says false. */
START_TEST(open_meshes_are_flipped) {
    static const char *const keys[] = {"FlipNormals",  "flipNormal",    "flipNormalVectors",
                                       "invertNormal", "invertNormals", "invertNormalVectors"};
    int32_t corners[3];
    char text[256];
    write_file("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (int i = 0; i < 12; i++) {
        snprintf(text, sizeof text, "\"Path\": \"open.obj\", \"Unit\": \"mm\", \"%s\": %s", keys[i / 2],
                 i % 2 ? "true" : "false");
        write_edited("\"Cuboid\": [1, 2, 3, \"cm\"]", text);
        ck_skg(load());
        ck_skg(skg_mesh_triangles_get(part_at(1).mesh, corners, 3));
        ck_assert_int_eq(corners[1], i % 2 ? 2 : 1);
        ck_assert_int_eq(corners[2], i % 2 ? 1 : 2);
    }
}
END_TEST

START_TEST(scans_are_kept) {
    write_edited("\"Samples\"", "\"Scan\": {\"NumberOfProjections\": 200, \"FinalAngle\": 360, "
                                "\"IncludeFinalAngle\": false, \"CenterOfRotation\": [0, 0, 0], "
                                "\"OutFolder\": \"out\", \"Flat-Field Correction\": true, "
                                "\"NumberOfWhiteImages\": 5}, \"Samples\"");
    ck_skg(load());
    skg_scan *scan = NULL;
    int64_t count = 0;
    double angle = 0;
    ck_skg(skg_setup_scan_get(setup, &scan));
    ck_skg(skg_scan_projection_count(scan, &count));
    ck_assert_int_eq(count, 200);
    ck_skg(skg_scan_angle_get(scan, 100, &angle));
    ck_assert_double_eq_tol(angle, 3.14159265358979, 1e-14); /* as many digits as are written here */
    ck_assert_int_eq(setup->scan.flat_field, 1);
    ck_assert_int_eq(setup->scan.white_images, 5);
    check_vector(setup->view.source, 0, -400, 0);
    ck_assert_ptr_nonnull(strstr(setup->scan.folder, "/out"));
    int64_t projections = 0;
    ck_skg(skg_setup_projection_count_get(setup, &projections));
    ck_assert_int_eq(projections, 200);
}
END_TEST

START_TEST(projections_are_counted) {
    static const struct {
        const char *scan;
        int64_t count;
    } cases[] = {
        {"", 1},
        {"\"Scan\": {}, ", 0},
        {"\"Scan\": {\"NumberOfProjections\": 7}, ", 7},
        {"\"Scan\": {\"AngleStep\": 0.1, \"FinalAngle\": 360}, ", 3600},
        {"\"Scan\": {\"AngleStep\": 0.1, \"FinalAngle\": 360, \"IncludeFinalAngle\": true}, ", 3601},
        {"\"Scan\": {\"AngleStep\": 100, \"StartAngle\": 10, \"FinalAngle\": 360}, ", 4},
        {"\"Scan\": {\"AngleStep\": -1, \"FinalAngle\": 360}, ", 0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char with[256];
        int64_t projections = -1;
        snprintf(with, sizeof with, "%s\"Samples\"", cases[k].scan);
        write_edited("\"Samples\"", with);
        ck_skg(load());
        ck_skg(skg_setup_projection_count_get(setup, &projections));
        ck_assert_int_eq(projections, cases[k].count);
        skg_setup_release(&setup);
    }
}
END_TEST

/* The first projection turns the samples by +90 degrees about z through (100, 0, 0): source and detector turn
 * back. What was at distance 100 in front of the detector stays there. */
START_TEST(a_scan_gives_its_first_projection) {
    write_edited("\"Samples\"",
                 "\"Scan\": {\"NumberOfProjections\": 4, \"AngleStep\": 90, \"StartAngle\": 90, "
                 "\"CentreOfRotation\": [10, 0, 0, \"cm\"], \"RotationAxis\": [0, 0, 1]}, "
                 "\"Samples\"");
    ck_skg(load());
    check_vector(setup->view.source, -300, 100, 0);
    check_vector(setup->view.centre, 200, 100, 0);
    check_vector(setup->view.column_step, 0, 1, 0);
    check_vector(setup->view.row_step, 0, 0, -2);
    skg_plan_options options;
    skg_plan_options_init(&options);
    ck_skg(skg_setup_options_get(setup, &options)); /* 270 degrees on, and a sixteenth of it */
    ck_assert_int_eq(options.view_count, 16);
    check_vector(options.views[15].source, 0, -400, 0);
    const double angle = (180 - 270 / 16.0) * acos(-1) / 180;
    check_vector(options.views[0].source, 100 + 400 * cos(angle) + 100 * sin(angle),
                 400 * sin(angle) - 100 * cos(angle), 0);
}
END_TEST

START_TEST(options_are_given_on) {
    skg_plan_options options = {
        .size = sizeof options, .precision = SKG_PRECISION_SINGLE, .tile = 32, .overlaps = 1};
    write_edited("\"Samples\"", "\"Precision\": \"Double\", \"tolerance\": 1e-3, \"Samples\"");
    ck_skg(load());
    ck_skg(skg_setup_options_get(setup, &options));
    ck_assert_int_eq(options.precision, SKG_PRECISION_DOUBLE);
    ck_assert_int_eq(options.tile, 32); /* what the file does not say stays */
    ck_assert_double_eq(setup->said.tolerance, 1e-3);
    write_file("scene.json", good);
    ck_skg(load());
    ck_skg(skg_setup_options_get(setup, &options));
    ck_assert_int_eq(options.precision, SKG_PRECISION_DOUBLE);
    ck_assert_double_lt(setup->said.tolerance, 0);
}
END_TEST

START_TEST(mends_and_priorities) {
    skg_plan_options options;
    skg_plan_options_init(&options);
    write_edited("\"Opacity\": 0.4", "\"priority\": -3");
    ck_skg(load());
    ck_assert_int_eq(part_at(0).priority, -3);
    write_edited("\"Opacity\": 0.4", "\"Through\": true");
    ck_skg(load());
    ck_assert_int_eq(part_at(0).priority, INT32_MAX);
    write_edited("\"Opacity\": 0.4", "\"Priority\": -3, \"Through\": false");
    ck_skg(load());
    ck_assert_int_eq(part_at(0).priority, -3);
    ck_assert_int_eq(part_at(1).priority, 0);
    ck_skg(skg_setup_options_get(setup, &options));
    ck_assert_int_eq(options.repair, SKG_REPAIR_NEIGHBOURS); /* what the file does not say stays */
    ck_assert_int_eq(options.clip, 0);
    write_edited("\"Samples\"", "\"Repair\": \"Exact\", \"Clip\": true, \"Samples\"");
    ck_skg(load());
    ck_skg(skg_setup_options_get(setup, &options));
    ck_assert_int_eq(options.repair, SKG_REPAIR_EXACT);
    ck_assert_int_eq(options.clip, 1);
    write_edited("\"Samples\"", "\"Repair\": \"none\", \"Samples\"");
    ck_skg(load());
    ck_skg(skg_setup_options_get(setup, &options));
    ck_assert_int_eq(options.repair, SKG_REPAIR_NONE);
}
END_TEST

/* Maps of pixels, as bytes: A is 65. Lines are bad as a whole, and a later line wins. */
START_TEST(pixels_of_grey_values_differ) {
    enum { COLUMNS = 64, PIXELS = 64 * 48 };
    static char bytes[PIXELS + 1];
    const char *const settings[] = {
        "Detector.GreyValues={\"Gain\": {\"Path\": \"motion.csv\", \"Format\": \"uint8\"}, \"Saturation\": 50000, "
        "\"Offset\": {\"Path\": \"motion.csv\", \"Format\": \"int8\"}, \"BadColumns\": [[3, 0]], \"BadRows\": [[47, 777]]}",
        "Detector.GreyValues.BadRows=[[48, 0]]"};
    skg_readout r;
    memset(bytes, 'A', PIXELS);
    bytes[PIXELS - 1] = 'B';
    write_file("motion.csv", bytes);
    write_file("scene.json", good);
    ck_skg(skg_setup_load(NULL, path, 1, settings, &setup));
    skg_readout_init(&r);
    ck_skg(skg_setup_readout_get(setup, &r));
    ck_assert_double_eq((double)r.gain[0], 65);
    ck_assert_double_eq((double)r.offset[PIXELS - 1], 66);
    ck_assert_double_eq(r.saturation, 50000);
    ck_assert_double_eq((double)r.bad_pixels[2], -1);
    ck_assert_double_eq((double)r.bad_pixels[46 * COLUMNS + 3], 0);
    ck_assert_double_eq((double)r.bad_pixels[47 * COLUMNS + 3], 777);
    skg_setup_release(&setup);
    ck_skg_fails(skg_setup_load(NULL, path, 2, settings, &setup), SKG_ERR_FORMAT, "from 0 to 47");
}
END_TEST

START_TEST(settings_change_the_file) {
    const char *const settings[] = {"detector.numberofpixels=[32, 16]", "Samples.bone.Type=inner",
                                    "Samples.0.Cube=[2, \"cm\"]", "Precision=double", "Scan.StartAngle=180"};
    double bounds[6];
    write_file("scene.json", good);
    ck_skg(skg_setup_load(NULL, path, 5, settings, &setup));
    ck_assert_int_eq(setup->view.columns, 32);
    ck_assert_int_eq(setup->said.precision, SKG_PRECISION_DOUBLE);
    world_bounds(0, bounds);
    check_vector(bounds + 3, 10, 10, 10);
    check_vector(setup->view.source, 0, 400, 0); /* half a turn */
}
END_TEST

START_TEST(labels_with_dots_can_be_set) {
    const char *const settings[] = {"Samples.rib.l05.Material=[\"mu\", 0.75]"};
    double mu = 0;
    write_edited("\"bone\"", "\"rib.l05\"");
    ck_skg(skg_setup_load(NULL, path, 1, settings, &setup));
    ck_skg(skg_material_attenuation_get(part_at(1).material, 60, &mu));
    ck_assert_double_eq(mu, 0.75);
}
END_TEST

/* The example in docs/scene-files.md loads as it stands. */
START_TEST(the_example_of_the_manual_is_read) {
    char text[16384];
    FILE *stream = fopen(SKG_SOURCE "/docs/scene-files.md", "rb");
    ck_assert_ptr_nonnull(stream);
    text[fread(text, 1, sizeof text - 1, stream)] = '\0';
    fclose(stream);
    char *begin = strstr(text, "```json\n");
    ck_assert_ptr_nonnull(begin);
    begin += strlen("```json\n");
    char *end = strstr(begin, "```"), *mesh = strstr(begin, "bone.stl");
    ck_assert(end && mesh && mesh < end);
    *end = '\0';
    memcpy(mesh, "box.stl\"", 8); /* one shorter: the quote moves forward */
    mesh[8] = ' ';
    write_box();
    write_file("scene.json", begin);
    ck_skg(load());
    ck_assert_int_eq(part_at(1).inside, 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, a_scene_file_is_read);
    tcase_add_test(tests, set_up_outlives_nothing_it_gave_away);
    tcase_add_test(tests, right_follows_from_up);
    tcase_add_test(tests, shapes_of_sources);
    tcase_add_test(tests, transforms_multiply_from_the_right);
    tcase_add_test(tests, makers);
    tcase_add_test(tests, samples_move_to_the_centre);
    tcase_add_test(tests, parents);
    tcase_add_test(tests, mesh_files);
    tcase_add_test(tests, open_meshes_are_flipped);
    tcase_add_test(tests, scans_are_kept);
    tcase_add_test(tests, projections_are_counted);
    tcase_add_test(tests, a_scan_gives_its_first_projection);
    tcase_add_test(tests, options_are_given_on);
    tcase_add_test(tests, mends_and_priorities);
    tcase_add_test(tests, pixels_of_grey_values_differ);
    tcase_add_test(tests, settings_change_the_file);
    tcase_add_test(tests, the_example_of_the_manual_is_read);
    tcase_add_test(tests, labels_with_dots_can_be_set);
}

SKG_SUITE_MAIN("setup", add_tests)
