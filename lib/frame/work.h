/* The work of a frame: what it is to show, and where that goes. Private. */
#ifndef SKG_WORK_H
#define SKG_WORK_H

#include "plan/recipe.h"
#include "stage/attenuate.h"
#include "stage/machine.h"
#include "stage/staging.h"

/* --- Work of a frame: its output, and how it is made */

/* Beside SKG_LENGTHS_NET and SKG_LENGTHS_SURFACE: what the cells of a volume add to a plane of the model. */
enum { SKG_LENGTHS_CELLS = 2 };

typedef struct {
    const skg_view *view;
    const double *const *poses; /* [parts] each NULL for the scene's; NULL: all the scene's */
    const skg_frame *frame;     /* the caller's, for its overrides; NULL: none */
    skg_noise_args noise;       /* its key */
    /* The output that is shown, and its place in memory. */
    int32_t kind;  /* enum skg_output_kind */
    int32_t which; /* of lengths: SKG_LENGTHS_...; of a component of the scatter: which */
    int64_t part;  /* whose lengths are shown */
    int32_t plane; /* of SKG_LENGTHS_CELLS */
    skg_image_place place;
    /* How it is made. */
    /* 1: sums that stand from the frame before, if it was the same one, are not drawn again */
    int32_t reuses;
    int64_t step, each; /* of an image: which step is made, of so many passes; each: 0: all its passes */
    /* its sums, which were drawn together with those of other frames; NULL: they are to be drawn */
    const struct skg_pass *drawn;
    int32_t drawn_place; /* of that pass, among those of its raster */
    cl_event *end;       /* gets the event of the frame's last command, or NULL; NULL: is not asked for */
    /* 1: another frame of the job follows at once, so that nobody reads this one's count of negative exponents */
    int32_t followed;
} skg_frame_work;

/* --- The outputs of a submission: what is computed, and where it goes */

typedef struct {
    skg_output to; /* checked; strides filled in */
    int64_t channels;
    int64_t first; /* element of to.buffer where the first frame begins */
    cl_mem direct; /* the caller's host memory, which a CPU writes to itself; NULL: images are read back */
} skg_frame_output;

/* Checks output `index` of a list and fills in the rest. call: the name of the public function. frames: their number. */
skg_status skg_frame_output_read(const char *call, const skg_recipe *recipe, const skg_machine *machine,
                                 int64_t frames, const skg_output *outputs, int64_t index,
                                 skg_frame_output *output);

/* The part of it that holds for whatever stands in an output: type, memory, strides and buffer of an output whose `to` and `channels`
 * are filled in. */
skg_status skg_frame_output_check(const char *call, const skg_view *view, const skg_context *context,
                                  int64_t frames, skg_frame_output *output);

/* Bytes of a value. */
static inline int64_t skg_frame_output_element(const skg_frame_output *output) {
    return output->to.type == SKG_TYPE_FLOAT64 ? (int64_t)sizeof(double) : (int64_t)sizeof(float);
}

/* Lets a CPU write the images of all frames into the caller's host memory, if they are large: a copy less. They are read back where
 * this is not possible. */
void skg_frame_output_share(skg_frame_output *output, const skg_view *view, const skg_machine *machine,
                            int64_t frames);
void skg_frame_output_release(skg_frame_output *output);

/* Whether a kind of output shows the scatter alone. */
static inline int skg_output_is_scatter(int32_t kind) {
    return kind == SKG_OUTPUT_SCATTER || kind == SKG_OUTPUT_SCATTER_SIGMA ||
           kind == SKG_OUTPUT_SCATTER_COMPONENT;
}

/* Where the device puts the output of a frame: the caller's buffer, or device memory from which it is read back. */
skg_status skg_frame_output_place(const skg_frame_output *output, const skg_view *view, skg_machine *machine,
                                  int64_t frame, skg_image_place *place);

/* Enqueues the read of an output into the caller's host memory. Does nothing if it stays on the device. end: gets the event of the
 * read, if it is one command; NULL: is not asked for */
skg_status skg_frame_output_read_back(const skg_frame_output *output, const skg_view *view,
                                      const skg_machine *machine, int64_t frame, skg_stage_log *log,
                                      cl_event *end);

/* Checks that a buffer is of the context's, and gets its size. */
skg_status skg_caller_buffer_check(const char *call, const skg_context *context, cl_mem buffer,
                                   int64_t *bytes);

#endif
