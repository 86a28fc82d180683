/* A set-up that breathes: its scene's meshes posed at any time or phase, as the scene file's key Breathing
 * says (docs/scene-files.md), and the frames that show them.
 *
 * One call poses, another makes the image (skg_plan_submit copies what it needs), so the next pose may be
 * computed while an image is made, which pays on a CPU device too (bench/breathing). Poses do not depend on
 * those before: any order gives the same bits. */
#ifndef SKIAGRAPH_MOTION_H
#define SKIAGRAPH_MOTION_H

#include <skiagraph/breathing.h>
#include <skiagraph/setup.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct skg_motion skg_motion;

/* Links the scene's parts into a body; defaults where the file has no key Breathing. The set-up is not
 * retained and has to stay. context: for warnings; may be NULL. Errors: SKG_ERR_BREATHING (no part that
 * moves; a part that moves has a Transform: breathing needs positions as the file has them; a mesh of two
 * parts). The caller releases the motion. */
SKG_API skg_status skg_motion_create(skg_context *context, const skg_setup *setup, skg_motion **motion);
SKG_API void skg_motion_release(skg_motion **motion);

/* Whether a set-up's file has the key Breathing (1 or 0), and its body's options, prepared with
 * skg_body_options_init: what skg_motion_create would use. */
SKG_API skg_status skg_setup_body_options_get(const skg_setup *setup, int32_t *breathes,
                                              skg_body_options *options);

/* Poses the scene at a time in s, with the events until then; or at a phase, counted modulo 1, without
 * events: needle and contrast as the meshes have them. */
SKG_API skg_status skg_motion_at_time(skg_motion *motion, double time_s);
SKG_API skg_status skg_motion_at_phase(skg_motion *motion, double phase);

/* The matter of a frame as posed: lungs by their volume, contrast by the events. Pointers are valid until the
 * next pose. */
SKG_API skg_status skg_motion_fill(const skg_motion *motion, skg_frame *frame);

/* Where the motion is. Prepare with skg_motion_state_init. */
typedef struct {
    int32_t size;
    int32_t reserved;          /* 0 */
    double time_s;             /* NaN after skg_motion_at_phase */
    skg_breath_state breath;   /* with the weight of the events */
    double needle_mm;          /* depth below the skin; NaN without a needle */
    double lung_density_ratio; /* against the meshes' own volume; 1 where it is not to change */
    double lung_hu;            /* of the first lung, by its material at 70 keV and that; NaN: no lung */
} skg_motion_state;

SKG_API void skg_motion_state_init(skg_motion_state *state);
SKG_API skg_status skg_motion_state_get(const skg_motion *motion, skg_motion_state *state);

/* The period of the breath in s, and the body, for skg_body_measure_get; valid as long as the motion. */
SKG_API skg_status skg_motion_period_get(const skg_motion *motion, double *period_s);
SKG_API skg_status skg_motion_body_get(const skg_motion *motion, skg_body **body);

/* Whether a part of the scene moves with the breath: 1 or 0. */
SKG_API skg_status skg_motion_part_moves(const skg_motion *motion, int64_t part, int32_t *moves);

/* Positions of a part as its mesh had them when the motion was made: rows of x, y, z, mm. */
SKG_API skg_status skg_motion_rest_get(const skg_motion *motion, int64_t part, double *positions);

#ifdef __cplusplus
}
#endif
#endif
