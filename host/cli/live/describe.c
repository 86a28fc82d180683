/* The description of a scene for pages: facts that the command knows and the library does not. */
#include "live/describe.h"

#include "common/encode.h"
#include "live/slice.h"

#include <stdlib.h>
#include <string.h>

/* Of the radiograph of --fixed; null: there is none. */
static json_t *fixed_json(const register_image *fixed) {
    if (!fixed) return json_null();
    json_t *object = json_object();
    json_object_set_new(object, "path", cli_json_text(fixed->path));
    json_object_set_new(object, "projection",
                        fixed->projection < 0 ? json_null() : json_integer(fixed->projection));
    return object;
}

static json_t *reason_json(const char *reason) {
    return reason ? json_string(reason) : json_null();
}

/* Why switches of a slice change nothing; null: they do. */
static json_t *without_json(const live_scene *scene) {
    json_t *object = json_object();
    json_object_set_new(object, "spectrum", reason_json(live_slice_without_spectrum(scene)));
    json_object_set_new(object, "motion", reason_json(live_slice_without_motion(scene)));
    return object;
}

/* The text of an object, which is released; the caller frees it. */
static char *text_of(json_t *object) {
    char *text = json_dumps(object, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(object);
    return text;
}

skg_live_letter *live_describe_scene(const live_base *base, live_scene *scene, const live_wish *wish,
                                     int64_t geometry) {
    skg_live_letter *letter = NULL;
    const size_t count = json_array_size(base->warnings);
    const char **warnings = calloc(count + 1, sizeof *warnings);
    char *dose = scene->dose ? text_of(json_incref(scene->dose)) : NULL,
         *fixed = text_of(fixed_json(base->fixed)), *without = text_of(without_json(scene));
    skg_live_facts facts;
    skg_live_facts_init(&facts);
    if (skg_setup_text_get(scene->setup, &facts.document) != SKG_OK) facts.document = NULL;
    for (size_t i = 0; warnings && i < count; i++)
        warnings[i] = json_string_value(json_array_get(base->warnings, i));
    facts.warnings = warnings;
    facts.warning_count = warnings ? (int64_t)count : 0;
    facts.path = base->path;
    facts.geometry = geometry;
    facts.load_ms = scene->load_ms;
    facts.dose = dose, facts.fixed = fixed, facts.without = without;
    (void)skg_live_scene_write(scene->plans, &scene->subject, wish->message, &facts, &letter);
    free(warnings);
    free(dose);
    free(fixed);
    free(without);
    return letter;
}

/* Adds bytes to a sum by which scenes are told apart (FNV-1a). */
static uint64_t mix(uint64_t sum, const void *bytes, size_t size) {
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < size; i++) sum = (sum ^ byte[i]) * 1099511628211u;
    return sum;
}

int64_t live_geometry_of(const live_scene *scene) {
    uint64_t sum = 14695981039346656037u;
    for (int64_t i = 0; i < scene->parts; i++) {
        skg_part part;
        skg_mesh_health health;
        skg_part_init(&part);
        skg_mesh_health_init(&health);
        if (skg_scene_part_get(scene->session.scene, i, &part) != SKG_OK ||
            skg_mesh_health_get(part.mesh, &health) != SKG_OK)
            continue;
        sum = mix(sum, part.label, strlen(part.label));
        sum = mix(sum, part.pose, sizeof part.pose);
        sum = mix(sum, health.bounds, sizeof health.bounds);
        sum = mix(sum, &health.triangles, sizeof health.triangles);
    }
    return (int64_t)(sum >> 12); /* which a number of JavaScript holds exactly */
}
