/* The verb breathe: a breathing scene as frames, a film, one picture or meshes. */
#include "verbs/verbs.h"

#include "breathe/outputs.h"
#include "common/encode.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/made.h"
#include "common/progress.h"
#include "common/say.h"
#include "common/values.h"
#include "film/film.h"
#include "session/explain.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { FRAMES_MAX = 1000000, RANGE_FRAMES = 16, RANGE_BINS = 4096 };
static const double RANGE_HIGHEST = 32; /* -ln(I/I0) */

static int read_positive(const cli_arguments *arguments, const char *flag, double *number) {
    const char *value = cli_value(arguments, flag);
    char *end = NULL;
    if (!value) return CLI_DONE;
    *number = strtod(value, &end);
    if (end == value || *end || !isfinite(*number) || !(*number > 0))
        return cli_error(CLI_USAGE, "%s %s is not a number above 0", flag, value);
    return CLI_DONE;
}

static int is_one(const sequence *s) {
    return !isnan(s->phase) || !isnan(s->at);
}

static int is_film(const sequence *s) {
    return !is_one(s) && film_is(s->place);
}

/* Whether the frames become files in a folder. */
static int has_folder(const sequence *s) {
    return !is_one(s) && !film_is(s->place);
}

static int read_moment(const cli_arguments *arguments, const char *flag, double *number) {
    const char *value = cli_value(arguments, flag);
    char *end = NULL;
    *number = (double)NAN;
    if (!value) return CLI_DONE;
    *number = strtod(value, &end);
    if (end == value || *end || !isfinite(*number))
        return cli_error(CLI_USAGE, "%s %s is not a number", flag, value);
    return CLI_DONE;
}

static int read_flags(const cli_arguments *arguments, fluoroscopy *f, sequence *s) {
    *s = (sequence){.fps = 30};
    s->place = cli_value(arguments, "-o");
    s->meshes = cli_value(arguments, "--meshes");
    if (s->meshes) cli_guard_output(s->meshes);
    if (!s->place) return cli_error(CLI_USAGE, "breathe: no output is named; add -o DIR or -o FILE.mp4");
    int exit_status = read_positive(arguments, "--seconds", &s->seconds);
    if (exit_status == CLI_DONE) exit_status = read_positive(arguments, "--fps", &s->fps);
    if (exit_status == CLI_DONE) exit_status = cli_range(arguments, "--range", &f->low, &f->high);
    const char *phase = cli_value(arguments, "--phase");
    s->phase = (double)NAN;
    if (exit_status == CLI_DONE && phase) exit_status = cli_phase("--phase", phase, &s->phase);
    if (exit_status == CLI_DONE) exit_status = read_moment(arguments, "--at", &s->at);
    if (exit_status == CLI_DONE && is_film(s)) return film_check(s->place, s->fps);
    if (exit_status != CLI_DONE || !is_one(s)) return exit_status;
    if (!isnan(s->phase) && !isnan(s->at))
        return cli_error(CLI_USAGE, "--phase and --at both choose one picture; give one of them");
    if (film_is(s->place))
        return cli_error(CLI_USAGE,
                         "%s: %s makes one picture; name a .png, .tif or .mha, or leave %s out for a film",
                         s->place, isnan(s->at) ? "--phase" : "--at", isnan(s->at) ? "--phase" : "--at");
    skg_status status = skg_picture_path_check(s->place);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int make_image(fluoroscopy *f, int which) {
    skg_job *job = NULL;
    int exit_status = fluoroscopy_start_image(f, which, &job);
    return exit_status == CLI_DONE ? fluoroscopy_wait_image(f, &job) : exit_status;
}

/* One range for all frames, from frames that are spread over the whole time. Of the pixels behind a part, the
 * least dense 2 % and the densest 0.1 % lie outside the range. */
static int find_range(fluoroscopy *f, const sequence *s) {
    int64_t *bin = calloc(RANGE_BINS, sizeof *bin), total = 0, sum = 0;
    const int64_t looks = s->frames < RANGE_FRAMES ? s->frames : RANGE_FRAMES;
    int exit_status = bin ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
    cli_progress_begin("looking for the range of grey, frames", looks);
    for (int64_t k = 0; k < looks && exit_status == CLI_DONE; k++) {
        exit_status = sequence_pose(f, s, k * s->frames / looks);
        if (exit_status == CLI_DONE) exit_status = make_image(f, 0);
        for (int64_t i = 0; i < f->pixels && exit_status == CLI_DONE; i++) {
            const double at = (double)f->image[0][i] / RANGE_HIGHEST * RANGE_BINS;
            if (at < 1) continue; /* behind no part */
            bin[at < RANGE_BINS ? (int)at : RANGE_BINS - 1]++;
            total++;
        }
        cli_progress_step(k + 1);
    }
    cli_progress_end();
    f->low = 0, f->high = RANGE_HIGHEST;
    for (int b = 0; b < RANGE_BINS && exit_status == CLI_DONE; b++) {
        if (sum <= total / 50) f->low = b * RANGE_HIGHEST / RANGE_BINS;
        if (sum <= total - total / 1000) f->high = (b + 1) * RANGE_HIGHEST / RANGE_BINS;
        sum += bin[b];
    }
    free(bin);
    return exit_status;
}

/* Times the sequence without writing: while the device makes an image, the next pose is computed, and given to it before that image is
 * waited for. */
static int run_sequence(fluoroscopy *f, sequence *s) {
    skg_job *jobs[2] = {NULL, NULL};
    const double start = cli_now_ms();
    int exit_status = CLI_DONE;
    s->pose_ms = 0;
    cli_progress_begin("timing without writing, frames", s->frames);
    for (int64_t i = 0; i < s->frames && exit_status == CLI_DONE; i++) {
        const double posing = cli_now_ms();
        exit_status = sequence_pose(f, s, i);
        s->pose_ms += cli_now_ms() - posing;
        if (exit_status == CLI_DONE) exit_status = fluoroscopy_start_image(f, (int)(i % 2), &jobs[i % 2]);
        if (exit_status == CLI_DONE && i > 0) exit_status = fluoroscopy_wait_image(f, &jobs[(i + 1) % 2]);
        cli_progress_step(i);
    }
    for (int k = 0; k < 2; k++) {
        const int waited = jobs[k] ? fluoroscopy_wait_image(f, &jobs[k]) : CLI_DONE;
        if (exit_status == CLI_DONE) exit_status = waited;
    }
    s->sequence_ms = cli_now_ms() - start;
    cli_progress_end();
    return exit_status;
}

/* Computes one frame and writes its files. */
static int write_frame(fluoroscopy *f, const sequence *s, int64_t i, motion_table *table,
                       contact_sheet *sheet) {
    skg_job *job = NULL;
    char *path = cli_path_in(s->place, "frame-%04" PRId64 ".png", i);
    int exit_status = path ? sequence_pose(f, s, i) : cli_error(CLI_DEVICE, "out of host memory");
    if (exit_status == CLI_DONE) exit_status = fluoroscopy_start_image(f, 0, &job);
    if (exit_status == CLI_DONE) exit_status = table_add(f, (double)i / s->fps, table);
    if (exit_status == CLI_DONE && s->meshes) exit_status = meshes_write(f, s->meshes, i);
    if (job) {
        int waited = fluoroscopy_wait_image(f, &job);
        if (exit_status == CLI_DONE) exit_status = waited;
    }
    if (exit_status == CLI_DONE) fluoroscopy_hold(f, 0);
    if (exit_status == CLI_DONE) cli_made(path);
    if (exit_status == CLI_DONE) exit_status = fluoroscopy_write(f, 0, path);
    if (exit_status == CLI_DONE) sheet_add(f, 0, i, s->frames, sheet);
    free(path);
    return exit_status;
}

static int write_sequence(fluoroscopy *f, const sequence *s) {
    motion_table table = {0};
    contact_sheet sheet = {0};
    char *motion = cli_path_in(s->place, "motion.csv"), *contact = cli_path_in(s->place, "contact.png");
    int exit_status = motion && contact ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
    if (exit_status == CLI_DONE) exit_status = table_open(motion, &table);
    if (exit_status == CLI_DONE) exit_status = sheet_create(f, s->frames, &sheet);
    if (exit_status == CLI_DONE) cli_made(motion), cli_made(contact);
    cli_progress_begin("writing, frames", s->frames);
    for (int64_t i = 0; i < s->frames && exit_status == CLI_DONE; i++) {
        exit_status = write_frame(f, s, i, &table, &sheet);
        if (exit_status != CLI_DONE) break;
        table_keep(&table);
        cli_keep("%" PRId64 " of %" PRId64 " frames are in %s, with their lines in motion.csv", i + 1,
                 s->frames, s->place);
        cli_progress_step(i + 1);
    }
    cli_progress_end();
    const int closed = table_close(&table, exit_status == CLI_DONE);
    if (exit_status == CLI_DONE) exit_status = closed;
    if (exit_status == CLI_DONE) exit_status = sheet_write(f, &sheet, contact);
    free(sheet.values);
    free(motion);
    free(contact);
    return exit_status;
}

static int print(const cli_arguments *arguments, const fluoroscopy *f, const sequence *s) {
    const double rate = 1e3 * (double)s->frames / s->sequence_ms;
    const double range[2] = {f->low, f->high};
    if (cli_given(arguments, "--json")) {
        json_t *object = json_object();
        json_object_set_new(object, "frames", json_integer(s->frames));
        json_object_set_new(object, "frames_per_s", cli_json_number(rate));
        json_object_set_new(object, "frame_ms", cli_json_number(s->sequence_ms / (double)s->frames));
        json_object_set_new(object, "pose_ms", cli_json_number(s->pose_ms / (double)s->frames));
        json_object_set_new(object, "plan_ms", cli_json_number(s->plan_ms));
        json_object_set_new(object, "range", cli_json_numbers(range, 2));
        if (is_film(s)) json_object_set_new(object, "file", json_string(s->place));
        if (!is_one(s)) json_object_set_new(object, "dose", film_dose_json(s->dose));
        json_object_set_new(object, "plan", cli_explain_json(f->plan, &f->session));
        return cli_json_print(object);
    }
    if (cli_is_quiet()) return CLI_DONE;
    if (is_one(s)) {
        cli_print("%s %.6g%s; wrote %s\n", isnan(s->at) ? "phase" : "at", isnan(s->at) ? s->phase : s->at,
                  isnan(s->at) ? "" : " s", s->place);
        return CLI_DONE;
    }
    printf("%" PRId64
           " frames of %g s: %.1f frames/s without writing, %.2f ms a frame; a pose takes %.2f ms of it, "
           "overlapped\nwith the image; -ln(I/I0) is shown from %.3g to %.3g\n",
           s->frames, (double)s->frames / s->fps, rate, s->sequence_ms / (double)s->frames,
           s->pose_ms / (double)s->frames, f->low, f->high);
    film_dose_print(s->dose);
    if (is_film(s)) {
        cli_print("wrote %s: %" PRId64 " frames, %g per second\n", s->place, s->frames, s->fps);
        return CLI_DONE;
    }
    cli_print("wrote %s/frame-0000.png to frame-%04" PRId64 ".png, contact.png, motion.csv\n", s->place,
              s->frames - 1);
    return CLI_DONE;
}

static int prepare(const cli_arguments *arguments, fluoroscopy *f, sequence *s) {
    const char *outline = cli_value(arguments, "--outline");
    double period = 0;
    int exit_status = cli_open_session(arguments, 0, &f->session);
    if (exit_status == CLI_DONE) exit_status = cli_refuse_counting(&f->session, "breathe");
    if (exit_status != CLI_DONE) return exit_status;
    f->session.options.quantity = SKG_QUANTITY_ATTENUATION;
    skg_status status = skg_motion_create(f->session.context, f->session.setup, &f->motion);
    if (status == SKG_OK) status = skg_motion_period_get(f->motion, &period);
    if (status != SKG_OK) return cli_fail(status);
    if (!(s->seconds > 0)) s->seconds = period;
    const double frames = is_one(s) ? 1 : fmax(1, floor(s->seconds * s->fps + 0.5));
    if (frames > FRAMES_MAX)
        return cli_error(CLI_USAGE, "%g frames are too many; %d at most", frames, FRAMES_MAX);
    s->frames = (int64_t)frames;
    f->pixels = f->session.view.columns * f->session.view.rows;
    for (int i = 0; i < 2; i++) f->image[i] = calloc((size_t)f->pixels, sizeof(float));
    if (!f->image[0] || !f->image[1]) return cli_error(CLI_DEVICE, "out of host memory for the images");
    exit_status = cli_make_plan(&f->session, &f->plan, &s->plan_ms);
    if (exit_status == CLI_DONE && outline) exit_status = outline_find(f, outline);
    if (exit_status == CLI_DONE && !is_one(s)) exit_status = fluoroscopy_open_lag(f);
    if (exit_status == CLI_DONE && !is_one(s) && (status = film_dose(f, s->frames, &s->dose)) != SKG_OK)
        exit_status = cli_fail(status);
    return exit_status;
}

/* Nothing beside the scene is overwritten that this command did not write. */
static int check_files(const cli_arguments *arguments, const sequence *s) {
    int exit_status = CLI_DONE;
    for (int64_t i = -2; i < s->frames && exit_status == CLI_DONE; i++) {
        char *path = i < 0 ? cli_path_in(s->place, "%s", i == -2 ? "motion.csv" : "contact.png")
                           : cli_path_in(s->place, "frame-%04" PRId64 ".png", i);
        exit_status =
            path ? cli_check_overwrite(arguments, path) : cli_error(CLI_DEVICE, "out of host memory");
        free(path);
    }
    return exit_status;
}

static int work(const cli_arguments *arguments, fluoroscopy *f, sequence *s) {
    int exit_status = read_flags(arguments, f, s);
    if (exit_status == CLI_DONE && has_folder(s)) exit_status = cli_make_folder(s->place);
    if (exit_status == CLI_DONE && s->meshes) exit_status = cli_make_folder(s->meshes);
    if (exit_status == CLI_DONE) exit_status = prepare(arguments, f, s);
    if (exit_status == CLI_DONE && has_folder(s)) exit_status = check_files(arguments, s);
    if (exit_status == CLI_DONE && f->low == 0 && f->high == 0) exit_status = find_range(f, s);
    if (exit_status == CLI_DONE) exit_status = run_sequence(f, s);
    if (exit_status != CLI_DONE) return exit_status;
    if (is_film(s)) {
        exit_status = write_film(f, s);
    } else if (!is_one(s)) {
        exit_status = write_sequence(f, s);
    } else {
        if (s->meshes) exit_status = meshes_write(f, s->meshes, 0);
        if (exit_status == CLI_DONE) exit_status = fluoroscopy_write(f, 0, s->place);
    }
    return exit_status == CLI_DONE ? print(arguments, f, s) : exit_status;
}

int cli_breathe(const cli_arguments *arguments) {
    fluoroscopy f = {.arguments = arguments};
    sequence s = {.dose = NULL};
    int exit_status = work(arguments, &f, &s);
    for (int i = 0; i < 2; i++) free(f.image[i]);
    free(f.outline);
    skg_lag_release(&f.lag);
    skg_dose_release(&s.dose);
    skg_plan_release(&f.plan);
    skg_motion_release(&f.motion);
    cli_close_session(&f.session);
    return exit_status;
}
