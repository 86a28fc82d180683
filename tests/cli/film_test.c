/* Films: what is in a GIF, and how ffmpeg is called, which scripts play here. */
#include "cli/command.h"
#include "cli/scene.h"

#include "film/film.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#if SKG_HAS_GIF
#include <gif_lib.h>
#endif

enum { COLUMNS = 37, ROWS = 23, PIXELS = COLUMNS * ROWS, FRAMES = 7, BYTES_MAX = 1 << 20 };

static char start_path[4096];

/* The test works in its folder, where ./ comes first on PATH. What the film's code prints goes to `complained`. */
static void set_up_films(void) {
    char path[4200];
    set_up();
    ck_assert_int_eq(chdir(folder), 0);
    snprintf(start_path, sizeof start_path, "%s", getenv("PATH"));
    snprintf(path, sizeof path, "%s:%s", folder, start_path);
    ck_assert_int_eq(setenv("PATH", path, 1), 0);
    ck_assert_ptr_nonnull(freopen(".heard", "w", stderr));
    setvbuf(stderr, NULL, _IONBF, 0);
}

static void heard(void) {
    FILE *stream = fopen(".heard", "rb");
    ck_assert_ptr_nonnull(stream);
    complained[fread(complained, 1, sizeof complained - 1, stream)] = '\0';
    fclose(stream);
}

#define ck_heard(text)                                                                                       \
    do {                                                                                                     \
        heard();                                                                                             \
        ck_assert_msg(strstr(complained, (text)) != NULL, "\"%s\" does not say \"%s\"", complained, (text)); \
        ck_assert_msg(strchr(complained, '\n') == complained + strlen(complained) - 1,                       \
                      "not one line: \"%s\"", complained);                                                   \
    } while (0)

/* A grey of its own for each place and frame; all 256 appear. */
static unsigned char grey_at(int frame, int64_t pixel) {
    return (unsigned char)(pixel * 11 + 50 * frame);
}

static int add_greys(film *opened, int frame) {
    unsigned char pixels[PIXELS];
    for (int i = 0; i < PIXELS; i++) pixels[i] = grey_at(frame, i);
    return film_add(opened, pixels);
}

static film *open_greys(const char *path, double fps) {
    const film_format format = {COLUMNS, ROWS, 1, fps, "skiagraph: a test"};
    film *opened = NULL;
    ck_assert_int_eq(film_open(path, &format, &opened), 0);
    return opened;
}

static int write_greys(const char *path, double fps) {
    film *opened = open_greys(path, fps);
    int exit_status = 0;
    for (int f = 0; f < FRAMES && exit_status == 0; f++) exit_status = add_greys(opened, f);
    if (exit_status == 0) return film_finish(&opened);
    film_discard(&opened);
    return exit_status;
}

/* A file of this name, a program if it is "ffmpeg", and .heard: nothing unfinished. */
static void ck_only(const char *name) {
    DIR *directory = opendir(".");
    for (struct dirent *entry; (entry = readdir(directory));)
        ck_assert_msg(entry->d_name[0] == '.' || strcmp(entry->d_name, "ffmpeg") == 0 ||
                          (name && strcmp(entry->d_name, name) == 0),
                      "%s was left", entry->d_name);
    closedir(directory);
    if (name) ck_assert(has_file(name));
}

#if SKG_HAS_GIF

static GifFileType *read_gif(const char *path, int columns, int rows, int frames) {
    int error = 0;
    GifFileType *gif = DGifOpenFileName(path, &error);
    ck_assert_msg(gif && DGifSlurp(gif) == GIF_OK, "%s cannot be read: %d", path, error);
    ck_assert_int_eq(gif->SWidth, columns);
    ck_assert_int_eq(gif->SHeight, rows);
    ck_assert_int_eq(gif->ImageCount, frames);
    return gif;
}

static const GifColorType *colour_at(const GifFileType *gif, int frame, int64_t pixel) {
    const SavedImage *image = gif->SavedImages + frame;
    ck_assert(image->ImageDesc.Left == 0 && image->ImageDesc.Top == 0 && !image->ImageDesc.ColorMap);
    ck_assert(image->ImageDesc.Width == gif->SWidth && image->ImageDesc.Height == gif->SHeight);
    return gif->SColorMap->Colors + image->RasterBits[pixel];
}

START_TEST(greys_of_a_gif_are_exact) {
    ck_assert_int_eq(write_greys("a.gif", 30), 0);
    GifFileType *gif = read_gif("a.gif", COLUMNS, ROWS, FRAMES);
    for (int f = 0; f < FRAMES; f++)
        for (int i = 0; i < PIXELS; i++) {
            const GifColorType *colour = colour_at(gif, f, i);
            ck_assert_int_eq(colour->Red, grey_at(f, i));
            ck_assert(colour->Green == colour->Red && colour->Blue == colour->Red);
        }
    ck_assert_int_eq(DGifCloseFile(gif, NULL), GIF_OK);
    ck_only("a.gif");
}
END_TEST

/* Each frame begins at its time to within half of 1/100 s, so that nothing adds up. */
START_TEST(a_gif_lasts_as_long_as_it_should) {
    static const double rates[] = {30, 7, 12.5, 50, 0.4};
    const double fps = rates[_i];
    int64_t at = 0;
    ck_assert_int_eq(write_greys("a.gif", fps), 0);
    GifFileType *gif = read_gif("a.gif", COLUMNS, ROWS, FRAMES);
    for (int f = 0; f < FRAMES; f++) {
        GraphicsControlBlock control;
        ck_assert_int_eq(DGifSavedExtensionToGCB(gif, f, &control), GIF_OK);
        ck_assert_int_eq(control.TransparentColor, NO_TRANSPARENT_COLOR);
        at += control.DelayTime;
        ck_assert_double_le(fabs((double)at - 100 * (f + 1) / fps), 0.5); /* half of the step of 1/100 s */
    }
    ck_assert_int_eq(DGifCloseFile(gif, NULL), GIF_OK);
}
END_TEST

START_TEST(a_gif_repeats_and_names_its_program) {
    ck_assert_int_eq(write_greys("a.gif", 10), 0);
    GifFileType *gif = read_gif("a.gif", COLUMNS, ROWS, FRAMES);
    const ExtensionBlock *block = gif->SavedImages[0].ExtensionBlocks;
    int repeats = 0, names = 0;
    for (int b = 0; b < gif->SavedImages[0].ExtensionBlockCount; b++, block++) {
        if (b > 0 && block[-1].ByteCount == 11 && memcmp(block[-1].Bytes, "NETSCAPE2.0", 11) == 0)
            repeats = block->ByteCount == 3 && memcmp(block->Bytes, "\1\0\0", 3) == 0;
        names |=
            block->Function == COMMENT_EXT_FUNC_CODE && memcmp(block->Bytes, "skiagraph: a test", 17) == 0;
    }
    ck_assert(repeats && names);
    ck_assert_int_eq(DGifCloseFile(gif, NULL), GIF_OK);
}
END_TEST

/* 250 colours, far apart and close together: a palette can hold them. */
static void few_colours(int frame, unsigned char *pixels) {
    for (int i = 0; i < PIXELS; i++) {
        const int which = (i + 31 * frame) % 250;
        const unsigned char colour[4] = {(unsigned char)which, (unsigned char)(which * 37), 200,
                                         (unsigned char)i};
        memcpy(pixels + 4 * i, colour, 4);
    }
}

START_TEST(few_colours_of_a_gif_are_exact) {
    const film_format format = {COLUMNS, ROWS, 4, 25, "skiagraph"};
    unsigned char pixels[4 * PIXELS];
    film *opened = NULL;
    ck_assert_int_eq(film_open("a.gif", &format, &opened), 0);
    for (int f = 0; f < FRAMES; f++) {
        few_colours(f, pixels);
        ck_assert_int_eq(film_add(opened, pixels), 0);
    }
    ck_assert_int_eq(film_finish(&opened), 0);
    GifFileType *gif = read_gif("a.gif", COLUMNS, ROWS, FRAMES);
    for (int f = 0; f < FRAMES; f++) {
        few_colours(f, pixels);
        for (int i = 0; i < PIXELS; i++) {
            const GifColorType *colour = colour_at(gif, f, i);
            ck_assert(colour->Red == pixels[4 * i] && colour->Green == pixels[4 * i + 1] &&
                      colour->Blue == pixels[4 * i + 2]);
        }
    }
    ck_assert_int_eq(DGifCloseFile(gif, NULL), GIF_OK);
    ck_only("a.gif");
}
END_TEST

/* Every red with every green: 65536 colours on a plane. */
START_TEST(many_colours_of_a_gif_come_near) {
    enum { SIDE = 256 };
    const film_format format = {SIDE, SIDE, 4, 25, "skiagraph"};
    unsigned char *pixels = malloc(4 * SIDE * SIDE);
    film *opened = NULL;
    double squares = 0;
    ck_assert_int_eq(film_open("a.gif", &format, &opened), 0);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const unsigned char colour[4] = {(unsigned char)(i % SIDE), (unsigned char)(i / SIDE), 90, 255};
        memcpy(pixels + 4 * i, colour, 4);
    }
    ck_assert_int_eq(film_add(opened, pixels), 0);
    ck_assert_int_eq(film_finish(&opened), 0);
    GifFileType *gif = read_gif("a.gif", SIDE, SIDE, 1);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const GifColorType *colour = colour_at(gif, 0, i);
        ck_assert_int_eq(colour->Blue, 90);
        squares += (colour->Red - i % SIDE) * (colour->Red - i % SIDE) +
                   (colour->Green - i / SIDE) * (colour->Green - i / SIDE);
    }
    /* 16 x 16 squares of 16 levels, each shown as its centre, miss by 16 sqrt(2 / 12) in the mean of squares. */
    ck_assert_double_lt(sqrt(squares / (SIDE * SIDE)), 1.05 * 16 * sqrt(2. / 12));
    ck_assert_int_eq(DGifCloseFile(gif, NULL), GIF_OK);
    free(pixels);
}
END_TEST

START_TEST(rates_that_a_gif_does_not_have_are_refused) {
    ck_assert_int_eq(film_check("a.gif", 50), 0);
    ck_assert_int_eq(film_check("a.gif", 0.002), 0);
    ck_assert_int_eq(film_check("a.gif", 60), 2);
    ck_heard("a.gif: a GIF has 0.002 to 50 frames per second, not 60");
    ck_assert_int_eq(film_check("a.gif", 0.001), 2);
}
END_TEST

/* The disk is full from some byte on. */
START_TEST(a_gif_that_cannot_be_written_leaves_nothing) {
    const struct rlimit limit = {2000, 2000};
    signal(SIGXFSZ, SIG_IGN);
    ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &limit), 0);
    ck_assert_int_eq(write_greys("a.gif", 30), 5);
    ck_heard("a.gif: cannot be written: File too large");
    ck_only(NULL);
}
END_TEST

/* The frames of `breathe` are those of its pictures. */
START_TEST(breathe_writes_a_film) {
    enum { SIDE = 40 };
    static char bytes[BYTES_MAX];
    static float values[SIDE * SIDE];
    ck_run(0, "thorax -o . --simple --triangles 10000 --quiet");
    ck_run(
        0,
        "breathe thorax.json --set Detector.NumberOfPixels=[40,40] --set Breathing=null --fps 1 --range 0:8 -o a.gif --json");
    json_t *object = said_json();
    ck_assert_int_eq(json_integer_value(member(object, "frames")), 4);
    ck_assert_str_eq(json_string_value(member(object, "file")), "a.gif");
    json_decref(object);
    GifFileType *gif = read_gif("a.gif", SIDE, SIDE, 4);
    ck_run(
        0,
        "breathe thorax.json --set Detector.NumberOfPixels=[40,40] --set Breathing=null --at 3 --range 0:8 -o a.mha --quiet");
    FILE *stream = fopen("a.mha", "rb");
    const size_t count = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    memcpy(values, bytes + count - sizeof values, sizeof values);
    for (int i = 0; i < SIDE * SIDE; i++)
        ck_assert_int_eq(colour_at(gif, 3, i)->Red, lround(fmin((double)values[i] / 8, 1) * 255));
    ck_assert_int_eq(DGifCloseFile(gif, NULL), GIF_OK);
    ck_run(
        0,
        "breathe thorax.json --set Detector.NumberOfPixels=[40,40] --fps 1 --range 0:8 -o a.gif"); /* its own is replaced */
    ck_assert_ptr_nonnull(strstr(said, "is shown from 0 to 8\nwrote a.gif: 4 frames, 1 per second\n"));
    ck_assert(!has_file("motion.csv") && !has_file("contact.png"));
}
END_TEST

#else

START_TEST(without_giflib_a_gif_is_refused) {
    ck_assert_int_eq(film_check("a.gif", 10), 5);
    ck_heard("a.gif: this build of skiagraph has no giflib; build it with libgif-dev, or write a .mp4");
    ck_only(NULL);
}
END_TEST

#endif

/* ffmpeg's part, played by a script. */
static void play(const char *script) {
    write_text("ffmpeg", script);
    ck_assert_int_eq(chmod("ffmpeg", 0755), 0);
}

static const char copies[] = "#!/bin/sh\n"
                             "printf '%s\\n' \"$@\" >.words\n"
                             "for last; do :; done\n"
                             "cat >\"${last#file:}\"\n";

static void ck_word(const char *before, const char *word) {
    static char words[BYTES_MAX];
    char line[256];
    FILE *stream = fopen(".words", "rb");
    ck_assert_ptr_nonnull(stream);
    words[fread(words, 1, sizeof words - 1, stream)] = '\0';
    fclose(stream);
    snprintf(line, sizeof line, "\n%s\n%s\n", before, word);
    ck_assert_msg(strstr(words, line) != NULL, "no %s %s in %s", before, word, words);
}

/* The frames as they are, but for a last row and a last column that repeat the ones before: 37 x 23 becomes 38 x 24. */
START_TEST(ffmpeg_is_given_the_frames) {
    static unsigned char bytes[BYTES_MAX];
    const char *path = _i == 0 ? "a.mp4" : "-odd: name.WebM";
    play(copies);
    ck_assert_int_eq(film_check(path, 12.5), 0);
    ck_assert_int_eq(write_greys(path, 12.5), 0);
    FILE *stream = fopen(path, "rb");
    ck_assert_uint_eq(fread(bytes, 1, sizeof bytes, stream), (COLUMNS + 1) * (ROWS + 1) * FRAMES);
    fclose(stream);
    for (int f = 0, at = 0; f < FRAMES; f++)
        for (int r = 0; r <= ROWS; r++)
            for (int c = 0; c <= COLUMNS; c++, at++)
                ck_assert_int_eq(bytes[at], grey_at(f, (r < ROWS ? r : ROWS - 1) * COLUMNS +
                                                           (c < COLUMNS ? c : COLUMNS - 1)));
    ck_word("-pixel_format", "gray");
    ck_word("-video_size", "38x24");
    ck_word("-framerate", "12.5");
    ck_word("-c:v", _i == 0 ? "libx264" : "libvpx-vp9");
    ck_word("-f", _i == 0 ? "mp4" : "webm");
    ck_word("-metadata", "comment=skiagraph: a test");
    ck_only(path);
}
END_TEST

START_TEST(ffmpeg_that_fails_is_heard) {
    play("#!/bin/sh\ncat >/dev/null\necho \"Unknown encoder 'libx264'\" >&2\nexit 1\n");
    ck_assert_int_eq(write_greys("a.mp4", 10), 5);
    ck_heard("a.mp4: ffmpeg could not write it (exit status 1): Unknown encoder 'libx264'");
    ck_only(NULL);
    ck_assert_int_eq(waitpid(-1, NULL, WNOHANG), -1); /* no child is left */
}
END_TEST

/* An ffmpeg that dies before it has read all: no SIGPIPE, its reason is said. 400 frames are more than a socket holds. */
START_TEST(ffmpeg_that_dies_is_heard) {
    static const char *const scripts[] = {"#!/bin/sh\nexec 0<&-\nprintf 'no\\nspace\\n' >&2\nexit 3\n",
                                          "#!/bin/sh\nkill -9 $$\n"};
    static const char *const sentences[] = {"a.webm: ffmpeg could not write it (exit status 3): no;space",
                                            "a.webm: ffmpeg was ended by signal 9: it gave no reason"};
    int exit_status = 0;
    play(scripts[_i]);
    film *opened = open_greys("a.webm", 10);
    for (int f = 0; f < 400 && exit_status == 0; f++) exit_status = add_greys(opened, f);
    ck_assert_int_eq(exit_status, 5);
    film_discard(&opened);
    ck_heard(sentences[_i]);
    ck_only(NULL);
    ck_assert_int_eq(waitpid(-1, NULL, WNOHANG), -1);
}
END_TEST

START_TEST(ffmpeg_that_writes_nothing_is_noticed) {
    play("#!/bin/sh\ncat >/dev/null\n");
    ck_assert_int_eq(write_greys("a.mp4", 10), 5);
    ck_heard("a.mp4: ffmpeg ended without an error, but wrote nothing");
    ck_only(NULL);
}
END_TEST

START_TEST(a_film_that_is_left_ends_ffmpeg) {
    play("#!/bin/sh\nexec sleep 1000\n");
    film *opened = open_greys("a.mp4", 10);
    ck_assert_int_eq(add_greys(opened, 0), 0);
    film_discard(&opened);
    ck_assert_int_eq(waitpid(-1, NULL, WNOHANG), -1);
    ck_only(NULL);
}
END_TEST

START_TEST(without_ffmpeg_it_is_asked_for) {
    ck_assert_int_eq(setenv("PATH", folder, 1), 0);
    ck_assert_int_eq(film_check("a.mp4", 10), 5);
    ck_heard(
        "a.mp4: needs the program ffmpeg, which is not on PATH; install it (Debian: apt-get install ffmpeg), or write a .gif");
    ck_only(NULL);
    ck_assert_int_eq(setenv("PATH", start_path, 1), 0);
}
END_TEST

START_TEST(what_cannot_be_is_refused) {
    play(copies);
    write_text("scene.json", scene);
    ck_assert_int_eq(mkdir("b.mp4", 0777), 0);
    ck_run_fails(5, "b.mp4: cannot be written: it is a folder", "breathe scene.json -o b.mp4");
    ck_run_fails(5, "its folder does not exist", "breathe scene.json -o nowhere/a.mp4");
    ck_run_fails(2, "--phase makes one picture", "breathe scene.json -o a.mp4 --phase 0");
    ck_run_fails(2, "--at makes one picture", "breathe scene.json -o a.webm --at 1");
    ck_run_fails(2, "above 0", "breathe scene.json -o a.mp4 --fps 0");
    ck_run_fails(2, ".avi files are not written", "breathe scene.json -o a.avi");
    ck_assert_int_eq(rmdir("b.mp4"), 0);
}
END_TEST

static void wait_for(const char *name) {
    const struct timespec pause = {.tv_nsec = 10000000};
    while (!has_file(name)) nanosleep(&pause, NULL);
}

/* Ctrl-C while ffmpeg, which does not hear it, still reads: neither it nor its file is left. */
START_TEST(an_interrupt_ends_ffmpeg) {
    int status = 0, its = 0;
    play("#!/bin/sh\ntrap '' INT\necho $$ >.process.new\nmv .process.new .process\nexec sleep 1000\n");
    ck_run(0, "thorax -o . --simple --triangles 10000 --quiet");
    fflush(NULL);
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        execl(SKG_COMMAND, "skiagraph", "breathe", "thorax.json", "-o", "a.mp4", "--fps", "10", "--range",
              "0:8", "--quiet", (char *)NULL);
        _exit(127);
    }
    wait_for(".process");
    FILE *stream = fopen(".process", "r");
    ck_assert_int_eq(fscanf(stream, "%d", &its), 1);
    fclose(stream);
    ck_assert_int_eq(kill(its, 0), 0);
    kill(child, SIGINT);
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT);
    ck_assert_int_eq(kill(its, 0), -1);
    heard();
    ck_assert_str_eq(complained, "\nskiagraph: interrupted; no output was written\n");
    ck_assert(!has_file("a.mp4"));
    DIR *directory = opendir(".");
    for (struct dirent *entry; (entry = readdir(directory));)
        ck_assert_ptr_null(strstr(entry->d_name, ".part-"));
    closedir(directory);
}
END_TEST

static void tear_down_films(void) {
    ck_assert_int_eq(chdir("/"), 0);
    tear_down();
}

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_films, tear_down_films);
#if SKG_HAS_GIF
    tcase_add_test(tests, greys_of_a_gif_are_exact);
    tcase_add_loop_test(tests, a_gif_lasts_as_long_as_it_should, 0, 5);
    tcase_add_test(tests, a_gif_repeats_and_names_its_program);
    tcase_add_test(tests, few_colours_of_a_gif_are_exact);
    tcase_add_test(tests, many_colours_of_a_gif_come_near);
    tcase_add_test(tests, rates_that_a_gif_does_not_have_are_refused);
    tcase_add_test(tests, a_gif_that_cannot_be_written_leaves_nothing);
    tcase_add_test(tests, breathe_writes_a_film);
#else
    tcase_add_test(tests, without_giflib_a_gif_is_refused);
#endif
    tcase_add_loop_test(tests, ffmpeg_is_given_the_frames, 0, 2);
    tcase_add_test(tests, ffmpeg_that_fails_is_heard);
    tcase_add_loop_test(tests, ffmpeg_that_dies_is_heard, 0, 2);
    tcase_add_test(tests, ffmpeg_that_writes_nothing_is_noticed);
    tcase_add_test(tests, a_film_that_is_left_ends_ffmpeg);
    tcase_add_test(tests, without_ffmpeg_it_is_asked_for);
    tcase_add_test(tests, what_cannot_be_is_refused);
    tcase_add_test(tests, an_interrupt_ends_ffmpeg);
}

SKG_SUITE_MAIN("film", add_tests)
