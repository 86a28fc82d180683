/* Waveforms and phase. */
#include "suite.h"
#include "support/angles.h"

#include <skiagraph/breathing.h>

#include <float.h>
#include <math.h>
#include <string.h>

static const double samples[] = {1, 0.8, 0.35, 0.1, 0, 0.02, 0.4, 0.9};

static skg_breath of_kind(int32_t kind) {
    skg_breath b;
    skg_breath_init(&b);
    b.waveform = kind;
    b.samples = samples;
    b.sample_count = 8;
    return b;
}

static skg_breath_state at_phase(const skg_breath *b, double phase) {
    skg_breath_state s;
    skg_breath_state_init(&s);
    ck_skg(skg_breath_state_at_phase(b, phase, &s));
    return s;
}

static skg_breath_state at_time(const skg_breath *b, double time) {
    skg_breath_state s;
    skg_breath_state_init(&s);
    ck_skg(skg_breath_state_at_time(b, time, &s));
    return s;
}

START_TEST(
    phase_zero_is_end_inspiration) { /* every waveform: highest there, 0 to 1, falls once, rises once */
    skg_breath b = of_kind(_i);
    ck_assert_double_eq(at_phase(&b, 0).amplitude, 1);
    double last = 1, least = 1;
    int turns = 0, rising = 0;
    for (int i = 1; i <= 1000; i++) {
        double f = at_phase(&b, i / 1000.0).amplitude;
        ck_assert(f >= 0 && f <= 1);
        least = fmin(least, f);
        int up = f > last + 1e-14 ? 1 : f < last - 1e-14 ? 0 : rising;
        turns += up != rising;
        rising = up, last = f;
    }
    ck_assert_int_eq(turns, 1);
    /* 1000 phases step over the least: a cosine is flat there to (pi / 1000)^2. */
    ck_assert_double_le(least, 1e-5);
    for (int i = 0; i < 50; i++) /* modulo 1, from both sides */
        for (int shift = -3; shift <= 3; shift++)
            ck_assert_double_eq(at_phase(&b, i / 64.0 + shift).amplitude, at_phase(&b, i / 64.0).amplitude);
}
END_TEST

START_TEST(closed_forms) {
    skg_breath sine = of_kind(SKG_WAVEFORM_SINE), lujan = of_kind(SKG_WAVEFORM_LUJAN);
    skg_breath half = of_kind(SKG_WAVEFORM_ASYMMETRIC), list = of_kind(SKG_WAVEFORM_SAMPLED);
    ck_assert_double_eq_tol(at_phase(&sine, 0.25).amplitude, 0.5, 4 * DBL_EPSILON);
    ck_assert_double_eq_tol(at_phase(&lujan, 0.25).amplitude, 0.25, 1e-15); /* cos^4 45 degrees */
    ck_assert_double_eq_tol(at_phase(&half, 0.6).amplitude, 0, 1e-15);      /* 1 : 1.5 */
    ck_assert_double_eq_tol(at_phase(&half, 0.3).amplitude, 0.5, 1e-15);
    ck_assert_double_eq_tol(at_phase(&half, 0.8).amplitude, 0.5, 1e-15);
    for (int i = 0; i < 8; i++) ck_assert_double_eq(at_phase(&list, i / 8.0).amplitude, samples[i]);
    sine.start_phase = 0.75; /* the paper's (1 + sin 2 pi t/T)/2 */
    for (int i = 0; i < 40; i++) {
        double t = 0.17 * i, expected = 0.5 * (1 + sin(2 * pi * t / 4));
        ck_assert_double_eq_tol(at_time(&sine, t).amplitude, expected, 32 * DBL_EPSILON);
    }
}
END_TEST

START_TEST(channels) {
    skg_breath b = of_kind(SKG_WAVEFORM_SINE);
    b.thoracic = 0.5, b.diaphragmatic = 2, b.thoracic_lag = 0.1;
    skg_breath_state s = at_phase(&b, 0.35), earlier = at_phase(&b, 0.25);
    ck_assert_double_eq_tol(s.thoracic, 0.5 * earlier.amplitude, 4 * DBL_EPSILON);
    ck_assert_double_eq(s.diaphragmatic, 2 * s.amplitude);
    ck_skg(skg_breath_pattern_get("Diaphragmatic", &b));
    ck_assert_double_eq(at_phase(&b, 0.1).thoracic, 0);
    ck_skg_fails(skg_breath_pattern_get("thoracicc", &b), SKG_ERR_BREATHING, "\"thoracic\"");
}
END_TEST

static skg_breath_hold hold(double start_s, double end_s) {
    return (skg_breath_hold){.size = (int32_t)sizeof(skg_breath_hold), .start_s = start_s, .end_s = end_s};
}

START_TEST(holds_stop_the_clock) {
    const skg_breath_hold holds[] = {hold(1, 3), hold(3, 4), hold(10, 12.5)};
    skg_breath b = of_kind(SKG_WAVEFORM_LUJAN), free = b;
    b.holds = holds, b.hold_count = 3;
    ck_assert_double_eq(at_time(&b, 0.5).phase, at_time(&free, 0.5).phase);
    for (int i = 0; i <= 30; i++) ck_assert_double_eq(at_time(&b, 1 + 0.1 * i).phase, 0.25);
    ck_assert_double_eq_tol(at_time(&b, 7).phase, at_time(&free, 4).phase, 4 * DBL_EPSILON);
    ck_assert_double_eq_tol(at_time(&b, 20).phase, at_time(&free, 14.5).phase, 4 * DBL_EPSILON);
    ck_assert_double_eq_tol(at_time(&b, -3).phase, 0.25, 4 * DBL_EPSILON);
}
END_TEST

START_TEST(bad_fields_are_named) {
    const double high[] = {0.5, 0.9, 0.1};
    const skg_breath_hold crossed[] = {hold(1, 3), hold(2, 4)};
    skg_breath b = of_kind(7);
    skg_breath_state s;
    skg_breath_state_init(&s);
    ck_skg_fails(skg_breath_check(&b), SKG_ERR_BREATHING, "waveform");
    b = of_kind(0), b.period_s = 0;
    ck_skg_fails(skg_breath_check(&b), SKG_ERR_BREATHING, "period_s");
    b = of_kind(0), b.thoracic = (double)NAN;
    ck_skg_fails(skg_breath_check(&b), SKG_ERR_BREATHING, "thoracic");
    b = of_kind(SKG_WAVEFORM_SAMPLED), b.samples = high, b.sample_count = 3;
    ck_skg_fails(skg_breath_check(&b), SKG_ERR_BREATHING, "begin at end-inspiration");
    b.sample_count = 2;
    ck_skg_fails(skg_breath_check(&b), SKG_ERR_BREATHING, "at least 3");
    b = of_kind(0), b.holds = crossed, b.hold_count = 2;
    ck_skg_fails(skg_breath_check(&b), SKG_ERR_BREATHING, "hold 1");
    b = of_kind(0);
    ck_skg_fails(skg_breath_state_at_time(&b, HUGE_VAL, &s), SKG_ERR_BREATHING, "not finite");
    ck_skg_fails(skg_breath_state_at_phase(&b, (double)NAN, &s), SKG_ERR_BREATHING, "not finite");
    ck_skg_fails(skg_breath_check(NULL), SKG_ERR_ARGUMENT, "NULL");
}
END_TEST

/* Breaths of 3 and 5 s with a shallow turn between them, which is no breath. */
static const double recorded[] = {0, 0.2, 1, 1, 2, 0.1, 2.5, 0.3, 3, 0, 4, 0.9, 6, 0, 9, 1, 10, 0.5};

START_TEST(a_signal_replaces_the_waveform_in_time) {
    skg_breath b = of_kind(SKG_WAVEFORM_SINE);
    b.signal = recorded, b.signal_count = 9;
    b.diaphragmatic = 2, b.thoracic_lag = 0.25; /* of 4 s: 1 s */
    ck_skg(skg_breath_check(&b));
    static const double expected[][3] = {
        /* time, amplitude, phase */
        {-1, 0.2, 0.5}, {0, 0.2, 0.75},      {1, 1, 0}, {1.5, 0.55, 0.5 / 3}, {2.5, 0.3, 0.5},
        {4, 0.9, 0},    {6.5, 1.0 / 6, 0.5}, {9, 1, 0}, {10, 0.5, 0.25},      {20, 0.5, 0.75}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        const double *e = expected[i];
        const skg_breath_state s = at_time(&b, e[0]), late = at_time(&b, e[0] + 1);
        ck_assert_double_eq_tol(s.amplitude, e[1], 8 * DBL_EPSILON); /* one interpolation */
        ck_assert_double_eq_tol(s.phase, e[2], 8 * DBL_EPSILON);
        ck_assert_double_eq_tol(s.diaphragmatic, 2 * e[1], 16 * DBL_EPSILON);
        ck_assert_double_eq_tol(late.thoracic, e[1], 16 * DBL_EPSILON);
    }
    ck_assert_double_eq(at_phase(&b, 0.25).amplitude, 0.5 * (1 + cos(0.5 * acos(-1)))); /* the sine's */
    skg_breath_hold hold;
    skg_breath_hold_init(&hold);
    hold.start_s = 1, hold.end_s = 4;
    b.holds = &hold, b.hold_count = 1;
    ck_assert_double_eq(at_time(&b, 3).amplitude, 1);
    ck_assert_double_eq_tol(at_time(&b, 5.5).amplitude, 0.3, 8 * DBL_EPSILON);
}
END_TEST

START_TEST(bad_signals_are_refused) {
    static const double falls[] = {0, 0, 1, 1, 1, 0}, leaves[] = {0, 0, 1, 1.5};
    skg_breath b = of_kind(SKG_WAVEFORM_SINE);
    b.signal = falls, b.signal_count = 3;
    ck_skg_fails(skg_breath_check(&b), SKG_ERR_BREATHING, "point 2 of the signal is at 1 s");
    b.signal_count = 1;
    ck_skg_fails(skg_breath_check(&b), SKG_ERR_BREATHING, "at least 2 points");
    b.signal = leaves, b.signal_count = 2;
    ck_skg_fails(skg_breath_check(&b), SKG_ERR_BREATHING, "amplitudes 0 to 1");
    b.signal = NULL;
    ck_skg_fails(skg_breath_check(&b), SKG_ERR_BREATHING, "at least 2 points");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, phase_zero_is_end_inspiration, 0, 4);
    tcase_add_test(tests, closed_forms);
    tcase_add_test(tests, channels);
    tcase_add_test(tests, holds_stop_the_clock);
    tcase_add_test(tests, bad_fields_are_named);
    tcase_add_test(tests, a_signal_replaces_the_waveform_in_time);
    tcase_add_test(tests, bad_signals_are_refused);
}

SKG_SUITE_MAIN("breath", add_tests)
