/* Jobs: made of a submission, given to the device in steps, asked, waited for. Private. */
#ifndef SKG_JOBS_H
#define SKG_JOBS_H

#include "device/device.h"
#include "frame/plans.h"
#include "frame/work.h"
#include "plan/results.h"

#include <stdatomic.h>

/* --- Work under way: what it is made with, what must stay until the device is done with it, and what is reported then. */

/* The scene at the time of a submission, for frames that are enqueued later, perhaps while the program changes it. All NULL: every
 * frame was enqueued at once. */
typedef struct {
    skg_recipe *given; /* retained: that of the submission; the job's is a copy of it, for the scene below */
    skg_scene scene;   /* its parts are copies, with the meshes below */
    /* [meshes] of the recipe: copies of the structs. Their arrays may have other contents by now, and the device has those of the
     * submission */
    skg_mesh *meshes;
    skg_frame *frames; /* [count - first] copies with arrays of their own; NULL: as plan and scene stood */
    int64_t first;     /* number of frames[0] */
} skg_job_scene;

/* The functions that make the steps of a job. frame/render_output.c has the kind whose frames are images; rooms above have others. */
typedef struct {
    /* Enqueues what comes before the steps. These then follow one by one, when the job is asked or waited for, on vertices that are
     * copied. NULL: there is nothing before. frames: the caller's; poses: [parts] memory */
    skg_status (*begin)(skg_job *job, const skg_frame *frames, const double **poses);
    /* Enqueues a step of a frame. work: of the frame; what it is to show is filled in */
    skg_status (*step)(skg_job *job, int64_t frame, int64_t step, skg_frame_work *work);
    /* Hands out results when all steps are done. NULL: they are in place. */
    skg_status (*finish)(skg_job *job);
    skg_status (*cancelled)(const skg_job *job); /* fails, and says what is in place */
    void (*release)(void **state);               /* NULL: there is no state */
} skg_job_kind;

struct skg_job {
    /* the only member that is written when the job is gone, by who cancels it too late */
    atomic_int cancelled;
    skg_pool *pool;     /* retained: it has the memory of this */
    skg_plan *plan;     /* retained; NULL: the caller keeps machine and outcome */
    skg_recipe *recipe; /* retained: that of the submission, or of then.scene */
    skg_machine *machine;
    skg_scatterer *scatterer; /* of the plan; NULL: images of the primary alone */
    const skg_job_kind *kind;
    void *state;          /* of the kind */
    skg_outcome *outcome; /* takes what is known of a frame when it is enqueued, and remembers warnings */
    skg_frame_output *outputs; /* [output_count] */
    int64_t output_count;
    int64_t count; /* frames */
    int64_t steps; /* of each frame, which are given to the device one after another; 1: it is given whole */
    int64_t each;  /* passes of a step; 0: all */
    int64_t enqueued;    /* steps of all frames */
    int64_t done;        /* of them: known to be finished */
    cl_event *ends;      /* [count][steps] of the last command of each step that was enqueued */
    skg_job_scene then;  /* staged */
    skg_raster_pin main; /* the raster of the closed parts of the last pass */
    skg_staging staging; /* host memory that the device reads or writes; the log of all frames */
    skg_results results; /* staged */
    cl_event last;       /* of the last command; NULL until all that will be enqueued was */
    skg_aside *feeder;   /* goes on with the job while nobody asks; NULL: nothing does */
    int32_t finished;    /* 1: everything enqueued is done */
    int32_t of_plan;     /* 1: a plan that is made waits for it: skg_context_interrupt ends it */
    int32_t together;    /* its small frames are drawn together, so many side by side; 0: each by itself */
    int32_t uncounted;   /* 1: the count of negative exponents is 0 */
    int32_t followed;    /* 1: that count is of several frames, of which the last is not the job's */
    atomic_int references;
    atomic_int over; /* 1: the job was waited for, and nothing of it is left but what its references need */
    skg_status failure; /* of a frame that was to be enqueued after the submission */
    char *sentence;     /* of the failure */
};

/* Checks the outputs and makes a job of no frames yet. call: the name of the public function. */
skg_status skg_job_create(const char *call, const skg_job_kind *kind, const skg_recipe *recipe,
                          skg_machine *machine, skg_outcome *outcome, int64_t count, int64_t output_count,
                          const skg_output *outputs, skg_job **job);

/* Has each frame given in so many steps. Before any is enqueued. */
skg_status skg_job_divide(skg_job *job, int64_t steps);

/* Enqueues the step of a frame that was read, which comes next. end: the number before which others follow at once */
skg_status skg_job_step(skg_job *job, int64_t end, skg_frame_work *work);

static inline int skg_job_is_cancelled(const skg_job *job) {
    return atomic_load(&job->cancelled) || (job->of_plan && atomic_load(&job->machine->context->interrupted));
}

/* Steps of all frames. */
static inline int64_t skg_job_steps(const skg_job *job) {
    return job->count * job->steps;
}

/* Waits for everything enqueued, frees what the job holds, and gives up the reference that it was created with; *job becomes NULL.
 * Also for submissions that failed half way. */
void skg_job_end(skg_job **job);

/* Ends the work of a job, but keeps its reference. */
void skg_job_empty(skg_job *job);

/* --- Frames of a job: checked and enqueued, all at once or one after another (frame/submit_frames.c) */

/* Checks the frames and enqueues them. Of frames that keep the device busy for long, only the first ones are enqueued, so that a
 * job can be cancelled; the others follow while it is asked or waited for. frames: [job->count] the caller's; NULL: each as
 * plan and scene stand. at_once: 1: all are enqueued. After a failure nothing is under way, and the job is released. */
skg_status skg_submit_frames(skg_job **job, const skg_frame *frames, int at_once);

/* Enqueues frames that the device can be given by now, unless the job was cancelled. A failure is reported by skg_job_wait. */
void skg_submission_continue(skg_job *job);

/* Enqueues what is left of a context's earlier job, so that its jobs run in order. */
void skg_submission_flush(const skg_context *context);

/* Enqueues the reads of what is reported, of which the last is waited for, if that was not done. */
skg_status skg_submission_finish(skg_job *job);

/* --- Small frames, of which one launch draws several (frame/together.c) */

/* How many of a job's frames a worker draws side by side, if they are to be drawn together; 0: they are not. What single frames call for is
 * found out when they come. outputs: the only one */
int32_t skg_together_side(const skg_recipe *recipe, const skg_machine *machine, int64_t frames,
                          const skg_output *outputs);

/* The most frames that are drawn together. */
int64_t skg_together_most(const skg_machine *machine);

/* How many frames of a job the raster of the last one draws. */
int32_t skg_job_room(const skg_job *job);

/* Enqueues frames from job->enqueued on, before number `end`: as many as one launch draws. submitted: how many; 0: the next one has to be
 * drawn by itself. */
skg_status skg_submit_together(skg_job *job, const skg_frame *frames, const double **poses, int64_t end,
                               int64_t *submitted);

/* --- Waiting for a job, and giving the device its frames meanwhile (frame/wait.c) */

/* Counts the steps that are done, and gives the device others. */
skg_status skg_job_look(skg_job *job);

/* Waits, reports and releases. */
skg_status skg_job_complete(skg_job **job);

/* The last thing that a public call does which submits a job and does not wait for it. Starts a thread if some steps of the job are
 * not enqueued yet. The thread takes turns with the calls of the program, and ends when all steps are enqueued, or the job failed or was
 * cancelled. If there is no thread to be had, the device may be idle until the job is asked for. Returns status, that of the submission;
 * after a failure there is no job. */
skg_status skg_feeder_start(skg_status status, skg_job *const *job);

/* --- Frames that the caller describes: read and checked, and copied if they are enqueued later */

/* Reads and checks a frame: itself, its view, its poses ([parts], NULL: the scene's) and the key of its noise. frames: the
 * caller's, or those of job->then; NULL: as plan and scene stand. */
skg_status skg_held_frame_read(const skg_job *job, const skg_frame *frames, int64_t index, skg_frame *frame,
                               skg_view *view, const double **poses, skg_noise_args *noise);

/* Reads and checks the view and the poses of a frame, over those that are given. index: for the message */
skg_status skg_held_frame_place(const skg_recipe *recipe, int64_t index, const skg_frame *frame,
                                skg_view *view, const double **poses);

/* Copies what the frames from job->enqueued on need of scene and caller. From then on the job looks at neither. */
skg_status skg_held_frames_copy(skg_job *job, const skg_frame *frames);

/* --- OpenCL objects of the caller */

/* The events that a call is given, and where the caller wants one of its own. */
typedef struct {
    int32_t waits;
    const cl_event *wait_list; /* [waits] */
    cl_event *done;            /* may be NULL */
} skg_caller_events;

/* Sets *done to NULL, and checks the list. call: the name of the function, for the message. */
skg_status skg_caller_events_check(const char *call, const skg_caller_events *events);

/* Enqueues that the caller's events are waited for. */
skg_status skg_caller_events_wait(skg_context *context, const skg_caller_events *events);

#endif
