/** @file
 * Motion: the meshes of a set-up posed at any time or phase, as the key Breathing of its scene file says
 * (docs/scene-files.md), and the frames that show them.
 *
 * Posing runs on the host and submitting copies what a frame needs, so the next pose can be computed while an
 * image is made. That pays even if the device is the CPU (bench/breathing). Poses do not depend on those
 * before: any order gives the same bits. A motion is used by one thread at a time.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_MOTION_H
#define SKIAGRAPH_MOTION_H

#include <skiagraph/body.h>
#include <skiagraph/setup.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A set-up that breathes. */
typedef struct skg_motion skg_motion;

/** Links the parts of a set-up's scene into a body. Without the key Breathing the defaults hold.
 *
 *     context   receives warnings; may be NULL
 *     setup     not retained: it must stay as long as the motion
 *     motion    result; the caller releases it
 *     errors    SKG_ERR_BREATHING if no part moves, if a part that moves has a Transform (its positions must
 *               be those of the file), or if two parts have one mesh */
SKG_API skg_status skg_motion_create(skg_context *context, const skg_setup *setup, skg_motion **motion);

/** Frees a motion. The meshes stay as they are posed. */
SKG_API void skg_motion_release(skg_motion **motion);

/** Gets what skg_motion_create would use.
 *
 *     breathes   result: 1 if the file has the key Breathing, otherwise 0
 *     options    in and out: prepared with skg_body_options_init */
SKG_API skg_status skg_setup_body_options_get(const skg_setup *setup, int32_t *breathes,
                                              skg_body_options *options);

/** Poses the scene at a time in s, with the events until then. */
SKG_API skg_status skg_motion_pose_at_time(skg_motion *motion, double time_s);

/** Poses the scene at a phase, which counts modulo 1, without events: needle and contrast are as in the
 * file. */
SKG_API skg_status skg_motion_pose_at_phase(skg_motion *motion, double phase);

/** Fills the overrides of a frame for the last pose: the density of the lungs by their volume, the contrast
 * by the events.
 *
 *     frame   in and out: prepared with skg_frame_init. Its pointers are valid until the next pose */
SKG_API skg_status skg_motion_fill(const skg_motion *motion, skg_frame *frame);

/** Where a motion is. The library fills it; prepare with skg_motion_state_init. */
typedef struct {
    /** Set by skg_motion_state_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** s; NaN after skg_motion_pose_at_phase. */
    double time_s;
    /** Phase from end-inspiration, 0 to below 1. */
    double phase;
    /** Value of the waveform at that phase, 0 to 1. */
    double amplitude;
    /** Amplitude of the ribs: weight times lagged amplitude, with the weight of the events. */
    double thoracic;
    /** Amplitude of the diaphragm: weight times amplitude, with the weight of the events. */
    double diaphragmatic;
    /** Depth of the needle below the skin, mm; NaN: no needle. */
    double needle_mm;
    /** Density of the lungs over that of the meshes as in the file; 1 if it shall not change. */
    double lung_density_ratio;
    /** Hounsfield number of the first lung with that density, by its material at 70 keV; NaN: no lung. */
    double lung_hu;
} skg_motion_state;

SKG_INIT(skg_motion_state)

/** Gets where a motion is. */
SKG_API skg_status skg_motion_state_get(const skg_motion *motion, skg_motion_state *state);

/** Gets the period of the breath in s. */
SKG_API skg_status skg_motion_period_get(const skg_motion *motion, double *period_s);

/** Gets the body, for skg_body_measure_get. It is valid as long as the motion. */
SKG_API skg_status skg_motion_body_get(const skg_motion *motion, skg_body **body);

/** Whether a part of the scene moves with the breath.
 *
 *     moves   result: 1 or 0 */
SKG_API skg_status skg_motion_part_moves(const skg_motion *motion, int64_t part, int32_t *moves);

/** Copies out the positions that a part's mesh had when the motion was made: rows of x, y, z, mm. */
SKG_API skg_status skg_motion_rest_get(const skg_motion *motion, int64_t part, double *positions);

#ifdef __cplusplus
}
#endif
#endif
