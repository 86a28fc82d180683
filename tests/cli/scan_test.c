/* The verb scan. */
#include "cli/command.h"

#include "cli/scene.h"
#include "support/random.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <time.h>

#define SCAN "--set Scan='{\"NumberOfProjections\":12,\"FinalAngle\":360}'"
enum { COLUMNS = 65, ROWS = 49, COUNT = 12, BYTES_MAX = 1 << 24 };

static char bytes[BYTES_MAX], before[BYTES_MAX];

static void set_up_scan(void) {
    set_up();
    write_text("scene.json", scene);
}

static void tear_down_scan(void) {
    char line[128];
    snprintf(line, sizeof line, "rm -rf %s", folder);
    ck_assert_int_eq(system(line), 0);
}

static size_t read_file(const char *name, char *to) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_msg(stream != NULL, "no %s", name);
    const size_t count = fread(to, 1, BYTES_MAX, stream);
    fclose(stream);
    return count;
}

/* Each slice of the stack is the image of the same scene whose scan begins there. */
START_TEST(projections_are_images) {
    enum { IMAGE = COLUMNS * ROWS * sizeof(float) };
    ck_run(0, "scan scene.json %s -o scan.mha", SCAN);
    ck_assert(strstr(said, "scan.mha has 12 of 12") != NULL);
    const size_t size = read_file("scan.mha", bytes);
    for (int k = 0; k < COUNT; k += 5) {
        ck_run(0,
               "image scene.json -o one.mha --quiet --set "
               "Scan='{\"NumberOfProjections\":12,\"FinalAngle\":390,\"StartAngle\":%d}'",
               30 * k);
        const size_t one = read_file("one.mha", before);
        ck_assert_mem_eq(before + one - IMAGE, bytes + size - (size_t)(COUNT - k) * IMAGE, IMAGE);
    }
}
END_TEST

/* Of 60000 in the free beam, twice as much is cut off at 65535; intensities are over that of the first projection. */
START_TEST(intensities_that_do_not_fit) {
    static const char set[] =
        "--set Scan='{\"NumberOfProjections\":3,\"FinalAngle\":360,\"Intensity\":[%s]}'";
    char settings[200];
    snprintf(settings, sizeof settings, set, "1,2,0.5");
    ck_run(0, "scan scene.json %s -o bright.mha --grey16", settings);
    static uint16_t values[3 * COLUMNS * ROWS];
    const size_t size = read_file("bright.mha", bytes);
    memcpy(values, bytes + size - sizeof values, sizeof values);
    int clipped = 0;
    for (int i = 0; i < 3 * COLUMNS * ROWS; i++) clipped += values[i] == 65535;
    ck_assert_int_gt(clipped, 0);
    char warning[100];
    snprintf(warning, sizeof warning,
             "%d pixels of the projections are at 65535, the greatest grey value of 16 bits", clipped);
    ck_assert_msg(strstr(complained, warning) != NULL, "%s: not \"%s\"", complained, warning);
    snprintf(settings, sizeof settings, set, "2,1,4");
    ck_run_fails(3, "begins with 2, but is over that of the first projection",
                 "scan scene.json %s -o two.mha --grey16", settings);
}
END_TEST

/* The beam is on for three projections; a pixel beside the parts shows what comes later. */
START_TEST(projections_leave_a_lag) {
    enum { IMAGE = COLUMNS * ROWS * sizeof(float) };
    static const char settings[] =
        "--set Scan='{\"NumberOfProjections\":12,\"FinalAngle\":360,\"Intensity\":[1,1,1,0,0,0,0,0,0,0,0,0]}' "
        "--set Detector.GreyValues='{\"Bits\":0,\"Lag\":[[0.1,2]]}'";
    const double stays = exp(-0.5);
    ck_run(0, "scan scene.json %s -o scan.mha --quiet", settings);
    const size_t size = read_file("scan.mha", bytes);
    double held = 0;
    for (int k = 0; k < COUNT; k++) {
        float shown;
        memcpy(&shown, bytes + size - (size_t)(COUNT - k) * IMAGE, sizeof shown);
        const double light = k < 3 ? 60000 : 0;
        ck_assert_double_eq_tol((double)shown, 0.9 * light + held * (1 - stays), 0.05); /* 1e-6 of floats */
        held = held * stays + 0.1 * light;
    }
    ck_run_fails(2, "the detector has Lag", "scan scene.json %s -o other.mha --only 3", settings);
    ck_run_fails(2, "--from: the detector has Lag", "scan scene.json %s -o other.mha --from 3", settings);
    ck_run_fails(2, "shards: the detector has Lag", "scan scene.json %s -o other.mha --shard 1/2", settings);
    ck_run(0, "scan scene.json %s -o other.mha --to 5 --quiet", settings);
    ck_run_fails(2, "remove the output and begin anew", "scan scene.json %s -o other.mha", settings);
    ck_run(0, "scan scene.json %s --set 'Detector.GreyValues.Ghosting=[[-0.1,2]]' -o ghost.mha --quiet",
           settings);
    const size_t with = read_file("ghost.mha", bytes);
    for (int k = 0; k < 3;
         k++) { /* 0.1 of the light is held, and what comes is less by the ghost of the open beam */
        float shown;
        memcpy(&shown, bytes + with - (size_t)(COUNT - k) * IMAGE, sizeof shown);
        const double q = 1 - pow(stays, k), earlier = k < 1 ? 0 : 1 - 0.1 * (k < 2 ? 0 : 1 - stays);
        const double first =
            k < 2 ? 0 : 0.1 * stays; /* of the first projection, still held before the third */
        held = 60000 * (0.1 * earlier + first);
        ck_assert_double_eq_tol((double)shown, 0.9 * 60000 * (1 - 0.1 * q) + held * (1 - stays), 0.05);
    }
    ck_run_fails(
        2, "--from: the detector has Ghosting",
        "scan scene.json %s --set Detector.GreyValues='{\"Ghosting\":[[-0.1,2]]}' -o other.mha --from 3",
        settings);
    ck_run_fails(3, "add up to 1", "scan scene.json %s --set 'Detector.GreyValues.Lag=[[1,2]]' -o bad.mha",
                 settings);
}
END_TEST

START_TEST(parts_of_a_scan_make_the_whole) {
    ck_run(0, "scan scene.json %s -o whole.mha --quiet", SCAN);
    ck_run(0, "scan scene.json %s -o scan.mha --only 3,7 --json", SCAN);
    json_t *object = said_json();
    ck_assert_int_eq(json_integer_value(member(object, "computed")), 2);
    ck_assert(json_is_false(member(object, "finished")));
    json_decref(object);
    ck_assert(has_file("scan.mha.progress") && !has_file("scan.mha.lock"));
    ck_run(0, "scan scene.json %s -o scan.mha --from 2 --to 5 --strategy atomics --json", SCAN);
    object = said_json();
    ck_assert_int_eq(json_integer_value(member(object, "computed")), 3);
    ck_assert_int_eq(json_integer_value(member(object, "found")), 2);
    json_decref(object);
    ck_run(0, "scan scene.json %s -o scan.mha", SCAN);
    ck_assert(strstr(complained, "it is continued") != NULL);
    ck_assert(!has_file("scan.mha.progress"));
    ck_run(0, "scan scene.json %s -o scan.mha", SCAN);
    ck_assert(strstr(said, "is finished") != NULL);
    for (int again = 0; again < 2; again++)
        ck_run(0, "scan scene.json --set Scan='{\"NumberOfProjections\":1,\"FinalAngle\":360}' -o one.mha");
    ck_assert_msg(strstr(said, "one.mha is finished: it has its 1 projection\n") != NULL, "%s", said);
    const size_t size = read_file("whole.mha", before);
    ck_assert_uint_eq(read_file("scan.mha", bytes), size);
    ck_assert_mem_eq(bytes, before, size);
}
END_TEST

/* The scene, a file that it names, a quantity: each makes another scan. */
START_TEST(another_state_of_the_scene_is_another_scan) {
    static const char *const changes[] = {"--quantity photons", "--precision double", "--tolerance 0.01",
                                          "--set Samples.bone.Material='[\"mu\",0.6]'"};
    ck_run(0, "scan scene.json %s -o scan.tif --quiet", SCAN);
    for (int i = 0; i < 4; i++)
        ck_run_fails(5, "another scan", "scan scene.json %s -o scan.tif %s", SCAN, changes[i]);
    ck_run(0, "scan scene.json %s -o scan.tif %s --overwrite --quiet", SCAN, changes[0]);
    write_text("poses.csv", "0 -400 0 0 100 0 -1 0 0 0 0 -2\n");
    ck_run(0, "scan scene.json --set Scan='{\"Table\":\"poses.csv\"}' -o table.raw --quiet");
    write_text("poses.csv", "0 -401 0 0 100 0 -1 0 0 0 0 -2\n");
    ck_run_fails(5, "another scan", "scan scene.json --set Scan='{\"Table\":\"poses.csv\"}' -o table.raw");
    ck_run_fails(
        5, "./poses.csv: is read by the scene, as poses.csv; name another file",
        "scan scene.json --set Scan='{\"Table\":\"poses.csv\"}' -o other.raw --geometry ./poses.csv");
    ck_assert(!has_file("other.raw"));
}
END_TEST

START_TEST(a_folder_and_a_geometry) {
    ck_run(0, "scan scene.json %s --set Source.Shape=Point -o out --geometry g.csv --geometry g.xml --quiet",
           SCAN);
    ck_assert(has_file("out/projection-00000.tif") && has_file("out/projection-00011.tif"));
    ck_assert(has_file("g.csv") && has_file("g.xml"));
    ck_run(
        0,
        "scan scene.json --set Source.Shape=Point --set Scan='{\"Table\":\"g.csv\"}' -o table.raw --quiet");
    ck_run(0, "scan scene.json %s --set Source.Shape=Point -o circle.raw --quiet", SCAN);
    const size_t size = read_file("circle.raw", before);
    ck_assert_uint_eq(read_file("table.raw", bytes), size);
    ck_assert_mem_eq(bytes, before, size);
}
END_TEST

/* The mean and the standard deviation of the floats at the end of a file. */
static void look_at_end(const char *name, int images, double *mean, double *deviation) {
    const size_t count = (size_t)images * COLUMNS * ROWS, size = read_file(name, bytes);
    ck_assert_uint_ge(size, count * sizeof(float));
    double sum = 0, squares = 0;
    for (size_t i = 0; i < count; i++) {
        float value;
        memcpy(&value, bytes + size - (count - i) * sizeof value, sizeof value);
        sum += (double)value, squares += (double)value * (double)value;
    }
    *mean = sum / (double)count;
    *deviation = sqrt(squares / (double)count - *mean * *mean);
}

/* Beside a stack stand stacks of fields: flat fields of I0 and dark fields of 0, both with the electronic noise of 300 keV. Means and
 * deviations are known to five times their standard errors. */
START_TEST(stacks_have_fields_beside) {
    static const char noise[] = "--set Noise='{\"Quantum\":false,\"Electronic\":[300,\"keV\"]}'";
    static const char *const endings[] = {"mha", "raw", "tif"};
    char name[64];
    double mean, deviation;
    for (int e = 0; e < 3; e++) {
        ck_run(0, "scan scene.json %s %s --flats 5 --darks 3 --only 0 -o scan.%s --geometry g.csv --quiet",
               SCAN, noise, endings[e]);
        snprintf(name, sizeof name, "scan-flats.%s", endings[e]);
        look_at_end(name, 5, &mean, &deviation);
        /* five standard errors */
        ck_assert_double_eq_tol(mean, 60000, 5 * 300 / sqrt(5 * COLUMNS * ROWS));
        ck_assert_double_eq_tol(deviation / 300, 1, 5 / sqrt(2 * 5 * COLUMNS * ROWS));
        snprintf(name, sizeof name, "scan-darks.%s", endings[e]);
        look_at_end(name, 3, &mean, &deviation);
        /* five standard errors */
        ck_assert_double_eq_tol(mean, 0, 5 * 300 / sqrt(3 * COLUMNS * ROWS));
        ck_assert_double_eq_tol(deviation / 300, 1, 5 / sqrt(2 * 3 * COLUMNS * ROWS));
        before[read_file("g.csv", before)] = '\0';
        ck_assert_msg(strstr(before, name) != NULL, "%s", before);
    }
    ck_assert(has_file("scan-flats.mhd") && has_file("scan-darks.mhd"));
    /* A finished scan gets other numbers of them; and another scan removes them. */
    ck_run(0, "scan scene.json %s -o whole.mha --quiet --set Scan.Darks='{\"Number\":2}'", SCAN);
    ck_assert_uint_lt(read_file("whole-darks.mha", bytes), 2 * COLUMNS * ROWS * sizeof(float) + 2048);
    look_at_end("whole-darks.mha", 2, &mean, &deviation);
    ck_assert(mean == 0 && deviation == 0);
    ck_run(0, "scan scene.json %s -o whole.mha --quiet --overwrite", SCAN);
    ck_assert(!has_file("whole-darks.mha") && !has_file("whole-flats.mha"));
    ck_run(0, "scan scene.json %s -o whole.mha --quiet --flats 2 --darks 0", SCAN);
    look_at_end("whole-flats.mha", 2, &mean, &deviation);
    /* 6e-8 each, of floats */
    ck_assert(fabs(mean - 60000) < 1 && !has_file("whole-darks.mha"));
}
END_TEST

START_TEST(a_folder_has_fields) {
    ck_run(0, "scan scene.json %s --flats 3 --darks 2 -o out --only 0 --quiet", SCAN);
    ck_assert(has_file("out/flat-00000.tif") && has_file("out/flat-00002.tif") &&
              has_file("out/dark-00001.tif"));
    ck_run(0, "scan scene.json %s --flats 1 --darks 1 -o out --only 0 --quiet", SCAN);
    ck_assert(has_file("out/flat-00000.tif") && !has_file("out/flat-00001.tif"));
    ck_assert(has_file("out/dark-00000.tif") && !has_file("out/dark-00001.tif"));
    ck_run(0, "scan scene.json %s -o none --only 0 --quiet", SCAN);
    ck_assert(!has_file("none/flat-00000.tif") && !has_file("none/dark-00000.tif"));
}
END_TEST

START_TEST(what_cannot_be_is_refused) {
    ck_run_fails(2, "-o FILE", "scan scene.json");
    ck_run_fails(2, ".png", "scan scene.json -o a.png");
    ck_run_fails(3, "no key Scan", "scan scene.json -o a.mha");
    ck_run_fails(3, "number of projections", "scan scene.json -o a.mha --set Scan='{\"StartAngle\":3}'");
    ck_run_fails(2, "--only", "scan scene.json %s -o a.mha --only 3,x", SCAN);
    ck_run_fails(2, "the scan has 0 to 11", "scan scene.json %s -o a.mha --to 12", SCAN);
    ck_run_fails(2, "from 12 to 11", "scan scene.json %s -o a.mha --from 12", SCAN);
    ck_run_fails(2, "projection 12; the scan has 0 to 11", "scan scene.json %s -o a.mha --only 3,12", SCAN);
    ck_run_fails(2, "the numbers rise", "scan scene.json %s -o a.mha --only 3,2", SCAN);
    ck_assert(!has_file("a.mha"));
    ck_run_fails(5, "parallel", "scan scene.json %s -o a.mha --geometry a.xml", SCAN);
    ck_run_fails(3, "a short scan",
                 "scan scene.json -o a.mha --set Scan='{\"NumberOfProjections\":3,\"Short\":true}'");
}
END_TEST

/* Killed by SIGKILL at 20 random moments, and each time continued: the bytes are those of a scan without an
 * interruption. */
START_TEST(kills_leave_no_trace) {
    static const char scan[] =
        "\"Scan={\\\"NumberOfProjections\\\":400,\\\"FinalAngle\\\":360}\" --set \"Detector.NumberOfPixels=[130,98]\"";
    static const char *const names[] = {"scan.mha", "scan.raw", "scan.tif", "scan.h5"};
    if (_i == 3 && !SKG_HAS_HDF5) return;
    const char *name = names[_i];
    struct timespec begun, ended;
    uint64_t state = 17 + (uint64_t)_i;
    char whole[64];
    snprintf(whole, sizeof whole, "whole%s", name + 4);
    clock_gettime(CLOCK_MONOTONIC, &begun);
    ck_run(0, "scan scene.json --quiet -o %s --set %s", whole, scan);
    clock_gettime(CLOCK_MONOTONIC, &ended);
    const double span =
        (double)(ended.tv_sec - begun.tv_sec) + 1e-9 * (double)(ended.tv_nsec - begun.tv_nsec);
    for (int kills = 0; kills < suite_turns(20, 5); kills++) {
        /* The shell is replaced by the command, so that the signal meets the command. */
        char line[1024];
        snprintf(line, sizeof line, "cd %s && exec %s scan scene.json --quiet -o %s --set %s 2>.complained",
                 folder, SKG_COMMAND, name, scan);
        fflush(NULL);
        const pid_t child = fork();
        ck_assert_int_ge(child, 0);
        if (child == 0) {
            execl("/bin/sh", "sh", "-c", line, (char *)NULL);
            _exit(127);
        }
        const double delay = draw(&state, 0.1, 1.1) * span;
        const struct timespec pause = {(time_t)delay, (long)(1e9 * (delay - (double)(time_t)delay))};
        int status = 0;
        nanosleep(&pause, NULL);
        kill(child, SIGKILL);
        ck_assert_int_eq(waitpid(child, &status, 0), child);
        ck_assert(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
    }
    ck_run(0, "scan scene.json --quiet -o %s --set %s", name, scan);
    const size_t size = read_file(whole, before);
    ck_assert_uint_eq(read_file(name, bytes), size);
    ck_assert_mem_eq(bytes, before, size);
}
END_TEST

/* Starts the command on a scan of many projections, and waits until some of them are finished. */
static pid_t start_scan(const char *name) {
    char line[1024];
    snprintf(line, sizeof line,
             "cd %s && exec %s scan scene.json --quiet -o %s --set \"Scan={\\\"NumberOfProjections\\\":20000,"
             "\\\"FinalAngle\\\":360}\" 2>.complained",
             folder, SKG_COMMAND, name);
    fflush(NULL);
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        execl("/bin/sh", "sh", "-c", line, (char *)NULL);
        _exit(127);
    }
    return child;
}

static int64_t finished_in(const char *name) {
    int64_t count = 0;
    char path[512], text[256 + 20000];
    snprintf(path, sizeof path, "%s/%s.progress", folder, name);
    FILE *stream = fopen(path, "rb");
    const size_t got = stream ? fread(text, 1, sizeof text, stream) : 0;
    for (size_t i = 256; i < got; i++) count += text[i] == 1;
    if (stream) fclose(stream);
    return count;
}

/* A signal of a job manager: the command ends by itself, what it has is whole, and its parent sees the signal. */
START_TEST(a_signal_ends_a_scan_in_order) {
    static const int numbers[] = {SIGTERM, SIGUSR1, SIGXCPU};
    const struct timespec pause = {.tv_nsec = 5000000};
    int status = 0;
    const pid_t child = start_scan("scan.mha");
    while (finished_in("scan.mha") < 3) {
        ck_assert_int_eq(waitpid(child, &status, WNOHANG), 0);
        nanosleep(&pause, NULL);
    }
    kill(child, numbers[_i]);
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFSIGNALED(status) && WTERMSIG(status) == numbers[_i]);
    ck_assert(has_file("scan.mha.progress") &&
              !has_file("scan.mha.lock")); /* it had time to give up its lock */
    read_back(".complained", complained, sizeof complained);
    ck_assert_msg(strstr(complained, "what is done is kept") != NULL, "%s", complained);
    ck_assert_int_ge(finished_in("scan.mha"), 3);
}
END_TEST

/* A byte of a finished .h5, and of an unfinished .mha, is changed. */
START_TEST(damage_is_found_and_mended) {
    const char *name = _i == 0 ? "scan.mha" : "scan.h5";
    char path[512];
    if (_i == 1 && !SKG_HAS_HDF5) return;
    ck_run_fails(3, "no output of this scan to verify", "scan scene.json %s -o %s --verify", SCAN, name);
    ck_assert(!has_file(name));
    ck_run(0, "scan scene.json %s -o whole.mha --quiet", SCAN);
    const size_t stack = read_file("whole.mha", before), image = COLUMNS * ROWS * sizeof(float);
    const char *third = before + stack - (COUNT - 3) * image;
    ck_run(0, "scan scene.json %s -o %s --quiet %s", SCAN, name, _i == 0 ? "--to 7" : "");
    ck_run(_i == 0, "scan scene.json %s -o %s --verify", SCAN, name);
    ck_assert_msg(strstr(said, " 0 are damaged") != NULL, "%s", said);
    const size_t size = read_file(name, bytes);
    size_t at = 0;
    while (at + image < size && memcmp(bytes + at, third, image) != 0) at++;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "r+b");
    ck_assert(stream && fseek(stream, (long)(at + image / 3), SEEK_SET) == 0);
    fputc(bytes[at + image / 3] ^ 1, stream);
    fclose(stream);
    ck_run(1, "scan scene.json %s -o %s --verify --json", SCAN, name);
    json_t *object = said_json();
    /* the .mha is unfinished, so that opening it has marked the projection already */
    ck_assert_int_eq(json_integer_value(member(object, "damaged")), 1);
    ck_assert_int_eq(json_integer_value(member(object, "intact")), _i == 0 ? 7 : COUNT - 1);
    json_decref(object);
    ck_run(0, "scan scene.json %s -o %s", SCAN, name);
    const size_t again = read_file(name, bytes);
    ck_assert_uint_eq(again, size);
    at = 0;
    while (at + image < size && memcmp(bytes + at, third, image) != 0) at++;
    ck_assert_uint_le(at + image, size);
}
END_TEST

/* A cylinder of 0.2 per cm with a ball of 0.5 per cm: scanned, written, read, reconstructed. The middle plane has these
 * values within 1 %, two voxels from the surfaces. */
START_TEST(a_volume_has_the_coefficients) {
    enum { SIDE = 48, SLICE = SIDE * SIDE };
    static const char body[] =
        "{\"Source\": {\"Position\": [0, -400, 0, \"mm\"], \"Shape\": \"PointSource\",\n"
        "    \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]},\n"
        "  \"Detector\": {\"Position\": [0, 200, 0, \"mm\"], \"UpVector\": [0, 0, -1],\n"
        "    \"NumberOfPixels\": [240, 16], \"Spacing\": [0.5, 0.5, \"mm\"], \"Oversampling\": 4},\n"
        "  \"Scan\": {\"NumberOfProjections\": 360, \"FinalAngle\": 360},\n"
        "  \"Samples\": [\n"
        "    {\"Label\": \"body\", \"Cylinder\": [200, 60, 30, \"mm\"], \"Type\": \"outer\",\n"
        "     \"Transform\": [[\"Rotation\", 1, 0, 0, 90]], \"Material\": [\"mu\", 0.2]},\n"
        "    {\"Label\": \"ball\", \"Sphere\": [100, 8, \"mm\"], \"Material\": [\"mu\", 0.5],\n"
        "     \"Transform\": [[\"Translation\", 10, 0, 0, \"mm\"]]}]}\n";
    if (!SKG_HAS_HDF5) {
        ck_run_fails(3, "has no HDF5", "reconstruct scan.h5 -o volume.mha");
        return;
    }
    write_text("body.json", body);
    ck_run(0, "scan body.json -o scan.h5 --only 0 --quiet");
    ck_run_fails(3, "359 of 360 projections are missing", "reconstruct scan.h5 -o volume.mha");
    ck_run(0, "scan body.json -o scan.h5 --quiet");
    ck_run(0, "reconstruct scan.h5 -o volume.mha --size 48 --voxel 1.2 --filter hann --json");
    json_t *object = said_json();
    ck_assert_int_eq(json_integer_value(member(object, "projections")), 360);
    json_decref(object);
    const size_t size = read_file("volume.mha", bytes);
    const float *slice = (const float *)(const void *)(bytes + size) - (size_t)(SIDE / 2) * SLICE;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            float value;
            memcpy(&value, slice + SIDE * y + x, sizeof value);
            const double from = 1.2 * hypot(x - 23.5, y - 23.5),
                         ball = 1.2 * hypot(x - 23.5 - 10 / 1.2, y - 23.5);
            if (ball < 8 - 2.4)
                ck_assert_double_eq_tol((double)value, 0.5, 0.005); /* 1 %, the bar */
            else if (ball > 8 + 2.4 && from < 27)
                ck_assert_double_eq_tol((double)value, 0.2, 0.002); /* 1 %, the bar */
        }
    ck_assert_msg(strstr(complained, "crops") == NULL, "%s", complained);
    ck_run(0, "reconstruct scan.h5 -o crop.mha --size 24"); /* of .5 mm x 400 / 600 */
    ck_assert_msg(strstr(complained, "--size 24 crops: the volume is 8 mm wide, of 79.") != NULL, "%s",
                  complained);
    ck_assert_msg(
        strstr(complained,
               "8 of 24 slices lie beyond the rows of the detector, which sees the axis from -2.5 to 2.5 mm"),
        "%s", complained);
    ck_run(0, "reconstruct scan.h5 -o low.mha --size 24 --voxel 0.2"); /* to 2.3 mm */
    ck_assert_msg(strstr(complained, "slices lie beyond") == NULL, "%s", complained);
    ck_run_fails(2, "volume.png is no .mha; give -o FILE.mha", "reconstruct scan.h5 -o volume.png");
    ck_run(0, "scan body.json -o scan.h5 --packed packed.h5 --packed-grey16 --quiet");
    ck_run(0, "reconstruct packed.h5 -o grey.mha --size 48 --voxel 1.2 --filter hann --json");
    object = said_json();
    ck_assert_int_eq(json_integer_value(member(object, "projections")), 360);
    json_decref(object);
    ck_run_fails(5, "packed copy", "scan body.json -o packed.h5");
    ck_run_fails(2, "to another .h5", "scan body.json -o scan.mha --packed packed.h5");
    ck_run_fails(2, "add it", "scan body.json -o scan.h5 --packed-grey16");
    /* A stack, with the table of its poses, from which the axis follows, gives the same volume. */
    for (int with_fields = 0; with_fields < 2; with_fields++) {
        ck_run(0, "scan body.json -o stack.mha --geometry stack.csv --quiet --overwrite%s",
               with_fields ? " --flats 2 --precision double" : "");
        ck_run(
            0,
            "reconstruct stack.mha --geometry stack.csv -o other.mha --size 48 --voxel 1.2 --filter hann --quiet");
        ck_assert_uint_eq(read_file("volume.mha", bytes), size);
        const size_t its = read_file("other.mha", before); /* its place is written with more digits */
        for (size_t i = 0; i < SIDE * SLICE; i++) {
            float one, other;
            memcpy(&one, bytes + size - 4 * (SIDE * SLICE - i), sizeof one);
            memcpy(&other, before + its - 4 * (SIDE * SLICE - i), sizeof other);
            ck_assert_double_eq_tol((double)other, (double)one,
                                    1e-5); /* 2e-5 of the ball: roundings of poses and logarithms */
        }
    }
    ck_run_fails(3, "give them by --geometry", "reconstruct stack.mha -o other.mha");
    ck_run_fails(2, "scan.h5 has its geometry inside",
                 "reconstruct scan.h5 --geometry stack.csv -o other.mha");
    ck_run(0, "scan body.json -o few.mha --geometry few.csv --quiet --set Scan.NumberOfProjections=4");
    ck_run_fails(3, "few.csv: has 4 poses, but stack.mha has 360 projections",
                 "reconstruct stack.mha --geometry few.csv -o other.mha");
    write_text("none.mha", "projections");
    ck_run_fails(3, "none.mha: ", "reconstruct none.mha --geometry few.csv -o other.mha");
    ck_run(0, "scan body.json -o scan.nxs --quiet --set Scan.NumberOfProjections=90");
    ck_run(0, "reconstruct scan.nxs -o nexus.mha --size 48 --voxel 1.2 --quiet");
    ck_run_fails(3, "is no HDF5 file", "reconstruct body.json -o volume.mha");
    ck_run_fails(3, "none.h5: cannot be read: No such file", "reconstruct none.h5 -o volume.mha");
    ck_run(0, "scan body.json --set Scan.FinalAngle=90 -o part.h5 --quiet");
    ck_run_fails(3, "180 degrees plus the fan", "reconstruct part.h5 -o volume.mha");
}
END_TEST

/* Shards in files of their own, joined, are the scan that one process makes. */
START_TEST(shards_are_joined) {
    static const char *const names[] = {"scan.mha", "scan.h5"};
    const char *name = names[_i];
    if (_i == 1 && !SKG_HAS_HDF5) return;
    ck_run(0, "scan scene.json %s -o whole%s --quiet", SCAN, name + 4);
    ck_run(0, "scan scene.json %s -o %s --shard 1/3 --quiet", SCAN, name);
    ck_run(0, "scan scene.json %s -o %s --shard 3/3 --quiet", SCAN, name);
    ck_run_fails(3, "2-of-3", "scan scene.json %s -o %s --join", SCAN, name);
    ck_run(0, "scan scene.json %s -o %s --shard 2/3 --json", SCAN, name);
    json_t *object = said_json();
    ck_assert_int_eq(json_integer_value(member(object, "projections")), 4);
    json_decref(object);
    ck_run_fails(3, "no files of shards", "scan scene.json %s -o other%s --join", SCAN, name + 4);
    ck_run(0, "scan scene.json %s -o %s --join", SCAN, name);
    ck_assert(strstr(said, "has all 12 projections") != NULL);
    char whole[64];
    snprintf(whole, sizeof whole, "whole%s", name + 4);
    const size_t size = read_file(whole, before);
    ck_assert_uint_eq(read_file(name, bytes), size);
    ck_assert_mem_eq(bytes, before, size);
    ck_run_fails(2, "I/N", "scan scene.json %s -o %s --shard 4/3", SCAN, name);
    ck_run_fails(2, "leave out", "scan scene.json %s -o %s --shard 1/3 --from 2", SCAN, name);
    ck_run_fails(2, "shards are files", "scan scene.json %s -o folder --shard 1/3", SCAN);
}
END_TEST

/* Each projection shows the thorax at its own time, as breathe shows it. */
START_TEST(each_projection_has_its_own_time) {
    enum { SIDE = 40, IMAGE = SIDE * SIDE * sizeof(float) };
    static const char beam[] = "--set Detector.NumberOfPixels=[40,40] --set "
                               "Source.Beam='[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":1}]'";
    ck_run(0, "thorax -o . --simple --triangles 10000 --quiet");
    ck_run(0,
           "scan thorax.json %s --breathing --quantity attenuation -o scan.mha --quiet --set "
           "Scan='{\"NumberOfProjections\":3,\"StartTime\":0.5,\"Interval\":1.5}'",
           beam);
    const size_t size = read_file("scan.mha", bytes);
    for (int k = 0; k < 3; k++) {
        ck_run(0, "breathe thorax.json %s --at %g --range 0:8 -o one.mha --quiet", beam, 0.5 + 1.5 * k);
        const size_t one = read_file("one.mha", before);
        ck_assert_mem_eq(before + one - IMAGE, bytes + size - (size_t)(3 - k) * IMAGE, IMAGE);
    }
}
END_TEST

/* A breath lasts 4 s, and projections are 0.5 s apart from 0.1 s on: each of four phases has two of every eight. */
START_TEST(phases_have_their_projections) {
    enum { SIDE = 16, IMAGE = SIDE * SIDE * sizeof(float), ALL = 16 };
    ck_run(0, "thorax -o . --simple --triangles 10000 --quiet");
    ck_run(
        0,
        "scan thorax.json --breathing --phases 4 -o scan.mha --quiet --set Detector.NumberOfPixels=[16,16] "
        "--set Source.Beam='[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":1}]' --set "
        "Breathing.Period=4 --set Breathing.StartPhase=0 --set Breathing.Events=[] --set Scan='{\"NumberOfProjections\":16,\"FinalAngle\":360,\"StartTime\":0.1,\"Interval\":0.5}'");
    const size_t size = read_file("scan.mha", bytes);
    for (int bin = 0; bin < 4; bin++) {
        char name[64];
        snprintf(name, sizeof name, "scan.phase-%d-of-4.mha", bin + 1);
        const size_t its = read_file(name, before);
        ck_assert_ptr_nonnull(strstr(before, "DimSize = 16 16 4"));
        /* Phase k/4 is at k seconds; half a second before it belongs to it, half a second behind it does not. */
        for (int n = 0, k = 0; k < ALL; k++)
            if ((k + 1) / 2 % 4 == bin) {
                ck_assert_mem_eq(before + its - (size_t)(4 - n) * IMAGE,
                                 bytes + size - (size_t)(ALL - k) * IMAGE, IMAGE);
                n++;
            }
    }
    ck_run_fails(2, "add --breathing", "scan thorax.json --phases 4 -o a.mha");
    ck_run_fails(2, "phases are files", "scan thorax.json --breathing --phases 4 -o folder");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scan, tear_down_scan);
    tcase_add_test(tests, projections_are_images);
    tcase_add_test(tests, projections_leave_a_lag);
    tcase_add_test(tests, intensities_that_do_not_fit);
    tcase_add_test(tests, parts_of_a_scan_make_the_whole);
    tcase_add_test(tests, another_state_of_the_scene_is_another_scan);
    tcase_add_test(tests, a_folder_and_a_geometry);
    tcase_add_test(tests, stacks_have_fields_beside);
    tcase_add_test(tests, a_folder_has_fields);
    tcase_add_test(tests, what_cannot_be_is_refused);
    tcase_add_test(tests, a_volume_has_the_coefficients);
    tcase_add_loop_test(tests, shards_are_joined, 0, 2);
    tcase_add_test(tests, each_projection_has_its_own_time);
    tcase_add_test(tests, phases_have_their_projections);
    tcase_add_loop_test(tests, kills_leave_no_trace, 0, 4);
    tcase_add_loop_test(tests, a_signal_ends_a_scan_in_order, 0, 3);
    tcase_add_loop_test(tests, damage_is_found_and_mended, 0, 2);
}

SKG_SUITE_MAIN("scan", add_tests)
