/** @file
 * Fitting a body to a patient: finds the parameters of breathing with which the organs of a scene come nearest to
 * surfaces that were segmented from the patient at known phases, as Vidal and Villard, Comput. Med. Imaging Graph. 49
 * (2016) 1-15 do in section 4.2. What is minimized is the root mean square, over all targets, of the distance from the
 * organ's vertices to the target's surface.
 *
 *     skg_fit_create(context, setup, NULL, &fit);
 *     skg_fit_target_add(fit, liver, 0.5, mesh);
 *     do skg_fit_step(fit, &state); while (!state.done);
 *     skg_fit_finish(fit);
 *     skg_fit_scene_save(fit, "fitted.json");
 *
 * Same scene, targets, options and seed give the same bits with any number of threads. A body is fitted without
 * hysteresis. Lengths are in mm, angles in degrees. A fit is used by one thread at a time; it uses those of OpenMP.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_FIT_H
#define SKIAGRAPH_FIT_H

#include <skiagraph/progress.h>
#include <skiagraph/setup.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A fit that is under way. */
typedef struct skg_fit skg_fit;

/** How the parameters are searched. */
enum skg_fit_method {
    /** CMA-ES: a normal distribution that learns which parameters go together. */
    SKG_FIT_METHOD_CMA = 0,
    /** Differential evolution. */
    SKG_FIT_METHOD_DE = 1
};

/** Options of a fit. Prepare with skg_fit_options_init. */
typedef struct {
    /** Set by skg_fit_options_init. */
    int32_t size;
    /** enum skg_fit_method */
    int32_t method;
    /** Maximum number of evaluations of the objective, 1 to 1e9; 4000 by default. Each one poses the body for every
     * target and measures how far it is from the target. */
    int64_t evaluations;
    /** Decides all random numbers, at least 0; 1 by default. */
    int64_t seed;
    /** The search ends when the root mean square error is this small, mm; 0.001 by default. */
    double enough_mm;
    /** Steps are evaluations. Retained by the fit; NULL: nobody wants to know. */
    skg_progress *progress;
} skg_fit_options;

SKG_INIT(skg_fit_options)

/** Begins a fit of a scene that breathes. The start is the body of the scene file.
 *
 *     context   receives warnings; may be NULL
 *     setup     has to stay until the fit is released. Its meshes are read, and not changed
 *     options   NULL: the defaults
 *     fit       result; the caller releases it
 *     errors    SKG_ERR_ARGUMENT (an option), SKG_ERR_BREATHING if there is no diaphragm */
SKG_API skg_status skg_fit_create(skg_context *context, const skg_setup *setup,
                                  const skg_fit_options *options, skg_fit **fit);

/** Frees a fit. */
SKG_API void skg_fit_release(skg_fit **fit);

/** Adds a surface that a part has to reach at a phase. Call it before the first step.
 *
 *     part     number in the scene
 *     phase    0 to below 1, from end-inspiration
 *     mesh     retained; mm, in the frame of the scene
 *     errors   SKG_ERR_ARGUMENT, SKG_ERR_BREATHING if the part does not breathe */
SKG_API skg_status skg_fit_target_add(skg_fit *fit, int64_t part, double phase, skg_mesh *mesh);

/** Chooses the parameters; all others stay as the scene has them. Call it before the first step. By
 * default those of the scene's key Breathing.Fit, or all; with SKG_COUPLING_ANATOMICAL all but tissues.
 *
 *     names    separated by commas: tendon-x, tendon-y, tendon-z (displacement at weight 1); diaphragm-alpha-min,
 *              diaphragm-alpha-max, diaphragm-beta, liver-alpha-min, liver-alpha-max, liver-beta (tissues). With
 *              SKG_COUPLING_ANATOMICAL: dome-left, dome-right, dome-back, muscle-length, rib-angle, rib-fall,
 *              liver-follows, liver-held (body.h). With SKG_COUPLING_PAPER: plane-azimuth, plane-elevation,
 *              plane-offset (of the tendon's plane: direction of its normal, and its depth below the top of the
 *              diaphragm), diaphragm-ribs, diaphragm-liver (reach of links). Or the groups tendon, diaphragm, liver,
 *              domes, muscle, ribs, follow, plane, links, of which those count that have an effect
 *     errors   SKG_ERR_ARGUMENT with the known names, if there is no such parameter or it has no effect with the body's
 *              coupling */
SKG_API skg_status skg_fit_parameters_choose(skg_fit *fit, const char *names);

/** Sets the range of a parameter. Its start is moved into it. Call it before the first step.
 *
 *     errors   SKG_ERR_ARGUMENT if there is no such parameter, or the range is empty or leaves what is possible */
SKG_API skg_status skg_fit_bounds_set(skg_fit *fit, const char *name, double low, double high);

/** A parameter. The library fills it; prepare with skg_fit_parameter_init. */
typedef struct {
    /** Set by skg_fit_parameter_init. */
    int32_t size;
    /** 1: it is fitted. */
    int32_t chosen;
    /** 1: the targets determine it: sigma is at most a fifth of its range. Set by skg_fit_finish. */
    int32_t determined;
    /** 0 */
    int32_t reserved;
    /** Name, valid for ever. */
    const char *name;
    /** "mm", "degrees", or "" for a fraction. */
    const char *unit;
    /** Value in the scene. */
    double start;
    /** Least value. */
    double low;
    /** Greatest value. */
    double high;
    /** Best value so far. */
    double value;
    /** How far the value may go, the other parameters following it, until the mean square error of a surface has grown by
     * the square of the resolution; the resolution is the error that is left, at least 0.1 mm. Set by skg_fit_finish from
     * the change of all distances with each parameter. A parameter without any influence has 0.29 of its range. */
    double sigma;
} skg_fit_parameter;

SKG_INIT(skg_fit_parameter)

/** Number of parameters, chosen or not. */
SKG_API skg_status skg_fit_parameter_count(const skg_fit *fit, int64_t *count);

/** Gets parameter 0 <= index < count. */
SKG_API skg_status skg_fit_parameter_get(const skg_fit *fit, int64_t index, skg_fit_parameter *parameter);

/** Where a fit is. The library fills it; prepare with skg_fit_state_init. */
typedef struct {
    /** Set by skg_fit_state_init. */
    int32_t size;
    /** 1: the evaluations are used up, or the error is small enough. */
    int32_t done;
    /** Poses of the body so far. */
    int64_t evaluations;
    /** Generations so far. */
    int64_t generation;
    /** Restarts of CMA-ES so far. */
    int64_t restarts;
    /** Least root mean square error so far, mm. */
    double best_mm;
} skg_fit_state;

SKG_INIT(skg_fit_state)

/** Evaluates one generation. Does nothing if the fit is done.
 *
 *     state    result: in and out, prepared with skg_fit_state_init; may be NULL
 *     errors   SKG_ERR_ARGUMENT if there is no target; SKG_ERR_CANCELLED: the generation was not evaluated, and the
 *              best parameters so far stay */
SKG_API skg_status skg_fit_step(skg_fit *fit, skg_fit_state *state);

/** Writes where the search is, to a file that appears whole or not at all. Called after each step, it loses at most one
 * generation, however the process ends. */
SKG_API skg_status skg_fit_checkpoint_save(skg_fit *fit, const char *path);

/** Continues from such a file, with the same bits. Call it before the first step.
 *
 *     errors   SKG_ERR_FILE; SKG_ERR_FORMAT if it is none, or one of another scene, targets, parameters, bounds, method
 *              or seed */
SKG_API skg_status skg_fit_checkpoint_load(skg_fit *fit, const char *path);

/** Computes what the parameters and targets report: sigma, and the distances before and after. */
SKG_API skg_status skg_fit_finish(skg_fit *fit);

/** Gets the covariance of the chosen parameters, in their units, from which sigma comes. After skg_fit_finish.
 *
 *     size         number of chosen parameters
 *     covariance   result: [size][size] */
SKG_API skg_status skg_fit_covariance_get(const skg_fit *fit, int64_t size, double *covariance);

/** Distances of a target before and after the fit. The library fills it; prepare with skg_fit_target_init. Distances are from the organ to
 * the target, over the surface (distance.h). */
typedef struct {
    /** Set by skg_fit_target_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Number of the part. */
    int64_t part;
    /** Label of the part, valid as long as the set-up. */
    const char *label;
    /** Phase of the target. */
    double phase;
    /** Mean distance of the organ at rest, as its file has it: how far it has moved, mm. */
    double motion_mm;
    /** With the parameters of the scene, mm. */
    double before_mean_mm;
    /** Root mean square. */
    double before_rms_mm;
    /** One-sided maximum. */
    double before_max_mm;
    /** With the fitted parameters, mm. */
    double after_mean_mm;
    /** Root mean square. */
    double after_rms_mm;
    /** One-sided maximum. */
    double after_max_mm;
} skg_fit_target;

SKG_INIT(skg_fit_target)

/** Number of targets. */
SKG_API skg_status skg_fit_target_count(const skg_fit *fit, int64_t *count);

/** Gets target 0 <= index < count. Its distances are set by skg_fit_finish. */
SKG_API skg_status skg_fit_target_get(const skg_fit *fit, int64_t index, skg_fit_target *target);

/** Gets the mesh of target 0 <= index < count, valid as long as the fit and not retained for the caller. */
SKG_API skg_status skg_fit_target_mesh_get(const skg_fit *fit, int64_t index, skg_mesh **mesh);

/** Writes the scene with the best parameters in its key Breathing. Paths of files stay relative if the file is in the
 * folder of the scene, and become absolute otherwise.
 *
 *     errors   SKG_ERR_OUTPUT */
SKG_API skg_status skg_fit_scene_save(const skg_fit *fit, const char *path);

#ifdef __cplusplus
}
#endif
#endif
