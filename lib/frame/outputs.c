/* The outputs of a submission: checked, placed, read back. */
#include "frame/work.h"

#include "beam/counter.h"
#include "spectral/model.h"

#include <inttypes.h>

void skg_output_init_sized(void *output, int32_t size) {
    const skg_output defaults = {0};
    skg_struct_init(output, size, &defaults, sizeof defaults);
}

/* --- checks */

/* Below this products of strides and counts do not overflow. */
static const int64_t LARGEST_STRIDE = (int64_t)1 << 40;

static skg_status check_strides(const skg_view *view, int64_t frames, skg_frame_output *o) {
    skg_output *to = &o->to;
    const int64_t columns = view->columns, rows = view->rows;
    if (to->row_stride > LARGEST_STRIDE || to->channel_stride > LARGEST_STRIDE ||
        to->frame_stride > LARGEST_STRIDE)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "strides of %" PRId64 ", %" PRId64 " and %" PRId64 " elements; at most 2^40",
                        to->row_stride, to->channel_stride, to->frame_stride);
    if (!to->row_stride) to->row_stride = columns;
    if (to->row_stride < columns)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a row stride of %" PRId64 " elements does not hold %" PRId64 " columns",
                        to->row_stride, columns);
    if (!to->channel_stride) to->channel_stride = rows * to->row_stride;
    if (to->channel_stride < rows * to->row_stride)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a channel stride of %" PRId64 " elements does not hold %" PRId64 " rows",
                        to->channel_stride, rows);
    if (!to->frame_stride) to->frame_stride = o->channels * to->channel_stride;
    if (frames > 1 && to->frame_stride < o->channels * to->channel_stride)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a frame stride of %" PRId64 " elements does not hold %" PRId64 " channels",
                        to->frame_stride, o->channels);
    return SKG_OK;
}

static skg_status check_scatter(const char *call, const skg_recipe *recipe, const skg_output *to) {
    if (!recipe->options.scatter)
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "%s: the scatter is asked for, but the plan has none; set skg_plan_options.scatter (Scatter)",
            call);
    if (to->kind == SKG_OUTPUT_SCATTER_COMPONENT &&
        (to->component < 0 || to->component > SKG_SCATTER_COMPONENT_COMPTON_HIGHER))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: component %" PRId32 " of the scatter is no SKG_SCATTER_COMPONENT_ value", call,
                        to->component);
    return SKG_OK;
}

/* Images without noise are made with weights of energies that say nothing of the number of photons. */
static skg_status check_variance(const char *call, const skg_recipe *recipe) {
    const skg_counter *counter = recipe->options.counter;
    if (recipe->options.noise && counter && counter->counting.pile_up)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: the variance is not computed behind the dead time of a detector that counts; draw "
            "frames of other seeds, or leave the pile-up out (PileUp)",
            call);
    if (skg_quantity_has_noise(&recipe->options)) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT,
                    "%s: the variance of the noise is asked for, but the plan has none; set "
                    "skg_plan_options.noise (Noise), and take SKG_OUTPUT_MEAN for the image without it",
                    call);
}

static skg_status check_kind(const char *call, const skg_recipe *recipe, const skg_output *to) {
    const int64_t parts = recipe->scene->count;
    if (to->kind == SKG_OUTPUT_IMAGE || to->kind == SKG_OUTPUT_MEAN) return SKG_OK;
    if (to->kind == SKG_OUTPUT_VARIANCE) return check_variance(call, recipe);
    if (skg_output_is_scatter(to->kind)) return check_scatter(call, recipe, to);
    if (to->kind != SKG_OUTPUT_LENGTHS)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: an output of kind %" PRId32 " is no SKG_OUTPUT_ value", call,
                        to->kind);
    if (to->part < 0 || to->part >= parts)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: part %" PRId64 " of %" PRId64, call, to->part, parts);
    if (to->lengths != SKG_LENGTHS_NET && to->lengths != SKG_LENGTHS_SURFACE)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "lengths of kind %" PRId32 " are unknown; SKG_LENGTHS_NET or SKG_LENGTHS_SURFACE",
                        to->lengths);
    return SKG_OK;
}

static skg_status check_double(const skg_context *context, const skg_output *to) {
    const skg_device_info *device = &context->device->info;
    if (to->type != SKG_TYPE_FLOAT64 || device->double_precision) return SKG_OK;
    return skg_fail(SKG_ERR_UNSUPPORTED, "%s has no fp64, so it cannot write doubles; take SKG_TYPE_FLOAT32",
                    device->name);
}

static skg_status check_type(const skg_output *to) {
    if (to->type != SKG_TYPE_FLOAT32 && to->type != SKG_TYPE_FLOAT64)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "output type %" PRId32 " is unknown; SKG_TYPE_FLOAT32 or SKG_TYPE_FLOAT64", to->type);
    if (!to->buffer && !to->data)
        return skg_fail(SKG_ERR_ARGUMENT, "the output has no memory: its data is NULL");
    return SKG_OK;
}

/* From the first element of a frame to its last. */
static int64_t frame_elements(const skg_frame_output *o, const skg_view *view) {
    return (o->channels - 1) * o->to.channel_stride + (view->rows - 1) * o->to.row_stride + view->columns;
}

/* Checks that all frames fit the caller's buffer, and finds where they begin. */
static skg_status check_buffer(const char *call, const skg_view *view, const skg_context *context,
                               int64_t frames, skg_frame_output *o) {
    const skg_output *to = &o->to;
    const int64_t element = skg_frame_output_element(o);
    int64_t bytes = 0;
    SKG_TRY(skg_caller_buffer_check(call, context, to->buffer, &bytes));
    if (to->offset < 0 || to->offset % element)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "an offset of %" PRId64 " bytes is no multiple of an element's %" PRId64, to->offset,
                        element);
    o->first = to->offset / element;
    const int64_t last = (frames - 1) * to->frame_stride + frame_elements(o, view);
    if ((o->first + last) * element > bytes)
        return skg_fail(SKG_ERR_ARGUMENT, "the images end at byte %" PRId64 ", the buffer at %" PRId64,
                        (o->first + last) * element, bytes);
    return SKG_OK;
}

skg_status skg_frame_output_check(const char *call, const skg_view *view, const skg_context *context,
                                  int64_t frames, skg_frame_output *output) {
    SKG_TRY(check_type(&output->to));
    SKG_TRY(check_strides(view, frames, output));
    return output->to.buffer ? check_buffer(call, view, context, frames, output) : SKG_OK;
}

skg_status skg_frame_output_read(const char *call, const skg_recipe *recipe, const skg_machine *machine,
                                 int64_t frames, const skg_output *outputs, int64_t index,
                                 skg_frame_output *output) {
    *output = (skg_frame_output){.to = {.size = sizeof output->to}};
    SKG_TRY(skg_struct_read_at(outputs, index, "skg_output", &output->to, sizeof output->to));
    SKG_TRY(check_kind(call, recipe, &output->to));
    SKG_TRY(check_double(machine->context, &output->to));
    output->channels = output->to.kind == SKG_OUTPUT_LENGTHS ? 1 : recipe->model.channels;
    return skg_frame_output_check(call, &recipe->view, machine->context, frames, output);
}

/* --- memory that a CPU shares with the caller */

/* Smaller images are copied sooner than a buffer is made of their memory. */
static const int64_t SHARED_BYTES = 512 << 10;

void skg_frame_output_share(skg_frame_output *output, const skg_view *view, const skg_machine *machine,
                            int64_t frames) {
    const skg_device *device = machine->context->device;
    const int64_t element = skg_frame_output_element(output), one = frame_elements(output, view);
    cl_int code = CL_SUCCESS;
    if (output->to.buffer || !device->info.cpu || one * element < SHARED_BYTES) return;
    if ((uintptr_t)output->to.data % (uintptr_t)element) return;
    const size_t bytes = (size_t)(((frames - 1) * output->to.frame_stride + one) * element);
    cl_mem made =
        clCreateBuffer(device->cl, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, output->to.data, &code);
    if (code == CL_SUCCESS) output->direct = made;
}

void skg_frame_output_release(skg_frame_output *output) {
    if (output->direct) clReleaseMemObject(output->direct);
    output->direct = NULL;
}

/* --- enqueueing */

skg_status skg_frame_output_place(const skg_frame_output *output, const skg_view *view, skg_machine *machine,
                                  int64_t frame, skg_image_place *place) {
    const skg_output *to = &output->to;
    SKG_ASSERT(frame >= 0 && view->rows > 0 && view->columns > 0);
    *place = (skg_image_place){.memory = to->buffer,
                               .output_double = to->type == SKG_TYPE_FLOAT64,
                               .offset = output->first + frame * to->frame_stride,
                               .row_stride = to->row_stride,
                               .channel_stride = to->channel_stride};
    if (output->direct) place->memory = output->direct;
    if (place->memory) return SKG_OK;
    const int64_t size = view->rows * view->columns;
    SKG_TRY(skg_buffer_reserve(machine->context, &machine->image,
                               output->channels * size * skg_frame_output_element(output), CL_MEM_READ_WRITE,
                               "image"));
    place->memory = machine->image.memory;
    place->offset = 0;
    place->row_stride = view->columns;
    place->channel_stride = size;
    return SKG_OK;
}

/* Has what a CPU wrote into the caller's memory seen there: OpenCL promises it of a region that is mapped. */
static skg_status settle(const skg_frame_output *output, const skg_view *view, const skg_machine *machine,
                         int64_t frame) {
    cl_command_queue queue = machine->context->device->queue;
    const int64_t element = skg_frame_output_element(output), from = frame * output->to.frame_stride;
    cl_int code = CL_SUCCESS;
    void *mapped = clEnqueueMapBuffer(queue, output->direct, CL_FALSE, CL_MAP_READ, (size_t)(from * element),
                                      (size_t)(frame_elements(output, view) * element), 0, NULL, NULL, &code);
    SKG_CL_TRY(code);
    SKG_CL_TRY(clEnqueueUnmapMemObject(queue, output->direct, mapped, 0, NULL, NULL));
    return SKG_OK;
}

/* Reads one channel back, with a row stride of its own. OpenCL requires the strides of channels to be multiples of those
 * of rows, so each channel is read by itself. */
static skg_status read_channel(const skg_frame_output *output, const skg_view *view,
                               const skg_machine *machine, int64_t channel, char *to, skg_stage_log *log) {
    const size_t element = (size_t)skg_frame_output_element(output), rows = (size_t)view->rows;
    const size_t columns = (size_t)view->columns * element, stride = (size_t)output->to.row_stride * element;
    const size_t from[3] = {0, (size_t)channel * rows, 0}, at[3] = {0, 0, 0}, region[3] = {columns, rows, 1};
    cl_event event = NULL, *wanted = skg_stage_event(log, &event);
    to += (size_t)(channel * output->to.channel_stride) * element;
    SKG_CL_TRY(clEnqueueReadBufferRect(machine->context->device->queue, machine->image.memory, CL_FALSE, from,
                                       at, region, columns, 0, stride, 0, to, 0, NULL, wanted));
    return skg_stage_log_add(log, "read back", event);
}

skg_status skg_frame_output_read_back(const skg_frame_output *output, const skg_view *view,
                                      const skg_machine *machine, int64_t frame, skg_stage_log *log,
                                      cl_event *end) {
    const skg_output *to = &output->to;
    if (to->buffer) return SKG_OK;
    if (output->direct) return settle(output, view, machine, frame);
    const int64_t size = view->rows * view->columns, element = skg_frame_output_element(output);
    char *first = (char *)to->data + frame * to->frame_stride * element;
    if (to->row_stride != view->columns || (output->channels > 1 && to->channel_stride != size)) {
        for (int64_t c = 0; c < output->channels; c++)
            SKG_TRY(read_channel(output, view, machine, c, first, log));
        return SKG_OK;
    }
    cl_event event = NULL, *wanted = end ? &event : skg_stage_event(log, &event);
    SKG_CL_TRY(clEnqueueReadBuffer(machine->context->device->queue, machine->image.memory, CL_FALSE, 0,
                                   (size_t)(output->channels * size * element), first, 0, NULL, wanted));
    if (end) SKG_CL_TRY(clRetainEvent(*end = event));
    return skg_stage_log_add(log, "read back", event);
}

skg_status skg_caller_buffer_check(const char *call, const skg_context *context, cl_mem buffer,
                                   int64_t *bytes) {
    cl_context of = NULL;
    size_t size = 0;
    if (!buffer) return skg_fail(SKG_ERR_ARGUMENT, "%s: no buffer", call);
    SKG_CL_TRY(clGetMemObjectInfo(buffer, CL_MEM_CONTEXT, sizeof of, &of, NULL));
    if (of != context->device->cl)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: the buffer is another OpenCL context's; make it in that of the plan "
                        "(skg_context_create_cl)",
                        call);
    SKG_CL_TRY(clGetMemObjectInfo(buffer, CL_MEM_SIZE, sizeof size, &size, NULL));
    *bytes = (int64_t)size;
    return SKG_OK;
}
