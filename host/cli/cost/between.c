/* Measures linear values between the cells of the scene's volumes: their change of the image, and their price. */
#include "cost/measuring.h"
#include "cost/output.h"

#include "common/encode.h"
#include "common/say.h"

#include <stdio.h>
#include <stdlib.h>

static const char *const ways[2] = {"cells", "linear"};

/* The settings with which all volumes have such values. Returns how many there are; negative: out of memory. */
static int64_t list_settings(const skg_scene *scene, const char *way, char ***settings) {
    int64_t parts = 0, count = 0;
    if (skg_scene_part_count(scene, &parts) != SKG_OK) return 0;
    *settings = calloc((size_t)parts + 1, sizeof **settings);
    for (int64_t i = 0; *settings && i < parts; i++) {
        skg_part part;
        skg_part_init(&part);
        if (skg_scene_part_get(scene, i, &part) != SKG_OK || !part.volume) continue;
        char *text = cost_part_setting(&part, i, "Interpolation=\"%s\"", way);
        if (!text) return -1;
        (*settings)[count++] = text;
    }
    return *settings ? count : -1;
}

/* The image of the scene with such values, and its price. */
static skg_status shoot(cost_study *study, const char *const *settings, int64_t count, double *batch,
                        double *image, cost_shot *shot) {
    skg_setup *setup = NULL;
    skg_scene *scene = NULL;
    skg_status status = cost_load(study, count, settings, &setup);
    if (status == SKG_OK) status = skg_setup_scene_get(setup, &scene);
    if (status == SKG_OK) status = cost_shoot_scene(study, scene, batch, image, shot);
    skg_setup_release(&setup);
    return status;
}

/* Both images, and their prices. */
static skg_status shoot_both(cost_study *study, double *batch, double *images) {
    cost_between *between = &study->measured.between;
    skg_status status = SKG_OK;
    for (int k = 0; k < 2 && status == SKG_OK; k++) {
        char **settings = NULL;
        cost_shot *shot = calloc(1, sizeof *shot);
        const int64_t count = list_settings(study->session.scene, ways[k], &settings);
        status = shot && count >= 0 ? SKG_OK : SKG_ERR_MEMORY;
        if (status == SKG_OK)
            status =
                shoot(study, (const char *const *)settings, count, batch, images + k * study->pixels, shot);
        if (status == SKG_OK)
            between->ms[k] = shot->price_ms, between->uncertainty_ms[k] = shot->uncertainty_ms;
        for (int64_t i = 0; settings && settings[i]; i++) free(settings[i]);
        free(settings);
        free(shot);
    }
    return status;
}

int cost_measure_between(cost_study *study) {
    if (!study->subject.has_volume) return CLI_DONE;
    double *images = calloc((size_t)((2 + study->frames) * study->pixels), sizeof *images);
    if (!images) return cli_error(CLI_DEVICE, "out of host memory for the images of volumes");
    const skg_status status = shoot_both(study, images + 2 * study->pixels, images);
    cost_coarse difference = {0};
    int exit_status = CLI_DONE;
    if (status == SKG_OK)
        exit_status = cost_compare_coarsely(study, images + study->pixels, images, &difference);
    else if (status == SKG_ERR_MEMORY)
        exit_status = cli_fail(status);
    else
        cost_note(study, "linear values between cells are not compared: %.300s", skg_last_error());
    study->measured.between.is_known = status == SKG_OK;
    study->measured.between.max = difference.max;
    study->measured.between.rms = difference.error;
    free(difference.difference);
    free(images);
    return exit_status;
}

json_t *cost_between_json(const cost_study *study) {
    const cost_between *between = &study->measured.between;
    if (!between->is_known) return json_null();
    json_t *object = json_object();
    json_object_set_new(object, "max_open", cli_json_number(between->max));
    json_object_set_new(object, "rms_open", cli_json_number(between->rms));
    for (int k = 0; k < 2; k++) {
        char key[32];
        snprintf(key, sizeof key, "%s_ms", ways[k]);
        json_object_set_new(object, key, cli_json_number(between->ms[k]));
    }
    return object;
}
