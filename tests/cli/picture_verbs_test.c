/* The verbs image, lbuffer and plan: what they write and what they print. */
#include "cli/command.h"
#include "cli/scene.h"

#include <float.h>
#include <math.h>

enum { COLUMNS = 65, ROWS = 49, PIXELS = COLUMNS * ROWS, MIDDLE = ROWS / 2 * COLUMNS + COLUMNS / 2 };

static void set_up_scene(void) {
    set_up();
    write_text("scene.json", scene);
}

/* The values of a .mha file of one channel, which its header says are floats or doubles. */
static void read_mha(const char *name, int is_double, double values[PIXELS]) {
    static char bytes[PIXELS * 8 + 4096];
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    size_t count = fread(bytes, 1, sizeof bytes - 1, stream);
    fclose(stream);
    bytes[count] = '\0';
    const char *type = is_double ? "ElementType = MET_DOUBLE\n" : "ElementType = MET_FLOAT\n";
    const char *data = strstr(bytes, "ElementDataFile = LOCAL\n");
    ck_assert_ptr_nonnull(strstr(bytes, type));
    ck_assert_ptr_nonnull(strstr(bytes, "DimSize = 65 49 1\n"));
    ck_assert_ptr_nonnull(strstr(bytes, "TransformMatrix = "));
    ck_assert_ptr_nonnull(data);
    data += strlen("ElementDataFile = LOCAL\n");
    size_t element = is_double ? 8 : 4;
    ck_assert_uint_eq(count - (size_t)(data - bytes), PIXELS * element);
    for (size_t i = 0; i < PIXELS; i++) {
        float single;
        memcpy(&single, data + i * element, sizeof single);
        values[i] = (double)single;
        if (is_double) memcpy(&values[i], data + i * element, sizeof values[i]);
    }
}

/* Parallel rays 1 x 2 mm apart: 41 x 21 meet the skin's 40.5 mm, 11 x 15 the bone's 20 mm, along y. */
START_TEST(parts_are_a_table) {
    const double cube = 40.5 * 40.5 * 40.5, bone = 10.5 * 20 * 30.5;
    const double skin_sum = 861 * 40.5 - 165 * 20.0, bone_sum = 165 * 20.0;
    char line[256], table[1024];
    ck_run(0, "parts scene.json -o a.csv");
    ck_assert_ptr_nonnull(strstr(said, "at 60 keV, the mean energy of the beam\nwrote a.csv\n"));
    snprintf(line, sizeof line, "%-20s %-28s %11s %11.5g %11s %11.5g %6.2f %%\n", "skin", "skin", "-",
             cube - bone, "-", skin_sum / 861, 100 * 0.2 * skin_sum / (0.2 * skin_sum + 0.5 * bone_sum));
    ck_assert_msg(strstr(said, line) != NULL, "%s: not in\n%s", line, said);
    read_back("a.csv", table, sizeof table);
    double volume = 0, path = 0, share = 0;
    const char *at = strstr(table, "\"bone\",\"bone\",,");
    ck_assert_ptr_nonnull(at);
    ck_assert_int_eq(sscanf(at, "\"bone\",\"bone\",,%lf,,%lf,%lf", &volume, &path, &share), 3);
    ck_assert_double_eq_tol(volume, bone, 1e-8 * bone); /* nine digits */
    ck_assert_double_eq_tol(path, 20, 3e-6 * 40.5);     /* single path lengths */
    ck_assert_double_eq_tol(share, 0.5 * bone_sum / (0.2 * skin_sum + 0.5 * bone_sum), 1e-6);
    /* Water, mirrored: .5 x 3 x .5 of the volume. */
    ck_run(0, "parts scene.json --json --set 'Samples.bone.Material=H2O' --set Samples.bone.Density=1 "
              "--set 'Samples.bone.Transform=[[\"Scaling\",-0.5,3,0.5]]'");
    ck_assert_ptr_nonnull(strstr(said, "\"energy_keV\": 60.0"));
    at = strstr(said, "\"mass_g\": 4");
    ck_assert_msg(at != NULL, "%s", said);
    ck_assert_double_eq_tol(atof(at + strlen("\"mass_g\": ")), 0.75e-3 * bone, 1e-9); /* nine digits */
    ck_run_fails(2, "-o a.txt: the table is written as .csv", "parts scene.json -o a.txt");
}
END_TEST

/* The scene's parallel beam has 1000 photons of 60 keV in a pixel of 2 mm2, and a field of 65 x 98 mm. */
START_TEST(dose_is_that_of_the_beam) {
    /* Energy transfer of dry air at 60 keV, .2 to .6 % above NIST's .03041 cm2/g. */
    const double kerma = 1000 / 0.02 * 60 * 1.602176634e-16 * 0.03041 * 1e3 * 1e6;
    ck_run(0,
           "dose scene.json --json --at 0,0,0 --at 40,0,0 --histories 2000 --set Samples.skin.Material=H2O "
           "--set Samples.skin.Density=1 --set Samples.bone.Material=H2O --set Samples.bone.Density=2");
    json_t *object = said_json(), *places = member(object, "kerma"), *parts = member(object, "parts");
    ck_assert_uint_eq(json_object_size(object), 7);
    ck_assert_uint_eq(json_array_size(places), 2);
    json_t *first = json_array_get(places, 0), *second = json_array_get(places, 1);
    /* .2 to .6 %. */
    ck_assert_double_eq_tol(json_number_value(member(first, "air_kerma_uGy")) / kerma, 1.002, 4e-3);
    ck_assert(json_is_null(member(first, "backscatter"))); /* it is within the parts */
    ck_assert_double_eq(json_number_value(json_array_get(member(second, "at"), 0)), 40);
    ck_assert_double_eq(json_number_value(member(second, "air_kerma_uGy")), 0); /* beside the field */
    ck_assert_double_eq_tol(json_number_value(member(object, "kap_uGy_cm2")) / (kerma * 6.5 * 9.8), 1.002,
                            4e-3);
    ck_assert_str_eq(json_string_value(member(json_array_get(parts, 1), "label")), "bone");
    ck_assert_double_gt(json_number_value(member(json_array_get(parts, 1), "dose_uGy")), 0);
    ck_assert_double_eq_tol(json_number_value(member(object, "hvl1_mm_al")), 9.27,
                            0.05); /* ln 2 / (.277 x 2.70 g/cm3) by NIST */
    ck_assert(json_is_number(member(object, "hvl2_mm_al")) &&
              json_is_number(member(object, "exposure_index")) &&
              json_is_number(member(object, "detector_air_kerma_uGy")));
    json_decref(object);
    /* Materials of unknown composition, and noise: the first part is entered in the middle of its face. */
    ck_run(0, "dose scene.json --set Noise=true");
    ck_assert_ptr_nonnull(strstr(complained, "no photons are followed"));
    ck_assert_ptr_nonnull(strstr(said, "at (0, -20.25, 0) mm 0.0146"));
    ck_assert_ptr_nonnull(strstr(said, "least signal"));
    ck_assert_ptr_null(strstr(said, "dose uGy"));
    ck_run_fails(2, "--at 1,2: give three numbers in mm", "dose scene.json --at 1,2");
    ck_run_fails(3, "give mAs",
                 "dose scene.json --set 'Source.Beam={\"kVp\": 80, \"Filter\": [[\"Al\", 3, \"mm\"]]}'");
}
END_TEST

/* 60 keV x 1000 photons behind 20.5 mm of skin and 20 mm of bone; bars are those of single and double path
 * lengths, 3e-6 and 1e-11 of the largest, times the exponent. */
START_TEST(quantities_have_their_values) {
    static const struct {
        const char *flags, *title;
        int relative;
        double open;
    } cases[] = {
        {"", "energy (keV per pixel)", 0, 60000},
        {"--quantity photons", "photons (photons per pixel)", 0, 1000},
        {"--quantity fluence", "fluence (keV/mm2)", 0, 30000}, /* pixels of 1 x 2 mm */
        {"--quantity=transmission", "transmission (I/I0)", 0, 1},
        {"--quantity attenuation", "attenuation (-ln(I/I0))", 1, 0},
    };
    double values[PIXELS], exponent = 0.02 * 20.5 + 0.05 * 20;
    for (int twice = 0; twice < 2; twice++) {
        double bar = twice ? 1e-10 : 1e-5;
        for (size_t i = 0; i < (twice ? 1 : sizeof cases / sizeof *cases); i++) {
            double expected = cases[i].relative ? exponent : cases[i].open * exp(-exponent);
            ck_run(0, "image scene.json -o a.mha %s %s", cases[i].flags, twice ? "--precision double" : "");
            ck_assert_str_eq(complained, "");
            ck_assert_ptr_nonnull(strstr(said, "65 x 49 pixels"));
            ck_assert_ptr_nonnull(strstr(said, "wrote a.mha"));
            read_mha("a.mha", twice, values);
            ck_assert_double_eq_tol(values[MIDDLE], expected, bar * expected);
            ck_assert(values[0] == cases[i].open); /* beside both: the open beam */
        }
    }
}
END_TEST

/* Two energies and one band for each: a channel each, with its own name in the file. */
START_TEST(bands_are_channels) {
    static const char beam[] = "--set 'Source.Beam=[{\"Energy\":40,\"Unit\":\"keV\",\"PhotonCount\":100},"
                               "{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":1000}]'";
    static char bytes[PIXELS * 8 + 4096];
    char path[512];
    float values[2];
    double expected = exp(-(0.02 * 20.5 + 0.05 * 20));
    ck_run(0, "image scene.json -o a.mha -o a.tif -o a.png --bands 30,50,70 --quantity photons %s", beam);
    ck_assert_ptr_nonnull(strstr(said, "photons from 30 to 50 keV"));
    snprintf(path, sizeof path, "%s/a.mha", folder);
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    size_t count = fread(bytes, 1, sizeof bytes - 1, stream);
    fclose(stream);
    bytes[count] = '\0';
    ck_assert_ptr_nonnull(strstr(bytes, "ElementNumberOfChannels = 2\n"));
    ck_assert_ptr_nonnull(
        strstr(bytes, "ChannelNames = photons from 30 to 50 keV; photons from 50 to 70 keV\n"));
    memcpy(values, bytes + count - (size_t)(PIXELS - MIDDLE) * sizeof values, sizeof values);
    /* Some tens of roundings of single precision. */
    ck_assert_double_eq_tol((double)values[0], 100 * expected, 64 * (double)FLT_EPSILON * 100);
    ck_assert_double_eq_tol((double)values[1], 1000 * expected, 64 * (double)FLT_EPSILON * 1000);
    static const char both[] = "image scene.json -o a.mha --bands 30,70 --quantity transmission";
    ck_run(0, "%s %s", both, beam);
    ck_assert_ptr_nonnull(strstr(said, "transmission from 30 to 70 keV"));
    ck_run(0, "%s --band-weight energy %s", both, beam);
    ck_run_fails(2, "--band-weight mass is not known", "%s --band-weight mass", both);
    ck_run(0, "image scene.json -o a.mha --bands 1,2");
    ck_assert_ptr_nonnull(strstr(said, "energy from 1 to 2 keV 0 to 0 keV per pixel"));
    ck_run_fails(2, "--bands 30: one edge makes no band", "image scene.json -o b.mha --bands 30");
    ck_run_fails(2, "\"20\" is not an energy in keV above", "image scene.json -o b.mha --bands 30,20");
    ck_run_fails(2, "\"\" is not an energy in keV above", "image scene.json -o b.mha --bands 30,");
    ck_run_fails(2, "more than 16 bands",
                 "image scene.json -o b.mha --bands 1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18");
    ck_run_fails(3, "channel 0", "image scene.json -o b.mha --bands 1,2 --quantity transmission");
}
END_TEST

START_TEST(lengths_are_net_or_of_the_surface) {
    double values[PIXELS];
    ck_run(0, "lbuffer scene.json --part skin -o a.mha --precision double");
    read_mha("a.mha", 1, values);
    ck_assert_double_eq_tol(values[MIDDLE], 20.5, 1024 * DBL_EPSILON * 40);
    ck_run(0, "lbuffer scene.json --part SKIN --surface -o a.mha");
    read_mha("a.mha", 0, values);
    ck_assert_double_eq_tol(values[MIDDLE], 40.5, 16 * (double)FLT_EPSILON * 40);
    ck_run(0, "lbuffer scene.json --part bone -o a.mha --quiet --set Samples.bone.Cuboid='[9,8,7,\"mm\"]'");
    ck_assert_str_eq(said, "");
    read_mha("a.mha", 0, values);
    ck_assert_double_eq_tol(values[MIDDLE], 8, 16 * (double)FLT_EPSILON * 40);
    ck_run_fails(3, "no part has the label bon; did you mean bone", "lbuffer scene.json --part bon -o a.mha");
    ck_run_fails(2, "no part is named; add --part LABEL", "lbuffer scene.json -o a.mha");
}
END_TEST

START_TEST(every_output_is_written) {
    ck_run(0, "image scene.json -o a.png -o a.tif -o=a.mha --range 0:2 --display transmission");
    ck_assert(has_file("a.png") && has_file("a.tif") && has_file("a.mha"));
    ck_assert_int_eq(look_at_folder(0), 4);
}
END_TEST

START_TEST(a_picture_of_a_scan_says_what_it_leaves_out) {
    ck_run(0, "image scene.json -o a.mha --set 'Scan={\"NumberOfProjections\": 12, \"AngleStep\": 30}'");
    ck_assert_msg(strstr(complained, "this is one projection of 12"), "%s", complained);
    ck_run(0, "lbuffer scene.json --part bone -o a.mha --set 'Scan={\"StartAngle\": 30}'");
    ck_assert_msg(strstr(complained, "this is its first projection"), "%s", complained);
    ck_run(0, "image scene.json -o a.mha");
    ck_assert_msg(!strstr(complained, "Scan"), "%s", complained);
}
END_TEST

START_TEST(noise_without_an_efficiency_is_warned_of) {
    static const char lut[] = "--set 'Detector.EnergyResponse={\"LUT\": [[10, 10], [100, 60]]%s}'";
    char with[128];
    snprintf(with, sizeof with, lut, "");
    ck_run(0, "image scene.json -o a.mha %s", with);
    ck_assert_msg(!strstr(complained, "efficiency"), "%s", complained);
    ck_run(0, "image scene.json -o a.mha --set Noise=true %s", with);
    ck_assert_msg(strstr(complained, "gives no efficiency"), "%s", complained);
    snprintf(with, sizeof with, lut, ", \"Meaning\": \"absorbed\"");
    ck_run(0, "image scene.json -o a.mha --set Noise=true %s", with);
    ck_assert_msg(!strstr(complained, "efficiency"), "%s", complained);
}
END_TEST

START_TEST(strategies_give_the_same_bits) {
    double one[PIXELS], other[PIXELS];
    ck_run(0, "image scene.json -o a.mha --strategy copies");
    read_mha("a.mha", 0, one);
    ck_run(0, "image scene.json -o a.mha --strategy tiles --device 'cpu threads=1'");
    read_mha("a.mha", 0, other);
    ck_assert_int_eq(memcmp(one, other, sizeof one), 0);
    ck_run(0, "image scene.json -o a.mha --strategy atomics");
    read_mha("a.mha", 0, other);
    ck_assert_int_eq(memcmp(one, other, sizeof one), 0);
}
END_TEST

static void check_summary(json_t *summary) {
    double least = json_number_value(member(summary, "min"));
    double median = json_number_value(member(summary, "median"));
    ck_assert(least >= 0 && median >= least);
}

static void check_plan(json_t *plan) {
    json_t *effects = member(plan, "effects"), *nodes = member(plan, "nodes");
    ck_assert_uint_ge(json_array_size(effects), 1);
    for (size_t i = 0; i < json_array_size(effects); i++) {
        json_t *effect = json_array_get(effects, i);
        ck_assert(json_is_boolean(member(effect, "on")));
        ck_assert_uint_gt(json_string_length(member(effect, "name")), 0);
        ck_assert_uint_gt(json_string_length(member(effect, "reason")), 0);
    }
    ck_assert_uint_eq(json_array_size(nodes), 1);
    ck_assert(json_real_value(json_array_get(json_array_get(nodes, 0), 0)) == 60);
    ck_assert(json_real_value(json_array_get(json_array_get(nodes, 0), 1)) == 1000);
    ck_assert_int_eq(json_integer_value(member(plan, "planes")), 1);
    ck_assert(json_is_string(member(plan, "strategy")));
    ck_assert_int_ge(json_integer_value(member(member(plan, "tiles"), "count")), 1);
    ck_assert(json_number_value(member(plan, "bound")) == 0);
    /* At most that of single precision: 1.25 times 3e-5 of exponents of 2.8 (docs/numerics.md). */
    ck_assert_double_lt(json_number_value(member(plan, "bound_precision")), 1.25 * 3e-5 * 2.8);
    ck_assert_double_gt(json_number_value(member(plan, "bound_precision")), 0);
    ck_assert_int_eq(json_integer_value(member(plan, "parts")), 2);
    ck_assert_int_eq(json_integer_value(member(plan, "triangles")), 24);
    ck_assert_int_eq(json_integer_value(member(plan, "bad_pixels")), 0);
}

START_TEST(json_has_its_shape) {
    ck_run(0, "image scene.json -o a.mha --repeat 4 --json");
    json_t *object = said_json();
    check_summary(member(object, "frame_ms"));
    ck_assert(json_number_value(member(object, "first_ms")) > 0);
    json_t *stages = member(object, "stages"), *stage;
    const char *name;
    ck_assert_uint_ge(json_object_size(stages), 3);
    json_object_foreach(stages, name, stage) check_summary(stage);
    check_plan(member(object, "plan"));
    json_decref(object);
    ck_run(0, "lbuffer scene.json --part bone --repeat 1 --json");
    object = said_json();
    check_summary(member(object, "frame_ms"));
    ck_assert_uint_eq(json_array_size(member(object, "files")), 0);
    json_decref(object);
    ck_run(0, "image scene.json -o a.mha -o a.png --quantity transmission --json");
    object = said_json();
    ck_assert_str_eq(json_string_value(json_array_get(member(object, "files"), 1)), "a.png");
    json_t *range = json_array_get(member(object, "range"), 0);
    ck_assert_uint_eq(json_array_size(member(object, "range")), 1);
    /* Open pixels, and those behind skin and bone; the margin is that of single precision. */
    ck_assert_double_eq_tol(json_number_value(json_array_get(range, 1)), 1, 1e-6);
    ck_assert_double_eq_tol(json_number_value(json_array_get(range, 0)), exp(-0.2 * 2.05 - 0.5 * 2), 1e-5);
    ck_assert(json_is_null(member(object, "frame_ms")) && json_is_null(member(object, "stages")));
    json_decref(object);
    ck_run(0, "plan scene.json --json --strategy tiles --precision double");
    object = said_json();
    check_plan(object);
    ck_assert_str_eq(json_string_value(member(object, "strategy")), "tiles");
    ck_assert_str_eq(json_string_value(member(object, "precision")), "double");
    json_decref(object);
}
END_TEST

START_TEST(verbose_says_what_was_loaded) {
    ck_run(0, "image scene.json -o a.mha --verbose");
    ck_assert_ptr_nonnull(strstr(complained, "skiagraph: device "));
    ck_assert_ptr_nonnull(
        strstr(complained, "skiagraph: part bone: mesh cuboid of 12 triangles, closed; material "));
    ck_assert_ptr_nonnull(strstr(complained, "skiagraph: beam of 1 energy; detector of 65 x 49 pixels"));
    ck_assert_ptr_nonnull(strstr(complained, "skiagraph: planned and compiled in "));
    ck_assert_ptr_nonnull(strstr(complained, "skiagraph: on: nesting: "));
    ck_run(0, "image scene.json -o a.mha");
    ck_assert_str_eq(complained, "");
}
END_TEST

START_TEST(plan_says_what_and_why) {
    ck_run(0, "plan scene.json");
    ck_assert_ptr_nonnull(strstr(said, "scene.json: 2 parts (0 leaky), 24 triangles"));
    ck_assert_ptr_null(strstr(said, "1 tiles"));
    ck_assert_ptr_nonnull(strstr(said, "60 keV, 1000 photons per pixel"));
    ck_assert_ptr_nonnull(strstr(said, "\n  on  nesting "));
    ck_assert_ptr_null(strstr(said, "\nenergies, keV")); /* one: none was chosen */
    ck_assert_ptr_nonnull(strstr(said, "Directly transmitted photons only."));
    ck_assert_ptr_nonnull(strstr(said, "scatter, "));
    ck_assert_ptr_nonnull(strstr(said, "predicted"));
    ck_run(0, "plan scene.json --strategy atomics");
    ck_assert_ptr_nonnull(strstr(said, "atomics: the whole detector, 24 triangles\n"));
    ck_run(0, "plan scene.json --set Samples.bone.Cuboid='[10,60,30,\"mm\"]'");
    ck_assert_ptr_nonnull(strstr(said, "bone leaves its parent skin: "));
}
END_TEST

START_TEST(of_many_overlaps_the_worst_three_are_printed) {
    write_text(
        "many.json",
        "{\"Source\":{\"Position\":[0,-400,0,\"mm\"],\"Shape\":\"PointSource\",\"Beam\":[{\"Energy\":60,\"Unit\":\"keV\","
        "\"PhotonCount\":1}]},\"Detector\":{\"Position\":[0,100,0,\"mm\"],\"UpVector\":[0,0,-1],\"NumberOfPixels\":[8,8],"
        "\"Size\":[80,80,\"mm\"]},\"Samples\":["
        "{\"Label\":\"a\",\"Cube\":[10,\"mm\"],\"Material\":[\"mu\",0.5]},"
        "{\"Label\":\"b\",\"Cube\":[12,\"mm\"],\"Material\":[\"mu\",0.5]},"
        "{\"Label\":\"c\",\"Cube\":[14,\"mm\"],\"Material\":[\"mu\",0.5]},"
        "{\"Label\":\"d\",\"Cube\":[16,\"mm\"],\"Material\":[\"mu\",0.5]}]}");
    ck_run(0, "plan many.json");
    int lines = 0;
    for (const char *at = said; (at = strstr(at, " mm3, longest ")); at++) lines++;
    ck_assert_int_eq(lines, 3); /* of six pairs */
    const char *worst = strstr(said, "\n  c overlaps d: 2744 mm3"),
               *worse = strstr(said, "overlaps d: 1728 mm3");
    ck_assert_msg(worst && worse && worst < worse, "%s", said);
    ck_assert_ptr_nonnull(strstr(said, "  and 3 more; --json lists all\n"));
}
END_TEST

/* Warnings of the plan reach standard error, and the picture is made all the same. */
START_TEST(warnings_are_printed_unless_quiet) {
    write_text("open.obj",
               "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 4 3\nf 2 3 4\n"); /* without y = 0 */
    static const char open_part[] =
        "--set 'Samples.1={\"Label\":\"bone\",\"Path\":\"open.obj\",\"Unit\":\"mm\","
        "\"Material\":[\"mu\",0.5]}'";
    ck_run(0, "image scene.json -o a.mha %s", open_part);
    ck_assert_msg(strstr(complained, "skiagraph: warning: ") && strstr(complained, "leaky"), "%s",
                  complained);
    ck_run(0, "plan scene.json --json --quiet %s", open_part);
    ck_assert_str_eq(complained, "");
    json_t *object = said_json();
    ck_assert_int_eq(json_integer_value(member(object, "open_parts")), 1);
    ck_assert_int_gt(json_integer_value(member(object, "bad_pixels")), 0);
    json_decref(object);
    ck_run(0, "image scene.json -o a.mha --set 'Detector.Position=[1000,100,0,\"mm\"]' "
              "--set 'Source.Position=[1000,-400,0,\"mm\"]'");
    ck_assert_ptr_nonnull(strstr(complained, "skiagraph: warning: nothing falls on the detector"));
}
END_TEST

/* A flat mesh that faces the beam has no depth along it. It was once said to lie behind the source. */
START_TEST(a_wall_that_faces_the_beam_lies_on_its_way) {
    static const char wall[] = "--set 'Samples=[{\"Label\":\"wall\",\"Path\":\"wall.obj\",\"Unit\":\"mm\","
                               "\"Material\":[\"mu\",0.5]}]'";
    write_text("wall.obj", "v -5 0 -5\nv 5 0 -5\nv 5 0 5\nv -5 0 5\nf 1 2 3\nf 1 3 4\n");
    ck_run(0, "image scene.json -o a.mha %s", wall);
    ck_assert_msg(strstr(complained, "part wall is leaky"), "%s", complained);
    ck_assert_msg(!strstr(complained, "nothing falls on the detector"), "%s", complained);
    ck_run(0, "image scene.json -o a.mha %s --set 'Samples.0.Transform=[[\"Translation\",90,0,0,\"mm\"]]'",
           wall);
    ck_assert_msg(strstr(complained, "the shadow of wall, which comes nearest, lies"), "%s", complained);
    ck_run(0, "image scene.json -o a.mha %s --set 'Samples.0.Transform=[[\"Translation\",0,200,0,\"mm\"]]'",
           wall);
    ck_assert_msg(strstr(complained, "all parts lie behind the source or behind the detector"), "%s",
                  complained);
}
END_TEST

/* An unfiltered beam of 119 energies behind lead: its softest photons are met at the edges only. */
START_TEST(compression_that_does_not_pay_is_told) {
    static const char lead[] =
        "plan scene.json --set Samples.skin.Material=Water --set Samples.bone.Material=Pb "
        "--set 'Source.Beam={\"kVp\": 120}'";
    ck_run(0, "%s --tolerance 0.01", lead);
    ck_assert_msg(strstr(complained,
                         "compression does not pay: no fewer energies meet a tolerance of 0.01, so all 119"),
                  "%s", complained);
    ck_run(0, "%s --tolerance 0", lead);
    ck_assert_msg(!strstr(complained, "compression"), "%s", complained);
}
END_TEST

START_TEST(noise_is_said_to_be_missing_only_where_it_is) {
    static const char with[] = "scene.json --set Source.Shape=PointSource --set 'Source.Beam={\"kVp\": 80, "
                               "\"Filter\": [[\"Al\", 3]], \"mAs\": 2}'";
    ck_run(0, "image %s -o a.png", with);
    ck_assert_msg(strstr(complained, "there is no noise"), "%s", complained);
    ck_run(0, "image %s -o a.png --set Noise=true", with);
    ck_assert_msg(!strstr(complained, "noise"), "%s", complained);
    /* The warning stands where pixels are the result and in the table of the plan, and not before every command. */
    ck_run(0,
           "plan %s --tolerance 0 --set 'Samples.bone.Material=H2O' --set Samples.bone.Density=1 --set "
           "Samples.skin.Material=H2O --set Samples.skin.Density=1",
           with);
    ck_assert_msg(!strstr(complained, "noise"), "%s", complained);
    ck_assert_msg(strstr(said, "not asked for, although mAs counts the photons: the key Noise adds it"), "%s",
                  said);
    ck_assert_msg(strstr(said, "% of the open beam: no tolerance says that so much may be left out"), "%s", said);
    ck_run(0, "lbuffer %s --part bone -o a.png", with);
    ck_assert_str_eq(complained, "");
}
END_TEST

/* A compressed scene says nothing of its bound at the view that it was planned for, and reports what leaves it.
 */
START_TEST(the_bound_holds_at_the_own_view) {
    ck_run(0, "thorax -o .");
    ck_run(0, "plan thorax.json --json");
    json_t *object = said_json();
    ck_assert(json_number_value(member(object, "bound")) > 0);
    ck_assert_int_eq(json_integer_value(member(object, "outside_pixels")), 0);
    ck_assert(json_number_value(member(member(object, "stages_ns"), "attenuate")) > 0);
    ck_assert_int_gt(json_integer_value(member(object, "bins")),
                     (json_int_t)json_array_size(member(object, "nodes")));
    size_t index;
    json_t *effect;
    json_array_foreach(member(object, "effects"), index, effect) {
        const char *name = json_string_value(member(effect, "name"));
        const double cost = json_number_value(member(effect, "cost"));
        if (strcmp(name, "several energies") == 0 || strcmp(name, "priority") == 0) /* of the needle */
            ck_assert_double_gt(cost, 0);
        else if (strcmp(name, "spectral compression") == 0)
            ck_assert_double_lt(cost, 0);
        else
            ck_assert(cost == 0);
    }
    json_decref(object);
    ck_run(0, "plan thorax.json --set Source.Shape='[\"Rectangle\",1,1,\"mm\"]' --set Source.Samples=4");
    const char *source = strstr(said, "\n  on  extended source ");
    ck_assert_ptr_nonnull(source);
    ck_assert_double_gt(atof(source + strlen("\n  on  extended source ")), 0); /* three passes more */
    ck_assert_ptr_nonnull(strstr(said, "\nenergies, keV: photons per pixel"));
    ck_run(0, "image thorax.json -o a.mha");
    ck_assert_ptr_null(strstr(complained, "bound"));
}
END_TEST

/* Pixels of 1 mm x 2 mm, 500 mm from the tube: 65 uGy/mAs at 1 m are four times as much there. */
START_TEST(the_open_beam_is_reported) {
    ck_run(0, "plan scene.json --json --set Source.Shape=PointSource --set 'Source.Beam={\"kVp\": 80, "
              "\"Filter\": [[\"Al\", 3]], \"mAs\": 2, \"Output\": [65, \"uGy/mAs\", 1, \"m\"]}'");
    json_t *object = said_json(), *open = member(object, "open_beam");
    ck_assert_double_eq_tol(json_number_value(member(open, "air_kerma_uGy")) / (65 * 2 * 4), 1,
                            64 * DBL_EPSILON);
    json_decref(object);
}
END_TEST

START_TEST(times_are_printed) {
    ck_run(0, "image scene.json --repeat 3");
    ck_assert_ptr_nonnull(strstr(said, "(3 frames)\n"));
    ck_assert_ptr_nonnull(strstr(said, "\n  frame "));
}
END_TEST

/* Bytes through standard input and output are those through files, and nothing else is on standard output. */
START_TEST(dashes_are_standard_input_and_output) {
    char line[1024];
    snprintf(
        line, sizeof line,
        "cd %s && %s image - -o - <scene.json >b.mha 2>.complained && %s image scene.json -o a.mha --quiet && "
        "cmp a.mha b.mha",
        folder, SKG_COMMAND, SKG_COMMAND);
    int status = system(line);
    read_back(".complained", complained, sizeof complained);
    ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 0, "%s", complained);
    ck_run_fails(3, "standard input: line 1, column 0", "plan -"); /* which is empty here */
    ck_run(2, "image scene.json -o - --json");
    ck_assert_msg(strstr(complained, "standard output takes one thing"), "%s", complained);
    ck_run_fails(2, "cost reads its scene several times", "cost - --quick");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scene, tear_down);
    tcase_add_test(tests, quantities_have_their_values);
    tcase_add_test(tests, bands_are_channels);
    tcase_add_test(tests, lengths_are_net_or_of_the_surface);
    tcase_add_test(tests, parts_are_a_table);
    tcase_add_test(tests, dose_is_that_of_the_beam);
    tcase_add_test(tests, every_output_is_written);
    tcase_add_test(tests, a_picture_of_a_scan_says_what_it_leaves_out);
    tcase_add_test(tests, noise_without_an_efficiency_is_warned_of);
    tcase_add_test(tests, strategies_give_the_same_bits);
    tcase_add_test(tests, json_has_its_shape);
    tcase_add_test(tests, verbose_says_what_was_loaded);
    tcase_add_test(tests, plan_says_what_and_why);
    tcase_add_test(tests, of_many_overlaps_the_worst_three_are_printed);
    tcase_add_test(tests, warnings_are_printed_unless_quiet);
    tcase_add_test(tests, a_wall_that_faces_the_beam_lies_on_its_way);
    tcase_add_test(tests, compression_that_does_not_pay_is_told);
    tcase_add_test(tests, noise_is_said_to_be_missing_only_where_it_is);
    tcase_add_test(tests, the_bound_holds_at_the_own_view);
    tcase_add_test(tests, the_open_beam_is_reported);
    tcase_add_test(tests, times_are_printed);
    tcase_add_test(tests, dashes_are_standard_input_and_output);
}

SKG_SUITE_MAIN("picture_verbs", add_tests)
