/* Measures what each dial of a page would change of the image, and in what time. */
#include "live/ask.h"

#include "common/encode.h"
#include "common/progress.h"
#include "live/frame.h"

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

/* The image of a scene, and the time of the fastest of some. The caller frees the values. */
static float *render(const live_base *base, live_scene *scene, const live_wish *wish, live_hub *hub,
                     double *ms, char *sentence) {
    int dropped = 0, is_outside;
    skg_view view;
    skg_output output;
    *ms = HUGE_VAL;
    skg_output_init(&output);
    output.data = scene->values;
    if (!live_frame_pose(scene, wish, sentence) || !live_scene_view(base, scene, wish, &view, sentence))
        return NULL;
    for (int run = 0; run <= RUNS; run++) { /* the first warms up */
        const double start = cli_now_ms();
        if (live_hub_has_news(hub)) return NULL;
        if (!live_frame_render(scene, wish, scene->plan, &view, NULL, &output, 1, &dropped, &is_outside,
                               sentence))
            return NULL;
        const double took = cli_now_ms() - start;
        if (run > 0 && took < *ms) *ms = took;
        if (run > 0 && took > 1000) break;
    }
    float *values = scene->values;
    scene->values = NULL;
    return values;
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

void live_measure(const live_base *base, const live_scene *scene, const live_wish *wish, live_hub *hub) {
    const int64_t pixels = scene->session.view.columns * scene->session.view.rows;
    float *reference = NULL;
    for (int dial = 0; dial < DIALS && !live_hub_has_news(hub); dial++) {
        live_wish other = live_wish_copy(wish);
        live_scene with = {0};
        char sentence[LIVE_SENTENCE] = "";
        double ms = (double)NAN, error = (double)NAN;
        const int is_asked = !dials[dial].only_present || has_key(scene, dials[dial].key);
        other.quantity = SKG_QUANTITY_ATTENUATION;
        if (dials[dial].key)
            json_object_set_new(other.settings, dials[dial].key,
                                json_loads(dials[dial].value, JSON_DECODE_ANY, NULL));
        float *values = is_asked && live_scene_make(base, &other, &with, sentence)
                            ? render(base, &with, &other, hub, &ms, sentence)
                            : NULL;
        if (dial == 0)
            reference = values;
        else if (values && reference)
            error = difference(values, reference, pixels);
        if (is_asked && (values || *sentence)) tell(hub, dial, ms, error, sentence);
        if (values != reference) free(values);
        live_scene_free(&with);
        live_wish_free(&other);
    }
    free(reference);
    live_hub_tell(hub, "{\"measured\": null}");
}
