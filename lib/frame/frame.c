#include "frame/frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a frame knows of its parts, one for each. */
struct skg_frame_room {
    skg_geometry_part *parts;
    skg_extent *extents;
    skg_scale_part *scales; /* of those that add something */
};

void skg_frame_room_release(skg_frame_room **room) {
    if (!*room) return;
    skg_free(&(*room)->parts);
    skg_free(&(*room)->extents);
    skg_free(&(*room)->scales);
    skg_free(room);
}

static skg_status make_room(skg_plan *plan) {
    const int64_t count = plan->scene->count;
    skg_frame_room *room = NULL;
    skg_status status = SKG_OK;
    if (plan->room) return SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *room, "parts of a frame", &room));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *room->parts, "parts of a frame", &room->parts));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *room->extents, "parts of a frame", &room->extents));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *room->scales, "parts of a frame", &room->scales));
    plan->room = room;
    return SKG_OK;
cleanup:
    skg_frame_room_release(&room);
    return status;
}

static void release_parts(skg_frame_parts *frame) {
    skg_free(&frame->writes);
    skg_free(&frame->first_write);
    skg_mix_release(&frame->mix);
    skg_priority_release(&frame->priority);
}

/* What parts add to the only plane of path lengths: 1 mm per mm of the part asked for, less its children. */
static skg_status list_lengths(const skg_plan *plan, const skg_frame_work *work, skg_frame_parts *frame) {
    const int64_t parts = plan->scene->count;
    SKG_TRY(skg_alloc(parts, sizeof *frame->writes, "parts of a frame", &frame->writes));
    SKG_TRY(skg_alloc(parts + 1, sizeof *frame->first_write, "parts of a frame", &frame->first_write));
    int64_t count = 0;
    for (int64_t p = 0; p < parts; p++) {
        const int is_child =
            work->kind == SKG_LENGTHS_NET && plan->scene->parts[p].inside == work->lengths_of;
        frame->first_write[p] = count;
        if (p == work->lengths_of || is_child)
            frame->writes[count++] = (skg_contribution){.weight = is_child ? -1 : 1};
    }
    frame->first_write[parts] = count;
    frame->all_writes = frame->writes;
    frame->firsts = frame->first_write;
    frame->planes = 1;
    return SKG_OK;
}

static skg_status list_writes(const skg_plan *plan, const skg_frame_work *work, skg_frame_parts *frame) {
    if (work->lengths_of >= 0) return list_lengths(plan, work, frame);
    if (work->frame && work->frame->override_count != 0)
        return skg_frame_list_matter(plan, work->frame, frame);
    frame->all_writes = plan->model.contributions;
    frame->firsts = plan->model.first_contribution;
    frame->planes = plan->model.planes;
    return SKG_OK;
}

/* Parts that add alike share an accumulator, where that pays and there are not more kinds than planned. */
static skg_status mix_planes(const skg_plan *plan, const skg_frame_work *work, skg_frame_parts *frame) {
    if (work->lengths_of >= 0 || !plan->mixed) return SKG_OK;
    SKG_TRY(skg_mix_find(plan->scene->count, plan->model.planes, frame->all_writes, frame->firsts,
                         plan->mixed, &frame->mix));
    if (!frame->mix.sums) return SKG_OK; /* matter of many kinds in this frame */
    frame->all_writes = frame->mix.contributions;
    frame->firsts = frame->mix.first_contribution;
    frame->planes = plan->mixed;
    return SKG_OK;
}

/* Whether some part adds to more than one plane. */
static int has_lists(const skg_frame_parts *frame, int64_t parts) {
    for (int64_t p = 0; p < parts; p++)
        if (frame->firsts[p + 1] - frame->firsts[p] > 1) return 1;
    return 0;
}

static double largest_weight(const skg_frame_parts *frame, int64_t part) {
    double largest = 0;
    for (int64_t w = frame->firsts[part]; w < frame->firsts[part + 1]; w++)
        largest = fmax(largest, fabs(frame->all_writes[w].weight));
    return largest;
}

/* Where the parts lie, what they may add, and the scale that follows from both. */
static skg_status place_parts(skg_plan *plan, const skg_frame_work *work, skg_frame_parts *frame) {
    const skg_scene *scene = plan->scene;
    int64_t adding = 0;
    SKG_TRY(make_room(plan));
    skg_scale_part *scales = plan->room->scales;
    frame->parts = plan->room->parts;
    frame->extents = plan->room->extents;
    for (int64_t p = 0; p < scene->count; p++) {
        const skg_mesh *mesh = scene->parts[p].mesh;
        const double *pose = work->poses && work->poses[p] ? work->poses[p] : scene->parts[p].pose;
        const int64_t writes = frame->firsts[p + 1] - frame->firsts[p];
        frame->parts[p] = (skg_geometry_part){.pose = pose,
                                              .origin = mesh->origin,
                                              .flipped = mesh->orientation < 0,
                                              .weights = mesh->closed ? (int32_t)writes : 0,
                                              .weight = frame->all_writes + frame->firsts[p]};
        skg_extent_find(&frame->camera, mesh, pose, &frame->extents[p]);
        const skg_scale_part *reach = &frame->extents[p].scale;
        frame->parts[p].reference = 0.5 * (reach->low_depth + reach->high_depth);
        if (writes == 0) continue;
        frame->extents[p].scale.weight = largest_weight(frame, p);
        scales[adding++] = frame->extents[p].scale;
        frame->kernels.source_plane |= frame->extents[p].near_source && frame->extents[p].on_detector;
    }
    skg_scale_find(&plan->grid, adding, scales, plan->options.precision == SKG_PRECISION_DOUBLE ? 64 : 32,
                   &frame->scale);
    return SKG_OK;
}

/* Vertices that have changed since they were last uploaded, as they are now. */
static skg_status upload(skg_plan *plan, skg_job *job) {
    const int is_double = plan->options.precision == SKG_PRECISION_DOUBLE;
    SKG_TRY(skg_plan_meshes_check(&plan->meshes, plan->scene));
    for (int64_t i = 0; i < plan->meshes.count; i++) {
        skg_plan_mesh *mesh = &plan->meshes.meshes[i];
        void *offsets = NULL;
        if (mesh->version == mesh->mesh->version) continue;
        SKG_TRY(skg_job_stage(job, 3 * mesh->mesh->vertices, is_double ? sizeof(double) : sizeof(float),
                              "vertices", &offsets));
        skg_plan_mesh_offsets(mesh->mesh, is_double, offsets);
        SKG_TRY(skg_geometry_upload(plan->context, &plan->geometry, i, offsets, &job->log));
        mesh->version = mesh->mesh->version;
    }
    return SKG_OK;
}

/* The lists of the frame's accumulators, brought to the device where they differ from those it has. */
static skg_status upload_lists(skg_plan *plan, skg_job *job, const skg_frame_parts *frame) {
    const int64_t count = (int64_t)plan->mixed * plan->model.planes;
    const int is_double = plan->options.precision == SKG_PRECISION_DOUBLE;
    void *staged = NULL;
    if (!frame->mix.sums) return SKG_OK;
    if (plan->mix_sent && memcmp(plan->mix_sent, frame->mix.lists, (size_t)count * sizeof(double)) == 0)
        return SKG_OK;
    if (!plan->mix_sent) SKG_TRY(skg_alloc(count, sizeof(double), "planes of the parts", &plan->mix_sent));
    SKG_TRY(skg_job_stage(job, count, is_double ? sizeof(double) : sizeof(float), "planes", &staged));
    for (int64_t i = 0; i < count; i++)
        if (is_double)
            ((double *)staged)[i] = frame->mix.lists[i];
        else
            ((float *)staged)[i] = (float)frame->mix.lists[i];
    const int64_t bytes = count * (int64_t)(is_double ? sizeof(double) : sizeof(float));
    SKG_TRY(skg_buffer_reserve(plan->context, &plan->mix_lists, bytes, CL_MEM_READ_ONLY, "planes"));
    SKG_TRY(skg_stage_write(plan->context, "upload", plan->mix_lists.memory, 0, bytes, staged, &job->log));
    memcpy(plan->mix_sent, frame->mix.lists, (size_t)count * sizeof(double));
    return SKG_OK;
}

static skg_status resolve(skg_plan *plan, skg_job *job, const skg_frame_work *work, int64_t sample,
                          const skg_frame_parts *frame) {
    const int lengths = work->lengths_of >= 0;
    /* Noise is that of photons in a pixel: the area comes later. */
    const int areas =
        plan->options.quantity == SKG_QUANTITY_FLUENCE && !skg_quantity_is_absolute(&plan->options);
    const double area = areas ? skg_camera_pixel_area(&frame->camera) : 1;
    const double factor = lengths ? 1 : 1 / (area * (double)skg_samples_count(&plan->samples));
    /* A length may be off by some of its bound where a face lies nearly along the ray (contracts 3): a
     * ten-thousandth is no subtraction. */
    const double least = -1e-4 * frame->scale.bound - 1e-6;
    const cl_int none = 0;
    skg_image_place place = work->place;
    place.add = sample > 0;
    SKG_CL_TRY(clEnqueueFillBuffer(plan->context->device->queue, plan->negative.memory, &none, sizeof none, 0,
                                   sizeof none, 0, NULL, NULL));
    skg_noise_args noise = work->noise;
    noise.sample = sample > 0 ? (cl_int)sample : 0;
    SKG_TRY(upload_lists(plan, job, frame));
    const skg_sums sums = {.raster = plan->main,
                           .scale = frame->scale.scale,
                           .mixed = frame->mix.sums ? plan->mixed : 0,
                           .lists = plan->mix_lists.memory};
    return skg_attenuate(plan->attenuator, &sums, &frame->camera,
                         lengths ? &plan->lengths : &plan->attenuation, factor, least, plan->negative.memory,
                         &noise, &place, &job->log);
}

/* Who competes for intervals in this frame; a mesh's own lengths know nothing of others. */
static skg_status find_priorities(const skg_plan *plan, const skg_frame_work *work, skg_frame_parts *frame) {
    if (!plan->priority_possible || (work->lengths_of >= 0 && work->kind == SKG_LENGTHS_SURFACE))
        return SKG_OK;
    SKG_TRY(skg_priority_find(plan->scene, plan->options.clip, frame->extents, &frame->priority));
    for (int64_t s = 0; s < frame->priority.count; s++)
        frame->kernels.source_plane |= frame->extents[frame->priority.parts[s]].near_source;
    return SKG_OK;
}

/* Camera of a sample (below 0: the point source and the pixels' centres), parts, scale, and the rasteriser
 * that they call for. */
static skg_status prepare(skg_plan *plan, const skg_frame_work *work, int64_t sample,
                          skg_frame_parts *frame) {
    double source[3], shift[2] = {0, 0};
    if (sample >= 0) skg_samples_at(&plan->samples, work->view, sample, source, shift);
    SKG_TRY(skg_camera_make(work->view, sample >= 0 ? source : NULL, shift[0], shift[1], &frame->camera));
    SKG_TRY(list_writes(plan, work, frame));
    SKG_TRY(mix_planes(plan, work, frame));
    SKG_TRY(place_parts(plan, work, frame));
    SKG_TRY(find_priorities(plan, work, frame));
    frame->kernels.precision =
        plan->options.precision == SKG_PRECISION_DOUBLE ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    frame->kernels.half = plan->options.precision == SKG_PRECISION_HALF;
    frame->kernels.bits =
        frame->kernels.half ? 32 : frame->scale.bits; /* half: 2^-24 m, whatever the scene */
    frame->kernels.parallel = frame->camera.parallel;
    frame->kernels.listed_writes = frame->kernels.half || has_lists(frame, plan->scene->count);
    SKG_TRY(skg_plan_raster(plan, &frame->kernels, plan->strategy, frame->planes,
                            plan->open_count > 0 || plan->priority_possible, &plan->main));
    plan->report.plane_bits = frame->scale.bits;
    skg_raster_tiles(plan->main, &plan->report.tile_columns, &plan->report.tile_rows, &plan->report.tiles);
    return SKG_OK;
}

skg_status skg_frame_prepare(skg_plan *plan) {
    const skg_frame_work work = {.view = &plan->view, .lengths_of = -1};
    skg_frame_parts frame = {0};
    skg_status status = prepare(plan, &work, -1, &frame);
    release_parts(&frame);
    return status;
}

/* The fields of the raster's planes: what those of their parts cover. */
static skg_status find_fields(const skg_plan *plan, skg_job *job, const skg_frame_parts *frame,
                              cl_int **fields) {
    SKG_TRY(skg_job_stage(job, 4 * frame->planes, sizeof **fields, "fields", fields));
    for (int64_t p = 0; p < plan->scene->count; p++) {
        cl_int own[4];
        skg_extent_pixels(&frame->camera, &frame->extents[p], own);
        for (int64_t w = frame->firsts[p]; w < frame->firsts[p + 1]; w++) {
            cl_int *field = *fields + 4 * frame->all_writes[w].plane;
            const int known = field[1] > 0;
            for (int k = 0; k < 4; k += 2) {
                field[k] = known && field[k] < own[k] ? field[k] : own[k];
                field[k + 1] = known && field[k + 1] > own[k + 1] ? field[k + 1] : own[k + 1];
            }
        }
    }
    return SKG_OK;
}

/* One pass: from the vertices to the image of one sample. */
static skg_status enqueue_pass(skg_plan *plan, skg_job *job, const skg_frame_work *work, int64_t sample) {
    skg_frame_parts frame = {0};
    cl_int *fields = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(prepare(plan, work, sample, &frame));
    skg_warn_unseen(plan, &frame);
    SKG_TRY_CLEANUP(upload(plan, job));
    SKG_TRY_CLEANUP(skg_geometry_project(plan->context, &plan->geometry, &frame.kernels, &frame.camera,
                                         frame.parts, frame.scale.scale, &job->log));
    if (frame.kernels.half) skg_raster_set_rays(plan->main, &frame.camera);
    SKG_TRY_CLEANUP(find_fields(plan, job, &frame, &fields));
    SKG_TRY_CLEANUP(skg_raster_run(plan->main, &plan->geometry, fields, &job->log));
    if (frame.priority.count) SKG_TRY_CLEANUP(skg_priority_run(plan, job, &frame, plan->main));
    if (plan->open_count) SKG_TRY_CLEANUP(skg_open_parts_add(plan, job, &frame, plan->main));
    SKG_TRY_CLEANUP(resolve(plan, job, work, sample, &frame));
cleanup:
    release_parts(&frame);
    return status;
}

int skg_plan_averages(const skg_plan *plan) {
    return plan->samples.spot.shape != SKG_SPOT_POINT || plan->samples.shifts > 1;
}

skg_status skg_frame_enqueue(skg_plan *plan, skg_job *job, const skg_frame_work *work) {
    if (work->lengths_of >= 0) return enqueue_pass(plan, job, work, -1);
    const int64_t first = skg_plan_averages(plan) ? 0 : -1;
    const int64_t end = first < 0 ? 0 : skg_samples_count(&plan->samples);
    for (int64_t s = first; s < end; s++) SKG_TRY(enqueue_pass(plan, job, work, s));
    SKG_TRY(skg_plan_detect(plan, job, work));
    if (plan->options.quantity != SKG_QUANTITY_ATTENUATION || !skg_plan_is_late(plan)) return SKG_OK;
    return skg_attenuate_logarithm(plan->attenuator, plan->main, &plan->attenuation, &work->place, &job->log);
}
