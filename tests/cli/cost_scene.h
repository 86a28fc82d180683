/* The scene whose costs are studied, and the page that shows them. */
#ifndef SKG_TESTS_COST_SCENE_H
#define SKG_TESTS_COST_SCENE_H

#include "cli/browser.h"

/* A tube, a box and a sphere in it: every dial but the source's. */
static const char small_scene[] =
    "{ \"Source\": { \"Position\": [0, -400, 0, \"mm\"], \"Shape\": \"PointSource\",\n"
    "    \"Beam\": {\"kVp\": 80, \"Filter\": [[\"Al\", 3, \"mm\"]]} },\n"
    "  \"Detector\": { \"Position\": [0, 100, 0, \"mm\"], \"UpVector\": [0, 0, -1],\n"
    "    \"NumberOfPixels\": [33, 25], \"Spacing\": [1, 2, \"mm\"] },\n"
    "  \"Samples\": [\n"
    "    {\"Label\": \"skin\", \"Cube\": [30.5, \"mm\"], \"Type\": \"outer\", \"Material\": [\"HU\", 20]},\n"
    "    {\"Label\": \"bone\", \"Sphere\": [16, 7, \"mm\"], \"Material\": [\"HU\", 900]} ] }\n";

static const char disc[] = "--set 'Source.Shape=[\"Disc\",2,\"mm\"]'";

static inline void set_up_scene(void) {
    set_up();
    write_text("small scene.json", small_scene);
}

static inline double number(json_t *object, const char *key) {
    json_t *value = member(object, key);
    ck_assert_msg(json_is_number(value), "%s is no number", key);
    return json_number_value(value);
}

static inline json_t *point_of(json_t *study, json_t *index) {
    json_t *point = json_array_get(member(study, "points"), (size_t)json_integer_value(index));
    ck_assert_ptr_nonnull(point);
    return point;
}

/* Settings of one dial; values: of `key`, in their order. */
static inline int list_dial(json_t *study, const char *dial, const char *key, double *values) {
    json_t *point;
    size_t index;
    int count = 0;
    json_array_foreach(member(study, "points"), index, point) {
        if (strcmp(json_string_value(member(point, "dial")), dial) != 0) continue;
        ck_assert_int_lt(count, 16);
        values[count++] = number(point, key);
    }
    return count;
}

#endif
