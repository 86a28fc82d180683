/* Passes that one launch draws: samples of the source of one frame, or small frames of a job. Of small frames each worker takes whole ones,
 * so that launches, and waiting for each other after every stage, come once for all of them. What follows the sums of a frame is enqueued as
 * for any. */
#include "frame/frames.h"
#include "plan/decisions.h"

/* --- passes */

/* Numbers before the extents of the passes: the pass that is claimed next. */
enum { CLAIM = 1 };

static skg_status make_room(const skg_pass *pass, skg_waiting *g) {
    const int32_t room = skg_raster_passes(pass->main.raster);
    g->tables = (skg_pass_tables){0};
    SKG_TRY(skg_staging_take(g->staging, CLAIM + 4 * room * pass->planes, sizeof *g->placed, "extents",
                             &g->placed));
    SKG_TRY(skg_realloc(room, sizeof *g->passes, "passes", &g->passes));
    g->room = room;
    return SKG_OK;
}

skg_status skg_waiting_add(skg_job *job, const skg_pass *pass, skg_waiting *g) {
    SKG_ASSERT(g->count == 0 || g->count < g->room);
    if (g->count == 0) SKG_TRY(make_room(pass, g));
    SKG_TRY(skg_frame_update_meshes(job));
    SKG_TRY(skg_geometry_weigh_pass(&job->machine->geometry, &pass->camera, pass->parts, pass->scale.scale,
                                    g->room, &g->tables, g->staging));
    skg_pass_extents(pass, g->placed + CLAIM + 4 * g->count * pass->planes);
    g->passes[g->count++] = *pass;
    return SKG_OK;
}

skg_status skg_waiting_draw(skg_job *job, const skg_waiting *g, cl_event *read) {
    skg_machine *machine = job->machine;
    if (g->count == 0) return SKG_OK;
    SKG_TRY(skg_geometry_send_passes(machine->context, &machine->geometry, &g->tables));
    return skg_raster_run_passes(g->passes->main.raster, &machine->geometry, g->count, g->placed, read,
                                 &job->staging.log);
}

void skg_waiting_empty(skg_waiting *g) {
    while (g->count > 0) skg_pass_release(&g->passes[--g->count]);
}

void skg_waiting_release(skg_waiting *g) {
    skg_waiting_empty(g);
    skg_free(&g->passes);
}

/* --- frames */

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
                            .kind = job->outputs->to.kind,
                            .noise = g->noise[place]};
}

/* The contributions of all parts of a pass; passes that are drawn together have as many. */
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
    skg_pass_note(job, &pass);
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
        SKG_TRY(skg_job_step(job, end, &work));
    }
    return SKG_OK;
}

skg_status skg_submit_together(skg_job *job, const skg_frame *frames, const double **poses, int64_t end,
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
