/** @file
 * How far long work is, and its cancellation.
 *
 * A progress is given to work in its options: skg_scan_run_options, skg_fdk_options, skg_fit_options and
 * skg_distance_options. It can be used in three ways, also together: a function that the work calls, skg_progress_get
 * from any thread, and skg_progress_cancel from any thread or from a signal handler. Jobs of frames have functions of
 * their own: skg_job_progress and skg_job_cancel. Only the scatter of a frame, which is computed while the frame is submitted, has
 * a progress: skg_frame.progress.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_PROGRESS_H
#define SKIAGRAPH_PROGRESS_H

#include <skiagraph/error.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How far work is, and whether it is to be cancelled. */
typedef struct skg_progress skg_progress;

/** Hears how far work is. Called before the first step, between steps and after the last one, by the thread whose call
 * does the work. It must not call the library with objects of that work.
 *
 *     done     steps that are done: projections, evaluations, samples
 *     total    all of them
 *     user     as given to skg_progress_create
 *     return   0 to continue; any other number cancels the work */
typedef int32_t (*skg_progress_function)(int64_t done, int64_t total, void *user);

/** Makes a progress. Give one to one work at a time.
 *
 *     function   NULL: nobody is called, and progress is asked for by skg_progress_get
 *     user       handed to the function
 *     progress   result; the caller releases it; the work retains it */
SKG_API skg_status skg_progress_create(skg_progress_function function, void *user, skg_progress **progress);

/** Adds an owner to a progress. */
SKG_API skg_status skg_progress_retain(skg_progress *progress);

/** Removes an owner; with the last one it is freed. */
SKG_API void skg_progress_release(skg_progress **progress);

/** Gets how far the work is. Any thread may ask.
 *
 *     done    result: steps that are done; may be NULL
 *     total   result: all of them, 0 before the work has begun; may be NULL */
SKG_API skg_status skg_progress_get(const skg_progress *progress, int64_t *done, int64_t *total);

/** Cancels: the call that does the work, or the next one, returns SKG_ERR_CANCELLED before its next step. What was done
 * stays, and the objects can be released. The progress stays cancelled. Any thread and any signal handler may call it. */
SKG_API skg_status skg_progress_cancel(skg_progress *progress);

#ifdef __cplusplus
}
#endif
#endif
