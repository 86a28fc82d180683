/* A scene that breathes with another relaxation or hysteresis, at the phases of a breath. */
#include "cost/measuring.h"

#include "common/progress.h"
#include "common/say.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct {
    cost_study *study;
    skg_setup *setup;
    skg_scene *scene;
    skg_motion *motion;
    skg_plan *plan;
    skg_output output;
    int64_t phase;
} breath;

static skg_status begin(breath *b, const cost_setting *setting) {
    char hysteresis[64], relaxation[64];
    /* Phases have no events, and an event with Weight excludes hysteresis. Both models belong to the paper's coupling, which
     * they would choose by themselves where they are not 0. */
    const char *const settings[] = {"Breathing.Events=[]", "Breathing.Coupling=Paper", hysteresis,
                                    relaxation};
    snprintf(hysteresis, sizeof hysteresis, "Breathing.Hysteresis=%.17g", setting->hysteresis);
    snprintf(relaxation, sizeof relaxation, "Breathing.Relaxation=%d", (int)setting->relaxation);
    skg_status status = cost_load(b->study, 4, settings, &b->setup);
    if (status == SKG_OK) status = skg_setup_scene_get(b->setup, &b->scene);
    if (status == SKG_OK) status = skg_motion_create(NULL, b->setup, &b->motion);
    if (status == SKG_OK) status = cost_plan(b->study, setting, b->scene, &b->plan);
    skg_output_init(&b->output);
    b->output.type = cost_type(setting->precision);
    return status;
}

static void end(breath *b) {
    skg_plan_release(&b->plan);
    skg_motion_release(&b->motion);
    skg_setup_release(&b->setup);
}

/* The pose and the image of the next phase. */
static skg_status run(void *user) {
    breath *b = user;
    skg_frame frame;
    skg_job *job = NULL;
    skg_frame_init(&frame);
    skg_status status = skg_motion_pose_at_phase(b->motion, (double)b->phase / COST_PHASES);
    if (status == SKG_OK) status = skg_motion_fill(b->motion, &frame);
    if (status == SKG_OK) status = skg_plan_submit(b->plan, 1, &frame, 1, &b->output, &job);
    if (!SKG_FAILED(status)) status = skg_job_wait(&job);
    b->phase = (b->phase + 1) % COST_PHASES;
    return status;
}

/* Positions of the vertices of the parts that move, [count][3]. positions NULL: only counts them. */
static skg_status read_positions(const breath *b, double *positions, int64_t *count) {
    int64_t parts = 0, vertices, triangles;
    skg_status status = skg_scene_part_count(b->scene, &parts);
    *count = 0;
    for (int64_t i = 0; i < parts && status == SKG_OK; i++) {
        int32_t moves = 0;
        skg_part part;
        skg_part_init(&part);
        status = skg_scene_part_get(b->scene, i, &part);
        if (status == SKG_OK) status = skg_motion_part_moves(b->motion, i, &moves);
        if (status != SKG_OK || !moves) continue;
        status = skg_mesh_count(part.mesh, &vertices, &triangles);
        if (status == SKG_OK && positions)
            status = skg_mesh_positions_get(part.mesh, positions + 3 * *count, 3);
        *count += vertices;
    }
    return status;
}

static skg_status run_all(breath *b, double *images, double *positions, int64_t vertices) {
    skg_status status = SKG_OK;
    b->phase = 0;
    for (int64_t k = 0; k < COST_PHASES && !SKG_FAILED(status); k++) {
        b->output.data = images + k * b->study->pixels;
        status = run(b);
        cost_widen(b->output.type, b->study->pixels, b->output.data);
        if (!SKG_FAILED(status)) status = read_positions(b, positions + 3 * vertices * k, &vertices);
    }
    return status;
}

static void compare_positions(const double *positions, const double *reference, int64_t vertices,
                              cost_point *point) {
    double worst = 0, squares = 0;
    for (int64_t i = 0; i < vertices; i++) {
        const double *a = positions + 3 * i, *b = reference + 3 * i;
        const double square =
            (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
        worst = fmax(worst, square);
        squares += square;
    }
    point->max_mm = sqrt(worst);
    point->rms_mm = vertices ? sqrt(squares / (double)vertices) : 0;
}

skg_status cost_breathe(cost_study *study, const cost_setting *setting, cost_point *point, int *exit_status) {
    cost_reference *reference = &study->measured.references[COST_OF_BREATH];
    breath b = {.study = study};
    double *images = NULL, *positions = NULL, start = cli_now_ms();
    int64_t vertices = 0;
    *exit_status = CLI_DONE;
    skg_status status = begin(&b, setting);
    cost_shot shot = {.plan_ms = cli_now_ms() - start, .setting = *setting, .frames = 1};
    if (!SKG_FAILED(status)) status = read_positions(&b, NULL, &vertices);
    if (!SKG_FAILED(status) && point && vertices != reference->vertices) {
        *exit_status =
            cli_error(CLI_INPUT, "%s: its mesh files changed during the measurement", study->session.path);
        status = SKG_ERR_MESH;
    } else if (!SKG_FAILED(status)) {
        images = calloc((size_t)(COST_PHASES * study->pixels), sizeof *images);
        positions = calloc((size_t)(COST_PHASES * 3 * vertices) + 1, sizeof *positions);
        status = images && positions ? run_all(&b, images, positions, vertices) : SKG_ERR_MEMORY;
    }
    if (!SKG_FAILED(status) && !point) {
        reference->image = images;
        reference->positions = positions;
        reference->vertices = vertices;
        images = positions = NULL;
    } else if (!SKG_FAILED(status)) {
        *exit_status = cost_compare(study, COST_PHASES, images, reference->image, point);
        compare_positions(positions, reference->positions, COST_PHASES * vertices, point);
        b.output.data = images;
        status = cost_add_shot(study, b.plan, run, &b, &shot, &point->shot);
    }
    end(&b);
    free(images);
    free(positions);
    return SKG_FAILED(status) ? status : SKG_OK;
}
