/* Draws a model by the kernels of the 3D view. */
#include "show/drawing.h"

#include "show_shared.h"

#include "core/maths.h"
#include "device/device.h"
#include "stage/kernels.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* Towards the light, in the eye's axes: from the upper left, beside the eye. */
static const float LIGHT[3] = {-0.38f, 0.46f, 0.802f};
static const float BACKGROUND[3] = {0.957f, 0.961f, 0.969f};

/* Work-items of a group where each takes a triangle, or a strip on a GPU. On a CPU an item is a group of its own: its
 * strip is on the stack, and those of a group would be there together. */
enum { GROUP = 64 };

/* Buffers and kernels of one picture. */
typedef struct {
    skg_buffer positions, corners, normals, colours, faces, counts, starts, entries, image, rgba;
    cl_kernel count, fill, draw;
} scratch;

static void free_scratch(scratch *s) {
    skg_buffer *buffers[] = {&s->positions, &s->corners, &s->normals, &s->colours, &s->faces,
                             &s->counts,    &s->starts,  &s->entries, &s->image,   &s->rgba};
    cl_kernel kernels[] = {s->count, s->fill, s->draw};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++) skg_buffer_release(buffers[i]);
    for (size_t i = 0; i < sizeof kernels / sizeof *kernels; i++)
        if (kernels[i]) clReleaseKernel(kernels[i]);
}

static skg_status get_kernels(skg_context *context, scratch *s) {
    static const char *const files[] = {"config.clh", "types.clh", "show_shared.h", "show.cl"};
    const skg_define lanes = {"SKG_WIDE", skg_kernel_lanes(context, SKG_PRECISION_SINGLE)};
    char options[64];
    cl_program program;
    SKG_TRY(skg_defines_text(1, &lanes, sizeof options, options));
    SKG_TRY(skg_program_get(context, sizeof files / sizeof *files, files, options, &program));
    SKG_TRY(skg_kernel_create(program, "skg_show_count", &s->count));
    SKG_TRY(skg_kernel_create(program, "skg_show_fill", &s->fill));
    return skg_kernel_create(program, "skg_show_draw", &s->draw);
}

static skg_show_args arguments_of(const skg_show_model *model, const skg_show_camera *camera,
                                  const skg_look *look, int64_t image_columns, int64_t image_rows) {
    skg_show_args args = {.columns = (int32_t)look->columns,
                          .rows = (int32_t)look->rows,
                          .across = (int32_t)skg_divide_up(2 * look->columns, SKG_SHOW_TILE),
                          .down = (int32_t)skg_divide_up(2 * look->rows, SKG_SHOW_TILE),
                          .triangles = (int32_t)model->triangles,
                          .sections = (int32_t)model->sections,
                          .images = (int32_t)model->images,
                          .image_columns = (int32_t)image_columns,
                          .image_rows = (int32_t)image_rows};
    for (int k = 0; k < 16; k++) args.matrix[k] = camera->matrix[k];
    for (int k = 0; k < 3; k++) {
        args.light[k] = LIGHT[k];
        args.background[k] = look->background ? (float)look->background[k] / 255.0f : BACKGROUND[k];
        for (int axis = 0; axis < 3; axis++) args.turn[3 * axis + k] = (float)camera->axes[k][axis];
    }
    return args;
}

static skg_status upload(skg_context *context, const skg_show_model *model, const skg_show_args *args,
                         const uint8_t *image, scratch *s) {
    const int64_t triangles = model->triangles;
    SKG_TRY(skg_buffer_write(context, &s->positions, 3 * model->vertices * (int64_t)sizeof *model->positions,
                             model->positions, "vertices of the 3D view"));
    SKG_TRY(skg_buffer_write(context, &s->corners, 3 * triangles * (int64_t)sizeof *model->corners,
                             model->corners, "triangles of the 3D view"));
    SKG_TRY(skg_buffer_write(context, &s->normals, 12 * triangles * (int64_t)sizeof *model->normals,
                             model->normals, "normals of the 3D view"));
    SKG_TRY(skg_buffer_write(context, &s->colours, triangles * (int64_t)sizeof *model->colours,
                             model->colours, "colours of the 3D view"));
    SKG_TRY(skg_buffer_write(context, &s->image, (int64_t)args->image_columns * args->image_rows, image,
                             "the detector's image in the 3D view"));
    SKG_TRY(skg_buffer_reserve(context, &s->faces, triangles * (int64_t)sizeof(skg_show_face),
                               CL_MEM_READ_WRITE, "triangles of the 3D view"));
    return skg_buffer_reserve(context, &s->rgba, 4 * (int64_t)args->columns * args->rows, CL_MEM_WRITE_ONLY,
                              "picture of the 3D view");
}

/* Counts the triangles of each tile and places the lists one after the other. starts: [SKG_SHOW_LISTS * tiles + 1]. */
static skg_status place_lists(skg_context *context, const skg_show_args *args, scratch *s, int32_t *starts) {
    const int64_t lists = (int64_t)SKG_SHOW_LISTS * args->across * args->down;
    int64_t total = 0;
    SKG_TRY(skg_buffer_reserve(context, &s->counts, lists * (int64_t)sizeof *starts, CL_MEM_READ_WRITE,
                               "lists of the 3D view"));
    SKG_TRY(skg_buffer_write(context, &s->counts, lists * (int64_t)sizeof *starts, starts,
                             "lists of the 3D view"));
    const skg_argument arguments[] = {SKG_ARGUMENT(SHOW_COUNT, args, *args),
                                      SKG_ARGUMENT(SHOW_COUNT, vertices, s->positions.memory),
                                      SKG_ARGUMENT(SHOW_COUNT, corners, s->corners.memory),
                                      SKG_ARGUMENT(SHOW_COUNT, normals, s->normals.memory),
                                      SKG_ARGUMENT(SHOW_COUNT, colours, s->colours.memory),
                                      SKG_ARGUMENT(SHOW_COUNT, faces, s->faces.memory),
                                      SKG_ARGUMENT(SHOW_COUNT, counts, s->counts.memory)};
    const skg_work_size work = {1, {args->triangles}, {GROUP}};
    SKG_TRY(SKG_LAUNCH(context, s->count, "3D view", &work, arguments, NULL));
    SKG_CL_TRY(clEnqueueReadBuffer(context->device->queue, s->counts.memory, CL_TRUE, 0,
                                   (size_t)lists * sizeof *starts, starts, 0, NULL, NULL));
    for (int64_t i = 0; i <= lists; i++) {
        const int32_t count = i < lists ? starts[i] : 0;
        if (total > INT32_MAX)
            return skg_fail(SKG_ERR_SCENE,
                            "the 3D view has %" PRId32
                            " triangles that fill the picture; leave parts out or make the picture smaller",
                            args->triangles);
        starts[i] = (int32_t)total;
        total += count;
    }
    SKG_TRY(skg_buffer_write(context, &s->starts, (lists + 1) * (int64_t)sizeof *starts, starts,
                             "lists of the 3D view"));
    SKG_TRY(skg_buffer_write(context, &s->counts, lists * (int64_t)sizeof *starts, starts,
                             "lists of the 3D view"));
    return skg_buffer_reserve(context, &s->entries, total * (int64_t)sizeof *starts, CL_MEM_READ_WRITE,
                              "lists of the 3D view");
}

static skg_status draw_lists(skg_context *context, const skg_show_args *args, scratch *s) {
    const int64_t strips = SKG_SHOW_TILE / skg_kernel_lanes(context, SKG_PRECISION_SINGLE);
    const skg_work_size triangles = {1, {args->triangles}, {GROUP}};
    const skg_work_size tiles = {
        1, {(int64_t)args->across * args->down * strips}, {context->device->info.cpu ? 1 : GROUP}};
    const skg_argument fill[] = {SKG_ARGUMENT(SHOW_FILL, args, *args),
                                 SKG_ARGUMENT(SHOW_FILL, faces, s->faces.memory),
                                 SKG_ARGUMENT(SHOW_FILL, cursors, s->counts.memory),
                                 SKG_ARGUMENT(SHOW_FILL, entries, s->entries.memory)};
    const skg_argument draw[] = {SKG_ARGUMENT(SHOW_DRAW, args, *args),
                                 SKG_ARGUMENT(SHOW_DRAW, faces, s->faces.memory),
                                 SKG_ARGUMENT(SHOW_DRAW, starts, s->starts.memory),
                                 SKG_ARGUMENT(SHOW_DRAW, entries, s->entries.memory),
                                 SKG_ARGUMENT(SHOW_DRAW, image, s->image.memory),
                                 SKG_ARGUMENT(SHOW_DRAW, rgba, s->rgba.memory)};
    SKG_TRY(SKG_LAUNCH(context, s->fill, "3D view", &triangles, fill, NULL));
    return SKG_LAUNCH(context, s->draw, "3D view", &tiles, draw, NULL);
}

skg_status skg_show_draw(skg_context *context, const skg_show_model *model, const skg_show_camera *camera,
                         const skg_look *look, int64_t image_columns, int64_t image_rows,
                         const uint8_t *image, uint8_t *rgba) {
    const skg_show_args args = arguments_of(model, camera, look, image_columns, image_rows);
    scratch s = {0};
    int32_t *starts = NULL;
    skg_status status = SKG_OK;
    if (model->triangles == 0) { /* nothing is in front of the eye */
        for (int64_t i = 0; i < 4 * look->columns * look->rows; i++)
            rgba[i] = i % 4 < 3 ? (uint8_t)lroundf(255 * args.background[i % 4]) : 255;
        return SKG_OK;
    }
    skg_work_begin();
    SKG_TRY_CLEANUP(skg_alloc((int64_t)SKG_SHOW_LISTS * args.across * args.down + 1, sizeof *starts,
                              "lists of the 3D view", &starts));
    SKG_TRY_CLEANUP(get_kernels(context, &s));
    SKG_TRY_CLEANUP(upload(context, model, &args, image, &s));
    SKG_TRY_CLEANUP(place_lists(context, &args, &s, starts));
    SKG_TRY_CLEANUP(draw_lists(context, &args, &s));
    SKG_CL_CLEANUP(clEnqueueReadBuffer(context->device->queue, s.rgba.memory, CL_TRUE, 0,
                                       (size_t)(4 * look->columns * look->rows), rgba, 0, NULL, NULL));
cleanup:
    if (status != SKG_OK) clFinish(context->device->queue); /* kernels may still use the buffers */
    skg_work_end();
    if (status == SKG_OK) skg_programs_launched(context);
    free_scratch(&s);
    skg_free(&starts);
    return status;
}
