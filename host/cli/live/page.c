/* The page: HTML with the surfaces of the scene, and what it draws of source and detector. */
#include "live/page.h"

#include "common/say.h"
#include "view/pages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern const char live_page_text[]; /* page/page.html with its scripts, as built in */

/* Moments of the breath, between which the page moves vertices in straight lines. */
enum { MOMENTS = 12 };

/* Surfaces of the scene, over its breath. */
static int take_shapes(const live_scene *scene, view_shapes *shapes) {
    const int64_t frames = scene->motion ? MOMENTS : 1;
    int exit_status = view_shapes_make(scene->session.scene, frames, view_max_triangles(frames), shapes);
    for (int64_t f = 0; f < frames && exit_status == CLI_DONE; f++) {
        if (frames > 1) {
            const skg_status status = skg_motion_pose_at_phase(scene->motion, (double)f / (double)frames);
            if (status != SKG_OK) return cli_fail(status);
        }
        exit_status = view_shapes_take(scene->session.scene, f, shapes);
    }
    return exit_status;
}

/* Writes the template with scene, bytes, and the nonce in each of its scripts. */
static char *fill(const char *scene, const char *bytes, const char *nonce) {
    static const char script[] = "<script>", scene_mark[] = "\"SCENE\"", bytes_mark[] = "BYTES";
    char *html = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&html, &size);
    if (!stream) return NULL;
    for (const char *at = live_page_text; *at;) {
        if (strncmp(at, script, sizeof script - 1) == 0) {
            fprintf(stream, "<script nonce=\"%s\">", nonce);
            at += sizeof script - 1;
        } else if (scene && strncmp(at, scene_mark, sizeof scene_mark - 1) == 0) {
            fputs(scene, stream);
            at += sizeof scene_mark - 1;
            scene = NULL;
        } else if (bytes && !scene && strncmp(at, bytes_mark, sizeof bytes_mark - 1) == 0) {
            fputs(bytes, stream);
            at += sizeof bytes_mark - 1;
            bytes = NULL;
        } else {
            fputc(*at++, stream);
        }
    }
    if (fclose(stream) == 0) return html;
    free(html);
    return NULL;
}

static int begin(const live_scene *scene, view_page *page, skg_look *look, view_places *places) {
    skg_look_init(look);
    look->collimation = scene->session.options.collimation;
    page->session = &scene->session;
    page->look = look;
    page->places = places;
    return view_find_places(&scene->session, look, places);
}

static char *make(const live_scene *scene, const char *nonce) {
    char *text = NULL, *bytes = NULL, *html = NULL;
    skg_look look;
    view_places places = {0};
    view_shapes shapes = {0};
    view_page page = {.shapes = &shapes, .seconds = scene->period};
    int exit_status = begin(scene, &page, &look, &places);
    if (exit_status == CLI_DONE) exit_status = take_shapes(scene, &shapes);
    if (exit_status == CLI_DONE) exit_status = view_page_texts(&page, &text, &bytes);
    if (exit_status == CLI_DONE) {
        html = fill(text, bytes, nonce);
        if (!html) cli_error(CLI_DEVICE, "out of host memory for the page");
    }
    free(text);
    free(bytes);
    free(places.parts);
    view_shapes_free(&shapes);
    return html;
}

char *live_page_make(const live_base *base, const live_wish *wish, const char *nonce) {
    live_scene scene;
    char sentence[LIVE_SENTENCE], *html = NULL;
    if (live_scene_load(base, wish, &scene, sentence))
        html = make(&scene, nonce);
    else
        cli_error(CLI_INPUT, "%s", sentence);
    live_scene_free(&scene);
    return html;
}
