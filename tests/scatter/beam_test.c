/* Scatter behind what stands in the beam, heel effect, bow-tie filter and grid, in an oblique scintillator, and in air. */
#include "subject.h"
#include "suite.h"
#include "support/named.h"

#include <math.h>

/* Objects that change the beam. */
typedef struct {
    skg_heel heel;
    skg_bowtie bowtie;
    skg_grid grid;
    skg_response *response;
    skg_material *world;
} effects;

enum { HEEL = 1, BOWTIE = 2, GRID = 4, OBLIQUE = 8, WORLD = 16 };

static const int combinations[] = {
    0, HEEL, BOWTIE, GRID, OBLIQUE, WORLD, HEEL + BOWTIE + GRID + OBLIQUE + WORLD};
enum { COMBINATIONS = sizeof combinations / sizeof *combinations };

/* mm. Shares change by less than 0.3 % over the sphere. */
static const double RADIUS = 0.2, WORLD_RADIUS = 2;

/* Photons are emitted alike with an effect and without, but others are given up for their low weight: noise of .1 % at most. */
enum { HISTORIES = 1 << 16 };
static const double NOISE = 4e-3;

static const double angles[] = {-30, -12, -4, 5, 30}, paths[] = {25, 8, 1, 3, 20};

static void make_effects(effects *e, double kvp) {
    skg_heel_init(&e->heel);
    e->heel.kvp = kvp, e->heel.angle_deg = 16, e->heel.direction[0] = 1;
    skg_bowtie_init(&e->bowtie);
    e->bowtie.material = named("Aluminum");
    e->bowtie.count = sizeof angles / sizeof *angles, e->bowtie.angle_deg = angles, e->bowtie.path_mm = paths;
    skg_grid_init(&e->grid);
    e->grid.ratio = 8, e->grid.lines_per_cm = 40, e->grid.strip_mm = 0.05, e->grid.focus_mm = 900;
    e->grid.interspace = named("Aluminum");
    skg_material *layer = named("Cesium Iodide");
    ck_skg(skg_response_create_scintillator(layer, 0.2, 0.8, &e->response));
    skg_material_release(&layer);
    skg_material *air = named("Air, Dry (near sea level)"); /* dense enough to be seen */
    ck_skg(skg_material_create_at_density(air, 0.005, &e->world));
    skg_material_release(&air);
}

static void free_effects(effects *e) {
    skg_material_release(&e->bowtie.material);
    skg_material_release(&e->grid.interspace);
    skg_response_release(&e->response);
    skg_material_release(&e->world);
}

static void use(subject *s, const effects *e, int which) {
    s->options.heel = which & HEEL ? &e->heel : NULL;
    s->options.bowtie = which & BOWTIE ? &e->bowtie : NULL;
    s->options.grid = which & GRID ? &e->grid : NULL;
    s->options.oblique = (which & OBLIQUE) != 0;
    s->options.response = which & OBLIQUE ? e->response : NULL;
    s->options.world = which & WORLD ? e->world : NULL;
}

/* keV of a small sphere in the way to a place of the detector, in a beam as wide as the sphere. */
static double sum_of_sphere(const effects *e, int which, double kev, const double at[2]) {
    subject s;
    subject_open(&s);
    solid ball = solid_sphere(RADIUS, 24, 12);
    s.kev = kev;
    subject_add(&s, run_mesh(&ball), "Water, Liquid", at[0] * 5 / 7, at[1] * 5 / 7, 0, -1);
    solid_free(&ball);
    s.jaws.kind = SKG_COLLIMATION_RECTANGLE, s.jaws.distance_mm = 500;
    s.scatter.histories = HISTORIES;
    for (int k = 0; k < 2; k++)
        s.jaws.low[k] = at[k] * 5 / 7 - RADIUS, s.jaws.high[k] = at[k] * 5 / 7 + RADIUS;
    use(&s, e, which);
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    const double sum = subject_sum(&s, p.scatter);
    pictures_free(&p);
    subject_close(&s);
    return sum;
}

/* The share of the primary that an effect leaves on the way to a place of the detector, a pixel's middle. */
static double share_of_primary(const effects *e, int which, double kev, const double at[2]) {
    double values[2];
    for (int k = 0; k < 2; k++) {
        subject s;
        skg_spectrum *beam = NULL;
        subject_open(&s);
        subject_add_box(&s, 1, 1, 1, "Water, Liquid");
        ck_skg(skg_scene_part_pose_set(s.scene, 0,
                                       (const double[16]){1, 0, 0, 400, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
        use(&s, e, k ? which : 0);
        ck_skg(skg_spectrum_create_mono(kev, 1, &beam));
        ck_skg(skg_plan_create(run_context, s.scene, &s.view, beam, &s.options, &s.plan));
        double *image = run_image(s.plan, &s.view);
        values[k] = image[(int64_t)(at[1] / 5 + 14.5) * 40 + (int64_t)(at[0] / 5 + 19.5)];
        free(image);
        skg_spectrum_release(&beam);
        subject_close(&s);
    }
    return values[1] / values[0];
}

/* Equal histories with and without an effect: those of a small sphere differ by the share of its direction. */
START_TEST(emitted_photons_have_the_share_of_their_direction) {
    static const double places[][2] = {{2.5, 2.5}, {-92.5, 12.5}, {87.5, -62.5}, {12.5, 67.5}};
    static const double energies[] = {60, 30, 95};
    effects e;
    make_effects(&e, 100);
    for (size_t p = 0; p < sizeof places / sizeof *places; p++)
        for (int k = 0; k < suite_turns(sizeof energies / sizeof *energies, 1);
             k++) { /* each by the same table of shares */
            const double bare = sum_of_sphere(&e, 0, energies[k], places[p]);
            for (int which = HEEL; which <= HEEL + BOWTIE; which++) {
                const double share = sum_of_sphere(&e, which, energies[k], places[p]) / bare;
                const double primary = share_of_primary(&e, which, energies[k], places[p]);
                printf("to (%g, %g) mm, %g keV, effects %d: %.5f, primary %.5f\n", places[p][0], places[p][1],
                       energies[k], which, share, primary);
                fflush(stdout); /* before an assertion ends the process */
                ck_assert_double_eq_tol(share / primary, 1, NOISE);
            }
        }
    free_effects(&e);
}
END_TEST

/* The path through the filter in closed form. */
START_TEST(a_bowtie_thins_the_beam_by_its_path) {
    static const double at[2] = {87.5, -62.5}, kev = 60;
    effects e;
    make_effects(&e, 100);
    double per_cm = 0;
    ck_skg(skg_material_attenuation_get(e.bowtie.material, kev, &per_cm));
    const double x = at[0] / 700, degree = 3.14159265358979323846 / 180;
    const double low = tan(5 * degree), high = tan(30 * degree);
    const double path =
        (3 + 17 * (x - low) / (high - low)) * sqrt(1 + pow(at[1], 2) / (700 * 700 + at[0] * at[0]));
    const double share = sum_of_sphere(&e, BOWTIE, kev, at) / sum_of_sphere(&e, 0, kev, at);
    ck_assert_double_eq_tol(share / exp(-per_cm / 10 * path), 1, NOISE);
    free_effects(&e);
}
END_TEST

static skg_spectrum *tube(double kvp) {
    skg_spectrum *beam = NULL;
    skg_tube t;
    skg_tube_init(&t);
    t.kvp = kvp, t.bin_kev = 2;
    ck_skg(skg_spectrum_create_tube(&t, &beam));
    return beam;
}

/* The image of the open beam, with its falloff. */
static double *open_image(const effects *e, int which, skg_spectrum *beam) {
    subject s;
    subject_open(&s);
    subject_add_box(&s, 1, 1, 1, "Water, Liquid");
    ck_skg(skg_scene_part_pose_set(s.scene, 0,
                                   (const double[16]){1, 0, 0, 400, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
    use(&s, e, which);
    ck_skg(skg_plan_create(run_context, s.scene, &s.view, beam, &s.options, &s.plan));
    double *image = run_image(s.plan, &s.view);
    subject_close(&s);
    return image;
}

static pictures take(const effects *e, int which, skg_spectrum *beam, int32_t quantity, int noise) {
    subject s;
    subject_open(&s);
    subject_fill(&s);
    use(&s, e, which);
    s.beam = beam;
    s.options.quantity = quantity, s.options.noise = noise;
    subject_plan(&s);
    const pictures p = subject_pictures(&s, NULL);
    subject_close(&s);
    return p;
}

/* A ratio is the energy over that of the open beam behind the same effects, which is the primary's. */
START_TEST(ratios_are_over_the_open_beam_of_each_pixel) {
    effects e;
    skg_spectrum *beams[2] = {tube(90), NULL};
    ck_skg(skg_spectrum_create_mono(60, 1e5, &beams[1]));
    make_effects(&e, 90);
    for (int c = 0; c < COMBINATIONS; c++)
        for (int b = 0; b < 2; b++) {
            const int which = combinations[c];
            double *open = open_image(&e, which, beams[b]), worst = 0;
            pictures energy = take(&e, which, beams[b], SKG_QUANTITY_ENERGY, 0);
            pictures ratio = take(&e, which, beams[b], SKG_QUANTITY_TRANSMISSION, 0);
            for (int64_t i = 0; i < energy.count; i++) {
                const double share = (double)energy.scatter[i] / open[i];
                worst = fmax(worst, fabs((double)ratio.scatter[i] / share - 1));
                /* The image has what is shown of the scatter. */
                ck_assert_double_eq_tol((double)ratio.image[i], (double)energy.image[i] / open[i],
                                        1e-4 * (double)ratio.image[i]);
            }
            printf("effects %d, beam %d: off by %.2g\n", which, b, worst);
            fflush(stdout); /* before an assertion ends the process */
            /* The primary's shares are fitted; the worst that was found is 3e-5. */
            ck_assert_double_le(worst, 1e-4);
            pictures_free(&energy);
            pictures_free(&ratio);
            free(open);
        }
    skg_spectrum_release(&beams[0]);
    skg_spectrum_release(&beams[1]);
    free_effects(&e);
}
END_TEST

/* With noise photons are divided by the flat field later: of many photons the image is the same. */
START_TEST(noisy_ratios_are_the_same_on_average) {
    effects e;
    skg_spectrum *beam = NULL;
    ck_skg(skg_spectrum_create_mono(60, 1e12, &beam));
    make_effects(&e, 90);
    for (int c = 1; c < COMBINATIONS; c++) {
        const int which = combinations[c];
        pictures still = take(&e, which, beam, SKG_QUANTITY_TRANSMISSION, 0);
        pictures noisy = take(&e, which, beam, SKG_QUANTITY_TRANSMISSION, 1);
        for (int64_t i = 0; i < still.count; i++)
            /* 1e12 photons have noise of 1e-6; both are over fits as above. */
            ck_assert_double_eq_tol((double)noisy.image[i], (double)still.image[i],
                                    1e-4 * (double)still.image[i]);
        pictures_free(&still);
        pictures_free(&noisy);
    }
    skg_spectrum_release(&beam);
    free_effects(&e);
}
END_TEST

/* A component of the scatter. */
static double component_of(subject *s, int32_t component) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.kind = SKG_OUTPUT_SCATTER_COMPONENT, output.component = component;
    float *image = calloc((size_t)(s->view.rows * s->view.columns), sizeof *image);
    output.data = image;
    ck_skg(skg_plan_submit(s->plan, 1, NULL, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    const double sum = subject_sum(s, image);
    free(image);
    return sum;
}

/* From the source to a small sphere with 60 keV, and on with what the angle has left: exp(-mu l) of both ways. What the world itself
 * scatters is taken away: that around an empty sphere. */
START_TEST(a_world_attenuates_both_ways) {
    static const double at[3] = {0, 0, 0}, detector[3] = {120, 0, 200}, kev = 60, electron = 510.99895;
    for (int parallel = 0; parallel < 2; parallel++) {
        effects e;
        double sums[4][2], left = 0, per_cm[2];
        make_effects(&e, 90);
        for (int run = 0; run < 4;
             run++) { /* water in vacuum, in the world; the world around nothing; not met */
            const int which = run ? WORLD : 0;
            subject s;
            subject_open(&s);
            solid ball = solid_sphere(WORLD_RADIUS, 24, 12);
            subject_add(&s, run_mesh(&ball), run != 2 ? "Water, Liquid" : "Vacuum", at[0], at[1], at[2], -1);
            solid_free(&ball);
            for (int k = 0; k < 3; k++) s.view.centre[k] = detector[k];
            s.view.columns = s.view.rows = 8;
            s.view.column_step[0] = s.view.row_step[1] = 1;
            if (parallel) s.view.projection = SKG_PROJECTION_PARALLEL, s.view.source[0] = 120;
            s.jaws.kind = SKG_COLLIMATION_RECTANGLE, s.jaws.distance_mm = 500;
            for (int k = 0; k < 2; k++) {
                const double middle = k ? 0 : parallel ? 120 : detector[0] * 500 / 700;
                s.jaws.low[k] = -middle - WORLD_RADIUS, s.jaws.high[k] = -middle + WORLD_RADIUS;
            }
            s.scatter.histories = 1 << 18;
            s.options.world_scatter_off = run == 3;
            use(&s, &e, which);
            subject_plan(&s);
            for (int k = 0; k < 2; k++)
                sums[run][k] = component_of(&s, k ? SKG_SCATTER_COMPONENT_COMPTON_FIRST
                                                  : SKG_SCATTER_COMPONENT_RAYLEIGH_FIRST);
            subject_close(&s);
        }
        const double on = hypot(detector[0], detector[2]), before = 500;
        left = kev / (1 + kev / electron * (1 - detector[2] / on));
        ck_skg(skg_material_attenuation_get(e.world, kev, &per_cm[0]));
        ck_skg(skg_material_attenuation_get(e.world, left, &per_cm[1]));
        for (int k = 0; k < 2; k++) {
            ck_assert(sums[3][k] == sums[0][k]); /* the same histories through the same cells */
            const double share = (sums[1][k] - sums[2][k]) / sums[0][k],
                         expected = exp(-(per_cm[0] * before + per_cm[k] * on) / 10);
            printf("parallel %d, %s: %.5f, closed form %.5f\n", parallel, k ? "Compton" : "Rayleigh", share,
                   expected);
            fflush(stdout); /* before an assertion ends the process */
            /* The world scatters up to as much as the sphere, which takes up to a few per cent off that from behind it; both are known to
             * 1 % or better. */
            ck_assert_double_eq_tol(share / expected, 1, 3e-2);
        }
        free_effects(&e);
    }
}
END_TEST

START_TEST(dense_worlds_are_refused) {
    subject s;
    subject_open(&s);
    subject_fill(&s);
    s.options.world = named("Water, Liquid");
    skg_material *world = s.options.world;
    ck_skg_fails(subject_try(&s), SKG_ERR_UNSUPPORTED, "make it a part that holds the others");
    s.view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    s.view.source[2] = 1;
    ck_skg_fails(subject_try(&s), SKG_ERR_UNSUPPORTED, "a parallel beam from infinity");
    skg_material_release(&world);
    s.view.projection = SKG_PROJECTION_POINT;
    s.view.source[2] = -500;
    s.options.world = world = named("mu:0.0001");
    ck_skg_fails(subject_try(&s), SKG_ERR_MATERIAL, "World: mu:0.0001");
    skg_material_release(&world);
    subject_close(&s);
}
END_TEST

/* A field that is wider than what the effects are given for. */
START_TEST(fields_that_are_too_wide_are_refused) {
    for (int which = HEEL; which <= BOWTIE; which++) {
        effects e;
        subject s;
        skg_output output;
        skg_job *job = NULL;
        make_effects(&e, 90);
        subject_open(&s);
        subject_fill(&s);
        use(&s, &e, which);
        s.jaws.kind = SKG_COLLIMATION_RECTANGLE, s.jaws.distance_mm = 700;
        for (int k = 0; k < 2; k++) s.jaws.low[k] = -500, s.jaws.high[k] = 500;
        subject_plan(&s);
        skg_output_init(&output);
        output.data = calloc((size_t)(s.view.rows * s.view.columns), sizeof(float));
        skg_status status = skg_plan_submit(s.plan, 1, NULL, 1, &output, &job);
        if (status == SKG_OK) status = skg_job_wait(&job);
        ck_skg_fails(status, which == HEEL ? SKG_ERR_BEAM : SKG_ERR_SCENE,
                     which == HEEL ? "in the field of the beam"
                                   : "but the field of the beam from -35.54 to 35.54 degrees");
        free(output.data);
        subject_close(&s);
        free_effects(&e);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, emitted_photons_have_the_share_of_their_direction);
    tcase_add_test(tests, a_bowtie_thins_the_beam_by_its_path);
    tcase_add_test(tests, ratios_are_over_the_open_beam_of_each_pixel);
    tcase_add_test(tests, noisy_ratios_are_the_same_on_average);
    tcase_add_test(tests, a_world_attenuates_both_ways);
    tcase_add_test(tests, dense_worlds_are_refused);
    tcase_add_test(tests, fields_that_are_too_wide_are_refused);
}

SKG_SUITE_MAIN("scatter/beam", add_tests)
