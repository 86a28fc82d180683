/* Images of several energies against Beer and Lambert, summed here over the bins, along rays whose path
 * lengths are those of slabs. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <float.h>
#include <math.h>

enum { SIDE = 33, PARTS = 3, LIMIT = 200 };

/* A box of soft tissue, 80 mm along the ray; in it 10 mm of bone, and in that 3 mm of iodine solution. */
static const double thickness[PARTS] = {80, 10, 3};
static const char *const matter[PARTS] = {"Tissue, Soft (ICRU-44)", "Bone, Cortical (ICRU-44)", "I"};

static skg_context *context;
static skg_material *materials[PARTS];
static skg_scene *scene;
static skg_view view;

static void open_scene(void) {
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_scene_create(context, &scene));
    for (int i = 0; i < PARTS; i++) {
        skg_mesh *box = NULL;
        skg_part part;
        ck_skg(skg_material_create_named(matter[i], &materials[i]));
        ck_skg(skg_mesh_create_cuboid(100 - 30 * i, 100 - 30 * i, thickness[i], &box));
        skg_part_init(&part);
        part.mesh = box, part.material = materials[i], part.inside = i - 1;
        part.label = matter[i];
        ck_skg(skg_scene_part_add(scene, &part, NULL));
        skg_mesh_release(&box);
    }
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[2] = -1000;
    view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = 4;
}

static void close_scene(void) {
    for (int i = 0; i < PARTS; i++) skg_material_release(&materials[i]);
    skg_scene_release(&scene);
    skg_context_release(&context);
}

/* mm along the ray of a pixel: 1 / cos times the thickness, within the shadow of a box's inner part. */
static double secant(int column, int row) {
    const double x = 4.0 * (column - SIDE / 2), y = 4.0 * (row - SIDE / 2);
    return sqrt(x * x + y * y + 1200 * 1200) / 1200;
}

static skg_spectrum *tube(double kvp) {
    skg_tube t;
    skg_spectrum *spectrum = NULL;
    skg_material *aluminium = NULL;
    ck_skg(skg_material_create_element(13, &aluminium));
    const skg_filter filter = {.size = (int32_t)sizeof filter, .material = aluminium, .thickness_mm = 2.5};
    skg_tube_init(&t);
    t.kvp = kvp, t.filter_count = 1, t.filters = &filter;
    ck_skg(skg_spectrum_create_tube(&t, &spectrum));
    skg_material_release(&aluminium);
    return spectrum;
}

static double mu_of(const skg_material *material, double kev) {
    double per_cm = 0;
    ck_skg(skg_material_attenuation_get(material, kev, &per_cm));
    return 0.1 * per_cm;
}

/* Whether photons count 1, or by their recorded energy. */
static int counts(const skg_plan_options *options) {
    if (options->quantity == SKG_QUANTITY_PHOTONS) return 1;
    return options->quantity >= SKG_QUANTITY_TRANSMISSION && options->bands &&
           options->band_weight == SKG_BAND_WEIGHT_PHOTONS;
}

/* Sum over the bins of worth * photons behind the parts (all of them: the centre), and in front of them. */
static void sum_bins(const skg_spectrum *spectrum, const skg_plan_options *options, double longer, double low,
                     double high, double *behind, double *before) {
    int64_t count = 0;
    ck_skg(skg_spectrum_bin_count(spectrum, &count));
    *behind = *before = 0;
    for (int64_t i = 0; i < count; i++) {
        double kev = 0, photons = 0, recorded = 0, efficiency = 1, exponent = 0;
        ck_skg(skg_spectrum_bin_get(spectrum, i, &kev, &photons));
        if (kev < low || kev >= high) continue;
        recorded = kev;
        if (options->response) ck_skg(skg_response_get(options->response, kev, 1, &recorded, &efficiency));
        for (int p = 0; p < PARTS; p++) {
            const double inner = p + 1 < PARTS ? thickness[p + 1] : 0;
            exponent += mu_of(materials[p], kev) * (thickness[p] - inner) * longer;
        }
        double world = options->world ? mu_of(options->world, kev) * 1200 * longer : 0;
        const double worth = counts(options) ? efficiency : recorded;
        *before += photons * worth * exp(-world);
        if (options->world) world -= mu_of(options->world, kev) * thickness[0] * longer;
        *behind += photons * worth * exp(-exponent - world);
    }
}

static double expected(const skg_plan_options *options, double behind, double before, double longer) {
    switch (options->quantity) {
    case SKG_QUANTITY_TRANSMISSION:
        return behind / before;
    case SKG_QUANTITY_ATTENUATION:
        return -log(behind / before);
    case SKG_QUANTITY_FLUENCE:
        behind /= 16;
    }
    return options->falloff == SKG_FALLOFF_ON ? behind / (longer * longer * longer) : behind;
}

/* Makes the image and compares the pixels of the inner shadow. tolerance: relative. */
static void check(const skg_spectrum *spectrum, const skg_plan_options *options, double tolerance) {
    static double image[4][SIDE][SIDE];
    skg_plan *plan = NULL;
    skg_output output;
    int64_t channels = 0;
    ck_skg(skg_plan_create(context, scene, &view, (skg_spectrum *)spectrum, options, &plan));
    ck_skg(skg_plan_channel_count(plan, &channels));
    ck_assert_int_eq(channels, options->bands ? options->bands : 1);
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    ck_skg(skg_plan_image(plan, &output));
    for (int64_t c = 0; c < channels; c++) {
        skg_channel channel;
        skg_channel_init(&channel);
        ck_skg(skg_plan_channel_get(plan, c, &channel));
        for (int k = -3; k <= 3; k++) {
            const double longer = secant(SIDE / 2 + k, SIDE / 2 - 1);
            double behind = 0, before = 0;
            sum_bins(spectrum, options, longer, options->bands ? options->band_kev[c] : 0,
                     options->bands ? options->band_kev[c + 1] : 1e9, &behind, &before);
            const double truth = expected(options, behind, before, longer);
            ck_assert_double_eq_tol(image[c][SIDE / 2 - 1][SIDE / 2 + k] / truth, 1, tolerance);
            if (k == 0 && !options->world)
                ck_assert_double_eq_tol(channel.flat_field,
                                        options->quantity == SKG_QUANTITY_TRANSMISSION  ? 1
                                        : options->quantity == SKG_QUANTITY_ATTENUATION ? 0
                                        : options->quantity == SKG_QUANTITY_FLUENCE     ? before / 16
                                                                                        : before,
                                        64 * DBL_EPSILON * before);
        }
    }
    skg_plan_release(&plan);
}

static skg_plan_options options_of(int32_t precision, int32_t quantity) {
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.precision = precision;
    options.quantity = quantity;
    return options;
}

/* Single: exponents up to 20 carry 2^-24 of themselves from each of coefficient, length and product. Double:
 * the scale of the planes leaves 2^-50 of the depth. */
static double bar(int32_t precision) {
    return precision == SKG_PRECISION_SINGLE ? 20 * 4 * 0x1p-24 : 20 * 1e-12;
}

START_TEST(every_quantity) {
    const int32_t precision = _i % 2, quantity = _i / 2;
    if (precision == SKG_PRECISION_DOUBLE) { /* where the device has it */
        skg_plan *plan = NULL;
        skg_plan_options trial = options_of(SKG_PRECISION_DOUBLE, quantity);
        skg_spectrum *mono = NULL;
        ck_skg(skg_spectrum_create_mono(60, 1, &mono));
        const skg_status status = skg_plan_create(context, scene, &view, mono, &trial, &plan);
        skg_plan_release(&plan);
        skg_spectrum_release(&mono);
        if (status == SKG_ERR_UNSUPPORTED) return;
    }
    skg_plan_options options = options_of(precision, quantity);
    skg_spectrum *spectrum = tube(110);
    check(spectrum, &options, bar(precision));
    skg_material *csi = NULL, *air = NULL;
    skg_response *response = NULL;
    ck_skg(skg_material_create_named("CsI", &csi));
    ck_skg(skg_response_create_scintillator(csi, 0.6, 1, &response));
    options.response = response;
    check(spectrum, &options, bar(precision));
    ck_skg(skg_material_create_named("water", &air)); /* in water: what air does not show */
    options.world = air;
    check(spectrum, &options, 2 * bar(precision));
    options.falloff = 1;
    check(spectrum, &options, 2 * bar(precision));
    skg_material_release(&csi);
    skg_material_release(&air);
    skg_response_release(&response);
    skg_spectrum_release(&spectrum);
}
END_TEST

START_TEST(one_energy_has_one_plane) {
    skg_spectrum *spectrum = NULL;
    skg_material *water = NULL;
    ck_skg(skg_spectrum_create_mono(60, 1000, &spectrum));
    ck_skg(skg_material_create_named("water", &water));
    for (int32_t quantity = SKG_QUANTITY_ENERGY; quantity <= SKG_QUANTITY_ATTENUATION; quantity++) {
        skg_plan_options options = options_of(SKG_PRECISION_SINGLE, quantity);
        check(spectrum, &options, bar(SKG_PRECISION_SINGLE));
        options.world = water;
        check(spectrum, &options, 2 * bar(SKG_PRECISION_SINGLE));
    }
    skg_plan *plan = NULL;
    skg_plan_report report;
    skg_plan_report_init(&report);
    ck_skg(skg_plan_create(context, scene, &view, spectrum, NULL, &plan));
    ck_skg(skg_plan_report_get(plan, &report));
    ck_assert_int_eq(report.planes, 1);
    skg_plan_release(&plan);
    skg_material_release(&water);
    skg_spectrum_release(&spectrum);
}
END_TEST

START_TEST(bands_are_channels) {
    static const double edges[5] = {10, 33, 50, 70, 200};
    skg_spectrum *spectrum = tube(110);
    skg_material *layer = NULL;
    skg_response *silicon = NULL;
    ck_skg(skg_material_create_element(14, &layer));
    ck_skg(skg_response_create_scintillator(layer, 0.5, 1, &silicon));
    skg_material_release(&layer);
    for (int32_t quantity = SKG_QUANTITY_ENERGY; quantity <= SKG_QUANTITY_ATTENUATION; quantity++) {
        skg_plan_options options = options_of(SKG_PRECISION_SINGLE, quantity);
        options.bands = 4, options.band_kev = edges;
        /* By photons and energy, of an ideal detector and of one of silicon. */
        const int32_t ways = quantity < SKG_QUANTITY_TRANSMISSION ? 1 : 4;
        for (int32_t k = 0; k < ways; k++) {
            options.band_weight = k % 2 ? SKG_BAND_WEIGHT_ENERGY : SKG_BAND_WEIGHT_PHOTONS;
            options.response = k > 1 ? silicon : NULL;
            check(spectrum, &options, bar(SKG_PRECISION_SINGLE));
        }
    }
    static const double falling[3] = {30, 20, 40}, nothing[3] = {10, 100, 200};
    skg_plan_options options = options_of(SKG_PRECISION_SINGLE, SKG_QUANTITY_TRANSMISSION);
    skg_plan *plan = NULL;
    options.bands = 2, options.band_kev = falling;
    ck_skg_fails(skg_plan_create(context, scene, &view, spectrum, &options, &plan), SKG_ERR_BEAM, "rise");
    options.band_kev = nothing;
    skg_spectrum *mono = NULL;
    ck_skg(skg_spectrum_create_mono(60, 1, &mono));
    ck_skg_fails(skg_plan_create(context, scene, &view, mono, &options, &plan), SKG_ERR_BEAM, "channel 1");
    options.bands = SKG_CHANNELS_MAX + 1;
    ck_skg_fails(skg_plan_create(context, scene, &view, mono, &options, &plan), SKG_ERR_ARGUMENT, "bands");
    options.bands = 2, options.band_weight = 2;
    ck_skg_fails(skg_plan_create(context, scene, &view, mono, &options, &plan), SKG_ERR_ARGUMENT, "weight");
    skg_spectrum_release(&mono);
    skg_spectrum_release(&spectrum);
    skg_response_release(&silicon);
}
END_TEST

/* 120 kV behind 20 cm of water, one band from 20 keV: the figures of a sum by hand. */
START_TEST(a_band_counts_photons) {
    static const double edges[2] = {20, 200};
    skg_spectrum *spectrum = tube(120);
    skg_material *water = NULL;
    skg_mesh *slab = NULL;
    skg_scene *phantom = NULL;
    skg_part part;
    skg_output output;
    static float image[SIDE * SIDE];
    double sums[2][2] = {{0}}; /* [by energy][behind] */
    int64_t count = 0;
    ck_skg(skg_material_create_named("water", &water));
    ck_skg(skg_spectrum_bin_count(spectrum, &count));
    for (int64_t i = 0; i < count; i++) {
        double kev = 0, photons = 0;
        ck_skg(skg_spectrum_bin_get(spectrum, i, &kev, &photons));
        if (kev < edges[0]) continue;
        const double passed = photons * exp(-mu_of(water, kev) * 200);
        sums[0][0] += photons, sums[0][1] += passed;
        sums[1][0] += photons * kev, sums[1][1] += passed * kev;
    }
    /* Half a unit of the last of the digits that docs/physics.md tells. */
    ck_assert_double_eq_tol(sums[0][1] / sums[0][0], 0.0129, 0.00005);
    /* As above. */
    ck_assert_double_eq_tol(sums[1][1] / sums[1][0], 0.0165, 0.00005);
    ck_skg(skg_mesh_create_cuboid(100, 100, 200, &slab));
    ck_skg(skg_scene_create(context, &phantom));
    skg_part_init(&part);
    part.mesh = slab, part.material = water;
    ck_skg(skg_scene_part_add(phantom, &part, NULL));
    skg_output_init(&output);
    output.data = image;
    for (int32_t k = 0; k < 4; k++) {
        const int32_t weight = k % 2, is_logarithm = k / 2;
        skg_plan *plan = NULL;
        skg_plan_options options = options_of(SKG_PRECISION_SINGLE, is_logarithm ? SKG_QUANTITY_ATTENUATION
                                                                                 : SKG_QUANTITY_TRANSMISSION);
        options.bands = 1, options.band_kev = edges, options.band_weight = weight;
        ck_skg(skg_plan_create(context, phantom, &view, spectrum, &options, &plan));
        ck_skg(skg_plan_image(plan, &output));
        const double shown = (double)image[SIDE / 2 * SIDE + SIDE / 2];
        const double found = is_logarithm ? exp(-shown) : shown;
        ck_assert_double_eq_tol(found * sums[weight][0] / sums[weight][1], 1, bar(SKG_PRECISION_SINGLE));
        skg_plan_release(&plan);
    }
    skg_scene_release(&phantom);
    skg_mesh_release(&slab);
    skg_material_release(&water);
    skg_spectrum_release(&spectrum);
}
END_TEST

/* A metre of lead: transmission is 0, attenuation stands far beyond float's range. */
START_TEST(attenuation_beyond_any_float) {
    skg_spectrum *spectrum = tube(110);
    skg_material *lead = NULL;
    skg_mesh *block = NULL;
    skg_scene *thick = NULL;
    skg_part part;
    skg_plan *plan = NULL;
    static float image[SIDE * SIDE];
    ck_skg(skg_material_create_element(82, &lead));
    ck_skg(skg_mesh_create_cube(1000, &block));
    ck_skg(skg_scene_create(context, &thick));
    skg_part_init(&part);
    part.mesh = block, part.material = lead;
    part.pose[11] = -400;
    ck_skg(skg_scene_part_add(thick, &part, NULL));
    for (int32_t quantity = SKG_QUANTITY_TRANSMISSION; quantity <= SKG_QUANTITY_ATTENUATION; quantity++) {
        skg_plan_options options = options_of(SKG_PRECISION_SINGLE, quantity);
        skg_output output;
        skg_output_init(&output);
        output.data = image;
        ck_skg(skg_plan_create(context, thick, &view, spectrum, &options, &plan));
        ck_skg(skg_plan_image(plan, &output));
        const double centre = (double)image[SIDE * SIDE / 2];
        if (quantity == SKG_QUANTITY_TRANSMISSION)
            ck_assert_double_eq(centre, 0);
        else { /* the least attenuated energy rules: within a few ln of its share */
            double least = HUGE_VAL;
            for (double kev = 20; kev < 110; kev += 0.5) least = fmin(least, mu_of(lead, kev) * 1000);
            ck_assert_double_ge(centre, 0.99 * least);
            ck_assert_double_le(centre, 1.05 * least + 20);
        }
        skg_plan_release(&plan);
    }
    skg_scene_release(&thick);
    skg_mesh_release(&block);
    skg_material_release(&lead);
    skg_spectrum_release(&spectrum);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_loop_test(tests, every_quantity, 0, 2 * (SKG_QUANTITY_ATTENUATION + 1));
    tcase_add_test(tests, one_energy_has_one_plane);
    tcase_add_test(tests, bands_are_channels);
    tcase_add_test(tests, a_band_counts_photons);
    tcase_add_test(tests, attenuation_beyond_any_float);
}

SKG_SUITE_MAIN("polychromatic", add_tests)
