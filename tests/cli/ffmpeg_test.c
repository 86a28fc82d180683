/* Films written by ffmpeg, read by ffmpeg again: needs ffmpeg. */
#include "cli/command.h"

#include "film/film.h"

#include <math.h>
#include <stdlib.h>

enum { COLUMNS = 37, ROWS = 23, PIXELS = COLUMNS * ROWS, FRAMES = 7, BYTES_MAX = 1 << 20 };

/* A slow gradient, which a codec keeps well. */
static unsigned char grey_at(int frame, int c, int r) {
    return (unsigned char)(20 + 3 * c + 2 * r + 4 * frame);
}

static void write_film(const char *path, int channels) {
    const film_format format = {COLUMNS, ROWS, channels, 10, "skiagraph"};
    film *opened = NULL;
    ck_assert_int_eq(film_open(path, &format, &opened), 0);
    for (int f = 0; f < FRAMES; f++) {
        unsigned char pixels[4 * PIXELS];
        for (int i = 0; i < PIXELS; i++)
            memset(pixels + channels * i, grey_at(f, i % COLUMNS, i / COLUMNS), (size_t)channels);
        ck_assert_int_eq(film_add(opened, pixels), 0);
    }
    ck_assert_int_eq(film_finish(&opened), 0);
}

START_TEST(ffmpeg_keeps_the_greys) {
    static unsigned char bytes[BYTES_MAX];
    char path[128], line[512];
    double squares = 0;
    if (system("command -v ffmpeg >/dev/null 2>&1") != 0) skip_test("no ffmpeg");
    snprintf(path, sizeof path, "%s/film.%s", folder, _i % 2 ? "webm" : "mp4");
    write_film(path, _i < 2 ? 1 : 4);
    snprintf(line, sizeof line, "ffmpeg -v error -i %s -f rawvideo -pix_fmt gray %s/raw", path, folder);
    ck_assert_int_eq(system(line), 0);
    snprintf(line, sizeof line, "%s/raw", folder);
    FILE *stream = fopen(line, "rb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_uint_eq(fread(bytes, 1, sizeof bytes, stream), (COLUMNS + 1) * (ROWS + 1) * FRAMES);
    fclose(stream);
    for (int f = 0; f < FRAMES; f++)
        for (int i = 0; i < PIXELS; i++) {
            const int at = (f * (ROWS + 1) + i / COLUMNS) * (COLUMNS + 1) + i % COLUMNS;
            const double off = bytes[at] - grey_at(f, i % COLUMNS, i / COLUMNS);
            squares += off * off;
        }
    /* A wrong range (16 to 235 taken for 0 to 255) misses by about 12, a wrong order of frames by 4. */
    ck_assert_double_lt(sqrt(squares / (PIXELS * FRAMES)), 2);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_loop_test(tests, ffmpeg_keeps_the_greys, 0, 4);
}

SKG_SUITE_MAIN("ffmpeg", add_tests)
