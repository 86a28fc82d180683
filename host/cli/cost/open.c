/* Opens the scene of a study, and its end. */
#include "cost/clock.h"
#include "cost/dials.h"
#include "cost/measuring.h"

#include "common/say.h"

#include <stdlib.h>

enum { THUMB = 320 };

static int has_volume(const skg_scene *scene) {
    int64_t parts = 0;
    if (skg_scene_part_count(scene, &parts) != SKG_OK) return 0;
    for (int64_t i = 0; i < parts; i++) {
        skg_part part;
        skg_part_init(&part);
        if (skg_scene_part_get(scene, i, &part) == SKG_OK && part.volume) return 1;
    }
    return 0;
}

/* Finds the facts that the plan of the scene reports: leaky meshes, samples of the source, the flat field. */
static int look_at_scene(cost_study *study) {
    const skg_plan_options *options = &study->session.options;
    skg_plan *plan = NULL;
    skg_plan_report report;
    skg_channel channel;
    skg_plan_report_init(&report);
    skg_channel_init(&channel);
    skg_status status = skg_plan_create(study->session.context, study->session.scene, &study->session.view,
                                        study->session.spectrum, options, &plan);
    if (status == SKG_OK) status = skg_plan_report_get(plan, &report);
    if (status == SKG_OK) status = skg_plan_channel_get(plan, 0, &channel);
    study->subject.flat_field = channel.flat_field;
    study->subject.has_leaky = report.leaky_parts > 0;
    study->subject.has_shells = options->unite != 0;
    study->subject.has_volume = has_volume(study->session.scene);
    study->subject.triangles = report.triangles;
    study->subject.has_spot = options->spot && options->spot->shape != SKG_SPOT_POINT &&
                              options->spot->grid == 0 &&
                              study->session.view.projection == SKG_PROJECTION_POINT;
    study->subject.own = (cost_setting){.precision = options->precision,
                                        .supersampling = options->supersampling,
                                        .tolerance = options->tolerance,
                                        .repair = -1,
                                        .meshing = -1,
                                        .relaxation = -1,
                                        .hysteresis = -1};
    if (study->subject.has_spot)
        study->subject.own.samples =
            report.samples / ((int64_t)options->supersampling * options->supersampling);
    if (status == SKG_OK) cost_predict_scatter(study, plan);
    skg_plan_release(&plan);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* Whether the beam is a tube, whose bins can be set, and whether the scene's bins are wider than they need
 * be. */
static int look_at_beam(cost_study *study) {
    int64_t own = 0, finest = 0;
    skg_spectrum *spectrum = NULL;
    skg_status status = skg_spectrum_bin_count(study->session.spectrum, &own);
    if (status != SKG_OK) return cli_fail(status);
    study->subject.has_tube = cost_spectrum(study, COST_FINEST_BINS, &spectrum) == SKG_OK;
    if (study->subject.has_tube) status = skg_spectrum_bin_count(spectrum, &finest);
    study->subject.has_energies = own > 1 || finest > 1;
    study->subject.finest = finest > own ? COST_FINEST_BINS : 0;
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int look_at_breath(cost_study *study) {
    int32_t breathes = 0;
    skg_body_options_init(&study->subject.body);
    skg_status status = skg_setup_body_options_get(study->session.setup, &breathes, &study->subject.body);
    study->subject.has_breath = breathes;
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

int cost_open(cost_study *study) {
    int exit_status = cli_open_session(study->arguments, 0, &study->session);
    if (exit_status == CLI_DONE) exit_status = cli_refuse_counting(&study->session, "cost");
    cost_choose_clock(study);
    study->subject.own_scatter = study->session.options.scatter;
    study->session.options.scatter = NULL; /* its noise would hide the errors of the primary */
    if (exit_status == CLI_DONE) exit_status = look_at_scene(study);
    if (exit_status == CLI_DONE) exit_status = look_at_beam(study);
    if (exit_status == CLI_DONE) exit_status = look_at_breath(study);
    const skg_view *view = &study->session.view;
    int64_t side = view->columns > view->rows ? view->columns : view->rows;
    if (study->session.context) /* the scene's warnings have been printed */
        skg_context_log_set(study->session.context, NULL, NULL);
    study->pixels = view->columns * view->rows;
    study->thumb_block = (side + THUMB - 1) / THUMB > 1 ? (side + THUMB - 1) / THUMB : 1;
    study->thumb_columns = (view->columns + study->thumb_block - 1) / study->thumb_block;
    study->thumb_rows = (view->rows + study->thumb_block - 1) / study->thumb_block;
    return exit_status;
}

void cost_close(cost_study *study) {
    for (int i = 0; i < COST_REFERENCES; i++) {
        free(study->measured.references[i].image);
        free(study->measured.references[i].positions);
    }
    for (int i = 0; i < study->spectrum_count; i++) skg_spectrum_release(&study->spectra[i].spectrum);
    for (int i = 0; i < study->meshing_count; i++) cost_meshing_free(&study->meshings[i]);
    for (int i = 0; i < study->measured.count; i++) free(study->measured.points[i].difference);
    for (int i = 0; i < study->measured.shot_count; i++) {
        skg_plan_release(&study->measured.shots[i].plan);
        free(study->measured.shots[i].difference);
        free(study->measured.shots[i].small);
        free(study->measured.shots[i].command);
    }
    for (int i = 0; i < COST_SOURCES; i++) {
        free(study->judged.sources[i].command);
        free(study->measured.coarse[i].difference);
    }
    free(study->measured.sensitivity.parts);
    free(study->batch);
    free(study->measured.pulse_ms);
    for (int i = 0; i < COST_TOLERANCES; i++) {
        free(study->judged.advice[i].rays_command);
        free(study->judged.advice[i].whole_command);
    }
    cli_close_session(&study->session);
}
