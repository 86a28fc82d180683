/** @file
 * Breaths: waveforms, phase and the state of a breath at a time. Times are in s. Nothing is remembered from
 * call to call: any time or phase may be asked for in any order.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_BREATH_H
#define SKIAGRAPH_BREATH_H

#include <skiagraph/error.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Waveforms: the amplitude f over the phase p of 4D-CT, 0 <= p < 1, which counts from end-inspiration. f is
 * 0 at end-expiration and 1 at end-inspiration, and f(0) is its greatest value. */
enum skg_waveform {
    /** (1 + cos 2 pi p) / 2: the paper's Eq. 1, whose sine begins at p = 3/4. */
    SKG_WAVEFORM_SINE = 0,
    /** cos(pi p) to the power 2 exponent: dwells at expiration (Lujan et al., Med. Phys. 26 (1999) 715). */
    SKG_WAVEFORM_LUJAN = 1,
    /** Half cosines; expiration lasts expiration_ratio times as long as inspiration. */
    SKG_WAVEFORM_ASYMMETRIC = 2,
    /** Samples at equal distances over the cycle, joined by a monotone cubic. */
    SKG_WAVEFORM_SAMPLED = 3
};

/** A time during which the breath is held. It stays where it was and continues from there. Prepare with
 * skg_breath_hold_init. */
typedef struct {
    /** Set by skg_breath_hold_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** From this time on, s. */
    double start_s;
    /** To this time, s, which is not before start_s. */
    double end_s;
} skg_breath_hold;

SKG_INIT(skg_breath_hold)

/** One way to breathe. Prepare with skg_breath_init: sine, 4 s, ribs and diaphragm, no lag. What it points to
 * is not copied. */
typedef struct {
    /** Set by skg_breath_init. */
    int32_t size;
    /** enum skg_waveform */
    int32_t waveform;
    /** Exponent of SKG_WAVEFORM_LUJAN, 1 to 8; 2 by default. */
    int32_t exponent;
    /** 0 */
    int32_t reserved;
    /** Length of one breath in s, 0.2 to 60; 4 by default. */
    double period_s;
    /** Phase at time 0, 0 to 1; 0 by default. */
    double start_phase;
    /** Ratio of SKG_WAVEFORM_ASYMMETRIC, expiration over inspiration, 0.2 to 5; 1.5 by default. */
    double expiration_ratio;
    /** Weight of the ribs, 0 (diaphragmatic breathing) to 4; 1, the default, is quiet breathing. */
    double thoracic;
    /** Weight of the diaphragm, 0 (thoracic breathing) to 4; 1, the default, is quiet breathing. */
    double diaphragmatic;
    /** By how much the ribs are later than the diaphragm, in cycles, -0.5 to 0.5; 0 by default. */
    double thoracic_lag;
    /** [sample_count] of SKG_WAVEFORM_SAMPLED: f from 0 to 1, the first at end-inspiration and greatest. */
    const double *samples;
    /** At least 3. */
    int64_t sample_count;
    /** [hold_count] in order of time, without overlap; may be NULL. */
    const skg_breath_hold *holds;
    /** Number of holds. */
    int64_t hold_count;
    /** [signal_count][2] recorded: time in s, which rises, and f from 0 to 1. It replaces the waveform wherever a time is
     * asked for, linear between its points and constant beyond them; the phase then goes from one end-inspiration to the
     * next. A phase that is asked for is the waveform's. NULL: none. */
    const double *signal;
    /** At least 2, or 0. */
    int64_t signal_count;
} skg_breath;

SKG_INIT(skg_breath)

/** Gets a breath by the name of its pattern.
 *
 *     name     "quiet" (asymmetric 1 : 1.5, 4 s), "diaphragmatic", "thoracic", "shallow" (weights 0.3, 3 s),
 *              "deep" (weights 2.5, 6 s), "hyperventilation" (weights 2, 1.5 s)
 *     breath   result: prepared with skg_breath_init
 *     errors   SKG_ERR_BREATHING with the nearest name */
SKG_API skg_status skg_breath_pattern_get(const char *name, skg_breath *breath);

/** Checks a breath. Errors: SKG_ERR_BREATHING with the field that is out of range. */
SKG_API skg_status skg_breath_check(const skg_breath *breath);

/** Where a breath is. Prepare with skg_breath_state_init: end-expiration. */
typedef struct {
    /** Set by skg_breath_state_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** From end-inspiration, 0 to below 1. */
    double phase;
    /** f of the waveform at that phase, 0 to 1. */
    double amplitude;
    /** Amplitude of the ribs: weight times lagged amplitude. */
    double thoracic;
    /** Amplitude of the diaphragm: weight times amplitude. */
    double diaphragmatic;
} skg_breath_state;

SKG_INIT(skg_breath_state)

/** Gets the state of a breath at a time in s, which may be any finite number. */
SKG_API skg_status skg_breath_state_at_time(const skg_breath *breath, double time_s, skg_breath_state *state);

/** Gets the state of a breath at a phase, which may be any finite number and counts modulo 1. */
SKG_API skg_status skg_breath_state_at_phase(const skg_breath *breath, double phase, skg_breath_state *state);

#ifdef __cplusplus
}
#endif
#endif
