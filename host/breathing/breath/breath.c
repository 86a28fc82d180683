/* Waveforms and phase. */
#include "breath/signal.h"
#include "core/core.h"
#include "core/maths.h"
#include "core/text.h"

#include <skiagraph/breathing.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

void skg_breath_init_sized(void *breath, int32_t size) {
    const skg_breath defaults = {.waveform = SKG_WAVEFORM_SINE,
                                 .exponent = 2,
                                 .period_s = 4,
                                 .expiration_ratio = 1.5,
                                 .thoracic = 1,
                                 .diaphragmatic = 1};
    skg_struct_init(breath, size, &defaults, sizeof defaults);
}

void skg_breath_state_init_sized(void *state, int32_t size) {
    const skg_breath_state defaults = {.phase = 0.5};
    skg_struct_init(state, size, &defaults, sizeof defaults);
}

void skg_breath_hold_init_sized(void *hold, int32_t size) {
    const skg_breath_hold defaults = {0};
    skg_struct_init(hold, size, &defaults, sizeof defaults);
}

skg_status skg_breath_pattern_get(const char *name, skg_breath *breath) {
    SKG_PLAIN;
    static const struct {
        double period_s, thoracic, diaphragmatic;
    } pattern[] = {{4, 1, 1}, {4, 0, 1}, {4, 1, 0}, {3, 0.3, 0.3}, {6, 2.5, 2.5}, {1.5, 2, 2}};
    static const char *const names[] = {"quiet",   "diaphragmatic", "thoracic",
                                        "shallow", "deep",          "hyperventilation"};
    enum { COUNT = sizeof names / sizeof *names };
    for (int i = 0; i < COUNT; i++) {
        if (!skg_same_name(name ? name : "", names[i])) continue;
        skg_breath ours;
        skg_breath_init(&ours);
        ours.waveform = SKG_WAVEFORM_ASYMMETRIC;
        ours.period_s = pattern[i].period_s;
        ours.thoracic = pattern[i].thoracic;
        ours.diaphragmatic = pattern[i].diaphragmatic;
        return skg_struct_write(&ours, sizeof ours, "skg_breath", breath);
    }
    const char *near = skg_nearest_name(name ? name : "", names, COUNT);
    return skg_fail(SKG_ERR_BREATHING, "no breathing pattern \"%s\"; the nearest is \"%s\"", name ? name : "",
                    near ? near : names[0]);
}

static skg_status check_range(const char *field, double value, double low, double high) {
    if (value >= low && value <= high) return SKG_OK;
    return skg_fail(SKG_ERR_BREATHING, "breath: %s is %g; the range is %g to %g", field, value, low, high);
}

static skg_status check_samples(const skg_breath *b) {
    if (!b->samples || b->sample_count < 3)
        return skg_fail(SKG_ERR_BREATHING,
                        "breath: a sampled waveform needs at least 3 samples over one cycle");
    for (int64_t i = 0; i < b->sample_count; i++) {
        SKG_TRY(check_range("a sample", b->samples[i], 0, 1));
        if (b->samples[i] > b->samples[0])
            return skg_fail(SKG_ERR_BREATHING,
                            "breath: sample %" PRId64
                            " (%g) is above the first (%g); begin at end-inspiration",
                            i, b->samples[i], b->samples[0]);
    }
    return SKG_OK;
}

static skg_status check_holds(const skg_breath *b) {
    if (b->hold_count < 0 || (b->hold_count > 0 && !b->holds))
        return skg_fail(SKG_ERR_BREATHING,
                        "breath: hold_count is %" PRId64 ", but holds is NULL or the count below 0",
                        b->hold_count);
    double last = -HUGE_VAL;
    for (int64_t i = 0; i < b->hold_count; i++) {
        skg_breath_hold h;
        skg_breath_hold_init(&h);
        SKG_TRY(skg_struct_read_at(b->holds, i, "skg_breath_hold", &h, sizeof h));
        if (!(h.start_s >= last && h.end_s >= h.start_s && isfinite(h.start_s) && isfinite(h.end_s)))
            return skg_fail(SKG_ERR_BREATHING,
                            "breath: hold %" PRId64
                            " is from %g to %g s; holds have to be in order of time and must not overlap",
                            i, h.start_s, h.end_s);
        last = h.end_s;
    }
    return SKG_OK;
}

static skg_status check(const skg_breath *b) {
    SKG_TRY(check_range("waveform", b->waveform, SKG_WAVEFORM_SINE, SKG_WAVEFORM_SAMPLED));
    SKG_TRY(check_range("exponent", b->exponent, 1, 8));
    SKG_TRY(check_range("period_s", b->period_s, 0.2, 60));
    SKG_TRY(check_range("start_phase", b->start_phase, 0, 1));
    SKG_TRY(check_range("expiration_ratio", b->expiration_ratio, 0.2, 5));
    SKG_TRY(check_range("thoracic", b->thoracic, 0, 4));
    SKG_TRY(check_range("diaphragmatic", b->diaphragmatic, 0, 4));
    SKG_TRY(check_range("thoracic_lag", b->thoracic_lag, -0.5, 0.5));
    if (b->waveform == SKG_WAVEFORM_SAMPLED) SKG_TRY(check_samples(b));
    if (b->signal || b->signal_count != 0) SKG_TRY(skg_signal_check(b));
    return check_holds(b);
}

skg_status skg_breath_check(const skg_breath *breath) {
    SKG_PLAIN;
    skg_breath ours;
    skg_breath_init(&ours);
    SKG_TRY(skg_struct_read(breath, "skg_breath", &ours, sizeof ours));
    return check(&ours);
}

/* Phase modulo 1. The rounding of a small negative phase gives 1, which is 0. */
static double wrap(double phase) {
    double p = phase - floor(phase);
    return p < 1 ? p : 0;
}

/* Slope at sample i of a monotone cubic through evenly spaced samples. */
static double sample_slope(const skg_breath *b, int64_t i) {
    int64_t n = b->sample_count;
    return skg_monotone_slope(b->samples[i] - b->samples[(i + n - 1) % n],
                              b->samples[(i + 1) % n] - b->samples[i]);
}

static double sampled(const skg_breath *b, double p) {
    double at = p * (double)b->sample_count;
    int64_t i = (int64_t)at < b->sample_count ? (int64_t)at : b->sample_count - 1;
    int64_t j = (i + 1) % b->sample_count;
    double t = at - (double)i, s = 1 - t;
    double f = b->samples[i] * s * s * (1 + 2 * t) + b->samples[j] * t * t * (3 - 2 * t) +
               sample_slope(b, i) * t * s * s - sample_slope(b, j) * t * t * s;
    return fmin(fmax(f, 0), b->samples[0]); /* monotone between samples but for rounding */
}

/* Amplitude of the waveform at a phase from 0 to below 1. */
static double waveform(const skg_breath *b, double p) {
    if (b->waveform == SKG_WAVEFORM_SINE) return 0.5 * (1 + cos(2 * SKG_PI * p));
    if (b->waveform == SKG_WAVEFORM_LUJAN) return pow(cos(SKG_PI * p), 2 * b->exponent);
    if (b->waveform == SKG_WAVEFORM_SAMPLED) return sampled(b, p);
    double expiration = b->expiration_ratio / (1 + b->expiration_ratio);
    return p < expiration ? 0.5 * (1 + cos(SKG_PI * p / expiration))
                          : 0.5 * (1 - cos(SKG_PI * (p - expiration) / (1 - expiration)));
}

static skg_status fill(const skg_breath *b, double phase, skg_breath_state *theirs) {
    skg_breath_state state = {.size = (int32_t)sizeof state};
    state.phase = wrap(phase);
    state.amplitude = waveform(b, state.phase);
    state.thoracic = b->thoracic * waveform(b, wrap(state.phase - b->thoracic_lag));
    state.diaphragmatic = b->diaphragmatic * state.amplitude;
    return skg_struct_write(&state, sizeof state, "skg_breath_state", theirs);
}

/* With a signal: the ribs are later by a part of the period. */
static skg_status fill_recorded(const skg_breath *b, double time, skg_breath_state *theirs) {
    skg_breath_state state = {.size = (int32_t)sizeof state};
    state.phase = wrap(skg_signal_phase(b, time));
    state.amplitude = skg_signal_amplitude(b, time);
    state.thoracic = b->thoracic * skg_signal_amplitude(b, time - b->thoracic_lag * b->period_s);
    state.diaphragmatic = b->diaphragmatic * state.amplitude;
    return skg_struct_write(&state, sizeof state, "skg_breath_state", theirs);
}

skg_status skg_breath_state_at_phase(const skg_breath *breath, double phase, skg_breath_state *state) {
    SKG_PLAIN;
    skg_breath ours;
    skg_breath_init(&ours);
    SKG_TRY(skg_struct_read(breath, "skg_breath", &ours, sizeof ours));
    SKG_TRY(check(&ours));
    if (!isfinite(phase)) return skg_fail(SKG_ERR_BREATHING, "breath: phase %g is not finite", phase);
    return fill(&ours, phase, state);
}

/* Time between 0 and `time` without holds. */
static skg_status breathing_time(const skg_breath *b, double time, double *spent) {
    *spent = time;
    for (int64_t i = 0; i < b->hold_count; i++) {
        skg_breath_hold h;
        skg_breath_hold_init(&h);
        SKG_TRY(skg_struct_read_at(b->holds, i, "skg_breath_hold", &h, sizeof h));
        *spent -= fmin(fmax(time, h.start_s), h.end_s) - fmin(fmax(0, h.start_s), h.end_s);
    }
    return SKG_OK;
}

skg_status skg_breath_state_at_time(const skg_breath *breath, double time_s, skg_breath_state *state) {
    SKG_PLAIN;
    skg_breath ours;
    skg_breath_init(&ours);
    SKG_TRY(skg_struct_read(breath, "skg_breath", &ours, sizeof ours));
    SKG_TRY(check(&ours));
    if (!isfinite(time_s)) return skg_fail(SKG_ERR_BREATHING, "breath: time %g s is not finite", time_s);
    double spent = 0;
    SKG_TRY(breathing_time(&ours, time_s, &spent));
    return ours.signal ? fill_recorded(&ours, spent, state)
                       : fill(&ours, ours.start_phase + spent / ours.period_s, state);
}
