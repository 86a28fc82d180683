/* The scene as the last wish has it, ready for frames. */
#include "live/scene.h"

#include "common/progress.h"
#include "core/maths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Keys that frames can follow without another plan: they move source and detector. */
static const char *const moving[] = {"Source.Position",      "Detector.Position",   "Detector.UpVector",
                                     "Detector.RightVector", "Detector.ColumnStep", "Detector.RowStep"};
enum { MOVING = sizeof moving / sizeof *moving };

/* Photons of the first image with scatter; each further step has four times as many. */
static const int64_t FIRST_HISTORIES = 16384;

/* s: scatter that takes longer is shown step by step. */
static const double LONG_S = 0.25;

static int fail(char *sentence) {
    snprintf(sentence, LIVE_SENTENCE, "%s", skg_last_error());
    return 0;
}

static int is_moving(const char *key) {
    for (int i = 0; i < MOVING; i++)
        if (strcasecmp(key, moving[i]) == 0) return 1;
    return 0;
}

/* Keys of the samples, and of what needs them. */
static int is_of_samples(const char *key) {
    return strncasecmp(key, "Samples", 7) == 0 || strncasecmp(key, "SceneGraph", 10) == 0 ||
           strncasecmp(key, "Breathing", 9) == 0;
}

/* ["KEY=VALUE"] of a wish, which the caller frees by free_settings. without: keys that are left out; may be NULL. */
static char **list_settings(json_t *settings, int (*without)(const char *key), int64_t *count) {
    char **list = calloc(json_object_size(settings) + 1, sizeof *list);
    const char *key;
    json_t *value;
    *count = 0;
    if (!list) return NULL;
    json_object_foreach(settings, key, value) {
        if (without && without(key)) continue;
        char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(17));
        const size_t size = strlen(key) + (text ? strlen(text) : 0) + 2;
        list[*count] = text ? malloc(size) : NULL;
        if (list[*count]) snprintf(list[(*count)++], size, "%s=%s", key, text);
        free(text);
    }
    return list;
}

static void free_settings(char **list, int64_t count) {
    for (int64_t i = 0; list && i < count; i++) free(list[i]);
    free(list);
}

/* The settings without those that frames follow. */
static json_t *fixed_settings(const json_t *settings) {
    json_t *fixed = json_deep_copy(settings);
    const char *key;
    json_t *value;
    void *next;
    json_object_foreach_safe(fixed, next, key, value) if (is_moving(key)) json_object_del(fixed, key);
    return fixed;
}

/* Source, detector and scan alone, without the files of meshes. */
static int read_light(const live_base *base, const live_wish *wish, skg_setup **setup, char *sentence) {
    skg_setup_source source;
    json_t *document = json_loads(base->text, 0, NULL);
    const char *key;
    json_t *value;
    void *next;
    json_object_foreach_safe(document, next, key, value) if (is_of_samples(key))
        json_object_del(document, key);
    char *text = json_dumps(document, JSON_REAL_PRECISION(17));
    skg_setup_source_init(&source);
    char **settings = list_settings(wish->settings, is_of_samples, &source.setting_count);
    source.text = text;
    source.path = base->path;
    source.settings = (const char *const *)settings;
    source.partial = 1;
    source.lenient = cli_given(base->arguments, "--lenient");
    const skg_status status = text && settings ? skg_setup_create(NULL, &source, setup) : SKG_ERR_MEMORY;
    free_settings(settings, source.setting_count);
    free(text);
    json_decref(document);
    return status == SKG_OK ? 1 : fail(sentence);
}

static int has_moved(const live_scene *scene, const live_wish *wish) {
    for (int i = 0; i < MOVING; i++) {
        json_t *was = json_object_get(scene->settings, moving[i]),
               *is = json_object_get(wish->settings, moving[i]);
        if (was != is && !(was && is && json_equal(was, is))) return 1;
    }
    return 0;
}

int live_scene_view(const live_base *base, const live_scene *scene, const live_wish *wish, skg_view *view,
                    char *sentence) {
    skg_setup *setup = NULL;
    skg_scan *scan = NULL;
    skg_status status = SKG_OK;
    *view = scene->session.view;
    if (wish->projection >= scene->projections) {
        snprintf(sentence, LIVE_SENTENCE, "the scene has no projection %lld", (long long)wish->projection);
        return 0;
    }
    const int has = has_moved(scene, wish);
    if (has && !read_light(base, wish, &setup, sentence)) return 0;
    if (has) status = skg_setup_view_get(setup, view);
    if (status == SKG_OK && wish->projection >= 0)
        status = skg_setup_scan_get(has ? setup : scene->setup, &scan);
    if (status == SKG_OK && scan) status = skg_scan_view_get(scan, wish->projection, view);
    skg_setup_release(&setup);
    return status == SKG_OK ? 1 : fail(sentence);
}

/* Whether a scene has the bands of a wish. */
static int has_bands(const live_scene *scene, const live_wish *wish) {
    if (scene->session.options.bands != wish->bands) return 0;
    for (int64_t i = 0; wish->bands > 0 && i <= wish->bands; i++)
        if (scene->band_kev[i] != wish->band_kev[i]) return 0;
    return 1;
}

int live_scene_fits(const live_scene *scene, const live_wish *wish) {
    if (!scene->plan || (scene->is_posed && isnan(wish->phase))) return 0;
    if (wish->quantity != scene->session.options.quantity || !has_bands(scene, wish)) return 0;
    /* What is tabulated for the rays of a view is made anew. */
    const skg_plan_options *options = &scene->session.options;
    if ((options->grid || options->oblique || options->heel || options->bowtie) && has_moved(scene, wish))
        return 0;
    json_t *was = fixed_settings(scene->settings), *is = fixed_settings(wish->settings);
    const int fits = json_equal(was, is);
    json_decref(was);
    json_decref(is);
    return fits;
}

static skg_status read_setup(const live_base *base, const live_wish *wish, live_scene *scene) {
    cli_session *session = &scene->session;
    skg_setup_source source;
    skg_setup_source_init(&source);
    char **settings = list_settings(wish->settings, NULL, &source.setting_count);
    source.text = base->text;
    source.path = base->path;
    source.settings = (const char *const *)settings;
    source.lenient = cli_given(base->arguments, "--lenient");
    skg_status status = settings ? skg_setup_create(base->context, &source, &scene->setup) : SKG_ERR_MEMORY;
    free_settings(settings, source.setting_count);
    if (status == SKG_OK) status = skg_setup_scene_get(scene->setup, &session->scene);
    if (status == SKG_OK) status = skg_setup_spectrum_get(scene->setup, &session->spectrum);
    if (status == SKG_OK) status = skg_setup_view_get(scene->setup, &session->view);
    if (status == SKG_OK) status = skg_setup_options_get(scene->setup, &session->options);
    if (status == SKG_OK) status = skg_scene_part_count(session->scene, &scene->parts);
    if (status == SKG_OK) status = skg_setup_projection_count_get(scene->setup, &scene->projections);
    if (base->precision >= 0) session->options.precision = base->precision;
    session->options.quantity = wish->quantity;
    session->options.profile = 1;
    if (status != SKG_OK || wish->bands == 0) return status;
    scene->band_kev = malloc(sizeof wish->band_kev);
    if (!scene->band_kev) return SKG_ERR_MEMORY;
    memcpy(scene->band_kev, wish->band_kev, sizeof wish->band_kev);
    session->options.bands = wish->bands;
    session->options.band_kev = scene->band_kev;
    return SKG_OK;
}

static skg_status read_motion(const live_base *base, live_scene *scene) {
    skg_body_options body;
    int32_t breathes = 0;
    skg_body_options_init(&body);
    skg_status status = skg_setup_body_options_get(scene->setup, &breathes, &body);
    if (status != SKG_OK || !breathes) return status;
    status = skg_motion_create(base->context, scene->setup, &scene->motion);
    return status == SKG_OK ? skg_motion_period_get(scene->motion, &scene->period) : status;
}

static skg_status make_plan(const live_base *base, live_scene *scene) {
    const cli_session *session = &scene->session;
    const double start = cli_now_ms();
    skg_status status = skg_plan_create(base->context, session->scene, &session->view, session->spectrum,
                                        &session->options, &scene->plan);
    if (status == SKG_OK) status = skg_plan_channel_get(scene->plan, 0, &scene->channel);
    scene->plan_ms = cli_now_ms() - start;
    return status;
}

int live_scene_load(const live_base *base, const live_wish *wish, live_scene *scene, char *sentence) {
    const double start = cli_now_ms();
    *scene = (live_scene){.session = {.context = base->context, .path = base->path}, .factor = 1};
    scene->settings = json_deep_copy(wish->settings);
    skg_view_init(&scene->session.view);
    skg_plan_options_init(&scene->session.options);
    skg_channel_init(&scene->channel);
    skg_status status = read_setup(base, wish, scene);
    if (status == SKG_OK) status = read_motion(base, scene);
    scene->session.setup = scene->setup;
    scene->load_ms = cli_now_ms() - start;
    return status == SKG_OK ? 1 : fail(sentence);
}

int live_scene_make(const live_base *base, const live_wish *wish, live_scene *scene, char *sentence) {
    const skg_view *view = &scene->session.view;
    if (!live_scene_load(base, wish, scene, sentence)) return 0;
    skg_status status = make_plan(base, scene);
    if (status == SKG_OK) status = skg_plan_channel_count(scene->plan, &scene->channels);
    if (status != SKG_OK) return fail(sentence);
    scene->values = calloc((size_t)(view->columns * view->rows * scene->channels), sizeof *scene->values);
    if (!scene->values) snprintf(sentence, LIVE_SENTENCE, "out of host memory for the image");
    scene->step = LIVE_STEPS;
    return scene->values != NULL;
}

void live_scene_refine(live_scene *scene, double seconds) {
    const int is_slow = seconds == 0 || seconds > LONG_S;
    scene->step = scene->session.options.scatter && is_slow ? 0 : LIVE_STEPS;
}

int live_scene_step(live_scene *scene, skg_plan **plan, char *sentence) {
    const skg_scatter *asked = scene->session.options.scatter;
    skg_plan_options options = scene->session.options;
    const int64_t histories = scene->step < LIVE_STEPS ? FIRST_HISTORIES << 2 * scene->step : 0;
    if (!asked || (asked->histories > 0 && asked->histories <= histories)) scene->step = LIVE_STEPS;
    *plan = scene->plan;
    if (scene->step == LIVE_STEPS) return 1;
    if (!scene->steps[scene->step]) {
        skg_scatter rough = *asked;
        rough.tolerance = 0;
        rough.histories = histories;
        options.scatter = &rough;
        if (skg_plan_create(scene->session.context, scene->session.scene, &scene->session.view,
                            scene->session.spectrum, &options, scene->steps + scene->step) != SKG_OK)
            return fail(sentence);
    }
    *plan = scene->steps[scene->step];
    return 1;
}

void live_scene_free(live_scene *scene) {
    for (int i = 0; i < LIVE_STEPS; i++) skg_plan_release(scene->steps + i);
    skg_plan_release(&scene->draft);
    json_decref(scene->dose);
    skg_plan_release(&scene->plan);
    skg_motion_release(&scene->motion);
    skg_setup_release(&scene->setup);
    json_decref(scene->settings);
    free(scene->values);
    free(scene->band_kev);
    *scene = (live_scene){0};
}

void live_view_coarsen(skg_view *view, int64_t factor) {
    const int64_t columns = view->columns / factor > 1 ? view->columns / factor : 1,
                  rows = view->rows / factor > 1 ? view->rows / factor : 1;
    skg_scale_vector((double)view->columns / (double)columns, view->column_step, view->column_step);
    skg_scale_vector((double)view->rows / (double)rows, view->row_step, view->row_step);
    view->columns = columns;
    view->rows = rows;
}

int live_scene_draft(const live_base *base, live_scene *scene, double ms, char *sentence) {
    skg_view view = scene->session.view;
    skg_plan_options options = scene->session.options;
    const int has_scatter = options.scatter != NULL;
    const double pixels = (double)(view.columns * view.rows);
    int64_t factor = 1;
    if (scene->is_drafted || (scene->frame_ms <= ms && !has_scatter)) return 1;
    scene->is_drafted = 1;
    /* what a frame takes goes about with its pixels; with scatter the time of the rest is not known */
    while (scene->frame_ms / (double)(factor * factor) > ms && pixels / (double)(factor * factor) > 4096)
        factor++;
    if (has_scatter || options.counter) factor = 1; /* what counts has pixels of its own */
    live_view_coarsen(&view, factor);
    options.scatter = NULL;
    if (factor > 1)
        options.blur = NULL, options.depth_blur = NULL; /* less than a pixel of these, as a rule */
    const skg_status status = skg_plan_create(base->context, scene->session.scene, &view,
                                              scene->session.spectrum, &options, &scene->draft);
    if (status != SKG_OK) return fail(sentence);
    scene->factor = factor;
    return 1;
}
