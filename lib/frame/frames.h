/* The levels of a frame: passes and their parts, scatter, the detector. Private. */
#ifndef SKG_FRAMES_H
#define SKG_FRAMES_H

#include "frame/jobs.h"
#include "frame/work.h"
#include "plan/recipe.h"
#include "stage/pass.h"

/* --- One frame: everything from vertices to pixels, enqueued stage by stage */

/* Prefetches the programs of images of the recipe's view (skg_prefetch_begin), as far as they are known before a frame. What fails
 * here fails again, and is reported, where it is needed. */
void skg_frame_prefetch(const skg_recipe *recipe, const skg_machine *machine);

/* Compiles and allocates for images of the recipe's view. */
skg_status skg_frame_prepare(const skg_recipe *recipe, skg_machine *machine, skg_outcome *outcome);

/* Fills a pass and pins the raster that it calls for; release it with skg_pass_release, also after a failure. number: of the pass, below
 * 0: the only one. alone: 1: it is drawn by itself */
skg_status skg_pass_begin(skg_job *job, const skg_frame_work *work, int64_t number, int alone,
                          skg_pass *pass);

/* The job's report is that of this pass from now on. Warns if the pass shows nothing. */
void skg_pass_note(skg_job *job, const skg_pass *pass);

/* Enqueues the sums of a pass that has begun: the raster of all parts, and what priorities, volumes and leaky parts change in its sums. */
skg_status skg_draw_sums(skg_job *job, const skg_frame_work *work, const skg_pass *pass);

/* The sums of a pass that was drawn, as the attenuation reads them, with what it reads beside them. place: of the pass among those of
 * its raster */
skg_status skg_frame_sums(skg_job *job, const skg_pass *pass, int32_t place, skg_sums *sums);

/* The factor of the intensities of a pass. */
double skg_frame_factor(const skg_recipe *recipe, const skg_frame_work *work, const skg_pass *pass);

/* Draws the path lengths through a part along every ray of a pass into a buffer, [rows][columns] of the pass's precision; of a volume,
 * what its cells add to a plane of the model. The pass is made for it alone; release it with skg_pass_release, also after a failure. */
skg_status skg_draw_lengths(skg_job *job, const skg_frame_work *work, int64_t number, int64_t part,
                            int32_t plane, skg_buffer *lengths, skg_pass *pass);

/* The number of the first pass of an image; -1: its only one, which is averaged with none. */
static inline int64_t skg_frame_first_pass(const skg_recipe *recipe) {
    return skg_recipe_averages(recipe) ? 0 : -1;
}

/* Whether nothing but the raster makes the sums, so that passes may be drawn together. */
int skg_frame_gathers(const skg_recipe *recipe, const skg_machine *machine);

/* Pins the raster by which the pass of a frame is drawn together with those of the job's other frames, and reports its layout; none if it
 * is better drawn by itself. */
skg_status skg_frame_pin_together(const skg_job *job, skg_pass *pass);

/* Uploads the positions of meshes that have changed. After the submission they are no longer looked at. */
skg_status skg_frame_update_meshes(skg_job *job);

/* Enqueues the passes from number `first` on, before `end`; of a frame that was drawn already (work->drawn) its share of the image. */
skg_status skg_draw_passes(skg_job *job, const skg_frame_work *work, int64_t first, int64_t end);

/* The steps of an output (enum skg_output_kind) of which an image's have `each` passes; 0: all. */
int64_t skg_frame_steps(const skg_recipe *recipe, int32_t kind, int64_t each);

/* The kind of job whose frames are images, and other outputs. */
extern const skg_job_kind skg_job_images;

/* Enqueues a step of one output of a frame; of an undivided job all of it. When the device is done with the last step the result is in
 * its place. index: of the frame */
skg_status skg_render_output(skg_job *job, const skg_frame_output *output, int64_t index,
                             skg_frame_work *work);

/* --- Passes that one launch draws */

/* Passes that wait to be drawn together: `count` of them, in a raster of `room`. All zero but for the staging: none. */
typedef struct {
    skg_pass *passes; /* [room] */
    int32_t count, room;
    skg_pass_tables tables;
    cl_int *placed;       /* what skg_raster_run_passes uploads */
    skg_staging *staging; /* of tables and extents */
} skg_waiting;

/* Adds a pass to those that wait, which takes it over if it succeeds. There is room. */
skg_status skg_waiting_add(skg_job *job, const skg_pass *pass, skg_waiting *gathered);

/* Enqueues their sums. read: the event from which on the staging may go; NULL: none. */
skg_status skg_waiting_draw(skg_job *job, const skg_waiting *gathered, cl_event *read);

/* Releases the passes; and the memory for them. */
void skg_waiting_empty(skg_waiting *gathered);
void skg_waiting_release(skg_waiting *gathered);

/* --- Contributions of the parts of one pass, and their places */

/* Fills a pass, but for its raster. number: of the passes that samples of source and pixel need; below 0: the point source and
 * the pixels' centres. The pass borrows memory; release it with skg_pass_release, also after a failure. */
skg_status skg_pass_fill(const skg_recipe *recipe, const skg_frame_work *work, int64_t number,
                         const skg_pass_memory *memory, skg_pass *pass);

/* Widens the extents of the raster's planes, [planes][4], all 0 before, to what those of their parts cover. */
void skg_pass_extents(const skg_pass *pass, cl_int *extents);

/* --- Frames in which parts have another density or fill fraction than planned: air that thins a lung, contrast medium that fills
 * a duct */

/* The contributions of every part of such a frame; both arrays are freed by the caller.
 *
 * contributions   part p has first[p] to first[p + 1] - 1
 * first           [parts + 1] */
skg_status skg_overrides_apply(const skg_recipe *recipe, const skg_frame *given,
                               skg_contribution **contributions, int64_t **first);

/* The matter of all parts in a frame: density over that of the material, and the share that is there. [parts] each */
skg_status skg_overrides_matter(const skg_recipe *recipe, const skg_frame *given, double *density,
                                double *fill);

/* --- Scattered photons of a frame */

/* Whether images of the job hold scattered photons. */
int skg_frame_scatters(const skg_job *job);

/* Densities of all parts in a frame, and behind them the shares that are there; NULL: those of the materials. The caller frees
 * them. */
skg_status skg_frame_matter(const skg_recipe *recipe, const skg_frame *frame, double **matter);

/* Refuses positions that are on the device alone, which are not known here. */
skg_status skg_frame_check_places(const skg_recipe *recipe, const skg_machine *machine);

/* Computes the scatter of the frame, waits for it, and enqueues what adds it to the intensities. image: where these are. */
skg_status skg_frame_add_scatter(skg_job *job, const skg_frame_work *work, const skg_image_place *image);

/* Computes the scatter of the frame as the output itself: the scatter, its standard error or a component, alone. */
skg_status skg_frame_show_scatter(skg_job *job, const skg_frame_work *work);

/* --- The detector's readout of a frame: intensities, their means and their variances */

/* Whether a frame shows what photons are expected, without noise, or how much noise varies. */
static inline int skg_frame_is_expected(const skg_recipe *recipe, const skg_frame_work *work) {
    return recipe->linear || work->kind == SKG_OUTPUT_MEAN || work->kind == SKG_OUTPUT_VARIANCE;
}

/* The factor of the weights of the model for a view: those of a ratio hold for any. */
double skg_frame_exposure(const skg_recipe *recipe, const skg_view *view);

/* How many layers the stage `attenuate` writes; expected intensities have none of noise. */
int32_t skg_frame_layers(const skg_job *job, const skg_frame_work *work);

/* Enqueues what the detector makes of intensities: blur, electronic noise, steps. layers: where these are. */
skg_status skg_frame_detect(skg_job *job, const skg_frame_work *work, const skg_image_place *layers);

/* Enqueues what the detector makes of the variances of intensities. mean: [channels][rows][columns] of the transmission, if
 * variances are those of its -ln; else NULL. */
skg_status skg_frame_detect_variance(skg_job *job, const skg_frame_work *work, const skg_image_place *layers,
                                     cl_mem mean);

/* Enqueues -ln of a finished mean. */
skg_status skg_frame_take_logarithm(skg_job *job, const skg_frame_work *work);

#endif
