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
#include "live/page.h"
#include "live/paths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WARNINGS_MAX = 20 };

/* ms: how long to wait for something asked, and how often files are looked at. */
static const double PAUSE = 100, LOOK = 500;

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
    live_hub_scene_tell(loop->hub,
                        live_describe_scene(&loop->base, &loop->scene, &loop->wish, loop->geometry), is_new);
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
    live_scene_move(&made, &loop->scene);
    return 1;
}

/* Tells pages of a frame: all of it, or while the scene breathes by itself often only the phase. */
static void tell_frame(live_loop *loop) {
    const double now = cli_now_ms();
    const int is_brief =
        loop->wish.says.play && loop->told == loop->wish.says.number && now - loop->told_ms < TELL;
    skg_live_letter *letter = NULL;
    (void)skg_live_shot_write(loop->scene.plans, &loop->scene.subject, loop->wish.message, loop->number,
                              is_brief, &letter);
    if (is_brief) {
        live_hub_tell(loop->hub, letter);
        return;
    }
    loop->told = loop->wish.says.number;
    loop->told_ms = now;
    live_hub_shot_tell(loop->hub, letter);
}

/* The end drops the image that is under way, and so does a newer wish; but its scatter only if the image refines the one that is shown:
 * wishes that follow each other fast would otherwise show nothing. */
static int32_t is_outdated(int64_t done, int64_t total, void *user) {
    const live_loop *loop = user;
    (void)done;
    if (cli_stop_asked()) return 1;
    return (total == 0 || loop->told == loop->wish.says.number) &&
           live_hub_has(loop->hub, SKG_LIVE_ASKED_WISH);
}

static int make_frame(live_loop *loop, char *sentence) {
    live_scene *scene = &loop->scene;
    const int64_t number = loop->number + 1;
    skg_progress *progress = NULL;
    skg_live_letter *letter = NULL;
    skg_live_frame frame;
    loop->is_wanted = loop->again = 0;
    skg_live_frame_init(&frame);
    skg_status status = skg_progress_create(is_outdated, loop, &progress);
    if (status == SKG_OK)
        status = skg_live_frame_make(scene->plans, &scene->subject, loop->wish.message, progress, &frame);
    skg_progress_release(&progress);
    loop->is_shown = status == SKG_OK && !frame.dropped;
    if (status != SKG_OK) return live_fail(sentence);
    if (frame.dropped) return 1;
    if (!frame.draft && !live_lag_show(&loop->lag, scene, &frame, sentence)) return 0;
    if (skg_live_frame_write(scene->plans, number, &letter) != SKG_OK) return live_fail(sentence);
    loop->number = number;
    loop->framed_ms = cli_now_ms();
    loop->again = frame.again;
    if (!isnan(frame.scatter_s)) loop->scatter_s = frame.scatter_s;
    live_hub_show(loop->hub, number, letter);
    tell_frame(loop);
    return 1;
}

int live_loop_begin(live_loop *loop, const char *nonce) {
    char sentence[LIVE_SENTENCE];
    loop->nonce = nonce;
    loop->wish = live_wish_plain();
    loop->base.warnings = json_array();
    cli_progress_begin("preparing the scene", 0);
    int is_made = live_base_read(&loop->base, sentence);
    /* the terminal has the warnings of the file as it is; those that follow are the pages' */
    (void)skg_context_log_set(loop->base.context, keep_warning, loop->base.warnings);
    is_made = is_made && change_scene(loop, &loop->wish, sentence);
    const int exit_status = is_made ? live_fixed_read(&loop->base, &loop->scene, loop->hub) : CLI_DONE;
    if (is_made && exit_status == CLI_DONE && loop->base.fixed && loop->base.fixed->projection >= 0)
        is_made = live_wish_change(&loop->wish,
                                   json_pack("{s:I}", "projection", (json_int_t)loop->base.fixed->projection),
                                   sentence) &&
                  live_scene_see(&loop->base, &loop->scene, &loop->wish, sentence);
    is_made = is_made && exit_status == CLI_DONE && make_frame(loop, sentence);
    cli_progress_end();
    if (exit_status != CLI_DONE) return exit_status;
    if (!is_made) return cli_error(CLI_INPUT, "%s", sentence);
    if (!make_page(loop)) return CLI_DEVICE;
    tell_scene(loop, 0);
    return CLI_DONE;
}

/* Whether the plans that there are can show a wish. */
static int has_plans(const live_loop *loop, const live_wish *wish) {
    int32_t fits = 0;
    return skg_live_plans_fit(loop->scene.plans, &loop->scene.subject, wish->message, &fits) == SKG_OK &&
           fits;
}

/* Takes over a wish. */
static void take_wish(live_loop *loop, live_wish *wish) {
    char sentence[LIVE_SENTENCE];
    const int is_new = !has_plans(loop, wish);
    const int is_made = live_paths_check(loop->base.path, wish, sentence) &&
                        (is_new ? change_scene(loop, wish, sentence)
                                : live_scene_see(&loop->base, &loop->scene, wish, sentence));
    if (!is_made) {
        tell_error(loop, wish->says.number, sentence);
        live_wish_free(wish);
        return;
    }
    live_wish_free(&loop->wish);
    loop->wish = *wish;
    loop->is_wanted = 1;
    loop->is_told = 0;
    (void)skg_live_plans_refine(loop->scene.plans, loop->scatter_s);
    if (is_new && make_page(loop)) tell_scene(loop, 1);
}

/* A file has changed: the same wish on top of what it is now. */
static void read_again(live_loop *loop) {
    char sentence[LIVE_SENTENCE];
    loop->looked_ms = cli_now_ms();
    if (!live_base_is_stale(&loop->base)) return;
    if (!live_base_read(&loop->base, sentence) || !change_scene(loop, &loop->wish, sentence)) {
        tell_error(loop, loop->wish.says.number, sentence);
        return;
    }
    loop->is_wanted = 1;
    if (make_page(loop)) tell_scene(loop, 1);
}

/* The next moment of a breath that goes on by itself. */
static void play(live_loop *loop) {
    char sentence[LIVE_SENTENCE];
    const double now = cli_now_ms();
    double phase = loop->wish.says.phase;
    if (!loop->wish.says.play || !loop->scene.motion || isnan(phase)) {
        loop->played_ms = 0;
        return;
    }
    if (!live_hub_is_thirsty(loop->hub)) return;
    if (loop->played_ms > 0) phase = fmod(phase + (now - loop->played_ms) / 1000 / loop->scene.period, 1);
    loop->played_ms = now;
    loop->is_wanted = live_wish_change(&loop->wish, json_pack("{s:f}", "phase", phase), sentence);
    (void)skg_live_plans_refine(loop->scene.plans,
                                loop->scatter_s); /* the first step alone, until it stands */
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
    live_hub_refuse(loop->hub, sentence);
}

/* A file, of the scene as `image` reads it. */
static void answer_take(live_loop *loop, const skg_live_message *take) {
    char sentence[LIVE_SENTENCE];
    skg_live_letter *letter = NULL;
    live_scene scene;
    const int is_made = live_scene_load(&loop->base, &loop->wish, &scene, sentence) &&
                        live_scene_see(&loop->base, &scene, &loop->wish, sentence) &&
                        (skg_live_file_write(&scene.subject, loop->wish.message, take, &letter) == SKG_OK ||
                         live_fail(sentence));
    if (!is_made) tell_error(loop, loop->wish.says.number, sentence);
    live_hub_give(loop->hub, letter);
    live_scene_free(&scene);
}

static void answer_probe(live_loop *loop, const skg_live_message *probe) {
    char sentence[LIVE_SENTENCE];
    skg_live_letter *letter = NULL;
    if (skg_live_probe_write(&loop->scene.subject, loop->wish.message, probe, &letter) == SKG_OK)
        live_hub_tell(loop->hub, letter);
    else
        tell_error(loop, loop->wish.says.number, (live_fail(sentence), sentence));
}

/* Draws a picture of the 3D view that a page waits for. Images come first. */
static void draw(live_loop *loop) {
    int64_t page;
    skg_live_letter *letter = NULL;
    const double start = cli_now_ms();
    skg_live_message *look = start < loop->picture_ms ? NULL : live_hub_look_take(loop->hub, &page);
    if (!look) return;
    if (skg_live_picture_write(loop->scene.plans, &loop->scene.subject, loop->wish.message, look, &letter) !=
        SKG_OK) {
        live_hub_refuse(loop->hub, skg_last_error());
        (void)skg_live_picture_miss(look, &letter);
    }
    skg_live_message_release(&look);
    live_hub_picture(loop->hub, page, letter);
    const double now = cli_now_ms();
    loop->picture_ms = start - loop->framed_ms < PAUSE ? now + X_RAYS * (now - start) : now;
}

/* Draws while something takes long. */
static void draw_meanwhile(void *user) {
    draw(user);
}

static void answer(live_loop *loop, const live_asked *asked) {
    skg_live_message *const *newest = asked->newest;
    const live_wish part = live_wish_of(newest[SKG_LIVE_ASKED_REGISTER]),
                    slice = live_wish_of(newest[SKG_LIVE_ASKED_RECONSTRUCT]);
    for (int i = 0; i < asked->take_count; i++) answer_take(loop, asked->takes[i]);
    if (newest[SKG_LIVE_ASKED_PROBE] && !live_hub_has(loop->hub, SKG_LIVE_ASKED_WISH))
        answer_probe(loop, newest[SKG_LIVE_ASKED_PROBE]);
    if (part.message) answer_register(loop, part.says.number);
    if (slice.message && !slice.says.stop)
        live_reconstruct(&loop->base, &loop->wish, &slice.says, loop->hub, draw_meanwhile, loop);
    if (newest[SKG_LIVE_ASKED_MEASURE]) live_measure(&loop->base, &loop->scene, &loop->wish, loop->hub);
}

/* Tells pages what a frame gives, if that is not known of the view. */
static void tell_dose(live_loop *loop) {
    live_scene *scene = &loop->scene;
    if (!loop->is_shown || live_dose_is_known(scene, loop->wish.says.phase)) return;
    if (!live_dose_find(scene, loop->hub, loop->wish.says.phase)) return;
    json_t *object = json_object();
    json_object_set(object, "dosed", scene->dose);
    live_hub_tell_json(loop->hub, object);
    tell_scene(loop, 0); /* of pages that begin */
}

/* Does the work that can wait until nothing is asked for. */
static void rest(live_loop *loop) {
    char sentence[LIVE_SENTENCE];
    if (!loop->is_told) tell_scene(loop, 0);
    if (loop->is_wanted || !live_hub_is_thirsty(loop->hub)) return; /* no page is there */
    if (loop->again || live_lag_changes(&loop->lag))
        loop->is_wanted = 1; /* with more scatter, with less lag, or once more, for its time */
    else if (skg_live_plans_draft(loop->scene.plans, &loop->scene.subject) != SKG_OK)
        tell_error(loop, loop->wish.says.number, (live_fail(sentence), sentence));
    else if (!loop->wish.says.drag)
        tell_dose(loop);
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
        if (asked.newest[SKG_LIVE_ASKED_WISH]) {
            live_wish wish = live_wish_of(asked.newest[SKG_LIVE_ASKED_WISH]);
            asked.newest[SKG_LIVE_ASKED_WISH] = NULL;
            take_wish(loop, &wish);
        }
        if (loop->is_wanted && live_hub_is_thirsty(loop->hub) && !make_frame(loop, sentence))
            tell_error(loop, loop->wish.says.number, sentence);
        draw(loop);
        if (has)
            answer(loop, &asked);
        else if (!is_ready)
            rest(loop);
        live_asked_free(&asked);
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
    live_wish_free(&loop->wish);
    live_base_free(&loop->base);
    live_hub_free(loop->hub);
    loop->hub = NULL;
}
