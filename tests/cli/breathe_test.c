/* The verbs thorax and breathe. */
#include "cli/command.h"

#include <skiagraph/image.h>

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <time.h>

#define SMALL                                                                                                \
    "--set Detector.NumberOfPixels=[40,40] --set Source.Beam='[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":1}]'"
#define PLAIN "--set Breathing=null"

enum { BYTES_MAX = 1 << 20 };

static char made[64]; /* the folder of the thorax, made once: each test has a copy of its files */

static void make_thorax(void) {
    set_up();
    strcpy(made, folder);
    ck_run(0, "thorax -o . --simple --triangles 10000 --json");
    json_t *object = said_json();
    ck_assert_int_gt(json_integer_value(member(object, "parts")), 60);
    ck_assert_int_gt(json_integer_value(member(object, "triangles")), 8000);
    json_decref(object);
}

static void remove_thorax(void) {
    strcpy(folder, made);
    tear_down();
}

static void set_up_thorax(void) {
    char line[256];
    set_up();
    snprintf(line, sizeof line, "cp %s/* %s", made, folder);
    ck_assert_int_eq(system(line), 0);
}

/* Folders that breathe made, and what is in them. */
static void tear_down_thorax(void) {
    char line[256];
    snprintf(line, sizeof line, "rm -rf %s/f %s/g %s/m", folder, folder, folder);
    ck_assert_int_eq(system(line), 0);
    tear_down();
}

static size_t read_file(const char *name, char *bytes) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_msg(stream != NULL, "no %s", name);
    size_t count = fread(bytes, 1, BYTES_MAX, stream);
    fclose(stream);
    ck_assert_uint_gt(count, 0);
    return count;
}

static void ck_same_files(const char *a, const char *b) {
    static char left[BYTES_MAX], right[BYTES_MAX];
    size_t count = read_file(a, left);
    ck_assert_msg(count == read_file(b, right) && memcmp(left, right, count) == 0, "%s differs from %s", a,
                  b);
}

enum {
    PHASE = 1,
    AMPLITUDE = 2,
    LUNG = 5,
    TIDAL = 6,
    HU = 7,
    RIGHT = 9,
    LIVER_Z = 12,
    CONFLICT = 15,
    BROKEN = 16,
    NEEDLE = 17
};

static char conflict[200];

/* Columns of a line of motion.csv. */
static void read_line(const char *name, int line, int columns, double *values) {
    static char bytes[BYTES_MAX + 1];
    char *at = bytes;
    bytes[read_file(name, bytes)] = '\0';
    for (int i = 0; i < line; i++) {
        at = strchr(at, '\n');
        ck_assert_ptr_nonnull(at);
        at++;
    }
    for (int c = 0; c < columns; c++) {
        values[c] = strtod(at, &at);
        ck_assert(*at == ',');
        at++;
    }
    snprintf(conflict, sizeof conflict, "%.*s", (int)strcspn(at, "\n"), at); /* the last column */
}

/* Head up, the patient's right on the viewer's left: the liver is there, in the lower half. */
START_TEST(the_liver_is_on_the_left) {
    enum { SIDE = 40 };
    static char bytes[BYTES_MAX];
    static float lengths[SIDE * SIDE];
    double sum = 0, column = 0, row = 0;
    ck_run(0, "lbuffer thorax.json %s --part liver -o liver.mha --quiet", SMALL);
    const size_t count = read_file("liver.mha", bytes);
    ck_assert_uint_gt(count, sizeof lengths);
    memcpy(lengths, bytes + count - sizeof lengths, sizeof lengths);
    for (int i = 0; i < SIDE * SIDE; i++) {
        sum += (double)lengths[i];
        column += i % SIDE * (double)lengths[i];
        row += i / SIDE * (double)lengths[i];
    }
    ck_assert_double_gt(sum, 0);
    /* A twentieth of the side left of its middle. */
    ck_assert_double_lt(column / sum, 0.45 * SIDE);
    ck_assert_double_gt(row / sum, 0.5 * SIDE);
}
END_TEST

/* A moment between events, needle half in: as in sequence, where other moments come before. */
START_TEST(a_moment_alone_is_the_moment_in_sequence) {
    ck_run(0, "breathe thorax.json %s --fps 0.25 --seconds 12 --range 0:8 -o f --quiet", SMALL);
    ck_run(0, "breathe thorax.json %s --at 4 --range 0:8 -o one.png", SMALL);
    ck_same_files("f/frame-0001.png", "one.png");
    ck_run(0, "breathe thorax.json %s --at 8 --range 0:8 -o one.png --quiet", SMALL);
    ck_same_files("f/frame-0002.png", "one.png");
}
END_TEST

START_TEST(conflicts_are_reported) { /* too deep a breath for stiff organs */
    double values[18];
    ck_run(0,
           "breathe thorax.json %s --fps 0.25 -o f "
           "--set Breathing='{\"Pattern\":\"deep\",\"Organs\":{\"liver\":{\"Tissue\":[1,1,0.01],"
           "\"Links\":[{\"To\":\"diaphragm\",\"Distance\":[9,\"mm\"]},"
           "{\"To\":\"spine\",\"Distance\":[20,\"mm\"]}]}}}'",
           SMALL);
    read_line("f/motion.csv", 1, 18, values);
    ck_assert(values[CONFLICT] > 1 && values[BROKEN] == 0);
    ck_assert(strstr(conflict, "\"liver: ") && strstr(conflict, "diaphragm"));
    ck_assert(strstr(complained, "liver: ") && strstr(complained, "meet halfway"));
    ck_run(0, "breathe thorax.json %s --fps 0.25 -o f %s --quiet", SMALL, PLAIN);
    read_line("f/motion.csv", 1, 18, values);
    ck_assert(values[CONFLICT] < 0.5);
}
END_TEST

/* The needle passes through skin and liver: it displaces them, and nothing is warned of. */
START_TEST(the_needle_passes_in_silence) {
    ck_run(0, "image thorax.json %s --quantity attenuation -o t.mha", SMALL);
    ck_assert_ptr_null(strstr(complained, "needle"));
    ck_run(0, "image thorax.json %s --quantity attenuation -o t.mha --set Samples.needle.Through=false",
           SMALL);
    ck_assert_ptr_nonnull(strstr(complained, "skin with needle"));
    ck_run_fails(3, "give Through or Priority, not both", "plan thorax.json --set Samples.needle.Priority=3");
}
END_TEST

/* Starts breathe, which writes to the folder f, and lets a signal end it behind the fourth frame. */
static void end_while_it_writes(int number) {
    const struct timespec pause = {.tv_nsec = 10000000};
    int status = 0;
    fflush(NULL);
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        if (chdir(folder) != 0 || !freopen(".complained", "w", stderr) || !freopen("/dev/null", "w", stdout))
            _exit(127);
        execl(SKG_COMMAND, "skiagraph", "breathe", "thorax.json", "-o", "f", "--fps", "500", "--range", "0:8",
              "--set", "Detector.NumberOfPixels=[40,40]", "--set", "Breathing={\"Pattern\":\"quiet\"}",
              (char *)NULL);
        _exit(127);
    }
    while (!has_file("f/frame-0003.png") && waitpid(child, &status, WNOHANG) == 0) nanosleep(&pause, NULL);
    ck_assert_msg(has_file("f/frame-0003.png"), "the command ended before it wrote a frame");
    kill(child, number);
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFSIGNALED(status) && WTERMSIG(status) == number);
}

static int unfinished_files(const char *place) {
    int found = 0;
    DIR *directory = opendir(place);
    for (struct dirent *entry; directory && (entry = readdir(directory));)
        found += strstr(entry->d_name, ".part-") != NULL;
    if (directory) closedir(directory);
    return found;
}

/* Killed, it leaves no table under its name; what it leaves unfinished goes when the next command writes there. */
START_TEST(what_was_killed_is_cleared) {
    char place[256], path[512];
    snprintf(place, sizeof place, "%s/f", folder);
    end_while_it_writes(SIGKILL);
    ck_assert(!has_file("f/motion.csv") && unfinished_files(place) >= 1);
    static const char *const others[] = {"mine.part-1-notes", "far.png.part-1-00000badcafe"};
    for (int i = 0; i < 2; i++) { /* the user's, and perhaps another machine's: both stay */
        snprintf(path, sizeof path, "%s/%s", place, others[i]);
        fclose(fopen(path, "wb"));
    }
    ck_run(0, "breathe thorax.json %s %s --phase 0.25 --range 0:8 -o f/one.png --quiet", SMALL, PLAIN);
    ck_assert(has_file("f/one.png") && has_file("f/frame-0003.png"));
    ck_assert_int_eq(unfinished_files(place), 2);
}
END_TEST

/* Stopped while it writes, it keeps the frames so far and their lines, and says so. */
START_TEST(what_is_written_is_kept) {
    int frames = 0, lines = 0, said_frames = 0;
    end_while_it_writes(SIGINT);
    read_back(".complained", complained, sizeof complained);
    const char *sentence = strstr(complained, "skiagraph: interrupted; ");
    ck_assert_msg(sentence && sscanf(sentence, "skiagraph: interrupted; %d of", &said_frames) == 1, "\"%s\"",
                  complained);
    for (char name[64];; frames++) {
        snprintf(name, sizeof name, "f/frame-%04d.png", frames);
        if (!has_file(name)) break;
    }
    static char table[BYTES_MAX];
    const size_t size = read_file("f/motion.csv", table);
    for (size_t i = 0; i < size; i++) lines += table[i] == '\n';
    ck_assert(table[size - 1] == '\n');
    ck_assert(said_frames >= 3 && said_frames <= frames && lines - 1 >= said_frames &&
              lines - 1 <= said_frames + 1);
}
END_TEST

/* Phase 0.25 is the second of four frames of a breath, and the last of one frame a second from phase 0.25 on.
 */
START_TEST(a_phase_alone_is_the_phase_in_sequence) {
    ck_run(0, "breathe thorax.json %s %s --fps 1 --range 0:8 -o f --quiet", SMALL, PLAIN);
    ck_run(0, "breathe thorax.json %s %s --phase 0.25 --range 0:8 -o one.png --quiet", SMALL, PLAIN);
    ck_run(0,
           "breathe thorax.json %s --set Breathing='{\"Pattern\":\"quiet\",\"StartPhase\":0.25}' --fps 1 "
           "--range 0:8 --seconds 5 -o g --quiet",
           SMALL);
    ck_same_files("f/frame-0001.png", "one.png");
    ck_same_files("g/frame-0000.png", "one.png");
    ck_same_files("g/frame-0004.png", "one.png");
    ck_assert(has_file("f/frame-0003.png") && !has_file("f/frame-0004.png") && has_file("f/contact.png"));
}
END_TEST

/* A breath: the tidal volume of quiet breathing, mass of the lungs, a diaphragm that goes down with the
 * liver. */
START_TEST(motion_is_reported) {
    double in[18], out[18];
    ck_run(0, "breathe thorax.json %s %s --fps 0.5 --set Breathing='{\"Waveform\":\"Sine\"}' -o f --json",
           SMALL, "");
    json_t *object = said_json();
    ck_assert_int_eq(json_integer_value(member(object, "frames")), 2);
    ck_assert(json_real_value(member(object, "frames_per_s")) > 0);
    json_decref(object);
    read_line("f/motion.csv", 1, 18, in);
    read_line("f/motion.csv", 2, 18, out);
    ck_assert(in[PHASE] == 0 && in[AMPLITUDE] == 1 && out[PHASE] == 0.5 && out[AMPLITUDE] == 0);
    ck_assert(in[TIDAL] > 200 && in[TIDAL] < 800); /* coarse lungs are smaller */
    ck_assert_double_eq_tol((in[HU] + 1000) * in[LUNG] / ((out[HU] + 1000) * out[LUNG]), 1,
                            1e-7); /* 9 digits */
    ck_assert(in[RIGHT] > 10 && in[RIGHT] < 20 && fabs(out[RIGHT]) < 1e-9);
    ck_assert(in[LIVER_Z] < -8 && in[BROKEN] == 0 && out[BROKEN] == 0);
}
END_TEST

/* Each frame is an exposure of the scene: its dose is that of the verb dose, times their number. */
START_TEST(a_film_adds_up_its_dose) {
    static const char *const names[] = {"kap_uGy_cm2", "detector_air_kerma_uGy"};
    const char *mas = "--set Source.Beam='{\"kVp\":80,\"mAs\":2}'";
    double one[3], all[3];
    ck_run(0, "dose thorax.json %s %s %s --histories 0 --json", SMALL, PLAIN, mas);
    json_t *object = said_json();
    for (int k = 0; k < 2; k++) one[k] = json_number_value(member(object, names[k]));
    one[2] = json_number_value(member(json_array_get(member(object, "kerma"), 0), "air_kerma_uGy"));
    json_decref(object);
    ck_run(0, "breathe thorax.json %s %s %s --fps 1 --seconds 3 -o f --json", SMALL, PLAIN, mas);
    object = said_json();
    json_t *sum = member(object, "dose");
    for (int k = 0; k < 2; k++) all[k] = json_number_value(member(sum, names[k]));
    all[2] = json_number_value(member(sum, "air_kerma_uGy"));
    json_decref(object);
    for (int k = 0; k < 3; k++) /* floats of the image at the detector */
        ck_assert_double_eq_tol(all[k] / (3 * one[k]), 1, 1e-6);
    ck_run(0, "breathe thorax.json %s %s %s --fps 1 --seconds 3 -o g", SMALL, PLAIN, mas);
    ck_assert_msg(strstr(said, "all frames together: air kerma ") != NULL, "%s", said);
    ck_run(0, "breathe thorax.json %s %s --set Source.Beam='{\"kVp\":80}' --fps 1 --seconds 3 -o m --json",
           SMALL, PLAIN);
    object = said_json();
    ck_assert(json_is_null(member(object, "dose"))); /* a tube without mAs */
    json_decref(object);
}
END_TEST

/* The scene's own events: a hold, and a needle that goes in. */
START_TEST(events_happen) {
    double values[18];
    ck_run(0, "breathe thorax.json %s --fps 0.5 --seconds 10 -o f --quiet", SMALL);
    read_line("f/motion.csv", 2, 18, values); /* 2 s */
    ck_assert(values[NEEDLE] == -20);
    read_line("f/motion.csv", 3, 18, values); /* 4 s: held */
    ck_assert_double_eq_tol(values[PHASE], 0.6, 1e-9);
    ck_assert(values[NEEDLE] > 0 && values[NEEDLE] < 110);
    read_line("f/motion.csv", 5, 18, values); /* 8 s */
    ck_assert(values[NEEDLE] == 110);
    ck_assert(values[AMPLITUDE] == 1 && values[3] == 0.3 && values[4] == 0.3);
}
END_TEST

START_TEST(contrast_fills) {
    static const char beam[] = "--phase 0 --range 0:8 --quiet";
    ck_run(0, "breathe thorax.json %s %s -o a.png", SMALL, beam);
    ck_run(0, "breathe thorax.json %s %s -o b.png --outline ribs,diaphragm@0.5", SMALL, beam);
    static char a[BYTES_MAX], b[BYTES_MAX];
    size_t count = read_file("a.png", a);
    ck_assert(count != read_file("b.png", b) || memcmp(a, b, count) != 0);
    ck_run(0, "breathe thorax.json %s --seconds 11 --fps 0.1 --range 0:8 --quiet -o f", SMALL);
    count = read_file("f/frame-0000.png", b);
    ck_assert(count != read_file("a.png", a) || memcmp(a, b, count) != 0); /* without contrast and needle */
}
END_TEST

START_TEST(meshes_have_displacements) {
    static char bytes[BYTES_MAX + 1];
    ck_run(0, "breathe thorax.json %s %s --phase 0 -o a.mha --meshes m --quiet", SMALL, PLAIN);
    const size_t size = read_file("m/liver-0000.ply", bytes);
    bytes[size] = '\0';
    const char *vertices = strstr(bytes, "element vertex "), *faces = strstr(bytes, "element face ");
    const char *end = strstr(bytes, "end_header\n");
    ck_assert_ptr_nonnull(strstr(bytes, "property double z\nproperty float displacement\n"));
    ck_assert(vertices && faces && end);
    ck_assert_uint_eq(size, (size_t)(end + 11 - bytes) + 28 * strtoul(vertices + 15, NULL, 10) +
                                13 * strtoul(faces + 13, NULL, 10));
    ck_assert(!has_file("m/spine-0000.ply"));
    ck_run(0, "mesh m/liver-0000.ply m/diaphragm-0000.ply --quiet"); /* closed as they move */
}
END_TEST

/* The values of the pixels of a frame, as grey levels. */
static void read_frame(const char *name, double values[1600]) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    ck_assert_int_eq(skg_picture_load(path, 0, values), SKG_OK);
}

/* A detector that holds half of each frame for ever shows half of it, which is ln 2 more of -ln(I/I0). */
START_TEST(films_have_the_lag_of_the_detector) {
    static double plain[1600], held[1600];
    ck_run(0, "breathe thorax.json %s %s --seconds 0.1 --fps 20 --range 0:10 -o f --quiet", SMALL, PLAIN);
    ck_run(
        0,
        "breathe thorax.json %s %s --seconds 0.1 --fps 20 --range 0.69314718:10.69314718 -o g --quiet --set "
        "Detector.GreyValues='{\"Lag\":[[0.5,1e9]]}'",
        SMALL, PLAIN);
    for (int frame = 0; frame < 2; frame++) {
        read_frame(frame ? "f/frame-0001.png" : "f/frame-0000.png", plain);
        read_frame(frame ? "g/frame-0001.png" : "g/frame-0000.png", held);
        double most = 0;
        for (int i = 0; i < 1600; i++) {
            most = fmax(most, plain[i]);
            ck_assert_double_eq_tol(held[i], plain[i],
                                    2.5); /* grey levels, by rounding of floats and of levels */
        }
        ck_assert_double_gt(most, 1000);
    }
    ck_run_fails(3, "add up to 1",
                 "breathe thorax.json %s %s -o g --set Detector.GreyValues='{\"Lag\":[[1,2]]}'", SMALL,
                 PLAIN);
}
END_TEST

START_TEST(what_cannot_be_is_refused) {
    ck_run_fails(2, "-o DIR", "thorax");
    ck_run_fails(2, "--triangles", "thorax -o . --triangles 9");
    ck_run_fails(2, "-o DIR", "breathe thorax.json");
    ck_run_fails(2, "above 0", "breathe thorax.json -o f --fps 0");
    ck_run_fails(2, "--phase x: a phase is a number from 0 to below 1",
                 "breathe thorax.json -o a.png --phase x");
    ck_run_fails(2, "not a number", "breathe thorax.json -o a.png --at nan");
    ck_run_fails(2, "one of them", "breathe thorax.json -o a.png --phase 0 --at 1");
    ck_run_fails(2, "no part", "breathe thorax.json %s -o f --quiet --outline hats", SMALL);
    ck_run_fails(3, "has a Transform",
                 "breathe thorax.json -o f --set Samples.liver.Transform='[[\"Scaling\",1,1,2]]'");
    ck_run_fails(3, "Patern", "breathe thorax.json -o f --set Breathing='{\"Patern\":\"quiet\"}'");
    ck_run_fails(5, "thorax.json: is the input", "breathe thorax.json -o thorax.json");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_unchecked_fixture(tests, make_thorax, remove_thorax);
    tcase_add_checked_fixture(tests, set_up_thorax, tear_down_thorax);
    tcase_add_test(tests, the_liver_is_on_the_left);
    tcase_add_test(tests, the_needle_passes_in_silence);
    tcase_add_test(tests, what_is_written_is_kept);
    tcase_add_test(tests, what_was_killed_is_cleared);
    tcase_add_test(tests, a_phase_alone_is_the_phase_in_sequence);
    tcase_add_test(tests, a_moment_alone_is_the_moment_in_sequence);
    tcase_add_test(tests, conflicts_are_reported);
    tcase_add_test(tests, motion_is_reported);
    tcase_add_test(tests, a_film_adds_up_its_dose);
    tcase_add_test(tests, events_happen);
    tcase_add_test(tests, contrast_fills);
    tcase_add_test(tests, meshes_have_displacements);
    tcase_add_test(tests, films_have_the_lag_of_the_detector);
    tcase_add_test(tests, what_cannot_be_is_refused);
}

SKG_SUITE_MAIN("breathe", add_tests)
