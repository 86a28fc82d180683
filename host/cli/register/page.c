/* The page that shows what a registration found. */
#include "register/work.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Skiagraph: registration</title>\n<style>\n"
    ":root{color-scheme:light dark;--ground:#fff;--ink:#1a1c20;--faint:#5c6068;--rule:#d5d8de;--mark:#0062a3;--open:#a54400;--plate:#eef0f3}\n"
    "@media(prefers-color-scheme:dark){:root{--ground:#14161a;--ink:#e8eaee;--faint:#a3a8b3;--rule:#3a3f49;--mark:#6cb8f0;--open:#f0a060;"
    "--plate:#c9ced8}}\n"
    "*{box-sizing:border-box}body{font:15px/1.45 system-ui,sans-serif;color:var(--ink);background:var(--ground);max-width:1100px;"
    "margin:0 auto;padding:16px}\nh1{font-size:15px;color:var(--faint);margin:0}h2{font-size:17px;margin:28px 0 6px;overflow-wrap:anywhere}"
    "#verdict{font-size:20px;line-height:1.35;margin:6px 0 10px}\n"
    ".views{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,240px),1fr));gap:18px}figure{margin:0;min-width:0}"
    "figcaption{color:var(--faint);font-size:13px;margin-top:4px}\n"
    ".stack{position:relative;background:#000;line-height:0}.stack img{width:100%;image-rendering:pixelated}"
    ".stack img+img{position:absolute;left:0;top:0}.stack .model{clip-path:inset(0 0 0 var(--at,50%))}\n"
    ".difference{position:relative;background:var(--plate);line-height:0}.difference img{width:100%;image-rendering:pixelated}"
    ".cell{position:absolute;width:12.5%;height:12.5%;transform:translate(-50%,-50%);border:2px solid #1a1c20}\n"
    "input[type=range]{width:100%;accent-color:var(--mark)}label{font-size:13px}\n"
    ".scroll{overflow-x:auto}table{border-collapse:collapse;font-variant-numeric:tabular-nums}td,th{padding:3px 10px;border-bottom:1px "
    "solid var(--rule);text-align:right}td:first-child,th:first-child{text-align:left;padding-left:0}.open{color:var(--open)}\n"
    "svg{width:100%;height:auto}svg text{font:12px system-ui,sans-serif;fill:var(--faint)}.key{display:inline-block;width:14px;height:3px;"
    "vertical-align:4px;margin-right:4px}\n</style></head><body>\n<h1>Registration to radiographs</h1>\n";

static int put_picture(FILE *page, const register_png *picture, const char *kind, const char *what) {
    char *uri = cli_base64("data:image/png;base64,", picture->png, picture->size);
    if (!uri) return cli_error(CLI_DEVICE, "out of host memory for the page");
    fprintf(page, "<img class=\"%s\" alt=\"%s\" src=\"%s\">", kind, what, uri);
    free(uri);
    return CLI_DONE;
}

/* Writes the picture of the structure that noise does not explain, and marks the cell with most of it. */
static int put_structure(FILE *page, const register_work *work, int64_t image, const register_png *picture) {
    const skg_registration_result *r = &work->bodies[work->body_count - 1].result;
    const skg_view *view = &work->images[image].view;
    if (!picture->png) return CLI_DONE;
    fputs("<figure><div class=\"difference\">", page);
    const int exit_status = put_picture(page, picture, "structure", "what noise does not explain");
    if (image == r->worst_image)
        fprintf(page, "<div class=\"cell\" style=\"left:%.2f%%;top:%.2f%%\"></div>",
                100 * (double)r->worst_column / (double)view->columns,
                100 * (double)r->worst_row / (double)view->rows);
    fprintf(
        page,
        "</div><figcaption>What noise does not explain of it: means of neighbouring pixels beyond three standard deviations. The "
        "full colour is %.2g.%s</figcaption></figure>",
        picture->most, image == r->worst_image ? " Most of what is left is in the frame." : "");
    return exit_status;
}

static int put_view(FILE *page, const register_work *work, int64_t image, const register_png *pictures) {
    int exit_status = CLI_DONE;
    fprintf(page, "<h2>View %" PRId64 ": ", image + 1);
    cli_html_text(work->images[image].path, page);
    if (work->images[image].projection >= 0) fprintf(page, "@%" PRId64, work->images[image].projection);
    fputs("</h2>\n<div class=\"views\"><figure><div class=\"stack\">", page);
    if (exit_status == CLI_DONE)
        exit_status = put_picture(page, &pictures[REGISTER_FIXED], "fixed", "radiograph");
    if (exit_status == CLI_DONE) exit_status = put_picture(page, &pictures[REGISTER_MODEL], "model", "model");
    if (exit_status == CLI_DONE)
        exit_status = put_picture(page, &pictures[REGISTER_CONTOUR], "contour", "contours of the parts");
    fputs(
        "</div><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"radiograph to the left, model to the right\">"
        "<figcaption>Left of the slider the radiograph, right of it the model. <span class=\"key\" style=\"background:#57b5e8\"></span>"
        "the parts at the start, <span class=\"key\" style=\"background:#e69f00\"></span>at the end. <label><input type=\"checkbox\" "
        "checked> contours</label></figcaption></figure>\n<figure><div class=\"difference\">",
        page);
    if (exit_status == CLI_DONE)
        exit_status = put_picture(page, &pictures[REGISTER_BEFORE], "", "difference at the start");
    fputs(
        "</div><figcaption>Model less radiograph at the start: blue less, red more attenuation.</figcaption></figure>\n<figure><div "
        "class=\"difference\">",
        page);
    if (exit_status == CLI_DONE)
        exit_status = put_picture(page, &pictures[REGISTER_AFTER], "", "difference at the end");
    fprintf(
        page,
        "</div><figcaption>The same at the end, with the same colours. The full one is %.2g.</figcaption></figure>\n",
        pictures[REGISTER_AFTER].most);
    if (exit_status == CLI_DONE)
        exit_status = put_structure(page, work, image, &pictures[REGISTER_STRUCTURE]);
    fputs("</div>\n", page);
    return exit_status;
}

static int put_views(FILE *page, const register_work *work) {
    int exit_status = CLI_DONE;
    for (int64_t i = 0; i < work->image_count && exit_status == CLI_DONE; i++) {
        register_png pictures[REGISTER_PICTURES] = {{NULL, 0, 0}};
        exit_status = register_pictures(work, i, pictures);
        if (exit_status == CLI_DONE) exit_status = put_view(page, work, i, pictures);
        for (int k = 0; k < REGISTER_PICTURES; k++) free(pictures[k].png);
    }
    return exit_status;
}

/* The loss of each step on a logarithmic scale; colours change where the level does. */
static void put_path(FILE *page, const register_work *work) {
    enum { WIDTH = 760, HEIGHT = 200, LEFT = 60, BOTTOM = 24 };
    static const char *const colours[] = {"#0072b2", "#d55e00", "#009e73"};
    int64_t count = 0, level = 0, before = -1;
    double loss = 0, low = HUGE_VAL, high = 0;
    int turn = -1;
    if (skg_registration_step_count(work->last, &count) != SKG_OK || count == 0) return;
    for (int64_t k = 0; k < count; k++)
        if (skg_registration_step_get(work->last, k, &level, &loss) == SKG_OK && loss > 0)
            low = fmin(low, loss), high = fmax(high, loss);
    if (!(high > 0)) return;
    const double bottom = log10(low) - 0.05, top = log10(high) + 0.05;
    fprintf(
        page,
        "<h2>Path of the loss</h2>\n<svg viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"loss of each step\">",
        WIDTH, HEIGHT);
    fprintf(page, "<text x=\"0\" y=\"12\">%.2g</text><text x=\"0\" y=\"%d\">%.2g</text>", high,
            HEIGHT - BOTTOM, low);
    for (int64_t k = 0; k < count; k++) {
        if (skg_registration_step_get(work->last, k, &level, &loss) != SKG_OK || !(loss > 0)) continue;
        const double x = LEFT + (WIDTH - LEFT - 10) * ((double)k + 0.5) / (double)count,
                     y = (HEIGHT - BOTTOM) * (1 - (log10(loss) - bottom) / (top - bottom));
        if (level != before) {
            turn++;
            fprintf(page, "<text x=\"%.1f\" y=\"%d\">1/%" PRId64 "</text>", x, HEIGHT - 6, level);
        }
        before = level;
        fprintf(page, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\" fill=\"%s\"/>", x, y, colours[turn % 3]);
    }
    fputs(
        "</svg>\n<p><small>A point for each step, those that were taken back included; 1/4 is the level of the pyramid whose "
        "pixels are four times as large. Levels have losses of their own.</small></p>\n",
        page);
}

static void put_freedoms(FILE *page, const register_body *body) {
    json_t *one;
    size_t index;
    fputs(
        "<h2>Freedoms</h2>\n<div class=\"scroll\"><table><tr><th>direction<th>sigma from noise alone, mm<th>with what is left, mm<th></tr>\n",
        page);
    json_array_foreach(body->directions, index, one) {
        const int determined = json_is_true(json_object_get(one, "determined"));
        fprintf(page, "<tr%s><td>%s<td>%.2g<td>%.2g<td>%s</tr>\n", determined ? "" : " class=\"open\"",
                json_string_value(json_object_get(one, "name")),
                json_number_value(json_object_get(one, "sigma_mm")),
                json_number_value(json_object_get(one, "sigma_structure_mm")),
                determined ? "" : "not determined");
    }
    fputs(
        "</table></div>\n<p><small>Independent directions, the least certain first; turns by what they move at the body's radius. "
        "Neither number is the error: what the model lacks displaces the result further.</small></p>\n",
        page);
}

static void put_numbers(FILE *page, const register_work *work, const register_body *body) {
    const skg_registration_result *r = &body->result;
    fputs("<p>", page);
    cli_html_text(body->label, page);
    if (work->options.free == SKG_REGISTRATION_FREE_POSE)
        fprintf(page, ": moved by %.3g mm, turned by %.3g degrees", r->shift_mm,
                r->turn_rad * 57.29577951308232);
    fprintf(page,
            ". Loss %.3g, at the start %.3g. What is left is %.3g rms, of which noise is %.3g. %" PRId64
            " images, %.3g s.</p>\n",
            r->loss, r->loss_start, r->residual, r->noise, r->images, r->seconds);
}

int register_write_page(const register_work *work, const char *path) {
    char *text = NULL;
    size_t size = 0;
    const register_body *body = &work->bodies[work->body_count - 1];
    FILE *page = open_memstream(&text, &size);
    if (!page) return cli_error(CLI_DEVICE, "out of host memory for the page");
    fputs(head, page);
    fputs("<p id=\"verdict\">", page);
    cli_html_text(body->verdict, page);
    fputs("</p>\n", page);
    put_numbers(page, work, body);
    int exit_status = put_views(page, work);
    put_freedoms(page, body);
    put_path(page, work);
    fputs(
        "<p><small>Made by skiagraph.</small></p>\n<script>\"use strict\";for(const f of document.querySelectorAll(\"figure\")){const "
        "s=f.querySelector(\".stack\");if(!s)continue;f.querySelector(\"[type=range]\").oninput=e=>s.style.setProperty(\"--at\","
        "e.target.value+\"%\");f.querySelector(\"[type=checkbox]\").onchange=e=>s.querySelector(\".contour\").style.visibility="
        "e.target.checked?\"\":\"hidden\"}</script></body></html>\n",
        page);
    if (fclose(page) != 0 && exit_status == CLI_DONE)
        exit_status = cli_error(CLI_DEVICE, "out of host memory for the page");
    if (exit_status == CLI_DONE) exit_status = cli_write_file(path, text, size);
    free(text);
    return exit_status;
}
