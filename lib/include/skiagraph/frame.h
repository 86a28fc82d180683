/** @file
 * Frames: images of a scene, one or many, computed while the caller continues.
 *
 * A frame is one view of the scene as it stands when the frame is submitted. Submitting copies vertices,
 * poses, views and all else that the frames need, so the caller may write the next frame as soon as the call
 * returns.
 *
 * Any number of jobs may be in flight. The jobs of a context run in the order in which they were submitted,
 * whichever plans they belong to; they may be waited for in any order. The output's memory belongs to the
 * caller and must stay until the job was waited for. Plan, scene, meshes and context may be released before:
 * a job keeps what it needs. Every job must be waited for, because that is what releases it, also one that
 * was cancelled.
 *
 * The device is given frames for about half a second at once, and of a frame that takes longer, because it has many samples of the
 * source, some of these samples at once. If a job has more, the others follow during
 * skg_job_test, skg_job_progress and skg_job_wait, when another job is submitted to the context, and while nobody calls: a thread
 * of the library gives them then. Until the device has all of them a job can be cancelled (skg_job_cancel). Parts that are added
 * meanwhile are not in its frames. Frames of leaky meshes, those with scatter and those of opencl.h are all given at once.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_FRAME_H
#define SKIAGRAPH_FRAME_H

#include <skiagraph/progress.h>
#include <skiagraph/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** One frame. Prepare with skg_frame_init: the plan's view, the scene's poses and materials. */
typedef struct {
    /** Set by skg_frame_init. */
    int32_t size;
    /** 0 or 1: the frame is a whole exposure. n: it is one of n frames whose mean is an exposure. Each has the intensity of the
     * whole, and the noise of its share of the photons; if they have different seeds, their mean has the noise of one
     * exposure. */
    int32_t subframes;
    /** NULL: the plan's. It needs the plan's numbers of rows and columns. */
    const skg_view *view;
    /** Number of parts that have another pose in this frame. */
    int64_t pose_count;
    /** [pose_count] numbers of these parts */
    const int64_t *pose_parts;
    /** [pose_count][16] their poses */
    const double *poses;
    /** Seed of the noise. Seed and index decide it: frames with the same two have the same noise, others have
     * independent noise. */
    int64_t noise_seed;
    /** Number of the frame in its sequence, for the noise. */
    int64_t index;
    /** Number of parts whose matter differs from their material in this frame. */
    int64_t override_count;
    /** [override_count] numbers of these parts */
    const int64_t *override_parts;
    /** [override_count] density of the part over that of its material, 0 to 1000; NULL: 1 */
    const double *density_ratios;
    /** [override_count] fill fraction: the share of the part that is there, 0 to 1; the rest is what the part
     * lies inside. NULL: 1. A part below 1 must not contain another part. */
    const double *fill_fractions;
    /** Of a plan with scatter: a series that has the scatter of this frame (scatter_series.h) and was made by this plan; NULL: scatter
     * is computed for the frame. */
    const skg_scatter_series *scatter_series;
    /** The frame's number in that series, 0 to its number of frames less 1; between two numbers it is between them. */
    double series_place;
    /** Of a plan with scatter: the progress of the frame's scatter, which is computed while the frame is submitted. It is called at
     * least every 0.6 s. If it cancels, the submission returns SKG_ERR_CANCELLED, and the outputs are undefined. Its steps are
     * histories of a batch; the total rises where the error is not met. NULL: none. */
    skg_progress *progress;
} skg_frame;

SKG_INIT(skg_frame)

/** Kinds of outputs. */
enum skg_output_kind {
    /** Images: as many channels as the plan has, in its quantity. */
    SKG_OUTPUT_IMAGE = 0,
    /** Path lengths through one part in mm (the L-buffer): one channel. */
    SKG_OUTPUT_LENGTHS = 1,
    /** The scattered part of the images, without noise and blur, in the plan's quantity; of an attenuation or a transmission, as a
     * fraction of the flat field. Needs skg_plan_options.scatter. */
    SKG_OUTPUT_SCATTER = 2,
    /** Standard error of SKG_OUTPUT_SCATTER, smoothing included. */
    SKG_OUTPUT_SCATTER_SIGMA = 3,
    /** A component of the scatter, in the same unit (skg_output.component). Smoothed by the same cosines, so that the components
     * add up to SKG_OUTPUT_SCATTER; a small one may be slightly negative. */
    SKG_OUTPUT_SCATTER_COMPONENT = 4,
    /** The images that are expected, without noise and without the steps of the detector, in the plan's quantity. Of an attenuation
     * they are -ln of the mean transmission. */
    SKG_OUTPUT_MEAN = 5,
    /** The variance that noise gives to each value of the images, in the square of the plan's unit: that of quantum noise, primary and
     * scattered, behind the blur, of electronic noise, and step^2 / 12 for the steps of the detector. The last holds for steps up to
     * twice the standard deviation of the noise. Of an attenuation it is the variance of the transmission over the square of its
     * mean, which holds where the noise is small against the mean (first order). Neighbours in a blurred image are correlated,
     * which variances do not show. The error of the scatter itself is SKG_OUTPUT_SCATTER_SIGMA. Needs noise, electronic noise or
     * steps in skg_plan_options. */
    SKG_OUTPUT_VARIANCE = 6
};

/** Scattered photons by what they met in the parts. */
enum skg_scatter_component {
    /** Rayleigh scattering once. */
    SKG_SCATTER_COMPONENT_RAYLEIGH_FIRST = 0,
    /** Rayleigh scattering twice. */
    SKG_SCATTER_COMPONENT_RAYLEIGH_SECOND = 1,
    /** Rayleigh scattering three times or more. */
    SKG_SCATTER_COMPONENT_RAYLEIGH_HIGHER = 2,
    /** Compton scattering or fluorescence once. */
    SKG_SCATTER_COMPONENT_COMPTON_FIRST = 3,
    /** Two interactions, at least one of them Compton scattering or fluorescence. */
    SKG_SCATTER_COMPONENT_COMPTON_SECOND = 4,
    /** Three interactions or more, likewise. */
    SKG_SCATTER_COMPONENT_COMPTON_HIGHER = 5
};

/** Which lengths an output of SKG_OUTPUT_LENGTHS receives. */
enum skg_lengths {
    /** The length through the part itself, without what lies inside it (the paper's Eq. 9). */
    SKG_LENGTHS_NET = 0,
    /** The length between the surfaces of the part's mesh, whatever lies inside it. */
    SKG_LENGTHS_SURFACE = 1
};

/** An output of a job: its kind, and the memory that receives it as [frame][channel][row][column]. Prepare with skg_output_init:
 * images, float, dense. */
typedef struct {
    /** Set by skg_output_init. */
    int32_t size;
    /** enum skg_type; SKG_TYPE_FLOAT64 needs a device with fp64 */
    int32_t type;
    /** First element. The caller's memory; it must stay until the job was waited for. What it holds until then is not said: a CPU
     * writes large images straight into it. */
    void *data;
    /** Elements from one row to the next; 0: dense. */
    int64_t row_stride;
    /** Elements from one channel to the next; 0: dense. */
    int64_t channel_stride;
    /** Elements from one frame to the next; 0: dense. */
    int64_t frame_stride;
    /** enum skg_output_kind */
    int32_t kind;
    /** enum skg_lengths, of SKG_OUTPUT_LENGTHS. */
    int32_t lengths;
    /** Number of the part in the scene, of SKG_OUTPUT_LENGTHS. */
    int64_t part;
    /** A cl_mem of the plan's context that receives the output on the device (opencl.h), instead of data; NULL: data.
     * It must stay until the job was waited for. */
    void *buffer;
    /** Byte of the buffer at which the output begins, a multiple of an element's size. */
    int64_t offset;
    /** enum skg_scatter_component, of SKG_OUTPUT_SCATTER_COMPONENT. */
    int32_t component;
    /** 0 */
    int32_t reserved;
} skg_output;

SKG_INIT(skg_output)

/** Starts frames: an image of each, or several outputs, such as an image and the lengths through some of the parts. Each output is
 * rendered by itself, and is bit for bit that of a job of its own.
 *
 *     count          number of frames, at least 1; the plan splits them into batches that fit the device's memory
 *     frames         [count]; NULL: each as plan and scene stand
 *     output_count   number of outputs, at least 1
 *     outputs        [output_count] what is computed, and where it goes; their memory must not overlap
 *     job            result; skg_job_wait waits for it and releases it
 *     errors         SKG_ERR_MESH with part and vertex if a vertex is not finite; SKG_ERR_SCENE, SKG_ERR_ARGUMENT
 *     stale          SKG_STALE, and nothing is started, if the scene changed in a way that the plan cannot absorb:
 *                    a part was added or put elsewhere, a mesh has other triangles, a material lies outside what
 *                    was verified; or if a frame's view is one that skg_plan_view_set refuses so */
SKG_API skg_status skg_plan_submit(skg_plan *plan, int64_t count, const skg_frame *frames,
                                   int64_t output_count, const skg_output *outputs, skg_job **job);

/** Asks whether a job is finished, without waiting.
 *
 *     done   result: 1 if skg_job_wait would not wait, otherwise 0 */
SKG_API skg_status skg_job_test(skg_job *job, int32_t *done);

/** Gets how far a job is, without waiting.
 *
 *     done    result: number of frames that are in place; may be NULL
 *     total   result: number of frames of the job; may be NULL
 *
 * If the device is given the frames' samples of the source in steps, both are numbers of steps, and a multiple of the frames. */
SKG_API skg_status skg_job_progress(skg_job *job, int64_t *done, int64_t *total);

/** Cancels a job: frames, and steps of a frame, that the device was not given yet are not made. Those that it was given cannot be taken back;
 * skg_job_wait waits for them. Does nothing if the device has them all, or if the job was waited for. Other jobs are not touched.
 * Any thread, and any handler of a signal, may call it while it holds a reference: a window's thread retains the job that another waits
 * for. Without one it is no error as long as the context lives, but a younger job may have the same handle, which is then cancelled. */
SKG_API skg_status skg_job_cancel(skg_job *job);

/** Adds a reference to a job, for another thread that may cancel it. Any thread that holds a reference may call it. */
SKG_API skg_status skg_job_retain(skg_job *job);

/** Gives up a reference that skg_job_retain added, and sets the handle to NULL. The job's own reference is given up by skg_job_wait. Any
 * thread may call it; but if it gives up the last reference of a job that nobody has waited for, the job is cancelled and waited for,
 * which only the thread of its context may do. */
SKG_API void skg_job_release(skg_job **job);

/** Waits until a job's outputs are in place, releases the job and sets the handle to NULL.
 *
 *     range    SKG_RANGE: the images are in place, but some pixels meet path lengths outside the range for
 *              which the plan's error bound was verified, or some are not finite (skg_last_error says which)
 *     errors   SKG_ERR_MESH with frame, part and vertex if a vertex is not finite in its pose: the images of the
 *              other frames are in place, and later jobs are not touched; SKG_ERR_CANCELLED with the number of
 *              frames, the first ones of the job, that are in place; SKG_ERR_DEVICE and others. The job is
 *              released all the same, except with SKG_ERR_FORK */
SKG_API skg_status skg_job_wait(skg_job **job);

/** Makes one output, such as an image, of the scene as it stands: submits one frame and waits for it. */
SKG_API skg_status skg_plan_image(skg_plan *plan, const skg_output *output);

#ifdef __cplusplus
}
#endif
#endif
