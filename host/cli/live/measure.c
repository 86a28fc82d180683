/* Measures what each dial of a page would change of the image, and in what time. */
#include "live/ask.h"

#include "common/encode.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* The dials: what each switch would be instead. */
static const struct {
    const char *name, *key, *value;
    int only_present; /* 1: only where the scene has the key */
} dials[] = {
    {"as it is", NULL, NULL, 0},
    {"every energy", "Tolerance", "0", 1},
    {"fewer energies", "Tolerance", "0.01", 0},
    {"double precision", "Precision", "\"double\"", 0},
    {"2 x 2 rays a pixel", "Detector.Oversampling", "2", 0},
    {"1 ray a pixel", "Detector.Oversampling", "1", 1},
    {"a point as source", "Source.Shape", "\"PointSource\"", 1},
    {"no noise", "Noise", "false", 1},
    {"no scatter", "Scatter", "false", 1},
};
enum { DIALS = sizeof dials / sizeof *dials, RUNS = 5 };

/* Whether the scene's file has a key of the top, or of one of its objects. */
static int has_key(const live_scene *scene, const char *path) {
    const char *text = NULL, *dot = strchr(path, '.'), *key;
    json_t *value, *document = NULL;
    char name[64];
    int has = 0;
    if (skg_setup_text_get(scene->setup, &text) == SKG_OK) document = json_loads(text, 0, NULL);
    snprintf(name, sizeof name, "%.*s", dot ? (int)(dot - path) : (int)strlen(path), path);
    json_object_foreach(document, key, value) {
        const char *inner;
        json_t *its;
        if (strcmp(key, name) != 0) continue;
        if (!dot) has = !json_is_false(value);
        json_object_foreach(value, inner, its) if (dot && strcmp(inner, dot + 1) == 0) has = 1;
    }
    json_decref(document);
    return has;
}

/* The image of a scene, which lives as long as the scene, and the time of the fastest of some. */
static const float *render(live_scene *scene, live_hub *hub, double *ms, char *sentence) {
    skg_live_frame frame;
    *ms = HUGE_VAL;
    skg_live_frame_init(&frame);
    for (int run = 0; run <= RUNS; run++) { /* the first warms up */
        if (live_hub_has(hub, SKG_LIVE_ASKED_WISH)) return NULL;
        if (skg_live_frame_make(scene->plans, &scene->subject, scene->wish.message, NULL, &frame) != SKG_OK)
            return live_fail(sentence), NULL;
        if (run > 0 && frame.ms < *ms) *ms = frame.ms;
        if (run > 0 && frame.ms > 1000) break;
    }
    return frame.values;
}

/* The wish with a dial as it would be instead. Returns 0 with a sentence. */
static int turn(int dial, live_wish *wish, char *sentence) {
    const char *text = NULL;
    if (skg_live_message_text_get(wish->message, &text) != SKG_OK) return live_fail(sentence);
    json_t *state = json_loads(text, 0, NULL), *settings = json_incref(json_object_get(state, "settings"));
    json_decref(state);
    if (dials[dial].key)
        json_object_set_new(settings, dials[dial].key, json_loads(dials[dial].value, JSON_DECODE_ANY, NULL));
    return live_wish_change(
        wish, json_pack("{s:o, s:s, s:b}", "settings", settings, "quantity", "attenuation", "drag", 0),
        sentence);
}

/* The root mean square of the difference of two attenuations, where both are finite. */
static double difference(const float *a, const float *b, int64_t count) {
    double sum = 0;
    int64_t finite = 0;
    for (int64_t i = 0; i < count; i++)
        if (isfinite(a[i]) && isfinite(b[i])) {
            const double by = exp(-(double)a[i]) - exp(-(double)b[i]);
            sum += by * by;
            finite++;
        }
    return finite ? sqrt(sum / (double)finite) : (double)NAN;
}

static void tell(live_hub *hub, int dial, double ms, double error, const char *sentence) {
    json_t *object = json_object();
    json_object_set_new(object, "measured", json_string(dials[dial].name));
    json_object_set_new(object, "key", dials[dial].key ? json_string(dials[dial].key) : json_null());
    json_object_set_new(object, "value",
                        dials[dial].value ? json_loads(dials[dial].value, JSON_DECODE_ANY, NULL)
                                          : json_null());
    json_object_set_new(object, "ms", cli_json_number(isfinite(ms) ? ms : (double)NAN));
    json_object_set_new(object, "error", cli_json_number(error));
    json_object_set_new(object, "sentence", *sentence ? cli_json_text(sentence) : json_null());
    json_object_set_new(object, "when", json_integer((json_int_t)time(NULL)));
    live_hub_tell_json(hub, object);
}

/* Measures a dial. values: result, which the caller frees; NULL: it was not measured */
static double measure(const live_base *base, int dial, const live_wish *wish, live_hub *hub, float **values,
                      char *sentence) {
    live_wish other = live_wish_copy(wish);
    live_scene with = {0};
    double ms = (double)NAN;
    *values = NULL;
    if (turn(dial, &other, sentence) && live_scene_make(base, &other, &with, sentence)) {
        const float *image = render(&with, hub, &ms, sentence);
        const size_t size = (size_t)(with.view.columns * with.view.rows) * sizeof **values;
        *values = image ? malloc(size) : NULL;
        if (*values) memcpy(*values, image, size);
    }
    live_scene_free(&with);
    live_wish_free(&other);
    return ms;
}

void live_measure(const live_base *base, const live_scene *scene, const live_wish *wish, live_hub *hub) {
    const int64_t pixels = scene->session.view.columns * scene->session.view.rows;
    float *reference = NULL;
    for (int dial = 0; dial < DIALS && !live_hub_has(hub, SKG_LIVE_ASKED_WISH); dial++) {
        char sentence[LIVE_SENTENCE] = "";
        double error = (double)NAN;
        float *values = NULL;
        if (dials[dial].only_present && !has_key(scene, dials[dial].key)) continue;
        const double ms = measure(base, dial, wish, hub, &values, sentence);
        if (values && reference) error = difference(values, reference, pixels);
        if (values || *sentence) tell(hub, dial, ms, error, sentence);
        if (dial == 0)
            reference = values;
        else
            free(values);
    }
    free(reference);
    live_hub_tell_json(hub, json_pack("{s:n}", "measured"));
}
