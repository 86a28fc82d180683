/* Small frames of a job, of which one launch draws several: each worker takes whole frames, so that launches, and waiting for each other
 * after every stage, come once for all of them. What follows the sums of a frame is enqueued as for any. */
#include "frame/frames.h"
#include "frame/given.h"
#include "plan/decisions.h"

/* Frames that a launch draws. */
typedef struct {
    skg_waiting drawn;
    skg_view *views;       /* [most] */
    skg_frame *frames;     /* [most] */
    skg_noise_args *noise; /* [most] keys */
    int64_t first, most;   /* number of the first frame; how many there are at most */
} group;

static int32_t workers_of(const skg_machine *machine) {
    return machine->context->device->info.compute_units;
}

int64_t skg_together_most(const skg_machine *machine) {
    return skg_frames_most(workers_of(machine));
}

/* Whether the output of a frame is made of its sums alone. */
static int is_of_sums(const skg_recipe *recipe, int32_t kind) {
    return (kind == SKG_OUTPUT_IMAGE || kind == SKG_OUTPUT_MEAN) && !recipe->options.profile &&
           !recipe->options.scatter && skg_samples_passes(&recipe->samples) == 1;
}

int32_t skg_together_side(const skg_recipe *recipe, const skg_machine *machine, int64_t frames,
                          const skg_output *outputs) {
    const int64_t fine = recipe->samples.fine, planes = recipe->mixed ? recipe->mixed : recipe->model.planes;
    const int is_double = recipe->options.precision == SKG_PRECISION_DOUBLE;
    const skg_passes_request request = {.strategy = recipe->strategy,
                                        .workers = workers_of(machine),
                                        .passes = frames,
                                        .triangles = skg_scene_triangles(recipe->scene),
                                        .image_bytes = recipe->view.columns * recipe->view.rows * fine *
                                                       fine * planes * (is_double ? 8 : 4)};
    int32_t side = 1;
    if (!is_of_sums(recipe, outputs->kind) || !skg_frame_gathers(recipe, machine)) return 0;
    return skg_frames_choose(&request, &side) > 1 ? side : 0;
}

int32_t skg_job_room(const skg_job *job) {
    return job->main.raster ? skg_raster_passes(job->main.raster) : 1;
}

static skg_frame_work work_of(const skg_job *job, const group *g, int32_t place, const double **poses) {
    return (skg_frame_work){.view = &g->views[place],
                            .poses = poses,
                            .frame = &g->frames[place],
                            .shows = job->outputs->to.kind,
                            .noise = g->noise[place]};
}

/* What all parts of a pass add; passes that are drawn together have as many. */
static int64_t contributions_of(const skg_pass *pass) {
    int64_t count = 0;
    for (int64_t p = 0; p < pass->scene->count; p++) count += pass->parts[p].contributions;
    return count;
}

/* Whether a pass can be drawn with those that wait. */
static int fits_in(const group *g, const skg_pass *pass) {
    if (!pass->main.raster) return 0;
    return g->drawn.count == 0 || (g->drawn.passes->main.raster == pass->main.raster &&
                                   g->drawn.tables.contribution_count == contributions_of(pass));
}

/* Reads the frame that is next and adds its pass to those that wait. *fits: 0: it has to be drawn by another raster, or by itself. */
static skg_status add(skg_job *job, const skg_frame *frames, const double **poses, group *g, int *fits) {
    const int32_t place = g->drawn.count;
    const skg_recipe *recipe = job->recipe;
    skg_pass pass = {0};
    skg_status status = SKG_OK;
    *fits = 0;
    SKG_TRY_CLEANUP(skg_held_frame_read(job, frames, g->first + place, &g->frames[place], &g->views[place],
                                        poses, &g->noise[place]));
    const skg_frame_work work = work_of(job, g, place, poses);
    SKG_TRY_CLEANUP(skg_pass_fill(recipe, &work, skg_frame_first_pass(recipe), &job->machine->pass, &pass));
    SKG_TRY_CLEANUP(skg_frame_pin_together(job, &pass));
    if (!fits_in(g, &pass)) goto cleanup;
    skg_raster_pin_copy(&pass.main, &job->main);
    skg_warn_unseen(job->machine->context, pass.scene, &pass.camera, pass.extents, pass.fine, job->outcome);
    SKG_TRY_CLEANUP(skg_waiting_add(job, &pass, &g->drawn));
    *fits = 1;
    return SKG_OK;
cleanup:
    skg_pass_release(&pass);
    return status;
}

static skg_status open_group(skg_job *job, int64_t end, skg_together_slot *slot, group *g) {
    const int64_t left = end - job->enqueued, most = skg_together_most(job->machine);
    *g = (group){.first = job->enqueued, .most = left < most ? left : most, .drawn.staging = &slot->staging};
    SKG_TRY(skg_staging_take(&slot->staging, g->most, sizeof *g->views, "frames", &g->views));
    SKG_TRY(skg_staging_take(&slot->staging, g->most, sizeof *g->frames, "frames", &g->frames));
    return skg_staging_take(&slot->staging, g->most, sizeof *g->noise, "frames", &g->noise);
}

/* Enqueues the frames that were read. */
static skg_status submit_group(skg_job *job, const double **poses, int64_t end, skg_together_slot *slot,
                               const group *g) {
    skg_geometry_begin_frame(&job->machine->geometry, g->first, 1);
    SKG_TRY(skg_waiting_draw(job, &g->drawn, &slot->read));
    for (int32_t place = 0; place < g->drawn.count; place++) {
        skg_frame_work work = work_of(job, g, place, poses);
        work.drawn = &g->drawn.passes[place];
        work.drawn_place = place;
        SKG_TRY(skg_submit_step(job, end, &work));
    }
    return SKG_OK;
}

skg_status skg_together_submit(skg_job *job, const skg_frame *frames, const double **poses, int64_t end,
                               int64_t *submitted) {
    skg_together_slot *slot = NULL;
    group g;
    int fits = 1;
    *submitted = 0;
    SKG_TRY(skg_machine_slot_take(job->machine, skg_together_most(job->machine), &slot));
    SKG_TRY(open_group(job, end, slot, &g));
    skg_status status = SKG_OK;
    while (status == SKG_OK && fits && g.drawn.count < g.most &&
           (g.drawn.count == 0 || g.drawn.count < g.drawn.room))
        status = add(job, frames, poses, &g, &fits);
    *submitted = g.drawn.count;
    if (status == SKG_OK && g.drawn.count > 0) status = submit_group(job, poses, end, slot, &g);
    skg_waiting_release(&g.drawn);
    return status;
}
