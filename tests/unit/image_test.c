/* Image files, read back by libpng, libtiff and a small reader of MetaImage headers. */
#include "suite.h"

#include <skiagraph/image.h>

#include <dirent.h>
#include <math.h>
#include <png.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>

enum { COLUMNS = 7, ROWS = 5, PIXELS = COLUMNS * ROWS, CHANNELS = 2 };

static char folder[64], path[128];
static float floats[CHANNELS * PIXELS];
static double doubles[CHANNELS * PIXELS];
static skg_view view;

static void set_up(void) {
    strcpy(folder, "/tmp/skg-image-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    for (int i = 0; i < CHANNELS * PIXELS; i++) {
        doubles[i] = 1.0 / 3 + i * 1000.0 / 7;
        floats[i] = (float)doubles[i];
    }
    skg_view_init(&view);
    view.columns = COLUMNS;
    view.rows = ROWS;
    view.source[1] = -400;
    /* columns along (0.6, 0, 0.8) and rows along -y: a third axis of (0.8, 0, -0.6) */
    view.centre[0] = 10, view.centre[1] = 20, view.centre[2] = 30;
    view.column_step[0] = 0.6 * 0.5, view.column_step[1] = 0, view.column_step[2] = 0.8 * 0.5;
    view.row_step[0] = 0, view.row_step[1] = -0.25, view.row_step[2] = 0;
}

static int files_in_folder(void) {
    int count = 0;
    DIR *directory = opendir(folder);
    ck_assert_ptr_nonnull(directory);
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        count += entry->d_name[0] != '.';
    closedir(directory);
    return count;
}

static void tear_down(void) {
    static const char *const names[] = {"a.png", "a.tif", "A.TIFF", "a.mha"};
    for (int i = 0; i < 4; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        unlink(path);
    }
    ck_assert_int_eq(rmdir(folder), 0);
}

static const char *at(const char *name) {
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static skg_picture picture_of(int32_t type) {
    skg_picture picture;
    skg_picture_init(&picture);
    picture.type = type;
    picture.columns = COLUMNS;
    picture.rows = ROWS;
    picture.data = type == SKG_FLOAT64 ? (const void *)doubles : (const void *)floats;
    picture.name = "energy";
    picture.unit = "keV per pixel";
    picture.view = &view;
    return picture;
}

/* PNG: levels, and the text chunks as "key=value;" one after the other. */
static void read_png(const char *file, uint16_t levels[PIXELS], char *texts, size_t length) {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    FILE *stream = fopen(file, "rb");
    ck_assert_ptr_nonnull(stream);
    png_init_io(png, stream);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    ck_assert_uint_eq(png_get_image_width(png, info), COLUMNS);
    ck_assert_uint_eq(png_get_image_height(png, info), ROWS);
    ck_assert_uint_eq(png_get_bit_depth(png, info), 16);
    ck_assert_uint_eq(png_get_color_type(png, info), PNG_COLOR_TYPE_GRAY);
    png_bytepp rows = png_get_rows(png, info);
    for (int i = 0; i < PIXELS; i++) {
        const png_byte *pixel = rows[i / COLUMNS] + 2 * (i % COLUMNS);
        levels[i] = (uint16_t)(pixel[0] << 8 | pixel[1]);
    }
    png_textp entries = NULL;
    int count = png_get_text(png, info, &entries, NULL);
    texts[0] = '\0';
    for (int i = 0; i < count; i++) {
        size_t used = strlen(texts);
        snprintf(texts + used, length - used, "%s=%s;", entries[i].key, entries[i].text);
    }
    png_destroy_read_struct(&png, &info, NULL);
    fclose(stream);
}

START_TEST(png_shows_dense_white_or_dark) {
    uint16_t levels[PIXELS];
    char texts[2048];
    double expected[PIXELS];
    skg_picture picture = picture_of(SKG_FLOAT64);
    picture.open = 6000;
    for (int i = 0; i < PIXELS; i++) doubles[i] = 6000 * exp(-0.1 * i);
    ck_skg(skg_picture_write(&picture, at("a.png")));
    read_png(path, levels, texts, sizeof texts);
    for (int i = 0; i < PIXELS; i++) expected[i] = i / 34.0; /* -ln(I/I0) from 0 to 3.4 */
    for (int i = 0; i < PIXELS; i++)
        ck_assert_int_le(abs(levels[i] - (int)lround(expected[i] * 65535)), 1); /* a rounded log */
    ck_assert_ptr_nonnull(strstr(texts, "Display=radiograph: -ln(I/I0);"));
    ck_assert_ptr_nonnull(strstr(texts, "Range=black 0, white 3.4;"));
    ck_assert_ptr_nonnull(
        strstr(texts, "Description=energy (keV per pixel); point source at 0 -400 0; "
                      "detector centre 10 20 30 mm; column step 0.3 0 0.4 mm; row step 0 -0.25 0 mm;"));

    picture.display = SKG_DISPLAY_TRANSMISSION;
    picture.low = 0, picture.high = 0.5;
    ck_skg(skg_picture_write(&picture, path));
    read_png(path, levels, texts, sizeof texts);
    for (int i = 0; i < PIXELS; i++) {
        double grey = exp(-0.1 * i) / 0.5;
        ck_assert_int_le(abs(levels[i] - (int)lround((grey > 1 ? 1 : grey) * 65535)), 1);
    }
    ck_assert_ptr_nonnull(strstr(texts, "Display=transmission: I/I0;Range=black 0, white 0.5;"));
}
END_TEST

START_TEST(png_knows_what_the_data_are) {
    uint16_t levels[PIXELS], again[PIXELS];
    char texts[2048];
    double low, high;
    skg_picture picture = picture_of(SKG_FLOAT64);
    /* The same picture from transmissions and from attenuations. */
    picture.quantity = SKG_ATTENUATION;
    for (int i = 0; i < PIXELS; i++) doubles[i] = 0.125 * i;
    ck_skg(skg_picture_write(&picture, at("a.png")));
    read_png(path, levels, texts, sizeof texts);
    picture.quantity = SKG_TRANSMISSION;
    for (int i = 0; i < PIXELS; i++) doubles[i] = exp(-0.125 * i);
    ck_skg(skg_picture_write(&picture, path));
    read_png(path, again, texts, sizeof texts);
    for (int i = 0; i < PIXELS; i++) ck_assert_int_le(abs(levels[i] - again[i]), 1);
    /* Lengths, without an open beam, are shown as they are, and exactly: 0 to 34 of 35 pixels. */
    picture.quantity = SKG_ENERGY, picture.name = "path length", picture.unit = "mm";
    for (int i = 0; i < PIXELS; i++) doubles[i] = i;
    ck_skg(skg_picture_write(&picture, path));
    read_png(path, levels, texts, sizeof texts);
    for (int i = 0; i < PIXELS; i++) ck_assert_int_eq(levels[i], lround(i * 65535 / 34.0));
    ck_assert_ptr_nonnull(strstr(texts, "Display=path length (mm);Range=black 0, white 34;"));
    ck_skg(skg_picture_range(&picture, &low, &high));
    ck_assert(low == 0 && high == 34);
}
END_TEST

START_TEST(ranges_leave_out_what_is_not_finite) {
    double low, high;
    uint16_t levels[PIXELS];
    char texts[2048];
    skg_picture picture = picture_of(SKG_FLOAT32);
    picture.quantity = SKG_TRANSMISSION;
    for (int i = 0; i < PIXELS; i++) floats[i] = 0.5f;
    floats[0] = 0, floats[1] = -0.25f, floats[2] = nanf(""), floats[3] = 1;
    ck_skg(skg_picture_range(&picture, &low, &high));
    ck_assert(low == 0 && fabs(high - log(2)) < 1e-15);
    ck_skg(skg_picture_write(&picture, at("a.png")));
    read_png(path, levels, texts, sizeof texts);
    ck_assert_int_eq(levels[0], 65535); /* nothing comes through: dense */
    ck_assert_int_eq(levels[1], 65535);
    ck_assert_int_eq(levels[2], 0);
    ck_assert_int_eq(levels[3], 0);
    /* An empty field is black in a radiograph, white in a transmission. */
    for (int i = 0; i < PIXELS; i++) floats[i] = 1;
    ck_skg(skg_picture_write(&picture, path));
    read_png(path, levels, texts, sizeof texts);
    ck_assert_int_eq(levels[17], 0);
    picture.display = SKG_DISPLAY_TRANSMISSION;
    ck_skg(skg_picture_write(&picture, path));
    read_png(path, levels, texts, sizeof texts);
    ck_assert_int_eq(levels[17], 65535);
}
END_TEST

static void check_tiff(const char *file, int32_t type, int channels) {
    size_t element = type == SKG_FLOAT64 ? 8 : 4;
    TIFF *tiff = TIFFOpen(file, "r");
    ck_assert_ptr_nonnull(tiff);
    ck_assert_int_eq(TIFFNumberOfDirectories(tiff), channels);
    for (int channel = 0; channel < channels; channel++) {
        uint32_t width = 0, height = 0;
        uint16_t bits = 0, format = 0;
        float across = 0, down = 0;
        char *description = NULL;
        double row[COLUMNS];
        ck_assert_int_eq(TIFFSetDirectory(tiff, (tdir_t)channel), 1);
        TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
        TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
        TIFFGetField(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
        TIFFGetField(tiff, TIFFTAG_SAMPLEFORMAT, &format);
        TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &description);
        TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &across);
        TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &down);
        ck_assert(width == COLUMNS && height == ROWS && format == SAMPLEFORMAT_IEEEFP);
        ck_assert_uint_eq(bits, 8 * element);
        ck_assert_ptr_nonnull(strstr(description, "energy (keV per pixel); point source at 0 -400 0; "));
        ck_assert_ptr_nonnull(strstr(description, "detector centre 10 20 30 mm"));
        ck_assert(across == 20.0f && down == 40.0f); /* pixels of 0.5 and 0.25 mm, per cm */
        for (uint32_t r = 0; r < ROWS; r++) {
            ck_assert_int_eq(TIFFReadScanline(tiff, row, r, 0), 1);
            size_t first = (size_t)channel * PIXELS + r * COLUMNS;
            const char *data =
                type == SKG_FLOAT64 ? (const char *)(doubles + first) : (const char *)(floats + first);
            ck_assert_int_eq(memcmp(row, data, COLUMNS * element), 0);
        }
    }
    TIFFClose(tiff);
}

START_TEST(tiff_keeps_every_bit) {
    skg_picture picture = picture_of(SKG_FLOAT32);
    ck_skg(skg_picture_write(&picture, at("a.tif")));
    check_tiff(path, SKG_FLOAT32, 1);
    picture = picture_of(SKG_FLOAT64);
    picture.channels = CHANNELS;
    ck_skg(skg_picture_write(&picture, at("A.TIFF")));
    check_tiff(path, SKG_FLOAT64, CHANNELS);
}
END_TEST

/* MetaImage: text up to and with the line ElementDataFile, then the data. Returns the data's bytes. */
static long read_mha(const char *file, char *header, size_t length, void *data, size_t most) {
    FILE *stream = fopen(file, "rb");
    ck_assert_ptr_nonnull(stream);
    header[0] = '\0';
    do {
        size_t used = strlen(header);
        ck_assert_uint_lt(used + 2, length);
        ck_assert_ptr_nonnull(fgets(header + used, (int)(length - used), stream));
    } while (!strstr(header, "ElementDataFile = LOCAL\n"));
    size_t bytes = fread(data, 1, most, stream);
    fclose(stream);
    return (long)bytes;
}

static void read_field(const char *header, const char *key, int count, double *values) {
    const char *line = strstr(header, key);
    ck_assert_msg(line != NULL, "no %s in %s", key, header);
    line = strchr(line, '=') + 1;
    for (int i = 0; i < count; i++) {
        char *end = NULL;
        values[i] = strtod(line, &end);
        ck_assert_ptr_ne(end, line);
        line = end;
    }
    ck_assert_int_eq(*line, '\n');
}

START_TEST(metaimage_keeps_bits_and_place) {
    char header[2048];
    double data[CHANNELS * PIXELS + 1], numbers[9];
    skg_picture picture = picture_of(SKG_FLOAT64);
    ck_skg(skg_picture_write(&picture, at("a.mha")));
    ck_assert_int_eq(read_mha(path, header, sizeof header, data, sizeof data), PIXELS * 8);
    ck_assert_int_eq(memcmp(data, doubles, PIXELS * 8), 0);
    ck_assert_ptr_nonnull(strstr(header, "ElementType = MET_DOUBLE\n"));
    ck_assert_ptr_nonnull(strstr(header, "Comment = energy (keV per pixel)\n"));
    ck_assert_ptr_nonnull(strstr(header, "DimSize = 7 5 1\n"));
    read_field(header, "\nElementSpacing", 3, numbers);
    ck_assert(fabs(numbers[0] - 0.5) < 1e-15 && numbers[1] == 0.25 && numbers[2] == 1);
    read_field(header, "\nTransformMatrix", 9, numbers);
    static const double direction[9] = {0.6, 0, 0.8, 0, -1, 0, 0.8, 0, -0.6};
    for (int i = 0; i < 9; i++) ck_assert_double_eq_tol(numbers[i], direction[i], 1e-15); /* 4 ulp of 1 */
    read_field(header, "\nOffset", 3, numbers); /* centre - 3 columns - 2 rows */
    ck_assert_double_eq_tol(numbers[0], 10 - 3 * 0.3, 1e-14);
    ck_assert_double_eq_tol(numbers[1], 20 + 2 * 0.25, 1e-14);
    ck_assert_double_eq_tol(numbers[2], 30 - 3 * 0.4, 1e-14);
}
END_TEST

START_TEST(channels_have_names_of_their_own) {
    static const char *const names[CHANNELS] = {"low band", "high band"}, *const none[CHANNELS] = {"low",
                                                                                                   NULL};
    char header[2048];
    float data[CHANNELS * PIXELS + 1];
    skg_picture picture = picture_of(SKG_FLOAT32);
    picture.channels = CHANNELS, picture.channel_names = names;
    ck_skg(skg_picture_write(&picture, at("a.mha")));
    read_mha(path, header, sizeof header, data, sizeof data);
    ck_assert_ptr_nonnull(strstr(header, "\nChannelNames = low band; high band\n"));
    ck_skg(skg_picture_write(&picture, at("a.tif")));
    TIFF *tiff = TIFFOpen(path, "r");
    ck_assert_ptr_nonnull(tiff);
    for (int c = 0; c < CHANNELS; c++) {
        char *description = NULL;
        ck_assert_int_eq(TIFFSetDirectory(tiff, (tdir_t)c), 1);
        TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &description);
        ck_assert_int_eq(strncmp(description, names[c], strlen(names[c])), 0);
    }
    TIFFClose(tiff);
    picture.channel_names = none;
    ck_skg_fails(skg_picture_write(&picture, path), SKG_ERR_ARGUMENT, "channel 1 has no name");
}
END_TEST

START_TEST(metaimage_interleaves_channels) {
    char header[2048];
    float data[CHANNELS * PIXELS + 1];
    skg_picture picture = picture_of(SKG_FLOAT32);
    picture.channels = CHANNELS;
    picture.view = NULL;
    ck_skg(skg_picture_write(&picture, at("a.mha")));
    ck_assert_int_eq(read_mha(path, header, sizeof header, data, sizeof data), CHANNELS * PIXELS * 4);
    for (int i = 0; i < PIXELS; i++)
        for (int channel = 0; channel < CHANNELS; channel++)
            ck_assert(data[CHANNELS * i + channel] == floats[channel * PIXELS + i]);
    ck_assert_ptr_nonnull(strstr(header, "ElementNumberOfChannels = 2\n"));
    ck_assert_ptr_nonnull(strstr(header, "NDims = 2\n"));
    ck_assert_ptr_nonnull(strstr(header, "DimSize = 7 5\n"));
    ck_assert_ptr_null(strstr(header, "Offset"));
}
END_TEST

START_TEST(skewed_steps_are_no_metaimage) {
    skg_picture picture = picture_of(SKG_FLOAT32);
    view.row_step[0] = 0.25 * 0.6, view.row_step[2] = 0.25 * 0.8; /* 45 degrees off */
    ck_skg_fails(skg_picture_write(&picture, at("a.mha")), SKG_ERR_UNSUPPORTED, "write .tif instead");
    ck_assert_ptr_nonnull(strstr(skg_last_error(), "45 degrees"));
    ck_assert_int_eq(files_in_folder(), 0);
    ck_skg(skg_picture_write(&picture, at("a.tif")));
}
END_TEST

START_TEST(a_wrong_path_is_told) {
    skg_picture picture = picture_of(SKG_FLOAT32);
    ck_skg_fails(skg_picture_write(&picture, at("a.jpg")), SKG_ERR_ARGUMENT,
                 "the extension .jpg is no image format; use .png, .tif or .mha");
    ck_skg_fails(skg_picture_write(&picture, at("a")), SKG_ERR_ARGUMENT, "the extension is missing");
    ck_skg_fails(skg_picture_write(&picture, ""), SKG_ERR_ARGUMENT, "no path");
    ck_skg_fails(skg_picture_write(&picture, at("none/a.tif")), SKG_ERR_OUTPUT,
                 "none/a.tif: cannot be written: No such file or directory; make its folder first");
    ck_skg_fails(skg_picture_write(&picture, "/dev/null/a.mha"), SKG_ERR_OUTPUT, "Not a directory");
    ck_skg_fails(skg_picture_check_path(at("none/a.png")), SKG_ERR_OUTPUT, "none/a.png");
    ck_skg_fails(skg_picture_check_path(at("a.bmp")), SKG_ERR_ARGUMENT, ".bmp");
    ck_assert_int_eq(mkdir(at("a.png"), 0777), 0);
    ck_skg_fails(skg_picture_write(&picture, path), SKG_ERR_OUTPUT, "it is a folder; add a file name");
    ck_assert_int_eq(rmdir(path), 0);
    ck_assert_int_eq(mkfifo(path, 0600), 0);
    ck_skg_fails(skg_picture_write(&picture, path), SKG_ERR_OUTPUT, "it is a device");
    ck_assert_int_eq(unlink(path), 0);
    ck_skg(skg_picture_check_path(path));
    ck_assert_int_eq(files_in_folder(), 0);
}
END_TEST

/* A limit on file size stands for a full disk: it holds for root too. */
START_TEST(a_full_disk_leaves_nothing) {
    static const char *const names[] = {"a.png", "a.tif", "a.mha"};
    struct rlimit limit = {64, 64};
    enum { SIDE = 300 }; /* more than any buffer keeps back */
    skg_picture picture = picture_of(SKG_FLOAT32);
    float *noise = calloc(SIDE * SIDE, sizeof *noise);
    ck_assert_ptr_nonnull(noise);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) noise[i] = (float)(i * 2654435761u >> 8);
    picture.columns = picture.rows = SIDE;
    picture.data = noise;
    picture.view = NULL;
    signal(SIGXFSZ, SIG_IGN);
    ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &limit), 0);
    skg_status status[3];
    char sentence[3][256];
    for (int i = 0; i < 3; i++) {
        status[i] = skg_picture_write(&picture, at(names[i]));
        snprintf(sentence[i], sizeof sentence[i], "%s", skg_last_error());
    }
    int left = files_in_folder();
    free(noise);
    /* Check reports through a file of its own, which the limit cuts as well: leave by the exit status. */
    for (int i = 0; i < 3; i++)
        if (status[i] != SKG_ERR_OUTPUT || !strstr(sentence[i], names[i]) ||
            !strstr(sentence[i], "File too large; make room"))
            _exit(10 + i);
    tear_down();
    _exit(left == 0 ? 0 : 20);
}
END_TEST

START_TEST(an_unusable_picture_is_told) {
    skg_picture picture = picture_of(SKG_FLOAT32);
    picture.rows = 4;
    ck_skg_fails(skg_picture_write(&picture, at("a.tif")), SKG_ERR_ARGUMENT, "its view has 7 x 5");
    picture = picture_of(SKG_FLOAT32);
    picture.low = 2, picture.high = 1;
    ck_skg_fails(skg_picture_write(&picture, path), SKG_ERR_ARGUMENT, "range 2:1");
    picture = picture_of(2);
    ck_skg_fails(skg_picture_write(&picture, path), SKG_ERR_ARGUMENT, "type 2");
    picture = picture_of(SKG_FLOAT32);
    picture.data = NULL;
    ck_skg_fails(skg_picture_write(&picture, path), SKG_ERR_ARGUMENT, "no data");
    picture = picture_of(SKG_FLOAT32);
    picture.open = nan("");
    ck_skg_fails(skg_picture_write(&picture, path), SKG_ERR_ARGUMENT, "open beam");
    picture = picture_of(SKG_FLOAT32);
    picture.channels = 0;
    ck_skg_fails(skg_picture_write(&picture, path), SKG_ERR_ARGUMENT, "0 channels");
    ck_skg_fails(skg_picture_write(NULL, path), SKG_ERR_ARGUMENT, "skg_picture");
    ck_assert_int_eq(files_in_folder(), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, png_shows_dense_white_or_dark);
    tcase_add_test(tests, png_knows_what_the_data_are);
    tcase_add_test(tests, ranges_leave_out_what_is_not_finite);
    tcase_add_test(tests, tiff_keeps_every_bit);
    tcase_add_test(tests, channels_have_names_of_their_own);
    tcase_add_test(tests, metaimage_keeps_bits_and_place);
    tcase_add_test(tests, metaimage_interleaves_channels);
    tcase_add_test(tests, skewed_steps_are_no_metaimage);
    tcase_add_test(tests, a_wrong_path_is_told);
    tcase_add_exit_test(tests, a_full_disk_leaves_nothing, 0);
    tcase_add_test(tests, an_unusable_picture_is_told);
}

SKG_SUITE_MAIN("image", add_tests)
