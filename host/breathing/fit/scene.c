/* Writes the fitted parameters into the scene. */
#include "scene/scene.h"
#include "body/links.h"
#include "core/text.h"
#include "fit/types.h"
#include "setup/save.h"
#include "json/json.h"

#include <jansson.h>

#include <stdio.h>
#include <string.h>

/* The member of an object whose name is this one as keys are compared; its own name is stored in *name. */
static json_t *member(json_t *object, const char **name) {
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value) if (skg_json_same_key(key, *name)) {
        *name = key;
        return value;
    }
    return NULL;
}

/* Sets a member, under the name that it has already. The value is released in any case. */
static int set(json_t *object, const char *name, json_t *value) {
    const char *known = name;
    char copy[256];
    member(object, &known);
    snprintf(copy, sizeof copy, "%s", known); /* the key lives in the object that is changed */
    return json_object_set_new(object, copy, value) == 0;
}

/* The object with this name; made if there is none. */
static json_t *object_in(json_t *object, const char *name) {
    json_t *there = member(object, &name);
    if (json_is_object(there)) return there;
    return set(object, name, json_object()) ? member(object, &name) : NULL;
}

static json_t *numbers(int count, const double *values, const char *unit) {
    json_t *array = json_array();
    for (int k = 0; k < count; k++) json_array_append_new(array, json_real(values[k]));
    if (unit) json_array_append_new(array, json_string(unit));
    return array;
}

/* The part whose organ is found by a word, as the body does. */
static const char *label_of(const skg_fit *fit, const skg_fit_body *model, const char *word) {
    const int32_t organ = skg_find_organ(model->body, word);
    for (int64_t p = 0; p < model->parts; p++)
        if (organ >= 0 && model->organ[p] == organ) return fit->setup->scene->parts[p].label;
    return NULL;
}

static int any(const skg_fit *fit, int first, int count) {
    int one = 0;
    for (int p = first; p < first + count; p++) one |= fit->chosen[p];
    return one;
}

static int set_tissue(const skg_fit *fit, json_t *breathing, const char *label, const double *values) {
    json_t *organs = label ? object_in(breathing, "Organs") : NULL;
    json_t *organ = organs ? object_in(organs, label) : NULL;
    (void)fit;
    return !label || (organ && set(organ, "Tissue", numbers(3, values, NULL)));
}

/* A key is written if one of its numbers was fitted. */
static int set_anatomy(const skg_fit *fit, json_t *breathing, const double *values) {
    static const struct {
        const char *key, *unit;
        int first, count;
    } keys[] = {{"Domes", "mm", BODY_DOMES, 3}, {"RibAngles", NULL, BODY_RIB_ANGLE, 2}};
    static const struct {
        const char *key;
        int parameter;
    } fractions[] = {{"MuscleLength", BODY_MUSCLE}, {"LiverFollows", BODY_FOLLOWS}, {"LiverHeld", BODY_HELD}};
    int done = 1;
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        if (any(fit, keys[k].first, keys[k].count))
            done = done &&
                   set(breathing, keys[k].key, numbers(keys[k].count, values + keys[k].first, keys[k].unit));
    for (size_t f = 0; f < sizeof fractions / sizeof *fractions; f++)
        if (fit->chosen[fractions[f].parameter])
            done = done && set(breathing, fractions[f].key, json_real(values[fractions[f].parameter]));
    return done;
}

static int set_parameters(const skg_fit *fit, json_t *scene) {
    double values[BODY_PARAMETERS], plane[4];
    json_t *breathing = object_in(scene, "Breathing");
    int done = breathing != NULL;
    skg_fit_values_at(fit, fit->search.best, values);
    skg_fit_plane(fit->bounds, values, plane);
    done = done && set(breathing, "Comment", json_string("fitted by skiagraph fit"));
    done = done && set(breathing, "Coupling",
                       json_string(fit->coupling == SKG_COUPLING_PAPER ? "Paper" : "Anatomical"));
    done = done && set_anatomy(fit, breathing, values);
    if (any(fit, BODY_TENDON, 3))
        done = done && set(breathing, "Tendon", numbers(3, values + BODY_TENDON, "mm"));
    if (any(fit, BODY_AZIMUTH, 3)) done = done && set(breathing, "TendonPlane", numbers(4, plane, NULL));
    if (any(fit, BODY_DIAPHRAGM, 3))
        done = done &&
               set_tissue(fit, breathing, label_of(fit, fit->models, "diaphragm"), values + BODY_DIAPHRAGM);
    if (any(fit, BODY_LIVER, 3))
        done = done && set_tissue(fit, breathing, label_of(fit, fit->models, "liver"), values + BODY_LIVER);
    if (fit->chosen[BODY_RIBS])
        done = done && set(breathing, "DiaphragmRibs", numbers(1, values + BODY_RIBS, "mm"));
    if (fit->chosen[BODY_REACH])
        done = done && set(breathing, "DiaphragmLiver", numbers(1, values + BODY_REACH, "mm"));
    return done;
}

skg_status skg_fit_scene_save(const skg_fit *fit, const char *path) {
    SKG_PLAIN;
    SKG_NEEDS(fit);
    SKG_NEEDS(path);
    if (!fit->began) return skg_fail(SKG_ERR_ARGUMENT, "fit: nothing is fitted yet; call skg_fit_step first");
    json_t *scene = json_loads(fit->setup->text, 0, NULL);
    skg_status status;
    if (scene && set_parameters(fit, scene)) {
        skg_setup_rename_files(fit->setup, path, scene);
        status = skg_setup_write_text(scene, path);
    } else {
        status = skg_fail(SKG_ERR_MEMORY, "%s: no memory for its text", path);
    }
    json_decref(scene);
    return status;
}
