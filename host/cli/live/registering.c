/* A registration that a page has asked for: a thread with a device context and a scene of its own, so that images go on meanwhile. */
#include "live/registering.h"

#include "common/encode.h"
#include "common/progress.h"
#include "core/maths.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WARNINGS_MAX = 20 };
static const double TELL = 100; /* ms between two messages about steps */

struct live_registering {
    pthread_t thread;
    live_base base; /* its text and its context are of its own */
    live_wish wish;
    int64_t part;
    live_hub *hub;
    skg_progress *progress;
    json_t *warnings;
    atomic_int is_over;
    double told_ms;
};

static int32_t tell_step(int64_t done, int64_t total, void *user) {
    live_registering *r = user;
    const double now = cli_now_ms();
    if (now - r->told_ms < TELL) return 0;
    r->told_ms = now;
    json_t *object = json_object(), *inner = json_object();
    json_object_set_new(inner, "part", json_integer(r->part));
    json_object_set_new(inner, "step", json_integer(done));
    json_object_set_new(inner, "most", json_integer(total));
    json_object_set_new(object, "registering", inner);
    live_hub_tell_json(r->hub, object);
    return 0;
}

static void keep_warning(int32_t level, const char *sentence, void *user) {
    live_registering *r = user;
    if (level <= SKG_LOG_NOTE && json_array_size(r->warnings) < WARNINGS_MAX)
        json_array_append_new(r->warnings, cli_json_text(sentence));
}

/* Whether the wish shows what the radiograph shows. */
static int check_view(const live_registering *r, const skg_view *view, char *sentence) {
    const register_image *fixed = r->base.fixed;
    char name[64] = "the scene's own view", shown[64] = "the scene's own view";
    if (fixed->projection >= 0) snprintf(name, sizeof name, "projection %lld", (long long)fixed->projection);
    if (r->wish.says.projection >= 0)
        snprintf(shown, sizeof shown, "projection %lld", (long long)r->wish.says.projection);
    if (fixed->projection != r->wish.says.projection) {
        snprintf(sentence, LIVE_SENTENCE,
                 "%s: is of %s, and the page shows %s; choose the radiograph's to register", fixed->path,
                 name, shown);
        return 0;
    }
    if (view->columns == fixed->view.columns && view->rows == fixed->view.rows) return 1;
    snprintf(
        sentence, LIVE_SENTENCE,
        "%s: has %lld x %lld pixels, and the detector now has %lld x %lld; take Detector.NumberOfPixels back",
        fixed->path, (long long)fixed->view.columns, (long long)fixed->view.rows, (long long)view->columns,
        (long long)view->rows);
    return 0;
}

/* The part's motion over the scene file's pose: the one that was found, after that of the wish. */
static json_t *pose_json(const live_registering *r, const skg_registration *registration) {
    double motion[16], by[16], pose[16];
    skg_pose_identity(by);
    for (int64_t i = 0; i < r->wish.says.pose_count; i++)
        if (r->wish.says.parts[i] == r->part) memcpy(by, r->wish.says.poses + 16 * i, sizeof by);
    if (skg_registration_motion_get(registration, motion) != SKG_OK) return json_null();
    skg_pose_multiply(motion, by, pose);
    return cli_json_numbers(pose, 16);
}

/* {...} of what was found, as `register --json` has it of a body, with the pose. NULL with a sentence. */
static json_t *found_json(const live_registering *r, const live_scene *scene,
                          const skg_registration *registration, char *sentence) {
    skg_part part;
    skg_part_init(&part);
    register_body body = {.label = ""};
    skg_status status = skg_scene_part_get(scene->session.scene, r->part, &part);
    if (status == SKG_OK) status = register_result_get(registration, &body);
    body.label = part.label;
    json_t *found = status == SKG_OK ? register_body_json(&body, SKG_REGISTRATION_FREE_POSE)
                                     : (live_fail(sentence), NULL);
    if (found) json_object_set_new(found, "seconds", cli_json_number(body.result.seconds));
    if (found) json_object_set_new(found, "pose", pose_json(r, registration));
    json_decref(body.directions);
    return found;
}

/* Registers. NULL with a sentence. */
static json_t *search(live_registering *r, live_scene *scene, char *sentence) {
    const cli_session *s = &scene->session;
    skg_registration *registration = NULL;
    skg_registration_options options;
    skg_radiograph image;
    const skg_view *view = &scene->view;
    json_t *found = NULL;
    if (!live_scene_see(&r->base, scene, &r->wish, sentence) || !check_view(r, view, sentence)) return NULL;
    if (skg_live_place(&scene->subject, r->wish.message) != SKG_OK) return live_fail(sentence), NULL;
    skg_registration_options_init(&options);
    options.progress = r->progress;
    register_radiograph(r->base.fixed, &image);
    image.view = view; /* the page may have moved source and detector */
    (void)skg_context_log_set(r->base.context, keep_warning, r); /* what the scene says, pages have heard */
    skg_status status =
        skg_registration_create(s->context, s->scene, s->spectrum, &s->options, &options, &registration);
    if (status == SKG_OK) status = skg_registration_part_add(registration, r->part);
    if (status == SKG_OK) status = skg_registration_image_add(registration, &image);
    if (status == SKG_OK) status = skg_registration_run(registration);
    if (status == SKG_OK || status == SKG_ERR_CANCELLED)
        found = found_json(r, scene, registration, sentence);
    else
        live_fail(sentence);
    if (!found && status == SKG_ERR_CANCELLED)
        snprintf(sentence, LIVE_SENTENCE, "stopped before the search had begun");
    skg_registration_release(&registration);
    return found;
}

static void *run(void *user) {
    live_registering *r = user;
    char sentence[LIVE_SENTENCE] = "";
    live_scene scene = {0};
    json_t *found = NULL, *object = json_object();
    if (skg_context_create(cli_value(r->base.arguments, "--device"), &r->base.context) != SKG_OK)
        live_fail(sentence);
    else if (live_scene_load(&r->base, &r->wish, &scene, sentence))
        found = search(r, &scene, sentence);
    if (!found) {
        found = json_object();
        json_object_set_new(found, "error", cli_json_text(sentence));
    }
    json_object_set_new(found, "part", json_integer(r->part));
    json_object_set(found, "warnings", r->warnings);
    json_object_set_new(object, "registered", found);
    live_scene_free(&scene);
    skg_context_release(&r->base.context);
    atomic_store(&r->is_over,
                 1); /* before it is told, so that a page that hears of it may ask for the next */
    live_hub_tell_json(r->hub, object);
    return NULL;
}

static void destroy(live_registering *r) {
    live_wish_free(&r->wish);
    skg_progress_release(&r->progress);
    json_decref(r->warnings);
    free(r->base.text);
    free(r);
}

int live_registering_begin(const live_base *base, const live_wish *wish, int64_t part, live_hub *hub,
                           live_registering **registering, char *sentence) {
    if (!base->fixed) {
        snprintf(sentence, LIVE_SENTENCE,
                 "there is no radiograph to register to; start live with --fixed FILE");
        return 0;
    }
    live_registering *r = calloc(1, sizeof *r);
    if (!r) return snprintf(sentence, LIVE_SENTENCE, "out of host memory"), 0;
    *r = (live_registering){.part = part, .hub = hub, .warnings = json_array()};
    r->base = (live_base){.arguments = base->arguments,
                          .path = base->path,
                          .precision = base->precision,
                          .text = strdup(base->text),
                          .fixed = base->fixed};
    r->wish = live_wish_copy(wish);
    int is_begun = r->base.text && r->wish.message && r->warnings;
    if (!is_begun) snprintf(sentence, LIVE_SENTENCE, "out of host memory");
    if (is_begun && skg_progress_create(tell_step, r, &r->progress) != SKG_OK) is_begun = live_fail(sentence);
    if (is_begun && pthread_create(&r->thread, NULL, run, r) != 0) {
        snprintf(sentence, LIVE_SENTENCE, "no thread can be started for the registration");
        is_begun = 0;
    }
    if (is_begun)
        *registering = r;
    else
        destroy(r);
    return is_begun;
}

void live_registering_stop(live_registering *registering) {
    (void)skg_progress_cancel(registering->progress);
}

int live_registering_is_over(live_registering *registering) {
    return registering && atomic_load(&registering->is_over);
}

void live_registering_end(live_registering **registering) {
    if (!*registering) return;
    live_registering_stop(*registering);
    pthread_join((*registering)->thread, NULL);
    destroy(*registering);
    *registering = NULL;
}
