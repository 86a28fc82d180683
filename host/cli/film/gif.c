/* Films as GIF, by giflib. */
#include "common/say.h"
#include "film/palette.h"
#include "film/writer.h"

#include <errno.h>
#include <gif_lib.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LARGEST_SIDE = 65535, LONGEST_DELAY = 65535, FPS_MAX = 50, COMMENT_BYTES = 255 };

typedef struct {
    GifFileType *gif;
    GifPixelType *row; /* numbers of colours */
    /* In colour, all frames are kept in a file without a name until the palette is chosen. */
    FILE *frames;
    palette *palette;
    unsigned char *pixels;
} reel_state;

static const char *const extensions[] = {".gif", NULL};

/* Viewers show frames of less than 2/100 s slower. */
static int check(const char *path, double fps) {
    if (fps <= FPS_MAX && 100 / fps <= LONGEST_DELAY) return CLI_DONE;
    return cli_error(
        CLI_USAGE,
        "%s: a GIF has 0.002 to %d frames per second, not %g; choose another --fps, or write a .mp4", path,
        FPS_MAX, fps);
}

static int fail(const film_reel *reel, int error) {
    const char *reason = reel->file.reason ? strerror(reel->file.reason) : GifErrorString(error);
    return cli_file_fail(reel->file.path, reason ? reason : "giflib gave no reason");
}

static int fail_memory(const film_reel *reel) {
    return cli_error(CLI_DEVICE, "out of host memory for %s", reel->file.path);
}

static int write_bytes(GifFileType *gif, const GifByteType *bytes, int count) {
    film_reel *reel = gif->UserData;
    return cli_file_write(&reel->file, bytes, (size_t)count) ? count : 0;
}

/* Tells viewers to repeat the film for ever, and programs what made it. */
static int put_texts(GifFileType *gif, const char *comment) {
    static const GifByteType forever[] = {1, 0, 0};
    char text[COMMENT_BYTES + 1];
    snprintf(text, sizeof text, "%s", comment);
    if (EGifPutExtensionLeader(gif, APPLICATION_EXT_FUNC_CODE) == GIF_ERROR ||
        EGifPutExtensionBlock(gif, 11, "NETSCAPE2.0") == GIF_ERROR ||
        EGifPutExtensionBlock(gif, sizeof forever, forever) == GIF_ERROR ||
        EGifPutExtensionTrailer(gif) == GIF_ERROR)
        return GIF_ERROR;
    return EGifPutComment(gif, text);
}

static int begin_file(film_reel *reel, const unsigned char colours[PALETTE_COLOURS][3]) {
    reel_state *state = reel->state;
    int error = 0, done = GIF_ERROR;
    ColorMapObject *map = GifMakeMapObject(PALETTE_COLOURS, NULL);
    if (!map) return fail_memory(reel);
    for (int c = 0; c < PALETTE_COLOURS; c++)
        map->Colors[c] = (GifColorType){colours[c][0], colours[c][1], colours[c][2]};
    state->gif = EGifOpen(reel, write_bytes, &error);
    if (state->gif) {
        EGifSetGifVersion(state->gif, true);
        done = EGifPutScreenDesc(state->gif, (int)reel->format.columns, (int)reel->format.rows, 8, 0, map);
        if (done == GIF_OK) done = put_texts(state->gif, reel->format.comment);
        error = state->gif->Error;
    }
    GifFreeMapObject(map);
    return done == GIF_OK ? CLI_DONE : fail(reel, error);
}

static int open_film(film_reel *reel) {
    const film_format *format = &reel->format;
    if (format->columns > LARGEST_SIDE || format->rows > LARGEST_SIDE)
        return cli_error(CLI_USAGE, "%s: a GIF has at most %d columns and rows; write a .mp4",
                         reel->file.path, LARGEST_SIDE);
    reel_state *state = reel->state = calloc(1, sizeof *state);
    if (!state) return fail_memory(reel);
    state->row = malloc((size_t)format->columns);
    if (!state->row) return fail_memory(reel);
    if (format->channels == 1) {
        unsigned char greys[PALETTE_COLOURS][3];
        for (int g = 0; g < PALETTE_COLOURS; g++) greys[g][0] = greys[g][1] = greys[g][2] = (unsigned char)g;
        return begin_file(reel, greys);
    }
    state->palette = palette_create();
    state->pixels = malloc((size_t)(format->columns * format->rows * format->channels));
    if (!state->palette || !state->pixels) return fail_memory(reel);
    state->frames = tmpfile();
    return state->frames ? CLI_DONE : cli_file_fail("temporary file of frames", strerror(errno));
}

/* From the time of this frame to that of the next, both rounded to 1/100 s, so that the film lasts as long as it should. */
static int delay_of(const film_reel *reel, int64_t frame) {
    return (int)(lround(100 * (double)(frame + 1) / reel->format.fps) -
                 lround(100 * (double)frame / reel->format.fps));
}

static int put_frame(film_reel *reel, int64_t frame, const unsigned char *pixels) {
    reel_state *state = reel->state;
    const film_format *format = &reel->format;
    const GraphicsControlBlock control = {.DisposalMode = DISPOSE_DO_NOT,
                                          .DelayTime = delay_of(reel, frame),
                                          .TransparentColor = NO_TRANSPARENT_COLOR};
    GifByteType bytes[4];
    const size_t count = EGifGCBToExtension(&control, bytes);
    int done = EGifPutExtension(state->gif, GRAPHICS_EXT_FUNC_CODE, (int)count, bytes);
    if (done == GIF_OK)
        done = EGifPutImageDesc(state->gif, 0, 0, (int)format->columns, (int)format->rows, false, NULL);
    for (int64_t r = 0; r < format->rows && done == GIF_OK; r++) {
        for (int64_t c = 0; c < format->columns; c++, pixels += format->channels)
            state->row[c] = state->palette ? palette_index(state->palette, pixels) : *pixels;
        done = EGifPutLine(state->gif, state->row, (int)format->columns);
    }
    return done == GIF_OK ? CLI_DONE : fail(reel, state->gif->Error);
}

static int add(film_reel *reel, const unsigned char *pixels) {
    reel_state *state = reel->state;
    const int64_t count = reel->format.columns * reel->format.rows;
    if (!state->palette) return put_frame(reel, reel->frames, pixels);
    palette_count(state->palette, pixels, count);
    errno = 0;
    if (fwrite(pixels, 4, (size_t)count, state->frames) == (size_t)count) return CLI_DONE;
    return cli_file_fail("temporary file of frames", strerror(errno ? errno : EIO));
}

/* The frames in colour, with the palette of all of them. */
static int put_kept(film_reel *reel) {
    reel_state *state = reel->state;
    const size_t count = (size_t)(reel->format.columns * reel->format.rows);
    unsigned char colours[PALETTE_COLOURS][3];
    if (!palette_choose(state->palette, colours)) return fail_memory(reel);
    int exit_status = begin_file(reel, colours);
    rewind(state->frames);
    for (int64_t f = 0; f < reel->frames && exit_status == CLI_DONE; f++)
        exit_status = fread(state->pixels, 4, count, state->frames) == count
                          ? put_frame(reel, f, state->pixels)
                          : cli_file_fail("temporary file of frames", "it cannot be read again");
    return exit_status;
}

static int finish(film_reel *reel) {
    reel_state *state = reel->state;
    int error = 0, exit_status = state->palette ? put_kept(reel) : CLI_DONE;
    if (exit_status != CLI_DONE) return exit_status;
    const int done = EGifCloseFile(state->gif, &error);
    state->gif = NULL;
    return done == GIF_OK ? CLI_DONE : fail(reel, error);
}

static void release(film_reel *reel) {
    reel_state *state = reel->state;
    if (!state) return;
    if (state->gif) EGifCloseFile(state->gif, NULL);
    if (state->frames) fclose(state->frames);
    palette_free(state->palette);
    free(state->pixels);
    free(state->row);
    free(state);
    reel->state = NULL;
}

const film_writer film_gif = {extensions, check, open_film, add, finish, release};
