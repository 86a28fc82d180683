/* Scatter in frames: exact relations between images, and the same bits however they are made. */
#include "subject.h"
#include "suite.h"

#include <float.h>
#include <math.h>
#include <string.h>

static void same(const float *a, const float *b, int64_t count) {
    ck_assert_mem_eq(a, b, (size_t)count * sizeof *a);
}

/* The pictures of a subject that is planned anew, after which the subject is closed. */
static pictures take(subject *s) {
    subject_plan(s);
    const pictures p = subject_pictures(s, NULL);
    subject_close(s);
    return p;
}

START_TEST(nothing_scatters_nothing) {
    for (int beside = 0; beside < 2; beside++) {
        subject s;
        subject_open(&s);
        skg_mesh *mesh = NULL;
        ck_skg(skg_mesh_create_cube(10, &mesh));
        subject_add(&s, mesh, "Water, Liquid", beside ? 400 : 0, 0, beside ? 0 : 300, -1);
        subject_plan(&s);
        pictures p = subject_pictures(&s, NULL);
        const skg_scatter_report report = subject_report(&s);
        for (int64_t i = 0; i < p.count; i++) {
            ck_assert_double_eq((double)p.scatter[i], 0);
            ck_assert_double_eq((double)p.sigma[i], 0);
        }
        ck_assert_double_eq(report.mean, 0);
        pictures_free(&p);
        subject_close(&s);
    }
}
END_TEST

/* Orders and kinds add up to the scatter, to the rounding of six floats of which each is rounded once. */
START_TEST(components_add_up) {
    subject s;
    subject_open(&s);
    subject_fill(&s);
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    const skg_scatter_report report = subject_report(&s);
    double *sums = calloc((size_t)p.count, sizeof *sums), shares[6] = {0}, all = 0;
    float *image = calloc((size_t)p.count, sizeof *image);
    for (int32_t k = 0; k < 6; k++) {
        skg_output output;
        skg_output_init(&output);
        output.data = image;
        output.kind = SKG_OUTPUT_SCATTER_COMPONENT;
        output.component = k;
        ck_skg(skg_plan_image(s.plan, &output));
        for (int64_t i = 0; i < p.count; i++) sums[i] += (double)image[i];
        for (int64_t i = 0; i < p.count; i++) shares[k] += (double)image[i];
        all += shares[k];
    }
    for (int64_t i = 0; i < p.count; i++)
        ck_assert_double_eq_tol(sums[i], (double)p.scatter[i], 16 * (double)FLT_EPSILON * report.mean);
    /* The report counts photons where they arrive; with the falloff on the images do so, too, but for the smoothing's grid: 1 %. */
    ck_assert_double_eq_tol((shares[0] + shares[3]) / all, report.orders[0], 0.01);
    ck_assert_double_eq_tol((shares[0] + shares[1] + shares[2]) / all, report.rayleigh, 0.01);
    free(sums);
    free(image);
    pictures_free(&p);
    subject_close(&s);
}
END_TEST

/* Checks that the image of a quantity is primary plus scatter. */
static void subtract(int32_t quantity, int32_t falloff) {
    subject s;
    subject_open(&s);
    subject_fill(&s);
    s.options.quantity = quantity;
    s.options.falloff = falloff;
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    s.options.scatter = NULL;
    skg_plan_release(&s.plan);
    skg_spectrum *beam = NULL;
    ck_skg(skg_spectrum_create_mono(s.kev, s.photons, &beam));
    ck_skg(skg_plan_create(run_context, s.scene, &s.view, beam, &s.options, &s.plan));
    double *primary = run_image(s.plan, &s.view);
    ck_assert_double_gt(subject_sum(&s, p.scatter), 0);
    for (int64_t i = 0; i < p.count; i++) {
        const double added = (double)p.scatter[i], both = (double)p.image[i];
        const double expected =
            quantity == SKG_QUANTITY_ATTENUATION ? -log(exp(-primary[i]) + added) : primary[i] + added;
        /* Rounding of both terms; of a logarithm of numbers around 1 also in absolute terms. */
        ck_assert_double_eq_tol(both, expected,
                                16 * (double)FLT_EPSILON *
                                    (fabs(expected) + (quantity == SKG_QUANTITY_ATTENUATION)));
    }
    free(primary);
    pictures_free(&p);
    skg_spectrum_release(&beam);
    subject_close(&s);
}

START_TEST(images_are_primary_plus_scatter) {
    static const int32_t quantities[] = {SKG_QUANTITY_ENERGY, SKG_QUANTITY_FLUENCE, SKG_QUANTITY_PHOTONS,
                                         SKG_QUANTITY_TRANSMISSION, SKG_QUANTITY_ATTENUATION};
    for (size_t q = 0; q < sizeof quantities / sizeof *quantities; q++)
        for (int32_t falloff = SKG_FALLOFF_OFF; falloff <= SKG_FALLOFF_ON; falloff++)
            subtract(quantities[q], falloff);
}
END_TEST

START_TEST(without_falloff_scatter_is_over_the_shape_of_the_open_beam) {
    pictures p[2];
    subject s;
    for (int on = 0; on < 2; on++) {
        subject_open(&s);
        subject_fill(&s);
        s.options.falloff = on ? SKG_FALLOFF_ON : SKG_FALLOFF_OFF;
        p[on] = take(&s);
    }
    for (int64_t i = 0; i < p[0].count; i++) {
        const double x = ((double)(i % 40) - 19.5) * 5, y = ((double)(i / 40) - 14.5) * 5;
        const double shape = pow(700 / sqrt(700 * 700 + x * x + y * y), 3);
        /* Two floats. */
        ck_assert_double_eq_tol((double)p[0].scatter[i] * shape, (double)p[1].scatter[i],
                                2 * (double)FLT_EPSILON * (double)p[1].scatter[i]);
    }
    pictures_free(&p[0]);
    pictures_free(&p[1]);
}
END_TEST

START_TEST(strategies_have_the_same_scatter) {
    static const int32_t strategies[] = {SKG_STRATEGY_AUTO, SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES,
                                         SKG_STRATEGY_ATOMICS};
    pictures first = {0};
    for (size_t k = 0; k < sizeof strategies / sizeof *strategies; k++) {
        subject s;
        subject_open(&s);
        subject_fill(&s);
        s.options.strategy = strategies[k];
        s.options.noise = 1;
        pictures p = take(&s);
        if (k) {
            same(p.scatter, first.scatter, p.count);
            same(p.sigma, first.sigma, p.count);
            same(p.image, first.image, p.count);
            pictures_free(&p);
        } else
            first = p;
    }
    pictures_free(&first);
}
END_TEST

/* In all of the device's threads, and in one, if it can be parted. */
START_TEST(threads_have_the_same_scatter) {
    pictures p[2];
    for (int k = 0; k < 2; k++) {
        subject s;
        run_close();
        if (skg_context_create(k ? "threads=1" : NULL, &run_context) != SKG_OK)
            ck_skg(skg_context_create(NULL, &run_context));
        subject_open(&s);
        subject_fill(&s);
        p[k] = take(&s);
    }
    same(p[0].scatter, p[1].scatter, p[0].count);
    same(p[0].image, p[1].image, p[0].count);
    pictures_free(&p[0]);
    pictures_free(&p[1]);
}
END_TEST

START_TEST(batches_are_single_frames) {
    enum { FRAMES = 3 };
    subject s;
    skg_frame frames[FRAMES];
    skg_output output;
    skg_job *job = NULL;
    double poses[FRAMES][16] = {{0}};
    static const int64_t part = 0;
    subject_open(&s);
    subject_add_box(&s, 60, 60, 30, "Water, Liquid");
    subject_plan(&s);
    const int64_t count = s.view.rows * s.view.columns;
    float *all = calloc((size_t)(FRAMES * count), sizeof *all);
    for (int f = 0; f < FRAMES; f++) {
        skg_frame_init(&frames[f]);
        for (int k = 0; k < 4; k++) poses[f][5 * k] = 1;
        poses[f][3] = f == 1 ? 15 : 0; /* the first and the last are alike */
        frames[f].pose_count = 1, frames[f].pose_parts = &part, frames[f].poses = poses[f];
    }
    skg_output_init(&output);
    output.data = all;
    ck_skg(skg_plan_submit(s.plan, FRAMES, frames, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    same(all, all + 2 * count, count);
    ck_assert_mem_ne(all, all + count, (size_t)count * sizeof *all);
    for (int f = 0; f < FRAMES; f++) {
        pictures p = subject_pictures(&s, &frames[f]);
        same(p.image, all + f * count, count);
        pictures_free(&p);
    }
    free(all);
    subject_close(&s);
}
END_TEST

START_TEST(a_second_frame_is_the_first) {
    subject s;
    subject_open(&s);
    subject_fill(&s);
    subject_plan(&s);
    pictures a = subject_pictures(&s, NULL), b = subject_pictures(&s, NULL);
    same(a.image, b.image, a.count);
    same(a.scatter, b.scatter, a.count);
    s.scatter.seed = 1;
    subject_plan(&s);
    pictures c = subject_pictures(&s, NULL);
    ck_assert_mem_ne(a.scatter, c.scatter, (size_t)a.count * sizeof *a.scatter);
    pictures_free(&a);
    pictures_free(&b);
    pictures_free(&c);
    subject_close(&s);
}
END_TEST

static int32_t cancel_third(int64_t done, int64_t total, void *user) {
    int *calls = user;
    ck_assert(done >= 0 && done < total);
    return ++*calls == 3;
}

/* Cancelled while histories are followed; afterwards the same plan makes the same image as before. */
START_TEST(a_progress_cancels_scatter) {
    subject s;
    skg_frame frame;
    skg_output output;
    skg_job *job = NULL;
    skg_progress *progress = NULL;
    int calls = 0;
    subject_open(&s);
    subject_fill(&s);
    s.scatter.histories = 1 << 18;
    subject_plan(&s);
    pictures before = subject_pictures(&s, NULL);
    s.scatter.seed = 1;
    subject_plan(&s); /* another plan has no scatter yet */
    skg_frame_init(&frame);
    skg_output_init(&output);
    output.data = before.sigma;
    ck_skg(skg_progress_create(cancel_third, &calls, &progress));
    frame.progress = progress;
    ck_skg_fails(skg_plan_submit(s.plan, 1, &frame, 1, &output, &job), SKG_ERR_CANCELLED, "cancelled");
    ck_assert_ptr_null(job);
    ck_assert_int_eq(calls, 3);
    skg_progress_release(&progress);
    pictures after = subject_pictures(&s, NULL);
    ck_assert_mem_ne(after.scatter, before.scatter, (size_t)after.count * sizeof *after.scatter);
    s.scatter.seed = 0;
    subject_plan(&s);
    pictures again = subject_pictures(&s, NULL);
    same(again.image, before.image, again.count);
    pictures_free(&before);
    pictures_free(&after);
    pictures_free(&again);
    subject_close(&s);
}
END_TEST

/* A job need not have an image: the scatter is the same, and so is an image that follows. */
START_TEST(scatter_comes_alone) {
    subject s;
    skg_output output;
    skg_job *job = NULL;
    subject_open(&s);
    subject_fill(&s);
    subject_plan(&s);
    const int64_t count = s.view.rows * s.view.columns;
    float *alone = calloc((size_t)count, sizeof *alone);
    skg_output_init(&output);
    output.data = alone, output.kind = SKG_OUTPUT_SCATTER;
    ck_skg(skg_plan_submit(s.plan, 1, NULL, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    pictures after = subject_pictures(&s, NULL);
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    same(alone, p.scatter, count);
    same(after.image, p.image, count);
    free(alone);
    pictures_free(&after);
    pictures_free(&p);
    subject_close(&s);
}
END_TEST

/* Density and fill of a part are those of another material. */
START_TEST(overrides_are_other_materials) {
    static const int64_t part = 0;
    static const double half = 0.5;
    for (int fill = 0; fill < 2; fill++) {
        subject s, thin;
        skg_frame frame;
        skg_material *material = NULL, *full = NULL;
        subject_open(&s);
        subject_add_box(&s, 80, 60, 40, "Water, Liquid");
        subject_plan(&s);
        skg_frame_init(&frame);
        frame.override_count = 1, frame.override_parts = &part;
        if (fill)
            frame.fill_fractions = &half;
        else
            frame.density_ratios = &half;
        pictures p = subject_pictures(&s, &frame);
        subject_open(&thin);
        subject_add_box(&thin, 80, 60, 40, "Water, Liquid");
        ck_skg(skg_material_create_named("Water, Liquid", &full));
        ck_skg(skg_material_create_at_density(full, 0.5, &material));
        ck_skg(skg_scene_part_material_set(thin.scene, 0, material));
        pictures q = take(&thin);
        /* Equal cells in other roundings. A history ends up elsewhere where a rounding decides: one of 4,096 in 2 million. */
        ck_assert_double_eq_tol(subject_sum(&s, p.scatter) / subject_sum(&s, q.scatter), 1, 1e-3);
        pictures_free(&p);
        pictures_free(&q);
        skg_material_release(&material);
        skg_material_release(&full);
        subject_close(&s);
    }
}
END_TEST

START_TEST(histories_and_tolerances_are_met) {
    static const double tolerances[] = {0.05, 0.02, 0.01};
    subject s;
    subject_open(&s);
    subject_fill(&s);
    s.scatter.histories = 10001;
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    skg_scatter_report report = subject_report(&s);
    ck_assert_int_ge(report.histories, 10001);
    ck_assert_int_lt(report.histories, 10001 + 32); /* whole batches */
    ck_assert_double_eq_tol(report.mean * (double)p.count, subject_sum(&s, p.scatter),
                            (double)FLT_EPSILON * subject_sum(&s, p.scatter));
    ck_assert_double_eq_tol(report.orders[0] + report.orders[1] + report.orders[2], 1, 8 * DBL_EPSILON);
    ck_assert_int_eq(report.cells[0], 64);
    pictures_free(&p);
    s.scatter.histories = 0;
    for (size_t k = 0; k < sizeof tolerances / sizeof *tolerances; k++) {
        s.scatter.tolerance = tolerances[k];
        subject_plan(&s);
        p = subject_pictures(&s, NULL);
        report = subject_report(&s);
        ck_assert_double_le(report.sigma, 1.001 * tolerances[k] * report.mean); /* means of floats */
        pictures_free(&p);
    }
    subject_close(&s);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, nothing_scatters_nothing);
    tcase_add_test(tests, components_add_up);
    tcase_add_test(tests, images_are_primary_plus_scatter);
    tcase_add_test(tests, without_falloff_scatter_is_over_the_shape_of_the_open_beam);
    tcase_add_test(tests, strategies_have_the_same_scatter);
    tcase_add_test(tests, threads_have_the_same_scatter);
    tcase_add_test(tests, batches_are_single_frames);
    tcase_add_test(tests, a_second_frame_is_the_first);
    tcase_add_test(tests, a_progress_cancels_scatter);
    tcase_add_test(tests, scatter_comes_alone);
    tcase_add_test(tests, overrides_are_other_materials);
    tcase_add_test(tests, histories_and_tolerances_are_met);
}

SKG_SUITE_MAIN("scatter/scatter", add_tests)
