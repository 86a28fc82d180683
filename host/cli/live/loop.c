/* The loop of live: takes wishes, renders what is asked for, and ends when it is idle or asked to. */
#include "live/loop.h"

#include "common/encode.h"
#include "common/interrupt.h"
#include "common/progress.h"
#include "common/say.h"
#include "live/ask.h"
#include "live/describe.h"
#include "live/dose.h"
#include "live/fixed.h"
#include "live/frame.h"
#include "live/page.h"
#include "live/paths.h"
#include "live/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WARNINGS_MAX = 20 };

/* ms: how long to wait for something asked, how often files are looked at, and what an image may take while something is dragged. */
static const double PAUSE = 100, LOOK = 500, FLUENT = 40;

/* ms between two frames of which pages are told all while the scene breathes by itself. */
static const double TELL = 200;

/* While images follow each other, pictures of the 3D view leave this many times their own time to them. */
static const double X_RAYS = 3;

static void tell_error(live_loop *loop, int64_t wish, const char *sentence) {
    json_t *object = json_object();
    json_object_set_new(object, "error", cli_json_text(sentence));
    json_object_set_new(object, "wish", json_integer(wish));
    live_hub_tell_json(loop->hub, object);
}

/* Tells pages of the scene, those that are there only if it is another one. */
static void tell_scene(live_loop *loop, int is_new) {
    json_t *object = live_describe_scene(&loop->base, &loop->scene, &loop->wish, loop->geometry);
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(object);
    if (!text) return;
    live_hub_greeting_set(loop->hub, text);
    if (is_new) live_hub_tell(loop->hub, text);
    free(text);
    loop->is_told = 1;
}

/* A page for these surfaces, if they are others. Returns 0 if it cannot be made. */
static int make_page(live_loop *loop) {
    const int64_t geometry = live_geometry_of(&loop->scene);
    if (geometry == loop->geometry) return 1;
    char *html = live_page_make(&loop->base, &loop->wish, loop->nonce);
    if (!html) return 0;
    live_hub_page_set(loop->hub, html);
    loop->geometry = geometry;
    return 1;
}

/* Keeps a warning or note for the pages: each wish would repeat it on the terminal. */
static void keep_warning(int32_t level, const char *sentence, void *user) {
    json_t *warnings = user;
    if (level > SKG_LOG_NOTE) return;
    for (size_t i = 0; i < json_array_size(warnings); i++)
        if (strcmp(json_string_value(json_array_get(warnings, i)), sentence) == 0) return;
    if (json_array_size(warnings) < WARNINGS_MAX) json_array_append_new(warnings, cli_json_text(sentence));
}

/* Makes the scene of a wish; on failure the last one stays. */
static int change_scene(live_loop *loop, const live_wish *wish, char *sentence) {
    live_scene made;
    json_array_clear(loop->base.warnings);
    if (!live_scene_make(&loop->base, wish, &made, sentence)) {
        live_scene_free(&made);
        return 0;
    }
    live_scene_free(&loop->scene);
    loop->scene = made;
    return 1;
}

/* Tells pages of a frame: all of it, or while the scene breathes by itself often only the phase. */
static void tell_frame(live_loop *loop, const live_shot *shot) {
    const double now = cli_now_ms();
    if (loop->wish.plays && loop->told == loop->wish.number && now - loop->told_ms < TELL) {
        live_hub_tell_json(loop->hub, live_describe_phase(&loop->wish, loop->number, shot->ms));
        return;
    }
    loop->told = loop->wish.number;
    loop->told_ms = now;
    live_hub_shot_tell(loop->hub,
                       live_describe_shot(&loop->scene, &loop->wish, &shot->view, loop->number, shot->ms));
}

/* How long the whole scatter of a frame took, and what comes next. */
static void note_scatter(live_loop *loop) {
    live_scene *scene = &loop->scene;
    skg_scatter_report report;
    skg_scatter_report_init(&report);
    loop->refines = 0;
    if (loop->wish.dragging || !scene->session.options.scatter) return;
    const int has = skg_plan_scatter_report_get(scene->shown_plan, &report) == SKG_OK;
    if (scene->step == LIVE_STEPS)
        loop->scatter_s = has ? report.seconds : 0;
    else if (has && report.sigma <= 2 * scene->session.options.scatter->tolerance * report.mean)
        scene->step = LIVE_STEPS; /* half of the error needs four times as many photons, as a step more */
    else
        scene->step++;
    loop->refines = scene->shown_plan != scene->plan;
}

static int make_frame(live_loop *loop, char *sentence) {
    live_shot shot;
    const int64_t number = loop->number + 1;
    loop->is_wanted = 0;
    if (!live_frame_make(&loop->base, &loop->scene, &loop->wish, &loop->lag, loop->hub, number, &shot,
                         sentence))
        return 0;
    if (shot.is_dropped || !shot.bytes) return 1;
    loop->number = number;
    loop->framed_ms = cli_now_ms();
    live_hub_show(loop->hub, number, shot.bytes, shot.size);
    tell_frame(loop, &shot);
    note_scatter(loop);
    return 1;
}

int live_loop_begin(live_loop *loop, const char *nonce) {
    char sentence[LIVE_SENTENCE];
    loop->nonce = nonce;
    live_wish_init(&loop->wish);
    loop->base.warnings = json_array();
    cli_progress_begin("preparing the scene", 0);
    int is_made = live_base_read(&loop->base, sentence);
    /* the terminal has the warnings of the file as it is; those that follow are the pages' */
    (void)skg_context_log_set(loop->base.context, keep_warning, loop->base.warnings);
    is_made = is_made && change_scene(loop, &loop->wish, sentence);
    const int exit_status = is_made ? live_fixed_read(&loop->base, &loop->scene, loop->hub) : CLI_DONE;
    if (exit_status == CLI_DONE && loop->base.fixed) loop->wish.projection = loop->base.fixed->projection;
    is_made = is_made && exit_status == CLI_DONE && make_frame(loop, sentence);
    cli_progress_end();
    if (exit_status != CLI_DONE) return exit_status;
    if (!is_made) return cli_error(CLI_INPUT, "%s", sentence);
    if (!make_page(loop)) return CLI_DEVICE;
    tell_scene(loop, 0);
    return CLI_DONE;
}

/* Takes over a wish. */
static void take_wish(live_loop *loop, live_wish *wish) {
    char sentence[LIVE_SENTENCE];
    const int is_new = !live_scene_fits(&loop->scene, wish);
    skg_view view;
    const int is_made = live_paths_check(loop->base.path, wish->settings, sentence) &&
                        (is_new ? change_scene(loop, wish, sentence)
                                : live_scene_view(&loop->base, &loop->scene, wish, &view, sentence));
    if (!is_made) {
        tell_error(loop, wish->number, sentence);
        live_wish_free(wish);
        return;
    }
    live_wish_free(&loop->wish);
    loop->wish = *wish;
    loop->is_wanted = 1;
    loop->is_told = 0;
    live_scene_refine(&loop->scene, loop->scatter_s);
    if (is_new && make_page(loop)) tell_scene(loop, 1);
}

/* A file has changed: the same wish on top of what it is now. */
static void read_again(live_loop *loop) {
    char sentence[LIVE_SENTENCE];
    loop->looked_ms = cli_now_ms();
    if (!live_base_is_stale(&loop->base)) return;
    if (!live_base_read(&loop->base, sentence) || !change_scene(loop, &loop->wish, sentence)) {
        tell_error(loop, loop->wish.number, sentence);
        return;
    }
    loop->is_wanted = 1;
    if (make_page(loop)) tell_scene(loop, 1);
}

/* The next moment of a breath that goes on by itself. */
static void play(live_loop *loop) {
    const double now = cli_now_ms();
    if (!loop->wish.plays || !loop->scene.motion || isnan(loop->wish.phase)) {
        loop->played_ms = 0;
        return;
    }
    if (!live_hub_is_thirsty(loop->hub)) return;
    if (loop->played_ms > 0)
        loop->wish.phase = fmod(loop->wish.phase + (now - loop->played_ms) / 1000 / loop->scene.period, 1);
    loop->played_ms = now;
    loop->is_wanted = 1;
    live_scene_refine(&loop->scene, loop->scatter_s); /* the first step alone, until it stands */
}

static void end_registered(live_loop *loop) {
    if (live_registering_is_over(loop->registering)) live_registering_end(&loop->registering);
}

/* Begins or ends a registration. */
static void answer_register(live_loop *loop, int64_t part) {
    char sentence[LIVE_SENTENCE] = "no registration is under way";
    end_registered(loop);
    if (part < 0 && loop->registering) {
        live_registering_stop(loop->registering);
        return;
    }
    if (part >= 0 && loop->registering)
        snprintf(sentence, sizeof sentence, "a registration is under way; stop it first");
    else if (part >= 0 &&
             live_registering_begin(&loop->base, &loop->wish, part, loop->hub, &loop->registering, sentence))
        return;
    json_t *object = json_object();
    json_object_set_new(object, "refused", cli_json_text(sentence));
    live_hub_tell_json(loop->hub, object);
}

static void answer(live_loop *loop, const live_asked *asked) {
    char sentence[LIVE_SENTENCE];
    for (int i = 0; i < asked->take_count; i++) {
        unsigned char *bytes;
        size_t size;
        if (live_take(&loop->base, &loop->wish, asked->takes[i], &bytes, &size, sentence))
            live_hub_give(loop->hub, bytes, size);
        else
            tell_error(loop, loop->wish.number, sentence);
        free(bytes);
    }
    if (asked->has_probe && !live_hub_has_news(loop->hub)) {
        json_t *lengths = live_probe(&loop->base, &loop->scene, &loop->wish, asked->probe, sentence);
        if (lengths)
            live_hub_tell_json(loop->hub, lengths);
        else
            tell_error(loop, loop->wish.number, sentence);
    }
    if (asked->has_register) answer_register(loop, asked->part);
    if (asked->has_reconstruct && !asked->switches.is_stop)
        live_reconstruct(&loop->base, &loop->wish, &asked->switches, loop->hub);
    if (asked->has_measure) live_measure(&loop->base, &loop->scene, &loop->wish, loop->hub);
}

/* Tells pages what a frame gives, if that is not known of the view. */
static void tell_dose(live_loop *loop) {
    live_scene *scene = &loop->scene;
    if (!scene->is_shown || live_dose_is_known(scene, &scene->shown, loop->wish.phase)) return;
    if (!live_dose_find(scene, loop->hub, &scene->shown, loop->wish.phase)) return;
    json_t *object = json_object();
    json_object_set(object, "dosed", scene->dose);
    live_hub_tell_json(loop->hub, object);
    tell_scene(loop, 0); /* of pages that begin */
}

/* What can wait until nothing is asked for. */
static void rest(live_loop *loop) {
    char sentence[LIVE_SENTENCE];
    if (!loop->is_told) tell_scene(loop, 0);
    if (loop->is_wanted || !live_hub_is_thirsty(loop->hub)) return; /* no page is there */
    if (loop->refines || live_lag_changes(&loop->lag) ||
        (loop->scene.frames == 1 && !loop->scene.session.options.scatter))
        loop->is_wanted = 1; /* with more scatter, with less lag, or once more, for its time */
    else if (!live_scene_draft(&loop->base, &loop->scene, FLUENT, sentence))
        tell_error(loop, loop->wish.number, sentence);
    else if (!loop->wish.dragging)
        tell_dose(loop);
}

/* Draws a picture of the 3D view that a page waits for. Images come first. */
static void draw(live_loop *loop) {
    char sentence[LIVE_SENTENCE];
    unsigned char *bytes;
    size_t size;
    int64_t page;
    live_look look;
    const double start = cli_now_ms();
    if (start < loop->picture_ms || !live_hub_look_take(loop->hub, &look, &page)) return;
    if (!live_picture_make(&loop->scene, &loop->wish, &look, &bytes, &size, sentence)) {
        json_t *object = json_object();
        json_object_set_new(object, "refused", cli_json_text(sentence));
        live_hub_tell_json(loop->hub, object);
    }
    live_look_free(&look);
    if (bytes) live_hub_picture(loop->hub, page, bytes, size);
    const double now = cli_now_ms();
    loop->picture_ms = start - loop->framed_ms < PAUSE ? now + X_RAYS * (now - start) : now;
}

void live_loop_run(live_loop *loop, double idle) {
    char sentence[LIVE_SENTENCE];
    while (!cli_stop_asked()) {
        live_asked asked;
        if (cli_now_ms() - loop->looked_ms > LOOK) read_again(loop);
        end_registered(loop);
        play(loop);
        const int is_ready = loop->is_wanted && live_hub_is_thirsty(loop->hub);
        const double until = loop->picture_ms - cli_now_ms(); /* the next picture */
        const int has = live_hub_wait(loop->hub,
                                      is_ready    ? 0
                                      : until > 0 ? fmin(until, PAUSE)
                                                  : PAUSE,
                                      until <= 0, &asked);
        if (asked.has_wish) take_wish(loop, &asked.wish);
        if (loop->is_wanted && live_hub_is_thirsty(loop->hub) && !make_frame(loop, sentence))
            tell_error(loop, loop->wish.number, sentence);
        draw(loop);
        if (has)
            answer(loop, &asked);
        else if (!is_ready)
            rest(loop);
        if (idle > 0 && !loop->registering && live_hub_idle(loop->hub) > idle) {
            cli_note("live: nothing was asked for during %g s; this is the end (--idle)", idle);
            break;
        }
    }
}

void live_loop_end(live_loop *loop) {
    live_registering_end(&loop->registering);
    live_lag_free(&loop->lag);
    live_scene_free(&loop->scene);
    if (loop->wish.settings) live_wish_free(&loop->wish);
    live_base_free(&loop->base);
    live_hub_free(loop->hub);
    loop->hub = NULL;
}
