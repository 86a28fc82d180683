/** @file
 * Runs: the projections of a scan, computed batch by batch while the caller works with the batch before.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SCAN_RUN_H
#define SKIAGRAPH_SCAN_RUN_H

#include <skiagraph/motion.h>
#include <skiagraph/progress.h>
#include <skiagraph/scan_file.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A scan that is being computed. */
typedef struct skg_scan_run skg_scan_run;

/** Projections of a scan to be computed, and how. Prepare with skg_scan_run_options_init: every projection, as float, of a scene that
 * stands still. */
typedef struct {
    /** Set by skg_scan_run_options_init. */
    int32_t size;
    /** enum skg_type of the images */
    int32_t type;
    /** First projection. */
    int64_t from;
    /** One after the last projection; 0: the number of projections. */
    int64_t to;
    /** Number of projections in `only`; 0 (default): all from `from` to `to`. */
    int64_t only_count;
    /** [only_count] numbers of projections, rising. Those outside of `from` to `to` are left out. */
    const int64_t *only;
    /** Number of this shard, 0 <= shard < shards. Each shard has one block of consecutive projections. */
    int64_t shard;
    /** Number of shards; 1 by default. */
    int64_t shards;
    /** Projections in a batch; 0 (default): as many as 16 MiB hold, at most 32. Images do not depend on it. */
    int64_t batch;
    /** Frames from which each projection is averaged, spread evenly over its exposure; 1 (default) to 1000.
     * Source, detector and breath move from one to the next. */
    int64_t subframes;
    /** Poses the scene at the time of each frame. It is used by the run only, until that is released; NULL: the
     * scene stands still. */
    skg_motion *motion;
    /** Projections that this file has already are left out; NULL: none. */
    const skg_scan_file *file;
    /** Seed of the noise of every frame. The number of the projection is its index. */
    int64_t noise_seed;
    /** Number of parts that move from one projection to the next, beside what `motion` does. */
    int64_t moving_count;
    /** [moving_count] numbers of these parts; used until the run is released */
    const int64_t *moving_parts;
    /** [projections of the scan][moving_count][16] their poses; used until the run is released */
    const double *moving_poses;
    /** Steps are projections. Retained by the run; NULL: nobody wants to know. */
    skg_progress *progress;
} skg_scan_run_options;

SKG_INIT(skg_scan_run_options)

/** Starts a run. Three batches are in memory at a time: the caller's, and two that are being computed.
 *
 *     plan      retained. With sub-frames the mean is taken of the intensity, whatever the quantity; it has the noise
 *               of one exposure
 *     scan      retained
 *     options   NULL: the defaults
 *     run       result; the caller releases it
 *     errors    SKG_ERR_ARGUMENT (an option), SKG_ERR_MEMORY, and what skg_plan_submit gives */
SKG_API skg_status skg_scan_run_create(skg_plan *plan, skg_scan *scan, const skg_scan_run_options *options,
                                       skg_scan_run **run);

/** Frees a run. Batches that are being computed are cancelled. */
SKG_API void skg_scan_run_release(skg_scan_run **run);

/** Number of projections that a run computes, with those that were added. */
SKG_API skg_status skg_scan_run_projection_count(const skg_scan_run *run, int64_t *count);

/** Adds projections to a run, also to one that is finished, for instance a share of a scan that several processes compute. Those
 * outside of `from` to `to`, and those that the file of the options has, are left out. The size of a batch stays that of the
 * beginning, which is at most the number of the first projections.
 *
 *     count     number of projections
 *     indices   [count] their numbers in the scan; copied
 *     errors    SKG_ERR_ARGUMENT (a number), SKG_ERR_MEMORY */
SKG_API skg_status skg_scan_run_add(skg_scan_run *run, int64_t count, const int64_t *indices);

/** Projections that are finished. The library fills it; prepare with skg_scan_batch_init. Its pointers are valid
 * until the next call with the run. */
typedef struct {
    /** Set by skg_scan_batch_init. */
    int32_t size;
    /** enum skg_type */
    int32_t type;
    /** Number of projections; 0: the run is finished. */
    int64_t count;
    /** [count] their numbers in the scan, rising. */
    const int64_t *indices;
    /** [count][channel][row][column] */
    const void *images;
    /** [count] phase of the breath in the middle of the exposure; NULL without motion. */
    const double *phases;
    /** [count] amplitude of the breath in the middle of the exposure; NULL without motion. */
    const double *amplitudes;
} skg_scan_batch;

SKG_INIT(skg_scan_batch)

/** Waits for the next batch and starts another one.
 *
 *     batch    in and out: prepared with skg_scan_batch_init
 *     range    SKG_RANGE: the batch is in place, and skg_last_error says what is outside the verified range
 *     errors   SKG_ERR_CANCELLED; what skg_plan_submit and skg_job_wait give. The run cannot be continued, and the
 *              batches before stay valid */
SKG_API skg_status skg_scan_run_next(skg_scan_run *run, skg_scan_batch *batch);

/** Receives a batch. A status other than SKG_OK ends the run and is what skg_scan_run_each returns. */
typedef skg_status (*skg_scan_function)(const skg_scan_batch *batch, void *user);

/** Computes a whole run and gives each batch to a function.
 *
 *     range    SKG_RANGE: every batch was given, and pixels of some were outside the verified range
 *     errors   as of skg_scan_run_create and skg_scan_run_next */
SKG_API skg_status skg_scan_run_each(skg_plan *plan, skg_scan *scan, const skg_scan_run_options *options,
                                     skg_scan_function function, void *user);

/** Makes flat fields of a scan: images of the beam through the world, without parts, for the view of the first
 * projection. Their noise is that of the frames after the last projection.
 *
 *     scene     of the plan
 *     options   type and seed count; NULL: the defaults
 *     count     number of flat fields, at least 1
 *     images    result: [count][channel][row][column] of the options' type
 *     errors    what skg_plan_submit and skg_job_wait give */
SKG_API skg_status skg_scan_flat_fields_render(skg_plan *plan, const skg_scene *scene, skg_scan *scan,
                                               const skg_scan_run_options *options, int64_t count,
                                               void *images);

/** Makes dark fields of a scan: images without the beam, with the electronic noise and the steps of the plan's images. Of an
 * attenuation they are 0.
 *
 *     plan      of one channel
 *     options   type and seed count; NULL: the defaults
 *     count     number of dark fields, at least 1
 *     images    result: [count][row][column] of the options' type
 *     errors    SKG_ERR_ARGUMENT (count) */
SKG_API skg_status skg_scan_dark_fields_render(const skg_plan *plan, const skg_scan *scan,
                                               const skg_scan_run_options *options, int64_t count,
                                               void *images);

/** Gets the text that identifies a scan: the SHA-256 of the set-up (skg_setup_hash_get), of the options that
 * decide its images, and of the version of the library. Device, strategy, shard and batch do not change it.
 *
 *     options   of the plan: precision, quantity, tolerance and seed count, and what the set-up does not say
 *     run       sub-frames, motion (whether there is one) and seed count; NULL: the defaults
 *     hash      result: [size] bytes, at least 65: 64 hexadecimal digits and a zero
 *     errors    SKG_ERR_ARGUMENT (size), SKG_ERR_FILE */
SKG_API skg_status skg_scan_hash_get(const skg_setup *setup, const skg_plan_options *options,
                                     const skg_scan_run_options *run, char *hash, int64_t size);

#ifdef __cplusplus
}
#endif
#endif
