/* The verb cost: its dials, their errors, and whether what it recommends holds. */
#include "cli/cost_scene.h"

#include <float.h>
#include <math.h>
#include <stdint.h>

enum { COLUMNS = 33, ROWS = 25, PIXELS = COLUMNS * ROWS };

/* Pixels of a .mha of one channel, floats or doubles as its header says. */
static void read_pixels(const char *name, double values[PIXELS]) {
    static char bytes[PIXELS * 8 + 4096];
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    size_t count = fread(bytes, 1, sizeof bytes - 1, stream);
    fclose(stream);
    bytes[count] = '\0';
    int is_double = strstr(bytes, "ElementType = MET_DOUBLE\n") != NULL;
    const char *data = strstr(bytes, "ElementDataFile = LOCAL\n");
    ck_assert_ptr_nonnull(data);
    data += strlen("ElementDataFile = LOCAL\n");
    ck_assert_uint_eq(count - (size_t)(data - bytes), (size_t)PIXELS * (is_double ? 8 : 4));
    for (size_t i = 0; i < PIXELS; i++) {
        float single;
        memcpy(&single, data + i * sizeof single, sizeof single);
        values[i] = (double)single;
        if (is_double) memcpy(&values[i], data + i * sizeof values[i], sizeof values[i]);
    }
}

/* Runs a recommended command line and returns its largest error of the open beam, against `reference`. */
static double error_of(const char *command, const char *reference, double open) {
    static double image[PIXELS], exact[PIXELS];
    static const char name[] = "skiagraph ";
    double worst = 0;
    ck_assert_int_eq(strncmp(command, name, strlen(name)), 0);
    ck_run(0, "%s --quiet", command + strlen(name));
    read_pixels("image.mha", image);
    ck_run(0, "image 'small scene.json' -o exact.mha --quiet --precision double --tolerance 0 %s", reference);
    read_pixels("exact.mha", exact);
    for (int i = 0; i < PIXELS; i++) worst = fmax(worst, fabs(image[i] - exact[i]) / open);
    return worst;
}

/* The last words of a command: other triangles and another repair, which its reference has too. */
static const char *geometry_of(const char *command) {
    const char *repair = strstr(command, " --set Repair="), *samples = strstr(command, " --set Samples.");
    return repair ? repair : samples ? samples : "";
}

/* Each command line, run by itself, keeps what is said of it. Images of one setting are the same bits, so
 * that the error is the same number but for rounding in its own arithmetic. */
static void check_advice(json_t *study, size_t first, const char *extra) {
    double open = number(study, "open_keV");
    size_t index;
    json_t *advice;
    ck_assert_uint_eq(json_array_size(member(study, "advice")), 4);
    json_array_foreach(member(study, "advice"), index, advice) {
        char reference[1024];
        if (index < first) continue;
        json_t *rays = point_of(study, member(advice, "rays")), *whole = member(advice, "whole");
        json_t *setting = member(rays, "setting");
        double tolerance = number(advice, "tolerance");
        ck_assert(json_is_true(member(advice, "rays_met")));
        snprintf(reference, sizeof reference, "%s --set Source.Samples=%d", extra,
                 (int)json_integer_value(member(setting, "samples")));
        double error =
            error_of(json_string_value(member(advice, "rays_command")), *extra ? reference : "", open);
        ck_assert_double_le(error, tolerance);
        ck_assert_double_eq_tol(error, number(rays, "max_open"), 64 * DBL_EPSILON);
        if (json_is_null(whole)) continue;
        setting = member(whole, "setting");
        int used = 0;
        if (*extra)
            used = snprintf(reference, sizeof reference, "%s --set Source.Samples=%d", extra,
                            (int)json_integer_value(member(setting, "samples")));
        snprintf(reference + used, sizeof reference - (size_t)used, " --set Detector.Oversampling=%d%s",
                 (int)json_integer_value(member(setting, "supersampling")),
                 geometry_of(json_string_value(member(advice, "whole_command"))));
        error = error_of(json_string_value(member(advice, "whole_command")), reference, open);
        ck_assert_double_le(error, tolerance);
        ck_assert_double_eq_tol(error, number(whole, "max_open"), 64 * DBL_EPSILON);
    }
}

START_TEST(an_extended_source_is_swept) {
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json %s", disc);
    json_t *study = said_json(), *point;
    size_t index;
    double first = -1, last = -1;
    json_array_foreach(member(study, "points"), index, point) {
        if (strcmp(json_string_value(member(point, "dial")), "source samples") != 0) continue;
        last = number(point, "rms_open");
        if (first < 0) first = last;
    }
    ck_assert_double_gt(last, 0); /* 64 samples are not 256 */
    ck_assert_double_gt(first, 4 * last);
    check_advice(study, 3, disc);
    json_decref(study);
}
END_TEST

static int is_dial(json_t *point, const char *dial, const char *precision) {
    return strcmp(json_string_value(member(point, "dial")), dial) == 0 &&
           strcmp(json_string_value(member(member(point, "setting"), "precision")), precision) == 0;
}

/* Known relations of the dials: 16 bits lose to 32 and those to 64; a tolerance bounds the error it makes (and
 * single precision adds less than 1e-6 of the open beam); the best setting differs from itself by nothing. */
static void check_errors(json_t *study) {
    json_t *point;
    double half = -1, single = -1, twice = -1, half_mm = -1, single_mm = -1;
    size_t index;
    int tolerances = 0, bins = 0;
    json_array_foreach(member(study, "points"), index, point) {
        json_t *setting = member(point, "setting");
        double error = number(point, "max_open"), tolerance = number(setting, "tolerance");
        ck_assert_double_le(number(point, "rms_open"), error);
        ck_assert_double_le(number(point, "rms_ref"), number(point, "max_ref"));
        if (is_dial(point, "precision", "half")) half = error, half_mm = number(point, "max_mm");
        if (is_dial(point, "scene", "single")) single = error, single_mm = number(point, "max_mm");
        if (is_dial(point, "precision", "double")) twice = error;
        bins += is_dial(point, "bins", "single");
        if (strcmp(json_string_value(member(point, "dial")), "tolerance") != 0) continue;
        /* Single precision adds 16 roundings, 1e-6. */
        ck_assert_double_le(error, tolerance + 1e-6);
        tolerances++;
    }
    ck_assert_int_eq(tolerances, 6);
    ck_assert_int_ge(bins, 2);
    ck_assert(twice == 0);
    ck_assert(single > 0 && single < 1e-6);
    ck_assert_double_gt(half, 100 * single);
    ck_assert(single_mm > 0 && single_mm < 1e-3);
    ck_assert(half_mm > 0.01 && half_mm < 1); /* 16 bits of 0.25 to 0.5 m: half of 0.24 mm a surface */
}

START_TEST(errors_are_those_of_the_dials_and_advice_holds) {
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json");
    json_t *study = said_json();
    check_errors(study);
    check_advice(study, 0, "");
    json_decref(study);
}
END_TEST

/* A sphere's chords fall short of it by the square of their length: twice the sectors, a quarter of the error
 * (a third at most, for the edge's share and since the reference is a polyhedron too). */
START_TEST(round_parts_are_swept) {
    static const char grey[] = "--set 'Source.Beam=[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":100}]'";
    double rms[16], rms_mm[16];
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json %s --set Samples.bone.Sphere.0=32", grey);
    json_t *study = said_json();
    int count = list_dial(study, "triangles", "rms_open", rms);
    ck_assert_int_eq(count, 4); /* 8, 16, 32 and 64 sectors, against 128 */
    ck_assert_int_eq(list_dial(study, "triangles", "rms_mm", rms_mm), count);
    for (int i = 1; i < count; i++) {
        ck_assert_double_lt(rms[i], rms[i - 1] / 2);
        ck_assert_double_lt(rms_mm[i], rms_mm[i - 1] / 2);
    }
    const char *command =
        json_string_value(member(json_array_get(member(study, "advice"), 3), "whole_command"));
    ck_assert_ptr_nonnull(strstr(command, " --set Samples.bone.Sphere.0=64"));
    json_decref(study);
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json %s --set Samples.bone.Sphere.0=6", grey);
    study = said_json();
    ck_assert_int_eq(list_dial(study, "triangles", "rms_open", rms),
                     0); /* six-sided, for all that is known */
    json_decref(study);
}
END_TEST

/* A box without one of its triangles, whose cap is that triangle: the exact repair is exact, and the others
 * are not. */
START_TEST(repair_of_an_open_mesh_is_swept) {
    static const char box[] =
        "v -9 -9 -9\nv 9 -9 -9\nv -9 9 -9\nv 9 9 -9\nv -9 -9 9\nv 9 -9 9\nv -9 9 9\nv 9 9 9\n"
        "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 3 7 8\nf 3 8 4\n"
        "f 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n"; /* without 1 6 5, towards the source */
    static const char bone[] =
        "--set 'Samples.bone={\"Label\":\"bone\",\"Path\":\"box.obj\",\"Unit\":\"mm\","
        "\"Material\":[\"HU\",900]}' --set 'Source.Beam=[{\"Energy\":60,\"Unit\":\"keV\","
        "\"PhotonCount\":100}]'";
    double worst[16], rms[16], mm[16];
    write_text("box.obj", box);
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json %s", bone);
    json_t *study = said_json();
    ck_assert_int_eq(list_dial(study, "repair", "max_open", worst), 3);
    ck_assert_int_eq(list_dial(study, "repair", "max_mm", mm), 3);
    ck_assert(worst[2] == 0);
    ck_assert(mm[2] < 1e-3);          /* rounding of single */
    ck_assert_double_gt(mm[0], 17.9); /* left out: 18 mm and more */
    ck_assert_double_gt(mm[1], 10 * mm[2]);
    ck_assert_int_eq(list_dial(study, "repair", "rms_open", rms), 3);
    ck_assert_double_gt(rms[0], rms[1]);
    ck_assert_double_gt(rms[1], 0);
    check_advice(study, 3, bone);
    json_decref(study);
}
END_TEST

/* Two boxes of one mesh that share a third of their volume: united as the scene asks, and added, which its table and its sentence price. */
START_TEST(a_union_has_its_price) {
    static const char bone[] =
        "--set 'Repair=[\"union\"]' --set 'Samples.bone={\"Label\":\"bone\",\"Path\":\"boxes.obj\","
        "\"Unit\":\"mm\",\"Material\":[\"HU\",900]}' "
        "--set 'Source.Beam=[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":100}]'";
    char boxes[2048] = "";
    for (int k = 0, v = 1; k < 2; k++, v += 8) {
        for (int n = 0; n < 8; n++)
            sprintf(boxes + strlen(boxes), "v %d %d %d\n", n & 1 ? 6 : -6, (n & 2 ? 9 : -3) - 6 * k,
                    n & 4 ? 6 : -6);
        static const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
        for (int q = 0; q < 6; q++)
            sprintf(boxes + strlen(boxes), "f %d %d %d %d\n", v + quads[q][0], v + quads[q][1],
                    v + quads[q][2], v + quads[q][3]);
    }
    double worst[16];
    write_text("boxes.obj", boxes);
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json %s", bone);
    json_t *study = said_json();
    ck_assert_int_eq(list_dial(study, "repair", "max_open", worst), 2);
    ck_assert_double_gt(worst[0], 0.01);
    ck_assert(worst[1] == 0);
    ck_assert_ptr_nonnull(
        strstr(json_string_value(member(study, "summary")), "The union of components takes "));
    check_advice(study, 3, bone);
    json_decref(study);
}
END_TEST

/* A volume of 4 x 4 x 4 cells between air and bone: what linear values between them change and take is said beside the dials, and the image
 * of either setting is that of the command. */
START_TEST(linear_values_between_cells_have_their_price) {
    static const char beam[] = "--set 'Source.Beam=[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":100}]'";
    static double images[2][PIXELS];
    static const char volume[] =
        "--set 'Samples.bone={\"Label\":\"bone\",\"Volume\":\"ct.mha\",\"Values\":\"HU\",\"Parent\":\"skin\"}'";
    char head[512], path[512];
    int16_t cells[64];
    double worst = 0;
    for (int k = 0; k < 64; k++) cells[k] = (int16_t)(k * 37 % 64 * 40 - 1000);
    const int length = snprintf(head, sizeof head,
                                "NDims = 3\nElementSpacing = 5 5 5\nOffset = -7.5 -7.5 -7.5\n"
                                "DimSize = 4 4 4\nElementType = MET_SHORT\nElementDataFile = LOCAL\n");
    snprintf(path, sizeof path, "%s/ct.mha", folder);
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(fwrite(head, 1, (size_t)length, file), (size_t)length);
    ck_assert_uint_eq(fwrite(cells, sizeof *cells, 64, file), 64);
    fclose(file);
    ck_run(0, "cost 'small scene.json' --quick --within 20 --json %s %s", beam, volume);
    json_t *study = said_json(), *between = member(study, "interpolation");
    ck_assert_double_gt(number(between, "cells_ms"), 0);
    ck_assert_double_gt(number(between, "linear_ms"), 0);
    ck_assert_ptr_nonnull(strstr(json_string_value(member(study, "summary")),
                                 "Linear values between the cells of volumes take "));
    for (int k = 0; k < 2; k++) {
        ck_run(
            0,
            "image 'small scene.json' -o image.mha --quiet --quantity energy %s %s --set 'Samples.bone.Interpolation=\"%s\"'",
            beam, volume, k ? "linear" : "cells");
        read_pixels("image.mha", images[k]);
    }
    for (int i = 0; i < PIXELS; i++)
        worst = fmax(worst, fabs(images[1][i] - images[0][i]) / number(study, "open_keV"));
    ck_assert_double_gt(worst, 0.01);
    ck_assert_double_eq_tol(number(between, "max_open"), worst, 1e-6); /* floats of the same images */
    json_decref(study);
    /* A volume without a label is set by its number. */
    ck_run(0,
           "cost 'small scene.json' --quick --within 5 --json %s --set "
           "'Samples.bone={\"Volume\":\"ct.mha\",\"Values\":\"HU\",\"Parent\":\"skin\"}'",
           beam);
    study = said_json();
    ck_assert_double_gt(number(member(study, "interpolation"), "linear_ms"), 0);
    json_decref(study);
    ck_run(0, "cost 'small scene.json' --quick --within 5 --json %s", beam);
    study = said_json();
    ck_assert(json_is_null(member(study, "interpolation")));
    json_decref(study);
}
END_TEST

/* 1e4 photons of 60 keV a pixel of the open beam: the noise of N photons is sqrt(N), so that its root mean
 * square over the image is sqrt(mean I/I0) of 1 %; of 825 pixels within 15 %, six standard errors. */
START_TEST(advice_stops_at_a_tenth_of_the_noise) {
    static double image[PIXELS];
    static const char beam[] = "--set 'Source.Beam=[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":10000}]'";
    double mean = 0;
    ck_run(0, "image 'small scene.json' --quiet -o image.mha --quantity transmission %s", beam);
    read_pixels("image.mha", image);
    for (int i = 0; i < PIXELS; i++) mean += image[i] / PIXELS;
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json --set Noise=true %s", beam);
    json_t *study = said_json(), *advice = json_array_get(member(study, "advice"), 3);
    double noise = number(study, "noise");
    /* Six standard errors, see above. */
    ck_assert_double_eq_tol(noise, 0.01 * sqrt(mean), 0.15 * 0.01 * sqrt(mean));
    ck_assert_double_eq_tol(number(advice, "bar"), noise / 10, 64 * DBL_EPSILON);
    ck_assert_double_le(number(point_of(study, member(advice, "rays")), "max_open"), noise / 10);
    json_decref(study);
}
END_TEST

START_TEST(batches_are_timed) {
    ck_run(0, "cost 'small scene.json' --quick --within 3600 --json --frames 5");
    json_t *study = said_json();
    ck_assert_int_eq((int)json_integer_value(member(study, "frames")), 5);
    const char *summary = json_string_value(member(study, "summary"));
    ck_assert_ptr_nonnull(strstr(summary, " a frame in batches"));
    check_errors(study);
    json_decref(study);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_set_timeout(tests,
                      1200); /* on a busy machine prices are measured again until they agree, for minutes */
    tcase_add_checked_fixture(tests, set_up_scene, tear_down);
    tcase_add_test(tests, an_extended_source_is_swept);
    tcase_add_test(tests, errors_are_those_of_the_dials_and_advice_holds);
    tcase_add_test(tests, round_parts_are_swept);
    tcase_add_test(tests, repair_of_an_open_mesh_is_swept);
    tcase_add_test(tests, a_union_has_its_price);
    tcase_add_test(tests, linear_values_between_cells_have_their_price);
    tcase_add_test(tests, batches_are_timed);
    tcase_add_test(tests, advice_stops_at_a_tenth_of_the_noise);
}

SKG_SUITE_MAIN("cost", add_tests)
