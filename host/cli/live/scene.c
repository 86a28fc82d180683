/* The scene as the last wish has it, ready for frames. */
#include "live/scene.h"

#include "common/progress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Keys of the samples, and of what needs them. */
static int is_of_samples(const char *key) {
    return strncasecmp(key, "Samples", 7) == 0 || strncasecmp(key, "SceneGraph", 10) == 0 ||
           strncasecmp(key, "Breathing", 9) == 0;
}

/* The settings of a wish but those of samples, which the caller frees. */
static const char **light_settings(const live_wish *wish, int64_t *count) {
    const char **list = calloc((size_t)wish->says.setting_count + 1, sizeof *list);
    *count = 0;
    for (int64_t i = 0; list && i < wish->says.setting_count; i++)
        if (!is_of_samples(wish->says.settings[i])) list[(*count)++] = wish->says.settings[i];
    return list;
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
    const char **settings = light_settings(wish, &source.setting_count);
    source.text = text;
    source.path = base->path;
    source.settings = settings;
    source.partial = 1;
    source.lenient = cli_given(base->arguments, "--lenient");
    const skg_status status = text && settings ? skg_setup_create(NULL, &source, setup) : SKG_ERR_MEMORY;
    free(settings);
    free(text);
    json_decref(document);
    return status == SKG_OK || live_fail(sentence);
}

int live_scene_see(const live_base *base, live_scene *scene, const live_wish *wish, char *sentence) {
    skg_setup *setup = NULL;
    skg_scan *scan = scene->scan;
    int32_t has_moved = 0, is_other;
    skg_view view = scene->session.view;
    if (wish->says.projection >= scene->projections) {
        snprintf(sentence, LIVE_SENTENCE, "the scene has no projection %lld",
                 (long long)wish->says.projection);
        return 0;
    }
    skg_status status = skg_live_wish_compare(scene->wish.message, wish->message, &has_moved, &is_other);
    if (status == SKG_OK && has_moved && !read_light(base, wish, &setup, sentence)) return 0;
    if (status == SKG_OK && has_moved) status = skg_setup_view_get(setup, &view);
    if (status == SKG_OK && has_moved && wish->says.projection >= 0)
        status = skg_setup_scan_get(setup, &scan);
    if (status == SKG_OK && wish->says.projection >= 0)
        status = skg_scan_view_get(scan, wish->says.projection, &view);
    if (status == SKG_OK) scene->view = view;
    skg_setup_release(&setup);
    return status == SKG_OK || live_fail(sentence);
}

static skg_status read_setup(const live_base *base, const live_wish *wish, live_scene *scene) {
    cli_session *session = &scene->session;
    skg_setup_source source;
    skg_setup_source_init(&source);
    source.text = base->text;
    source.path = base->path;
    source.settings = wish->says.settings;
    source.setting_count = wish->says.setting_count;
    source.lenient = cli_given(base->arguments, "--lenient");
    skg_status status = skg_setup_create(base->context, &source, &scene->setup);
    if (status == SKG_OK) status = skg_setup_scene_get(scene->setup, &session->scene);
    if (status == SKG_OK) status = skg_setup_spectrum_get(scene->setup, &session->spectrum);
    if (status == SKG_OK) status = skg_setup_view_get(scene->setup, &session->view);
    if (status == SKG_OK) status = skg_setup_options_get(scene->setup, &session->options);
    if (status == SKG_OK) status = skg_scene_part_count(session->scene, &scene->parts);
    if (base->precision >= 0) session->options.precision = base->precision;
    return status;
}

/* The breath and the scan, if the scene has them. */
static skg_status read_motion(const live_base *base, live_scene *scene) {
    skg_body_options body;
    int32_t breathes = 0;
    skg_body_options_init(&body);
    if (skg_setup_scan_get(scene->setup, &scene->scan) != SKG_OK) scene->scan = NULL;
    skg_status status = SKG_OK;
    if (scene->scan) status = skg_scan_projection_count(scene->scan, &scene->projections);
    if (status == SKG_OK) status = skg_setup_body_options_get(scene->setup, &breathes, &body);
    if (status != SKG_OK || !breathes) return status;
    status = skg_motion_create(base->context, scene->setup, &scene->motion);
    return status == SKG_OK ? skg_motion_period_get(scene->motion, &scene->period) : status;
}

/* Points the library's subject at the scene. */
static void point(live_scene *scene) {
    const cli_session *session = &scene->session;
    skg_live_subject *subject = &scene->subject;
    skg_live_subject_init(subject);
    subject->context = session->context;
    subject->scene = session->scene;
    subject->spectrum = session->spectrum;
    subject->options = &session->options;
    subject->view = &session->view;
    subject->shown = &scene->view;
    subject->setup = scene->setup;
    subject->scan = scene->scan;
    subject->motion = scene->motion;
}

void live_scene_move(live_scene *from, live_scene *to) {
    *to = *from;
    point(to);
    *from = (live_scene){0};
}

int live_scene_load(const live_base *base, const live_wish *wish, live_scene *scene, char *sentence) {
    const double start = cli_now_ms();
    *scene = (live_scene){.session = {.context = base->context, .path = base->path}};
    scene->wish = live_wish_copy(wish);
    skg_view_init(&scene->session.view);
    skg_plan_options_init(&scene->session.options);
    skg_status status = read_setup(base, wish, scene);
    if (status == SKG_OK) status = read_motion(base, scene);
    scene->session.setup = scene->setup;
    scene->view = scene->session.view;
    point(scene);
    scene->load_ms = cli_now_ms() - start;
    return status == SKG_OK ? 1 : live_fail(sentence);
}

int live_scene_make(const live_base *base, const live_wish *wish, live_scene *scene, char *sentence) {
    if (!live_scene_load(base, wish, scene, sentence) || !live_scene_see(base, scene, wish, sentence))
        return 0;
    return skg_live_plans_create(&scene->subject, wish->message, &scene->plans) == SKG_OK ||
           live_fail(sentence);
}

void live_scene_free(live_scene *scene) {
    skg_live_plans_release(&scene->plans);
    json_decref(scene->dose);
    skg_motion_release(&scene->motion);
    skg_setup_release(&scene->setup);
    live_wish_free(&scene->wish);
    *scene = (live_scene){0};
}
