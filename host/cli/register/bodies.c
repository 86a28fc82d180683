/* Registers body after body. */
#include "register/work.h"

#include "common/encode.h"
#include "common/interrupt.h"
#include "common/progress.h"
#include "common/say.h"
#include "session/chosen.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Adds the parts of a body, or all of them if a geometry is searched and none is named. */
static int add_parts(register_work *work, const char *label, char *chosen) {
    memset(chosen, label ? 0 : 1, (size_t)work->part_count);
    int exit_status =
        label ? cli_mark_parts(work->session.scene, "--part", label, work->part_count, chosen) : CLI_DONE;
    for (int64_t p = 0; p < work->part_count && exit_status == CLI_DONE; p++) {
        if (!chosen[p]) continue;
        const skg_status status = skg_registration_part_add(work->last, p);
        if (status != SKG_OK) exit_status = cli_fail(status);
    }
    return exit_status;
}

static int add_images(register_work *work) {
    for (int64_t i = 0; i < work->image_count; i++) {
        skg_radiograph image;
        register_radiograph(&work->images[i], &image);
        const skg_status status = skg_registration_image_add(work->last, &image);
        if (status == SKG_ERR_ARGUMENT) return cli_fail(status), CLI_INPUT; /* of a file, not of a flag */
        if (status != SKG_OK) return cli_fail(status);
    }
    return CLI_DONE;
}

skg_status register_result_get(const skg_registration *registration, register_body *body) {
    const char *verdict = "";
    skg_registration_result_init(&body->result);
    skg_status status = skg_registration_result_get(registration, &body->result);
    if (status == SKG_OK) status = skg_registration_verdict_get(registration, &verdict);
    snprintf(body->verdict, sizeof body->verdict, "%s", verdict);
    body->directions = json_array();
    for (int64_t d = 0; d < body->result.directions && status == SKG_OK; d++) {
        skg_registration_direction one;
        skg_registration_direction_init(&one);
        status = skg_registration_direction_get(registration, d, &one);
        json_t *object = json_object();
        json_object_set_new(object, "name", cli_json_text(one.name));
        json_object_set_new(object, "sigma_mm", cli_json_number(one.sigma_mm));
        json_object_set_new(object, "sigma_structure_mm", cli_json_number(one.sigma_structure_mm));
        json_object_set_new(object, "determined", json_boolean(one.determined));
        json_array_append_new(body->directions, object);
    }
    return status;
}

/* Keeps what was found: results of this body, and poses from which the next one starts. */
static skg_status keep(register_work *work, register_body *body, const char *chosen) {
    skg_status status = register_result_get(work->last, body);
    if (work->options.free != SKG_REGISTRATION_FREE_POSE) return status;
    for (int64_t p = 0; p < work->part_count && status == SKG_OK; p++) {
        double pose[16], *motion = work->motions + 16 * p, product[16];
        if (!chosen[p]) continue;
        status = skg_registration_motion_get(work->last, pose);
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++) {
                product[4 * r + c] = 0;
                for (int k = 0; k < 4; k++) product[4 * r + c] += pose[4 * r + k] * motion[4 * k + c];
            }
        memcpy(motion, product, sizeof product);
        work->moved[p] = 1;
        if (status == SKG_OK) status = skg_registration_pose_get(work->last, p, pose);
        if (status == SKG_OK) status = skg_scene_part_pose_set(work->session.scene, p, pose);
    }
    return status;
}

/* The status of the run; a cancelled one has a result where the search had begun. */
static int run_one(register_work *work, register_body *body, const char *chosen) {
    cli_progress_follow("steps");
    skg_status status = skg_registration_run(work->last);
    cli_progress_end();
    if (status == SKG_ERR_ARGUMENT) return cli_fail(status), CLI_INPUT;
    work->is_stopped = status == SKG_ERR_CANCELLED && cli_stop_asked();
    if (status != SKG_OK && !work->is_stopped) return cli_fail(status);
    status = keep(work, body, chosen);
    if (status != SKG_OK && work->is_stopped)
        return cli_error(CLI_CHECK_FAILED, "stopped before the search had begun");
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int register_one(register_work *work, const char *label, char *chosen) {
    register_body *body = &work->bodies[work->body_count];
    const cli_session *s = &work->session;
    skg_registration_release(&work->last);
    body->label = label ? label : "all parts";
    skg_status status =
        skg_registration_create(s->context, s->scene, s->spectrum, &s->options, &work->options, &work->last);
    if (status != SKG_OK) return cli_fail(status);
    int exit_status = add_parts(work, label, chosen);
    if (exit_status == CLI_DONE) exit_status = add_images(work);
    if (exit_status == CLI_DONE) exit_status = run_one(work, body, chosen);
    if (exit_status == CLI_DONE) work->body_count++;
    memset(work->options.start, 0, sizeof work->options.start); /* of the first body only */
    return exit_status;
}

static int reserve(register_work *work, size_t bodies) {
    const skg_status status = skg_scene_part_count(work->session.scene, &work->part_count);
    if (status != SKG_OK) return cli_fail(status);
    work->bodies = calloc(bodies, sizeof *work->bodies);
    work->motions = calloc((size_t)work->part_count * 16, sizeof *work->motions);
    work->moved = calloc((size_t)work->part_count, 1);
    if (!work->bodies || !work->motions || !work->moved) return cli_error(CLI_DEVICE, "out of host memory");
    for (int64_t k = 0; k < work->part_count * 16; k++) work->motions[k] = k % 16 % 5 == 0;
    return CLI_DONE;
}

int register_run(register_work *work) {
    const char *label;
    int count = 0;
    while (cli_nth_value(work->arguments, "--part", count)) count++;
    if (count == 0 && work->options.free == SKG_REGISTRATION_FREE_POSE)
        return cli_error(CLI_USAGE, "register: say which part moves: --part LABEL");
    if (count > 1 && work->options.free != SKG_REGISTRATION_FREE_POSE)
        return cli_error(CLI_USAGE, "--part is given %d times; a geometry is found once, from one body",
                         count);
    int exit_status = reserve(work, (size_t)count + 1);
    char *chosen = exit_status == CLI_DONE ? calloc((size_t)work->part_count + 1, 1) : NULL;
    if (exit_status == CLI_DONE && !chosen) exit_status = cli_error(CLI_DEVICE, "out of host memory");
    cli_keep("the best pose so far is written");
    cli_stop_gently();
    for (int i = 0; exit_status == CLI_DONE && i < (count > 0 ? count : 1) && !work->is_stopped; i++) {
        label = cli_nth_value(work->arguments, "--part", i);
        exit_status = register_one(work, label, chosen);
    }
    free(chosen);
    return exit_status;
}
