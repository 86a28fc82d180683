/* Films by the program ffmpeg, which reads the frames from a pipe. */
#include "common/child.h"
#include "common/say.h"
#include "film/writer.h"

#include <inttypes.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 64, LONGEST_COMPLAINT = 1024 };

typedef struct {
    cli_child child;
    int64_t columns, rows; /* both even */
    unsigned char *pixels; /* a frame of this size */
} encoder;

static const char *const extensions[] = {".mp4", ".webm", NULL};

/* Nearly without visible loss: H.264 at 18 and VP9 at 24 of the scales that their encoders call crf. */
static const char *const mp4_words[] = {"-c:v",      "libx264",    "-preset", "medium", "-crf", "18",
                                        "-movflags", "+faststart", "-f",      "mp4",    NULL};
static const char *const webm_words[] = {"-c:v",    "libvpx-vp9", "-crf", "24",   "-b:v", "0",
                                         "-row-mt", "1",          "-f",   "webm", NULL};

static int check(const char *path, double fps) {
    (void)fps;
    if (cli_has_program("ffmpeg")) return CLI_DONE;
    return cli_error(
        CLI_OUTPUT,
        "%s: needs the program ffmpeg, which is not on PATH; install it (Debian: apt-get install "
        "ffmpeg), or write a .gif",
        path);
}

static int add_words(const char **words, int count, const char *const *more) {
    while (*more) words[count++] = *more++;
    return count;
}

/* Colours are those of ITU-R BT.709, in the limited range that players expect; both are written into the file. */
static int start(film_reel *reel, encoder *e) {
    static const char *const begin[] = {"ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "error",
                                        "-y",     "-f",       "rawvideo",     NULL};
    static const char *const colours[] = {
        "-i",       "pipe:0",     "-an",         "-vf",          "scale=out_color_matrix=bt709:out_range=tv",
        "-pix_fmt", "yuv420p",    "-colorspace", "bt709",        "-color_primaries",
        "bt709",    "-color_trc", "bt709",       "-color_range", "tv",
        NULL};
    const film_format *format = &reel->format;
    const char *words[WORDS_MAX];
    char size[64], rate[32];
    const size_t comment_size = strlen(format->comment) + 16, output_size = strlen(reel->file.temporary) + 8;
    char *comment = malloc(comment_size), *output = malloc(output_size);
    int reason = 0;
    if (!comment || !output) {
        free(comment);
        free(output);
        return cli_error(CLI_DEVICE, "out of host memory for %s", reel->file.path);
    }
    snprintf(size, sizeof size, "%" PRId64 "x%" PRId64, e->columns, e->rows);
    snprintf(rate, sizeof rate, "%.9g", format->fps);
    snprintf(comment, comment_size, "comment=%s", format->comment);
    snprintf(output, output_size, "file:%s",
             reel->file.temporary); /* a name may hold what ffmpeg reads as a protocol */
    int count = add_words(words, 0, begin);
    const char *const input[] = {"-pixel_format",
                                 format->channels == 1 ? "gray" : "rgb0",
                                 "-video_size",
                                 size,
                                 "-framerate",
                                 rate,
                                 NULL};
    const char *const end[] = {"-metadata", comment, output, NULL};
    count = add_words(words, count, input);
    count = add_words(words, count, colours);
    count = add_words(words, count, cli_has_extension(reel->file.path, ".mp4") ? mp4_words : webm_words);
    count = add_words(words, count, end);
    words[count] = NULL;
    reason = cli_child_start(words, &e->child);
    free(comment);
    free(output);
    return reason ? cli_error(CLI_OUTPUT, "%s: the program ffmpeg cannot be started: %s", reel->file.path,
                              strerror(reason))
                  : CLI_DONE;
}

static int open_film(film_reel *reel) {
    const film_format *format = &reel->format;
    encoder *e = reel->state = calloc(1, sizeof *e);
    if (e) {
        e->columns = format->columns + format->columns % 2, e->rows = format->rows + format->rows % 2;
        e->pixels = malloc((size_t)(e->columns * e->rows * format->channels));
    }
    if (!e || !e->pixels) return cli_error(CLI_DEVICE, "out of host memory for %s", reel->file.path);
    return start(reel, e);
}

/* Ends the child and names what went wrong. */
static int end_child(film_reel *reel, encoder *e, int took_all) {
    char said[LONGEST_COMPLAINT];
    const int status = cli_child_end(&e->child, said, sizeof said);
    if (status == 0 && took_all) return CLI_DONE;
    const char *because = *said ? said : "it gave no reason";
    if (status < 0)
        return cli_error(CLI_OUTPUT, "%s: ffmpeg was ended by signal %d: %s", reel->file.path, -status,
                         because);
    return cli_error(CLI_OUTPUT, "%s: ffmpeg could not write it (exit status %d): %s", reel->file.path,
                     status, because);
}

/* Copies a frame and repeats its last column and its last row where the film has one more: the halved colours of H.264 and
 * VP9 need even numbers. */
static const unsigned char *make_even(const film_reel *reel, const encoder *e, const unsigned char *pixels) {
    const film_format *format = &reel->format;
    const size_t pixel = (size_t)format->channels, from = (size_t)format->columns * pixel,
                 to = (size_t)e->columns * pixel;
    if (e->columns == format->columns && e->rows == format->rows) return pixels;
    for (int64_t r = 0; r < e->rows; r++) {
        const unsigned char *row = pixels + (size_t)(r < format->rows ? r : format->rows - 1) * from;
        unsigned char *its = e->pixels + (size_t)r * to;
        memcpy(its, row, from);
        if (to > from) memcpy(its + from, row + from - pixel, pixel);
    }
    return e->pixels;
}

static int add(film_reel *reel, const unsigned char *pixels) {
    encoder *e = reel->state;
    const size_t bytes = (size_t)(e->columns * e->rows * reel->format.channels);
    if (cli_child_feed(&e->child, make_even(reel, e, pixels), bytes)) return CLI_DONE;
    return end_child(reel, e, 0);
}

static int finish(film_reel *reel) {
    const int exit_status = end_child(reel, reel->state, 1);
    if (exit_status != CLI_DONE) return exit_status;
    if (fseek(reel->file.stream, 0, SEEK_END) == 0 && ftell(reel->file.stream) > 0) return CLI_DONE;
    return cli_error(CLI_OUTPUT, "%s: ffmpeg ended without an error, but wrote nothing", reel->file.path);
}

static void release(film_reel *reel) {
    encoder *e = reel->state;
    if (!e) return;
    cli_child_kill(&e->child);
    free(e->pixels);
    free(e);
    reel->state = NULL;
}

const film_writer film_encoded = {extensions, check, open_film, add, finish, release};
