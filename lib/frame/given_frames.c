/* Frames of the caller, read and copied, so that they may be enqueued later. */
#include "frame/frames.h"

#include "plan/decisions.h"

#include <inttypes.h>
#include <string.h>

void skg_frame_init_sized(void *frame, int32_t size) {
    const skg_frame defaults = {0};
    skg_struct_init(frame, size, &defaults, sizeof defaults);
}

static skg_status read_poses(const skg_recipe *recipe, int64_t index, const skg_frame *frame,
                             const double **poses) {
    if (frame->pose_count < 0 || (frame->pose_count > 0 && (!frame->pose_parts || !frame->poses)))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "frame %" PRId64 " has %" PRId64 " posed parts, but no ids or poses", index,
                        frame->pose_count);
    for (int64_t k = 0; k < frame->pose_count; k++) {
        const int64_t part = frame->pose_parts[k];
        if (part < 0 || part >= recipe->scene->count)
            return skg_fail(SKG_ERR_ARGUMENT, "frame %" PRId64 " poses part %" PRId64 " of %" PRId64, index,
                            part, recipe->scene->count);
        SKG_TRY(skg_scene_check_pose(recipe->scene->parts[part].label, frame->poses + 16 * k));
        poses[part] = frame->poses + 16 * k;
    }
    return SKG_OK;
}

skg_status skg_held_frame_place(const skg_recipe *recipe, int64_t index, const skg_frame *frame,
                                skg_view *view, const double **poses) {
    if (frame->view) {
        SKG_TRY(skg_view_check(frame->view));
        skg_view_init(view);
        SKG_TRY(skg_struct_read(frame->view, "skg_view", view, sizeof *view));
        SKG_TRY(skg_decide_view(recipe, view));
    }
    return read_poses(recipe, index, frame, poses);
}

skg_status skg_held_frame_read(const skg_job *job, const skg_frame *frames, int64_t index, skg_frame *frame,
                               skg_view *view, const double **poses, skg_noise_args *noise) {
    const skg_recipe *recipe = job->recipe;
    SKG_ASSERT(job->then.first <= index && index < job->count);
    skg_frame_init(frame);
    *view = recipe->view;
    *noise = skg_noise_key(recipe->options.noise_seed, index, 1);
    for (int64_t p = 0; p < recipe->scene->count; p++) poses[p] = NULL;
    if (!frames) return SKG_OK;
    SKG_TRY(skg_struct_read_at(frames, index - job->then.first, "skg_frame", frame, sizeof *frame));
    *noise = skg_noise_key((int64_t)((uint64_t)recipe->options.noise_seed + (uint64_t)frame->noise_seed),
                           frame->index, frame->subframes);
    if (frame->subframes < 0)
        return skg_fail(SKG_ERR_ARGUMENT, "frame %" PRId64 ": it is one of %" PRId32 " sub-frames", index,
                        frame->subframes);
    return skg_held_frame_place(recipe, index, frame, view, poses);
}

/* A copy that the job frees; NULL of NULL. copy: the address of a pointer to const. */
static skg_status copy_array(skg_job *job, int64_t count, size_t size, const void *from, void *copy) {
    void *block = NULL;
    if (!from || count < 1) return SKG_OK;
    SKG_TRY(skg_staging_take(&job->staging, count, size, "frames", &block));
    memcpy(block, from, (size_t)count * size);
    memcpy(copy, &block, sizeof block);
    return SKG_OK;
}

/* frame: in and out: the caller's, then with arrays of its own. view: as read. */
static skg_status own_arrays(skg_job *job, const skg_view *view, skg_frame *frame) {
    const int64_t parts = frame->override_count;
    if (frame->view) SKG_TRY(copy_array(job, 1, sizeof *view, view, &frame->view));
    SKG_TRY(
        copy_array(job, frame->pose_count, sizeof *frame->pose_parts, frame->pose_parts, &frame->pose_parts));
    SKG_TRY(copy_array(job, 16 * frame->pose_count, sizeof *frame->poses, frame->poses, &frame->poses));
    SKG_TRY(
        copy_array(job, parts, sizeof *frame->override_parts, frame->override_parts, &frame->override_parts));
    SKG_TRY(
        copy_array(job, parts, sizeof *frame->density_ratios, frame->density_ratios, &frame->density_ratios));
    return copy_array(job, parts, sizeof *frame->fill_fractions, frame->fill_fractions,
                      &frame->fill_fractions);
}

/* A submission refuses what a frame would be refused for later. */
static skg_status check_overrides(const skg_recipe *recipe, const skg_frame *frame) {
    skg_contribution *contributions = NULL;
    int64_t *first = NULL;
    if (frame->override_count == 0) return SKG_OK;
    const skg_status status = skg_overrides_apply(recipe, frame, &contributions, &first);
    skg_free(&contributions);
    skg_free(&first);
    return status;
}

/* Copies the vertices for readers on the host, which read them between steps and where they look for flat faces that touch, when the caller
 * may already have moved them. */
static skg_status own_vertices(skg_job *job, skg_mesh *mesh) {
    const int64_t count = 3 * mesh->vertices;
    if (mesh->positions_stale)
        return copy_array(job, count, sizeof *mesh->offsets, mesh->offsets, &mesh->offsets);
    return copy_array(job, count, sizeof *mesh->positions, mesh->positions, &mesh->positions);
}

/* The scene as the frames that are enqueued already were made of it. */
static skg_status copy_scene(skg_job *job) {
    const skg_scene *scene = job->recipe->scene;
    const skg_plan_meshes *meshes = &job->recipe->meshes;
    skg_job_scene *then = &job->then;
    skg_scene_part_data *parts = NULL;
    skg_recipe *recipe = NULL;
    SKG_TRY(skg_staging_take(&job->staging, scene->count, sizeof *parts, "parts", &parts));
    SKG_TRY(skg_staging_take(&job->staging, meshes->count, sizeof *then->meshes, "meshes", &then->meshes));
    for (int64_t m = 0; m < meshes->count; m++)
        memcpy(&then->meshes[m], meshes->meshes[m], sizeof *then->meshes);
    for (int64_t p = 0; p < scene->count; p++) {
        parts[p] = scene->parts[p];
        parts[p].mesh = &then->meshes[meshes->of_part[p]];
        parts[p].material = NULL; /* the model has what frames need of it */
    }
    SKG_TRY(skg_recipe_copy(job->recipe, &recipe));
    then->scene = (skg_scene){.parts = parts, .count = scene->count, .volumes = scene->volumes};
    recipe->scene = &then->scene;
    then->given = job->recipe;
    job->recipe = recipe;
    for (int64_t m = 0; m < meshes->count; m++)
        if (job->kind->begin || job->machine->geometry.layouts[m].flat)
            SKG_TRY(own_vertices(job, &then->meshes[m]));
    return SKG_OK;
}

skg_status skg_held_frames_copy(skg_job *job, const skg_frame *frames) {
    const int64_t first = job->enqueued / job->steps, count = job->count - first;
    const double **poses = NULL; /* are checked here, and read again later */
    skg_frame *copies = NULL;
    skg_status status = SKG_OK;
    if (frames) {
        SKG_TRY(skg_staging_take(&job->staging, count, sizeof *copies, "frames", &copies));
        SKG_TRY(skg_alloc(job->recipe->scene->count, sizeof *poses, "poses", &poses));
    }
    for (int64_t i = 0; frames && i < count; i++) {
        skg_view view;
        skg_noise_args noise;
        SKG_TRY_CLEANUP(skg_held_frame_read(job, frames, first + i, &copies[i], &view, poses, &noise));
        SKG_TRY_CLEANUP(check_overrides(job->recipe, &copies[i]));
        SKG_TRY_CLEANUP(own_arrays(job, &view, &copies[i]));
    }
    SKG_TRY_CLEANUP(copy_scene(job));
    job->then.frames = copies;
    job->then.first = first;
cleanup:
    skg_free(&poses);
    return status;
}
