/* The slice of the live page: what its voxels are, what each switch does to it, and what it refuses. */
#include "cli/command.h"

#include "live/slice.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = LIVE_SLICE_SIZE };
static const double RADIUS = 50; /* mm, of the cylinder about z */

/* A cylinder of water along z. */
static const char plain[] =
    "{\"Source\": {\"Position\": [0, -400, 0, \"mm\"], \"Shape\": \"PointSource\","
    " \"Beam\": {\"kVp\": 100, \"mAs\": 0.001, \"Filter\": [[\"Al\", 2.5, \"mm\"]]}},"
    " \"Detector\": {\"Position\": [0, 200, 0, \"mm\"], \"UpVector\": [0, 0, -1], \"RightVector\": [1, 0, 0],"
    "  \"NumberOfPixels\": [192, 48], \"Size\": [240, 60, \"mm\"]},"
    " \"Samples\": [{\"Label\": \"water\", \"Cylinder\": [64, 60, 50, \"mm\"], \"Material\": \"Water\","
    "  \"Transform\": [[\"Rotation\", 90, 1, 0, 0]]}]}";

static cli_arguments arguments;
static skg_context *context;

/* Reconstructs with settings, a JSON object. progress: may be NULL. Returns whether there is a slice. */
static int make(const char *settings, skg_live_asked switches, skg_progress *progress, live_slice *slice,
                char *sentence) {
    char text[sizeof plain];
    strcpy(text, plain);
    const live_base base = {
        .arguments = &arguments, .context = context, .path = "scene.json", .precision = -1, .text = text};
    static char words[sizeof "{\"wish\": 0, \"settings\": }" + 8192];
    skg_live_message *message = NULL;
    const int length = snprintf(words, sizeof words, "{\"wish\": 0, \"settings\": %s}", settings);
    ck_skg(skg_live_message_create(words, length, &message));
    live_wish wish = live_wish_of(message);
    const int is_made = live_slice_make(&base, &wish, &switches, progress, slice, sentence);
    live_wish_free(&wish);
    return is_made;
}

static void reconstruct(const char *settings, skg_live_asked switches, live_slice *slice) {
    char sentence[LIVE_SENTENCE] = "";
    ck_assert_msg(make(settings, switches, NULL, slice, sentence), "%s", sentence);
}

/* Mean of the voxels between two radii, mm, and their standard deviation. */
static double mean(const live_slice *slice, double from, double to, double *deviation) {
    double sum = 0, squares = 0;
    int count = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const double x = i % SIZE - 0.5 * (SIZE - 1), y = i / SIZE - 0.5 * (SIZE - 1),
                     r = slice->voxel_mm * hypot(x, y), value = (double)slice->values[i];
        if (r < from || r > to) continue;
        sum += value, squares += value * value, count++;
    }
    ck_assert_int_gt(count, 100);
    if (deviation) *deviation = sqrt(fmax(0, squares / count - sum / count * sum / count));
    return sum / count;
}

static double centre_of(const live_slice *slice) {
    return mean(slice, 0, 15, NULL);
}

static double edge_of(const live_slice *slice) {
    return mean(slice, 38, 44, NULL);
}

/* Water at the mean energy, 1/cm. */
static double truth(double kev) {
    skg_material *water = NULL;
    double per_cm = 0;
    ck_skg(skg_material_create_named("Water", &water));
    ck_skg(skg_material_attenuation_get(water, kev, &per_cm));
    skg_material_release(&water);
    return per_cm;
}

START_TEST(one_energy_is_true_and_a_spectrum_cups) {
    live_slice one, all;
    reconstruct("{}", (skg_live_asked){0}, &one);
    ck_assert_int_eq(one.projections, 120);
    ck_assert_int_eq(one.columns, 96);
    ck_assert_int_eq(one.across, 2);
    ck_assert_double_eq_tol(one.voxel_mm, 2 * 1.05 * RADIUS * sqrt(2) / SIZE, 1e-6); /* the box's corners */
    const double per_cm = truth(one.mean_kev);
    ck_assert_double_eq_tol(centre_of(&one), per_cm, 0.02 * per_cm); /* of the method with 96 columns */
    ck_assert_double_eq_tol(edge_of(&one), centre_of(&one), 0.01 * per_cm);
    ck_assert_double_eq_tol(mean(&one, 60, 66, NULL), 0, 0.02 * per_cm);
    ck_assert(one.truncated == 0 && one.turn_s == 0);
    reconstruct("{}", (skg_live_asked){.spectrum = 1}, &all);
    ck_assert_double_gt(edge_of(&all), 1.02 * centre_of(&all));
    ck_assert_double_lt(centre_of(&all), 0.98 * centre_of(&one)); /* 0.967 of it were found */
}
END_TEST

START_TEST(noise_and_scatter_change_the_slice) {
    live_slice none, noisy, hazy;
    double was, is;
    reconstruct("{}", (skg_live_asked){0}, &none);
    reconstruct("{}", (skg_live_asked){.noise = 1}, &noisy);
    mean(&none, 0, 40, &was), mean(&noisy, 0, 40, &is);
    ck_assert_double_gt(is, 4 * was);
    ck_assert_double_eq_tol(centre_of(&noisy), centre_of(&none),
                            0.01 * centre_of(&none)); /* noise of 1.4 % in each of 800 voxels */
    /* four times the photons, half of the noise: of larger pixels, too */
    reconstruct("{\"Source.Beam.mAs\": 0.004}", (skg_live_asked){.noise = 1}, &noisy);
    mean(&noisy, 0, 40, &was);
    ck_assert_double_eq_tol(was, 0.5 * is,
                            0.1 * is); /* what streaks of one energy add, 0.0002 per cm, and chance */
    reconstruct("{\"Scan\": {\"NumberOfProjections\": 30, \"FinalAngle\": 360}}",
                (skg_live_asked){.scatter = 1}, &hazy);
    ck_assert_double_lt(centre_of(&hazy),
                        0.95 * centre_of(&none)); /* 0.92 of it were found with all projections */
}
END_TEST

/* A sample with a pose for each projection, which steps aside for half of the turn. */
static void put_poses(char *text, size_t size, int projections) {
    size_t at = (size_t)snprintf(text, size,
                                 "{\"Scan\": {\"NumberOfProjections\": %d, \"FinalAngle\": 360},"
                                 " \"Samples.water.Poses\": [",
                                 projections);
    for (int k = 0; k < projections; k++)
        at += (size_t)snprintf(text + at, size - at, "%s[1,0,0,0, 0,0,1,0, 0,-1,0,0, %d,0,0,1]",
                               k ? ", " : "", k >= projections / 2 ? 10 : 0);
    snprintf(text + at, size - at, "]}");
}

START_TEST(motion_changes_the_slice) {
    static char settings[8192];
    live_slice still, moved;
    put_poses(settings, sizeof settings, 90);
    reconstruct(settings, (skg_live_asked){0}, &still);
    ck_assert_int_eq(still.projections, 90);
    reconstruct(settings, (skg_live_asked){.motion = 1}, &moved);
    double most = 0;
    for (int i = 0; i < SIZE * SIZE; i++)
        most = fmax(most, fabs((double)(still.values[i] - moved.values[i])));
    ck_assert_double_gt(most, 0.2 * centre_of(&still));
    ck_assert(moved.turn_s > 0 && still.turn_s == 0);
}
END_TEST

/* A scan of many projections is thinned, and the slice lies where it was asked for. */
START_TEST(a_scan_is_thinned) {
    live_slice slice;
    reconstruct("{\"Scan\": {\"NumberOfProjections\": 400, \"FinalAngle\": 360}}",
                (skg_live_asked){.at_mm = 10}, &slice);
    ck_assert_int_eq(slice.projections, 134);
    ck_assert_double_eq_tol(slice.at_mm, 10, 1e-9); /* rounding of doubles */
    const double per_cm = truth(slice.mean_kev);
    ck_assert_double_eq_tol(centre_of(&slice), per_cm, 0.02 * per_cm); /* of the method with 96 columns */
    static const char flat[] =
        "{\"Scan\": {\"NumberOfProjections\": 90, \"FinalAngle\": 360},"
        " \"Samples.water.Material\": [\"mu\", 0.3], \"Samples.water.Cylinder\": [64, 20, 50, \"mm\"]}";
    char sentence[LIVE_SENTENCE] = "";
    reconstruct(flat, (skg_live_asked){.at_mm = 16}, &slice);
    ck_assert_double_lt(centre_of(&slice), 0.05); /* beyond the cylinder's end */
    ck_assert(!make(flat, (skg_live_asked){.at_mm = 40}, NULL, &slice, sentence));
    ck_assert_msg(strstr(sentence, "it sees slices from -19.17 to 19.17 mm"), "%s",
                  sentence); /* 23 / 2 rows of 2.5 mm, as seen at the axis */
}
END_TEST

static int32_t stop_at_20(int64_t done, int64_t total, void *user) {
    *(int64_t *)user = done;
    return done >= 20 && total > 0;
}

START_TEST(a_slice_is_cancelled) {
    char sentence[LIVE_SENTENCE];
    live_slice slice;
    int64_t done = 0;
    skg_progress *progress = NULL;
    ck_skg(skg_progress_create(stop_at_20, &done, &progress));
    ck_assert_int_eq(make("{}", (skg_live_asked){0}, progress, &slice, sentence), 0);
    ck_assert_int_eq(slice.is_cancelled, 1);
    ck_assert_int_lt(done, 30);
    skg_progress_release(&progress);
}
END_TEST

START_TEST(what_cannot_be_reconstructed_is_refused) {
    static const struct {
        const char *settings, *says;
    } wrong[] = {
        {"{\"Scan\": {\"NumberOfProjections\": 90, \"FinalAngle\": 90}}", "needs 180 degrees plus the fan"},
        {"{\"Detector.Curved\": {\"Radius\": [300, \"mm\"]}}", "not at equal angles"},
        {"{\"Scan\": {\"NumberOfProjections\": 90, \"FinalAngle\": 360, \"Pitch\": [30, \"mm\"]}}", "circle"},
        {"{\"Source.Beem\": 1}", "Beem"},
    };
    char sentence[LIVE_SENTENCE];
    live_slice slice;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        ck_assert_int_eq(make(wrong[i].settings, (skg_live_asked){0}, NULL, &slice, sentence), 0);
        ck_assert_msg(strstr(sentence, wrong[i].says) != NULL, "%s", sentence);
        ck_assert_int_eq(slice.is_cancelled, 0);
    }
    /* the other curved detectors and parallel beams are not */
    reconstruct("{\"Detector.Curved\": {\"Radius\": [600, \"mm\"]}}", (skg_live_asked){0}, &slice);
    ck_assert_double_eq_tol(centre_of(&slice), truth(slice.mean_kev),
                            0.02 * truth(slice.mean_kev)); /* likewise */
    reconstruct("{\"Source.Shape\": \"ParallelBeam\"}", (skg_live_asked){0}, &slice);
    ck_assert_double_eq_tol(centre_of(&slice), truth(slice.mean_kev),
                            0.02 * truth(slice.mean_kev)); /* likewise */
}
END_TEST

static void open_device(void) {
    ck_skg(skg_context_create(NULL, &context));
}

static void close_device(void) {
    skg_context_release(&context);
}

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_device, close_device);
    tcase_add_test(tests, one_energy_is_true_and_a_spectrum_cups);
    tcase_add_test(tests, noise_and_scatter_change_the_slice);
    tcase_add_test(tests, motion_changes_the_slice);
    tcase_add_test(tests, a_scan_is_thinned);
    tcase_add_test(tests, a_slice_is_cancelled);
    tcase_add_test(tests, what_cannot_be_reconstructed_is_refused);
}

SKG_SUITE_MAIN("slice", add_tests)
