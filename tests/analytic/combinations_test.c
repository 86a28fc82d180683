/* Effects together against the same image made the plain way: path lengths of every part for one point source
 * and one ray a pixel at a time; exponentials, energies, samples, ratios and blur are summed here. Which
 * effects meet is a design of Plackett and Burman (1946): every pair is met on and off in all four ways. All of it is done without
 * and with jaws. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

enum { SIDE = 24, PIXELS = SIDE * SIDE, PARTS = 5, ENERGIES = 40, CHANNELS_MAX = 3, PSF = 3 };

enum {
    TOLERANCE,
    WORLD,
    OPEN, /* an open mesh, repaired */
    PRIORITY,
    CLIP,
    SPOT,
    SUPERSAMPLING,
    BLUR,
    BANDS,
    FALLOFF,
    RATIO,
    EFFECTS,
    JAWS = EFFECTS, /* not of the design */
    SWITCHES
};

static const double edges[CHANNELS_MAX + 1] = {10, 38, 55, 120};
static const double point_spread[PSF * PSF] = {0.05, 0.1, 0.02, 0.1, 0.4, 0.08, 0.05, 0.15, 0.05};
static const double spot_width = 3; /* mm */
static const skg_collimation jaws = {.size = sizeof jaws,
                                     .kind = SKG_COLLIMATION_RECTANGLE,
                                     .distance_mm = 60,
                                     .low = {-15.3, -12.1},
                                     .high = {17.9, 13.7}};

static skg_context *context;
static skg_scene *scene;
static skg_spectrum *spectrum;
static skg_response *response;
static skg_material *materials[PARTS], *world;
static double kev[ENERGIES], photons[ENERGIES];
static skg_view view;
static double bar;

static void add(int part, skg_mesh *mesh, const char *material, double x, double y, double z, int64_t inside,
                int32_t priority) {
    static const char *const labels[PARTS] = {"body", "bone", "fat", "contrast", "metal"};
    skg_part one;
    ck_skg(skg_material_create_named(material, &materials[part]));
    skg_part_init(&one);
    one.mesh = mesh, one.material = materials[part], one.inside = inside, one.priority = priority;
    one.label = labels[part];
    one.pose[3] = x, one.pose[7] = y, one.pose[11] = z;
    ck_skg(skg_scene_part_add(scene, &one, NULL));
    skg_mesh_release(&mesh);
}

static skg_mesh *sphere(double radius) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_sphere(radius, 24, &mesh));
    return mesh;
}

/* A sphere without one of its triangles. */
static skg_mesh *cut_sphere(double radius) {
    skg_mesh *whole = sphere(radius), *mesh = NULL;
    int64_t vertices = 0, triangles = 0;
    ck_skg(skg_mesh_count(whole, &vertices, &triangles));
    double *positions = malloc((size_t)vertices * 3 * sizeof *positions);
    int32_t *corners = malloc((size_t)triangles * 3 * sizeof *corners);
    ck_assert(positions && corners);
    ck_skg(skg_mesh_positions_get(whole, positions, 3));
    ck_skg(skg_mesh_triangles_get(whole, corners, 3));
    ck_skg(skg_mesh_create(context, "cut",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = vertices,
                                              .positions = positions,
                                              .position_stride = 3,
                                              .triangles = triangles - 1,
                                              .corners = corners + 3,
                                              .triangle_stride = 3,
                                              .unit_mm = 1},
                           &mesh));
    free(positions);
    free(corners);
    skg_mesh_release(&whole);
    return mesh;
}

/* Bone and fat overlap; contrast agent leaves the bone that it lies in. */
static void make_scene(const int *on) {
    skg_mesh *box = NULL;
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_mesh_create_cuboid(150, 140, 80, &box));
    add(0, box, "Tissue, Soft (ICRU-44)", 0, 0, 0, -1, 0);
    add(1, sphere(25), "Bone, Cortical (ICRU-44)", -20, 10, 0, 0, on[PRIORITY] ? 2 : 0);
    add(2, sphere(30), "Adipose Tissue (ICRU-44)", 15, 0, 5, 0, on[PRIORITY]);
    add(3, sphere(8), "CsI", -40, 14, 2, 1, 0);
    add(4, on[OPEN] ? cut_sphere(4) : sphere(4), "Al", 30, -45, 0, 0, 0);
}

static void open_all(void) {
    skg_material *iodide = NULL;
    skg_device_info info;
    ck_skg(skg_context_create(NULL, &context));
    for (int i = 0; i < ENERGIES; i++) kev[i] = 20.5 + 2 * i, photons[i] = (i + 4.0) * (ENERGIES - i);
    ck_skg(skg_spectrum_create_bins(ENERGIES, kev, photons, &spectrum));
    ck_skg(skg_material_create_named("CsI", &iodide));
    ck_skg(skg_response_create_scintillator(iodide, 0.6, 0.8, &response));
    skg_material_release(&iodide);
    ck_skg(skg_material_create_named("Polyethylene", &world));
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[2] = -150;
    view.centre[0] = 3, view.centre[2] = 70;
    view.column_step[0] = 7, view.row_step[1] = 6;
    skg_device_info_init(&info);
    ck_skg(skg_context_device_get(context, &info));
    /* Lengths carry 1e-11 and 3e-6 of themselves, exponents are up to 100. */
    bar = info.double_precision ? 1e-8 : 2e-3;
}

static void close_all(void) {
    skg_spectrum_release(&spectrum);
    skg_response_release(&response);
    skg_material_release(&world);
    skg_context_release(&context);
}

static skg_plan_options plain_options(const int *on) {
    skg_plan_options options;
    skg_device_info info;
    skg_device_info_init(&info);
    ck_skg(skg_context_device_get(context, &info));
    skg_plan_options_init(&options);
    options.overlaps = 0;
    options.precision = info.double_precision ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    options.clip = on[CLIP];
    return options;
}

/* --- the plain way --------------------------------------------------------------------------------------- */

/* Whether the jaws stop the ray between two points. */
static int jaws_stop(const double *from, const double *to) {
    const double share = (view.source[2] + jaws.distance_mm - from[2]) / (to[2] - from[2]);
    for (int a = 0; a < 2; a++) {
        const double middle = view.source[a] + (view.centre[a] - view.source[a]) * jaws.distance_mm /
                                                   (view.centre[2] - view.source[2]);
        const double at = from[a] + share * (to[a] - from[a]) - middle;
        if (at < jaws.low[a] || at > jaws.high[a]) return 1;
    }
    return 0;
}

/* Lengths along the rays, mm. */
typedef struct {
    double lengths[PARTS][PIXELS];
    double all[PIXELS], distance; /* rays from end to end; from the source to the plane of the detector */
    int stopped[PIXELS];          /* by the jaws */
} rays;

static skg_plan *plan_lengths(const skg_plan_options *options) {
    const double one_kev = 60, one_photon = 1;
    skg_spectrum *mono = NULL;
    skg_plan *plan = NULL;
    ck_skg(skg_spectrum_create_bins(1, &one_kev, &one_photon, &mono));
    ck_skg(skg_plan_create(context, scene, &view, mono, options, &plan));
    skg_spectrum_release(&mono);
    return plan;
}

static void find_rays(skg_plan *plan, int32_t precision, const skg_view *from, rays *found) {
    skg_output output;
    skg_output_init(&output);
    output.type = precision == SKG_PRECISION_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    ck_skg(skg_plan_view_set(plan, from));
    for (int p = 0; p < PARTS; p++) {
        static float single[PIXELS];
        skg_job *job = NULL;
        output.data = precision == SKG_PRECISION_DOUBLE ? (void *)found->lengths[p] : single;
        output.kind = SKG_OUTPUT_LENGTHS;
        output.part = p;
        ck_skg(skg_plan_submit(plan, 1, NULL, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
        for (int k = 0; k < PIXELS && output.type == SKG_TYPE_FLOAT32; k++)
            found->lengths[p][k] = (double)single[k];
    }
    /* Steps lie along x and y. */
    found->distance = fabs(from->centre[2] - from->source[2]);
    for (int k = 0; k < PIXELS; k++) {
        double square = 0, to[3];
        for (int a = 0; a < 3; a++) {
            to[a] = from->centre[a] + (k % SIDE - 0.5 * (SIDE - 1)) * from->column_step[a] +
                    (k / SIDE - 0.5 * (SIDE - 1)) * from->row_step[a];
            square += (to[a] - from->source[a]) * (to[a] - from->source[a]);
        }
        found->all[k] = sqrt(square);
        found->stopped[k] = jaws_stop(from->source, to);
    }
}

static double mu_of(const skg_material *material, double energy) {
    double per_cm = 0;
    ck_skg(skg_material_attenuation_get(material, energy, &per_cm));
    return 0.1 * per_cm;
}

/* Adds what these rays bring to the channels. */
static void add_rays(const int *on, const rays *r, double share, int channels, double *image) {
    static double behind[CHANNELS_MAX][PIXELS], before[CHANNELS_MAX][PIXELS];
    memset(behind, 0, sizeof behind);
    memset(before, 0, sizeof before);
    for (int e = 0; e < ENERGIES; e++) {
        double mu[PARTS], recorded = 0;
        const double around = on[WORLD] ? mu_of(world, kev[e]) : 0;
        int channel = 0;
        while (channels > 1 && kev[e] >= edges[channel + 1]) channel++;
        for (int p = 0; p < PARTS; p++) mu[p] = mu_of(materials[p], kev[e]);
        ck_skg(skg_response_get(response, kev[e], 1, &recorded, NULL));
        for (int k = 0; k < PIXELS; k++) {
            double exponent = around * r->all[k];
            for (int p = 0; p < PARTS; p++) exponent += (mu[p] - around) * r->lengths[p][k];
            behind[channel][k] += photons[e] * recorded * exp(-exponent);
            before[channel][k] += photons[e] * recorded * exp(-around * r->all[k]);
        }
    }
    for (int c = 0; c < channels; c++)
        for (int k = 0; k < PIXELS; k++) {
            if (on[JAWS] && r->stopped[k]) continue;
            const double fall = on[FALLOFF] ? pow(r->distance / r->all[k], 3) : 1;
            image[c * PIXELS + k] += share * (on[RATIO] ? behind[c][k] / before[c][k] : fall * behind[c][k]);
        }
}

/* The share of a pixel that its neighbours receive; beyond the border the border's pixels are repeated. */
static void blur(double *image) {
    static double from[PIXELS];
    double sum = 0;
    for (int k = 0; k < PSF * PSF; k++) sum += point_spread[k];
    memcpy(from, image, sizeof from);
    for (int row = 0; row < SIDE; row++)
        for (int column = 0; column < SIDE; column++) {
            double value = 0;
            for (int k = 0; k < PSF * PSF; k++) {
                const int i = column - (k % PSF - PSF / 2), j = row - (k / PSF - PSF / 2);
                value += point_spread[k] / sum *
                         from[(j < 0       ? 0
                               : j >= SIDE ? SIDE - 1
                                           : j) *
                                  SIDE +
                              (i < 0       ? 0
                               : i >= SIDE ? SIDE - 1
                                           : i)];
            }
            image[row * SIDE + column] = value;
        }
}

static void make_plainly(const int *on, int channels, double *image) {
    static rays found;
    const int side = on[SPOT] ? 2 : 1, pieces = on[SUPERSAMPLING] ? 2 : 1;
    const skg_plan_options options = plain_options(on);
    skg_plan *lengths = plan_lengths(&options);
    memset(image, 0, CHANNELS_MAX * PIXELS * sizeof *image);
    for (int s = 0; s < side * side * pieces * pieces; s++) {
        const int spot = s / (pieces * pieces), piece = s % (pieces * pieces);
        skg_view one = view;
        /* across the line from the source to the detector's centre, which is tilted by atan(3 / 220) */
        const double tilt = atan2(view.centre[0], view.centre[2] - view.source[2]);
        const double along = on[SPOT] ? (spot % 2 - 0.5) * spot_width / 2 : 0;
        one.source[0] += along * cos(tilt), one.source[2] -= along * sin(tilt);
        one.source[1] += on[SPOT] ? (spot / 2 - 0.5) * spot_width / 2 : 0;
        one.centre[0] += ((piece % pieces + 0.5) / pieces - 0.5) * view.column_step[0];
        one.centre[1] += ((piece / pieces + 0.5) / pieces - 0.5) * view.row_step[1];
        find_rays(lengths, options.precision, &one, &found);
        add_rays(on, &found, 1.0 / (side * side * pieces * pieces), channels, image);
    }
    skg_plan_release(&lengths);
    for (int c = 0; c < channels && on[BLUR]; c++) blur(image + c * PIXELS);
}

/* --- all at once ----------------------------------------------------------------------------------------- */

static void check_together(const int *on) {
    static double plain[CHANNELS_MAX * PIXELS], together[CHANNELS_MAX * PIXELS];
    static float single[CHANNELS_MAX * PIXELS];
    const skg_detector_blur spread = {
        .size = sizeof spread, .columns = PSF, .rows = PSF, .point = point_spread};
    const int channels = on[BANDS] ? CHANNELS_MAX : 1;
    skg_plan_options options = plain_options(on);
    skg_plan *plan = NULL;
    skg_plan_report report;
    skg_output output;
    skg_spot spot;
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_RECTANGLE, spot.extent[0] = spot.extent[1] = spot_width, spot.grid = 2;
    make_scene(on);
    make_plainly(on, channels, plain);
    options.response = response;
    options.tolerance = on[TOLERANCE] ? 1e-3 : 0;
    options.world = on[WORLD] ? world : NULL;
    options.spot = on[SPOT] ? &spot : NULL;
    options.supersampling = on[SUPERSAMPLING] ? 2 : 1;
    options.blur = on[BLUR] ? &spread : NULL;
    options.bands = on[BANDS] ? CHANNELS_MAX : 0, options.band_kev = edges;
    options.falloff = on[FALLOFF];
    options.collimation = on[JAWS] ? &jaws : NULL;
    options.band_weight = SKG_BAND_WEIGHT_ENERGY;
    options.quantity = on[RATIO] ? SKG_QUANTITY_TRANSMISSION : SKG_QUANTITY_ENERGY;
    ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
    skg_output_init(&output);
    output.type = options.precision == SKG_PRECISION_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    output.data = options.precision == SKG_PRECISION_DOUBLE ? (void *)together : single;
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_report_init(&report);
    ck_skg(skg_plan_report_get(plan, &report));
    ck_assert(on[TOLERANCE] ? report.bound > 0 && report.bound <= 1e-3 : report.bound == 0);
    ck_assert_int_eq(report.leaky_parts, on[OPEN]);
    for (int64_t k = 0; k < channels * PIXELS; k++) {
        skg_channel channel;
        skg_channel_init(&channel);
        ck_skg(skg_plan_channel_get(plan, k / PIXELS, &channel));
        const double found = output.type == SKG_TYPE_FLOAT64 ? together[k] : (double)single[k];
        const double unit = fmax(plain[k], 1e-6 * channel.flat_field);
        ck_assert_double_eq_tol(found / unit, plain[k] / unit, report.bound + bar);
    }
    skg_plan_release(&plan);
    for (int p = 0; p < PARTS; p++) skg_material_release(&materials[p]);
    skg_scene_release(&scene);
}

/* Rows 0 to 10: turns of Plackett and Burman's first; then none of the effects, and all of them. */
START_TEST(effects_together) {
    static const int first[EFFECTS] = {1, 1, 0, 1, 1, 1, 0, 0, 0, 1, 0};
    const int run = _i % (EFFECTS + 2);
    int on[SWITCHES];
    for (int k = 0; k < EFFECTS; k++) on[k] = run < EFFECTS ? first[(k + run) % EFFECTS] : run > EFFECTS;
    on[JAWS] = _i >= EFFECTS + 2;
    check_together(on);
}
END_TEST

static void take_half(const skg_view *from, const skg_spot *spot, float *image) {
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_output output;
    skg_plan_options_init(&options);
    options.overlaps = 0;
    options.precision = SKG_PRECISION_HALF;
    options.tolerance = 1e-3; /* half precision keeps every energy all the same */
    options.response = response;
    options.bands = CHANNELS_MAX, options.band_kev = edges;
    options.spot = spot;
    ck_skg(skg_plan_create(context, scene, from, spectrum, &options, &plan));
    skg_output_init(&output);
    output.data = image;
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_release(&plan);
}

/* Half precision rounds each pass by itself: the image of several samples is the mean of theirs. */
START_TEST(half_with_several_samples) {
    static const int none[EFFECTS];
    static float together[CHANNELS_MAX * PIXELS], one[CHANNELS_MAX * PIXELS];
    static double mean[CHANNELS_MAX * PIXELS];
    int differ = 0;
    skg_spot spot;
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_RECTANGLE, spot.extent[0] = spot.extent[1] = 4, spot.grid = 2;
    make_scene(none);
    view.centre[0] = 0;
    take_half(&view, &spot, together);
    for (int s = 0; s < 4; s++) {
        skg_view from = view;
        from.source[0] += s % 2 ? 1 : -1, from.source[1] += s / 2 ? 1 : -1;
        take_half(&from, NULL, one);
        for (int k = 0; k < CHANNELS_MAX * PIXELS; k++) mean[k] += 0.25 * (double)one[k];
    }
    for (int k = 0; k < CHANNELS_MAX * PIXELS; k++) {
        const double off = fabs((double)together[k] - mean[k]) / fmax(mean[k], 1); /* keV */
        differ += off > 4 * 0x1p-24;                                               /* four sums in float */
        /* A position that is off by a rounding may round one of four images the other way. */
        ck_assert_double_le(off, 0x1p-9);
    }
    ck_assert_int_lt(differ, CHANNELS_MAX * PIXELS / 50);
    for (int p = 0; p < PARTS; p++) skg_material_release(&materials[p]);
    skg_scene_release(&scene);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_all, close_all);
    tcase_add_loop_test(tests, effects_together, 0, 2 * (EFFECTS + 2));
    tcase_add_test(tests, half_with_several_samples);
}

SKG_SUITE_MAIN("combinations", add_tests)
