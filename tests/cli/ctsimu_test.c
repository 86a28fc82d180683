/* CTSimU scenarios as scenes of the command: what is computed, what is written, warned of and refused. */
#include "cli/command.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

enum { COLUMNS = 21, ROWS = 11, PIXELS = COLUMNS * ROWS, LIMIT = 1 << 20 };

/* A beam of one energy along x, an axis along z, a cube of 20 mm on it. The letters are replaced. */
static const char scenario[] =
    "{\"file\": {\"file_type\": \"CTSimU Scenario\", \"file_format_version\": {\"major\": 1, \"minor\": 2}},\n"
    "\"environment\": {\"material_id\": null},\n"
    "\"geometry\": {\n"
    " \"detector\": {\"center\": {\"x\": {\"value\": 100, \"unit\": \"mm\"}, \"y\": {\"value\": 0}, \"z\": {\"value\": 0}},\n"
    "  \"vector_u\": {\"x\": {\"value\": 0}, \"y\": {\"value\": -1}, \"z\": {\"value\": 0}},\n"
    "  \"vector_w\": {\"x\": {\"value\": 1}, \"y\": {\"value\": 0}, \"z\": {\"value\": 0}}},\n"
    " \"source\": {\"type\": \"cone\", \"center\": {\"x\": {\"value\": -90, \"unit\": \"cm\"}, \"y\": {\"value\": 0},\n"
    "  \"z\": {\"value\": 0}}, \"vector_u\": {\"x\": {\"value\": 0}, \"y\": {\"value\": -1}, \"z\": {\"value\": 0}},\n"
    "  \"vector_w\": {\"x\": {\"value\": 1}, \"y\": {\"value\": 0}, \"z\": {\"value\": 0}}},\n"
    " \"stage\": {\"center\": {\"x\": {\"value\": 0}, \"y\": {\"value\": 0}, \"z\": {\"value\": 0}},\n"
    "  \"vector_u\": {\"x\": {\"value\": 1}, \"y\": {\"value\": 0}, \"z\": {\"value\": 0}},\n"
    "  \"vector_w\": {\"x\": {\"value\": 0}, \"y\": {\"value\": 0}, \"z\": {\"value\": 1}}}},\n"
    "\"detector\": {\"columns\": {\"value\": 21}, \"rows\": {\"value\": 11},\n"
    " \"pixel_pitch\": {\"u\": {\"value\": 2, \"unit\": \"mm\"}, \"v\": {\"value\": 0.2, \"unit\": \"cm\"}},\n"
    " \"integration_time\": {\"value\": 500, \"unit\": \"ms\"}, \"gray_value\": {\"imax\": {\"value\": 50000},\n"
    " \"imin\": {\"value\": 100}}},\n"
    "\"source\": {\"voltage\": {\"value\": 60, \"unit\": \"kV\"}, \"current\": {\"value\": 1, \"unit\": \"mA\"},\n"
    " \"spectrum\": {\"monochromatic\": true}},\n"
    "\"samples\": [{\"name\": \"cube\", \"file\": {\"value\": \"cube.obj\"}, \"unit\": \"mm\", \"material_id\": \"water\",\n"
    " \"position\": {\"center\": {\"u\": {\"value\": 0}, \"v\": {\"value\": 0}, \"w\": {\"value\": 0}},\n"
    " \"vector_r\": {\"u\": {\"value\": 1}, \"v\": {\"value\": 0}, \"w\": {\"value\": 0}},\n"
    " \"vector_t\": {\"u\": {\"value\": 0}, \"v\": {\"value\": 0}, \"w\": {\"value\": 1}}}}],\n"
    "\"acquisition\": {\"start_angle\": {\"value\": 0}, \"stop_angle\": {\"value\": 180, \"unit\": \"deg\"},\n"
    " \"number_of_projections\": 4, \"direction\": \"CCW\",\n"
    " \"flat_field\": {\"number\": 2, \"frame_average\": 1, \"ideal\": false},\n"
    " \"dark_field\": {\"number\": 1, \"frame_average\": 1, \"ideal\": true}},\n"
    "\"materials\": [{\"id\": \"water\", \"density\": {\"value\": 1000, \"unit\": \"kg/m^3\"},\n"
    " \"composition\": [{\"formula\": {\"value\": \"H 2 O\"}, \"mass_fraction\": {\"value\": 2}}]}]}\n";

static const char cube[] =
    "v 5 5 5\nv 25 5 5\nv 25 25 5\nv 5 25 5\nv 5 5 25\nv 25 5 25\nv 25 25 25\nv 5 25 25\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

static void set_up_scenario(void) {
    set_up();
    write_text("box.json", scenario);
    write_text("cube.obj", cube);
}

static void tear_down_scenario(void) {
    char line[128];
    snprintf(line, sizeof line, "rm -rf %s", folder);
    ck_assert_int_eq(system(line), 0);
}

/* Writes a text with a piece of it replaced. */
static void write_edited(const char *whole, const char *from, const char *to) {
    static char text[sizeof scenario + 1024];
    const char *at = strstr(whole, from);
    ck_assert_msg(at != NULL, "no %s", from);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - whole), whole, to, at + strlen(from));
    write_text("box.json", text);
}

static void edit(const char *from, const char *to) {
    write_edited(scenario, from, to);
}

/* Replaces another piece. */
static void rewrite(const char *from, const char *to) {
    static char text[sizeof scenario + 1024];
    read_back("box.json", text, sizeof text);
    write_edited(text, from, to);
}

/* The last `count` elements of 16 bits of a file: pixels without compression end a stack. */
static void read_pixels(const char *name, int64_t count, uint16_t *pixels) {
    static char bytes[LIMIT];
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_msg(stream != NULL, "no %s", name);
    const size_t size = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    ck_assert_uint_gt(size, (size_t)count * 2);
    memcpy(pixels, bytes + size - (size_t)count * 2, (size_t)count * 2);
}

/* Water of 20 mm at 60 keV, with the coefficient that the command itself gives: 0.2059 1/cm. */
static double water_mu(void) {
    ck_run(0, "material water --energy 60 --json");
    json_t *object = said_json(), *row = json_array_get(member(object, "rows"), 0);
    const double mu = json_number_value(member(row, "mu_per_cm"));
    json_decref(object);
    return mu;
}

/* In the middle row and column the ray goes along x; the flat field is strongest there. */
START_TEST(grey_values_are_those_of_the_law) {
    uint16_t stack[4 * PIXELS];
    const int middle = (ROWS / 2) * COLUMNS + COLUMNS / 2;
    ck_run(0, "scan box.json -o scan.mha");
    read_pixels("scan.mha", 4 * PIXELS, stack);
    const double expected = 100 + 49900 * exp(-2 * water_mu());
    const double diagonal = 100 + 49900 * exp(-2 * sqrt(2) * water_mu());
    /* Half a grey value of rounding, and float's epsilon times 50000 a few times. */
    ck_assert_double_eq_tol(stack[middle], expected, 0.55);
    ck_assert_double_eq_tol(stack[PIXELS + middle], diagonal, 0.55);
    ck_assert_double_eq_tol(stack[2 * PIXELS + middle], expected, 0.55); /* as above */
    /* The corner of the free beam: inverse square and cosine. */
    const double r2 = 1e6 + 20.0 * 20 + 10.0 * 10;
    ck_assert_double_eq_tol(stack[0], 100 + 49900 * pow(1e6 / r2, 1.5), 0.55); /* as above */
}
END_TEST

START_TEST(a_folder_has_the_layout_of_the_format) {
    static const char *const names[] = {"box_0000.tif", "box_0003.tif", "box_flat_0000.tif",
                                        "box_flat_0001.tif", "box_dark.tif"};
    char text[8192], path[64];
    ck_run(0, "scan box.json -o proj --only 1");
    ck_run(0, "scan box.json -o proj");
    ck_assert(strstr(complained, "it is continued") != NULL);
    for (int i = 0; i < 5; i++) {
        snprintf(path, sizeof path, "proj/%s", names[i]);
        ck_assert_msg(has_file(path), "no %s", names[i]);
    }
    ck_assert(!has_file("proj/box_0004.tif"));
    read_back("proj/box_metadata.json", text, sizeof text);
    json_t *object = json_loads(text, 0, NULL);
    ck_assert_ptr_nonnull(object);
    json_t *projections = member(member(object, "output"), "projections");
    ck_assert_str_eq(json_string_value(member(projections, "filename")), "box_%04d.tif");
    ck_assert_str_eq(json_string_value(member(projections, "datatype")), "uint16");
    ck_assert_int_eq(json_integer_value(member(projections, "number")), 4);
    ck_assert_str_eq(json_string_value(member(member(projections, "flat_field"), "filename")),
                     "box_flat_%04d.tif");
    ck_assert_str_eq(json_string_value(member(member(projections, "dark_field"), "filename")),
                     "box_dark.tif");
    json_decref(object);
}
END_TEST

/* The current drifts to half of its value; a pixel is bad; the noise has its ratio; energies stay energies. */
START_TEST(current_bad_pixels_and_other_quantities) {
    uint16_t stack[4 * PIXELS], map[PIXELS];
    memset(map, 0xff, sizeof map); /* -1 */
    map[2] = 77;
    write_bytes("bad.raw", map, sizeof map);
    edit("\"imin\": {\"value\": 100}}",
         "\"imin\": {\"value\": 100}}, \"bad_pixel_map\": {\"file\": {\"value\": "
         "\"bad.raw\"}, \"type\": \"int16\"}");
    ck_run(0,
           "scan box.json -o scan.mha --set source.current.drifts='[{\"value\":[0,-0.75],\"unit\":\"mA\"}]'");
    ck_assert(strstr(complained, "drifts") == NULL);
    read_pixels("scan.mha", 4 * PIXELS, stack);
    ck_assert_uint_eq(stack[2], 77);
    /* Half a grey value of rounding in both. */
    ck_assert_double_eq_tol(stack[2 * PIXELS] - 100.0, 0.5 * (stack[0] - 100.0), 1);
    ck_run(0, "scan box.json -o energies.mha --quantity energy");
    ck_run_fails(2, "exclude each other", "scan box.json -o other.mha --quantity energy --grey16");
    ck_run_fails(5, "another scan", "scan box.json -o scan.mha --quantity energy");
}
END_TEST

/* A share of each projection is found in the next one, and no later; of two averaged frames the first has it. */
START_TEST(image_lag_is_that_of_the_next_frame) {
    uint16_t plain[4 * PIXELS], lagged[4 * PIXELS];
    ck_run(0, "scan box.json -o plain.mha");
    read_pixels("plain.mha", 4 * PIXELS, plain);
    for (int frames = 1; frames <= 2; frames++) {
        const double share = 0.2 / frames;
        ck_run(0,
               "scan box.json -o lagged.mha --overwrite --set detector.image_lag='{\"value\":0.2}' --set "
               "acquisition.frame_average=%d",
               frames);
        read_pixels("lagged.mha", 4 * PIXELS, lagged);
        for (int i = 0; i < 4 * PIXELS; i++) {
            const double before = i < PIXELS ? 100 : plain[i - PIXELS];
            /* Half a grey value of rounding, of three numbers */
            ck_assert_double_eq_tol(lagged[i], plain[i] + share * (before - plain[i]), 1.1);
        }
    }
}
END_TEST

START_TEST(what_is_not_simulated_is_a_warning) {
    edit("\"imin\"", "\"colour\": 3, \"imin\"");
    ck_run(0,
           "scan box.json -o a.mha --set geometry.source.beam_divergence=1 --set acquisition.scattering=true "
           "--set source.voltage.drifts='[{\"value\":[0,10]}]' --set detector.novelty=3 "
           "--set acquisition.scan_mode='\"continuous\"'");
    ck_assert_ptr_nonnull(strstr(complained, "geometry.source.beam_divergence: is not simulated"));
    ck_assert_ptr_nonnull(strstr(complained, "acquisition.scattering: is not simulated"));
    ck_assert_ptr_nonnull(strstr(complained, "source.voltage.drifts: is not simulated"));
    ck_assert_ptr_nonnull(strstr(complained, "detector.novelty: is no key of CTSimU"));
    ck_assert_ptr_nonnull(strstr(complained, "acquisition.scan_mode: the stage stands still"));
    edit("]}]}\n", "]},]}\n");
    ck_run(0, "scan box.json -o b.mha");
    ck_assert_ptr_nonnull(strstr(complained, "a comma before a closing bracket is passed over"));
}
END_TEST

START_TEST(what_cannot_be_read_is_refused) {
    static const struct {
        const char *setting, *sentence;
    } wrong[] = {
        {"file.file_format_version.major=0", "file.file_format_version.major: is 0"},
        {"geometry.stage.vector_u.x=null", "geometry.stage.vector_u: has neither"},
        {"geometry.stage.vector_u.z.value=1", "not perpendicular"},
        {"geometry.detector.center.x.unit='\"parsec\"'", "\"parsec\" is no unit"},
        {"geometry.stage.deviations='[{\"type\":\"twist\"}]'",
         "geometry.stage.deviations[0].type: is neither"},
        {"geometry.stage.center.z.drifts='[{\"file\":\"none.csv\"}]'", "none.csv: cannot be read"},
        {"samples.0.file.value='\"none.stl\"'", "none.stl: cannot be read"},
        {"samples.0.material_id='\"gold\"'", "\"gold\" is not among the materials"},
        {"source.spectrum.file='{\"value\":\"none.csv\"}'", "none.csv: cannot be read"},
        {"source.spot='{\"intensity_map\":{\"file\":{\"value\":\"none.tif\"}}}'", "none.tif: cannot be read"},
        {"detector.noise='{\"noise_characteristics_file\":{\"value\":\"none.tsv\"}}'",
         "none.tsv: cannot be read"},
        {"detector.image_lag='{\"value\":1.5}'", "give 0 or more, and less than 1"},
        {"acquisition.number_of_projections=0", "give a whole number"},
        {"acquisition.start_angle.value=190", "is less than start_angle"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        ck_run_fails(3, wrong[i].sentence, "scan box.json -o a.mha --set %s", wrong[i].setting);
}
END_TEST

/* A spectrum of a file weakened by a filter, a scintillator, a table of modulation and a curve of grey values. */
START_TEST(files_of_characteristics_are_read) {
    write_text("spectrum.tsv", "# keV\tN\n59.9\t1e12\n60\t1e12\n60.1\t1e12\n");
    write_text("mtf.tsv", "0\t1\n0.25\t0\n");
    write_text("grey.csv", "0,100\n1,100\n");
    write_text("snr.csv", "0,10\n60000,100\n");
    ck_run(
        0,
        "scan box.json -o a.mha --set source.spectrum.file='{\"value\":\"spectrum.tsv\"}' --set "
        "source.filters='[{\"material_id\":\"water\",\"thickness\":{\"value\":1,\"unit\":\"cm\"}}]' --set "
        "detector.unsharpness='{\"mtf\":{\"value\":\"mtf.tsv\"}}' --set "
        "detector.noise='{\"noise_characteristics_file\":{\"value\":\"snr.csv\"}}' --set detector.type='\"real\"' "
        "--set detector.scintillator='{\"material_id\":\"water\",\"thickness\":{\"value\":1,\"unit\":\"mm\"}}'");
    uint16_t stack[4 * PIXELS];
    ck_run(0, "scan box.json -o b.mha --set detector.gray_value.intensity_characteristics_file='{\"value\":"
              "\"grey.csv\"}'");
    read_pixels("b.mha", 4 * PIXELS, stack);
    for (int i = 0; i < 4 * PIXELS; i++) ck_assert_uint_eq(stack[i], 100);
    ck_run(0, "scan box.json -o c.h5 --set detector.bit_depth.value=32");
}
END_TEST

/* The beam alone, and the other verbs. */
START_TEST(scenarios_are_scenes) {
    uint16_t stack[4 * PIXELS];
    ck_run(0, "scan box.json -o a.mha --set samples='[]'");
    read_pixels("a.mha", 4 * PIXELS, stack);
    ck_assert_uint_eq(stack[(ROWS / 2) * COLUMNS + COLUMNS / 2], 50000);
    ck_run(0, "image box.json -o a.tif");
    ck_run(0, "lbuffer box.json --part cube -o l.mha");
    ck_run(0, "plan box.json");
}
END_TEST

/* Format 1.0 has a formula for a composition, and the file of bad pixels as its value. */
START_TEST(format_1_0_as_it_is) {
    uint16_t now[4 * PIXELS], then[4 * PIXELS], map[PIXELS];
    memset(map, 0xff, sizeof map); /* -1: not bad */
    map[2] = 77;
    write_bytes("bad.raw", map, sizeof map);
    ck_run(0, "scan box.json -o now.mha");
    edit("\"minor\": 2", "\"minor\": 0");
    rewrite("[{\"formula\": {\"value\": \"H 2 O\"}, \"mass_fraction\": {\"value\": 2}}]",
            "{\"value\": \"H 2 O\"}");
    rewrite("\"imin\": {\"value\": 100}}",
            "\"imin\": {\"value\": 100}}, \"bad_pixel_map\": {\"value\": \"bad.raw\", \"type\": \"int16\", "
            "\"endian\": \"little\", \"headersize\": 0, \"drifts\": null}");
    ck_run(0, "scan box.json -o then.mha");
    ck_assert_str_eq(complained, "");
    read_pixels("now.mha", 4 * PIXELS, now);
    read_pixels("then.mha", 4 * PIXELS, then);
    for (int k = 0; k < 4; k++) now[k * PIXELS + 2] = 77;
    ck_assert_mem_eq(now, then, sizeof now);
}
END_TEST

/* A scene with a leaning axis, a tilted detector, a mirrored pose, parts in parts, one of them empty. The letters are replaced. */
static const char circular[] =
    "{\"Source\": {\"Position\": [0, -400, 30, \"mm\"], \"Shape\": \"PointSource\", \"Beam\": [\n"
    "  {\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}, {\"Energy\": 90, \"Unit\": \"keV\", \"PhotonCount\": 500}]},\n"
    "\"Falloff\": true, \"Detector\": {\"Position\": [5, 200, 3, \"mm\"], \"UpVector\": [0, 0, -1],\n"
    "  \"NumberOfPixels\": [40, 32], \"Spacing\": [3, 2.8, \"mm\"]},\n"
    "\"Scan\": {\"NumberOfProjections\": 5, \"StartAngle\": 20, \"FinalAngle\": -320, \"RotationAxis\": [0.1, 0.05, 1],\n"
    "  \"CentreOfRotation\": [3, 4, 0, \"mm\"], \"DetectorTilt\": [2, 3, 4]},\n"
    "\"Samples\": [{\"Label\": \"body\", \"Cuboid\": [40, 30, 50, \"mm\"], \"Material\": \"water\",\n"
    "   \"Transform\": [[\"Scaling\", 1, 1, -1], [\"Rotation\", 1, 0, 0, 20]]},\n"
    "  {\"Label\": \"bone\", \"Cuboid\": [10, 12, 14, \"mm\"], \"Material\": \"Al\", \"Parent\": \"body\",\n"
    "   \"Transform\": [[\"Translation\", 4, 3, 2, \"mm\"]]},\n"
    "  {\"Label\": \"hole\", \"Sphere\": [40, 4, \"mm\"], \"Material\": \"Vacuum\", \"Parent\": \"bone\",\n"
    "   \"Transform\": [[\"Translation\", 4, 3, 2, \"mm\"]]}]}\n";

static void read_doubles(const char *name, int64_t count, double *values) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_msg(stream != NULL, "no %s", name);
    ck_assert_uint_eq(fread(values, sizeof *values, (size_t)count, stream), (size_t)count);
    fclose(stream);
}

/* A scene that is written as a scenario has the same images when it is read. */
START_TEST(a_scene_is_written_as_a_scenario) {
    enum { VALUES = 5 * 40 * 32 };
    static const char *const changes[] = {"Falloff=true", "Source.Shape='[\"Gaussian\",0.6,0.4,\"mm\"]'",
                                          "Source.Shape='\"ParallelBeam\"'",
                                          "World='{\"Material\":\"water\"}'"};
    static double ours[VALUES], theirs[VALUES];
    write_text("scene.json", circular);
    for (int c = 0; c < 4; c++) {
        ck_run(
            0,
            "scan scene.json --set %s -o one.raw --precision double --overwrite --quiet --geometry ct.ctsimu.json",
            changes[c]);
        ck_run(0, "scan ct.ctsimu.json -o two.raw --precision double --quantity energy --overwrite --quiet");
        read_doubles("one.raw", VALUES, ours);
        read_doubles("two.raw", VALUES, theirs);
        double most = 0;
        for (int i = 0; i < VALUES; i++) most = fmax(most, ours[i]);
        /* Corners are floats in an STL: 2e-6 mm of 50 mm, on faces that rays graze. */
        for (int i = 0; i < VALUES; i++) ck_assert_double_eq_tol(theirs[i], ours[i], 1e-5 * most);
    }
}
END_TEST

START_TEST(what_a_scenario_does_not_hold_is_named) {
    static const char *const refused[][2] = {
        {"Scan.Pitch='[9,\"mm\"]'", "Scan: Pitch is not written"},
        {"Scan.FixedDetector=true", "Scan: FixedDetector is not written"},
        {"Samples.bone.Material='[\"mu\",0.5]'", "part bone: its material is given by its attenuation"},
        {"Source.Shape='[\"Disc\",1,\"mm\"]'", "Source.Shape: a CTSimU scenario holds points"}};
    write_text("scene.json", circular);
    for (int r = 0; r < 4; r++)
        ck_run_fails(
            5, refused[r][1],
            "scan scene.json --set Samples.body.Transform=[] --set %s -o a.raw --geometry a.ctsimu.json",
            refused[r][0]);
    ck_assert(!has_file("a.ctsimu.json") && !has_file("a.raw") && !has_file("a-spectrum.csv") &&
              !has_file("a-part-1.stl"));
    ck_run(
        0,
        "scan scene.json -o a.raw --geometry a.ctsimu.json --set Falloff=false --set Noise='{\"Quantum\":true}'");
    ck_assert_msg(strstr(complained, "a.ctsimu.json: the scenario does not have quantum noise") != NULL, "%s",
                  complained);
    ck_assert_msg(strstr(complained, "the scene's does not (Falloff)") != NULL, "%s", complained);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scenario, tear_down_scenario);
    tcase_add_test(tests, format_1_0_as_it_is);
    tcase_add_test(tests, grey_values_are_those_of_the_law);
    tcase_add_test(tests, a_folder_has_the_layout_of_the_format);
    tcase_add_test(tests, current_bad_pixels_and_other_quantities);
    tcase_add_test(tests, image_lag_is_that_of_the_next_frame);
    tcase_add_test(tests, what_is_not_simulated_is_a_warning);
    tcase_add_test(tests, what_cannot_be_read_is_refused);
    tcase_add_test(tests, files_of_characteristics_are_read);
    tcase_add_test(tests, scenarios_are_scenes);
    tcase_add_test(tests, a_scene_is_written_as_a_scenario);
    tcase_add_test(tests, what_a_scenario_does_not_hold_is_named);
}

SKG_SUITE_MAIN("ctsimu", add_tests)
