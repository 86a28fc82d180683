/* TIFF and MetaImage files, read back by libtiff and a small reader of headers; paths and full disks. */
#include "image/image_files.h"

#include <float.h>
#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tiffio.h>

static void check_tiff(const char *file, int32_t type, int channels) {
    size_t element = type == SKG_TYPE_FLOAT64 ? 8 : 4;
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
                type == SKG_TYPE_FLOAT64 ? (const char *)(doubles + first) : (const char *)(floats + first);
            ck_assert_int_eq(memcmp(row, data, COLUMNS * element), 0);
        }
    }
    TIFFClose(tiff);
}

/* Tags that say that values or rows run the other way: such files were once read as if they did not. */
START_TEST(tiffs_that_are_turned_are_refused) {
    static const struct {
        int photometric, orientation;
        const char *reason;
    } cases[] = {{PHOTOMETRIC_MINISBLACK, ORIENTATION_TOPLEFT, NULL},
                 {PHOTOMETRIC_MINISWHITE, ORIENTATION_TOPLEFT, "its least value is white"},
                 {PHOTOMETRIC_MINISBLACK, ORIENTATION_TOPRIGHT, "Orientation 2"},
                 {PHOTOMETRIC_MINISBLACK, ORIENTATION_RIGHTTOP, "Orientation 6"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        uint8_t row[2] = {3, 7};
        double values[2] = {0};
        TIFF *tiff = TIFFOpen(at("turned.tif"), "w");
        ck_assert_ptr_nonnull(tiff);
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 2);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, cases[k].photometric);
        TIFFSetField(tiff, TIFFTAG_ORIENTATION, cases[k].orientation);
        ck_assert_int_eq(TIFFWriteScanline(tiff, row, 0, 0), 1);
        TIFFClose(tiff);
        if (cases[k].reason)
            ck_skg_fails(skg_picture_load(at("turned.tif"), 0, values), SKG_ERR_UNSUPPORTED, cases[k].reason);
        else
            ck_skg(skg_picture_load(at("turned.tif"), 0, values));
        ck_assert_double_eq(values[1], cases[k].reason ? 0 : 7);
        unlink(path);
    }
}
END_TEST

/* A page that is larger than the first was once written beyond the memory that the caller has for the first. */
START_TEST(pages_of_other_sizes_are_refused) {
    uint8_t row[4] = {1, 2, 3, 4};
    double values[2] = {0};
    skg_picture_contents contents;
    skg_picture_contents_init(&contents);
    TIFF *tiff = TIFFOpen(at("a.tif"), "w");
    ck_assert_ptr_nonnull(tiff);
    for (int page = 0; page < 3; page++) {
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, page == 1 ? 4 : 2);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        ck_assert_int_eq(TIFFWriteScanline(tiff, row, 0, 0), 1);
        ck_assert_int_eq(TIFFWriteDirectory(tiff), 1);
    }
    TIFFClose(tiff);
    ck_skg(skg_picture_contents_get(at("a.tif"), &contents));
    ck_assert(contents.columns == 2 && contents.rows == 1 && contents.pages == 3);
    ck_skg_fails(skg_picture_load(path, 1, values), SKG_ERR_UNSUPPORTED,
                 "a.tif: page 1 has 4 x 1 pixels, page 0 has 2 x 1; write pages of one size");
    ck_assert(values[0] == 0 && values[1] == 0);
    ck_skg(skg_picture_load(path, 2, values));
    ck_assert(values[0] == 1 && values[1] == 2);
}
END_TEST

START_TEST(tiff_keeps_every_bit) {
    skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
    ck_skg(skg_picture_save(&picture, at("a.tif")));
    check_tiff(path, SKG_TYPE_FLOAT32, 1);
    picture = picture_of(SKG_TYPE_FLOAT64);
    picture.channels = CHANNELS;
    ck_skg(skg_picture_save(&picture, at("A.TIFF")));
    check_tiff(path, SKG_TYPE_FLOAT64, CHANNELS);
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
    skg_picture picture = picture_of(SKG_TYPE_FLOAT64);
    ck_skg(skg_picture_save(&picture, at("a.mha")));
    ck_assert_int_eq(read_mha(path, header, sizeof header, data, sizeof data), PIXELS * 8);
    ck_assert_int_eq(memcmp(data, doubles, PIXELS * 8), 0);
    ck_assert_ptr_nonnull(strstr(header, "ElementType = MET_DOUBLE\n"));
    ck_assert_ptr_nonnull(strstr(header, "Comment = energy (keV per pixel); skiagraph "));
    ck_assert_ptr_nonnull(strstr(header, "DimSize = 7 5 1\n"));
    read_field(header, "\nElementSpacing", 3, numbers);
    ck_assert(fabs(numbers[0] - 0.5) < 4 * DBL_EPSILON && numbers[1] == 0.25 && numbers[2] == 1);
    read_field(header, "\nTransformMatrix", 9, numbers);
    static const double direction[9] = {0.6, 0, 0.8, 0, -1, 0, 0.8, 0, -0.6};
    for (int i = 0; i < 9; i++) ck_assert_double_eq_tol(numbers[i], direction[i], 1e-15); /* 4 ulp of 1 */
    read_field(header, "\nOffset", 3, numbers); /* centre - 3 columns - 2 rows */
    ck_assert_double_eq_tol(numbers[0], 10 - 3 * 0.3, 2 * DBL_EPSILON * 20);
    ck_assert_double_eq_tol(numbers[1], 20 + 2 * 0.25, 2 * DBL_EPSILON * 20);
    ck_assert_double_eq_tol(numbers[2], 30 - 3 * 0.4, 2 * DBL_EPSILON * 20);
}
END_TEST

START_TEST(channels_have_names_of_their_own) {
    static const char *const names[CHANNELS] = {"low band", "high band"}, *const none[CHANNELS] = {"low",
                                                                                                   NULL};
    char header[2048];
    float data[CHANNELS * PIXELS + 1];
    skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
    picture.channels = CHANNELS, picture.channel_names = names;
    ck_skg(skg_picture_save(&picture, at("a.mha")));
    read_mha(path, header, sizeof header, data, sizeof data);
    ck_assert_ptr_nonnull(strstr(header, "\nChannelNames = low band; high band\n"));
    ck_skg(skg_picture_save(&picture, at("a.tif")));
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
    ck_skg_fails(skg_picture_save(&picture, path), SKG_ERR_ARGUMENT, "channel 1 has no name");
}
END_TEST

START_TEST(metaimage_interleaves_channels) {
    char header[2048];
    float data[CHANNELS * PIXELS + 1];
    skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
    picture.channels = CHANNELS;
    picture.view = NULL;
    ck_skg(skg_picture_save(&picture, at("a.mha")));
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
    skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
    view.row_step[0] = 0.25 * 0.6, view.row_step[2] = 0.25 * 0.8; /* 45 degrees off */
    ck_skg_fails(skg_picture_save(&picture, at("a.mha")), SKG_ERR_UNSUPPORTED, "write .tif instead");
    ck_assert_ptr_nonnull(strstr(skg_last_error(), "45 degrees"));
    ck_assert_int_eq(files_in_folder(), 0);
    ck_skg(skg_picture_save(&picture, at("a.tif")));
}
END_TEST

START_TEST(a_wrong_path_is_refused) {
    skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
    ck_skg_fails(skg_picture_save(&picture, at("a.jpg")), SKG_ERR_ARGUMENT,
                 "the extension .jpg is no image format; use .png, .tif or .mha");
    ck_skg_fails(skg_picture_save(&picture, at("a")), SKG_ERR_ARGUMENT, "the extension is missing");
    ck_skg_fails(skg_picture_save(&picture, ""), SKG_ERR_ARGUMENT, "no path");
    ck_skg_fails(skg_picture_save(&picture, at("none/a.tif")), SKG_ERR_OUTPUT,
                 "none/a.tif: cannot be written: No such file or directory; make its folder first");
    ck_skg_fails(skg_picture_save(&picture, "/dev/null/a.mha"), SKG_ERR_OUTPUT, "Not a directory");
    ck_skg_fails(skg_picture_path_check(at("none/a.png")), SKG_ERR_OUTPUT, "none/a.png");
    ck_skg_fails(skg_picture_path_check(at("a.bmp")), SKG_ERR_ARGUMENT, ".bmp");
    ck_assert_int_eq(mkdir(at("a.png"), 0777), 0);
    ck_skg_fails(skg_picture_save(&picture, path), SKG_ERR_OUTPUT, "it is a folder; add a file name");
    ck_assert_int_eq(rmdir(path), 0);
    ck_assert_int_eq(mkfifo(path, 0600), 0);
    ck_skg_fails(skg_picture_save(&picture, path), SKG_ERR_OUTPUT, "it is a device");
    ck_assert_int_eq(unlink(path), 0);
    ck_skg(skg_picture_path_check(path));
    ck_assert_int_eq(files_in_folder(), 0);
}
END_TEST

/* A limit on file size stands for a full disk: it holds for root too. */
START_TEST(a_full_disk_leaves_nothing) {
    static const char *const names[] = {"a.png", "a.tif", "a.mha"};
    struct rlimit limit = {64, 64};
    enum { SIDE = 300 }; /* more than any buffer keeps back */
    skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
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
        status[i] = skg_picture_save(&picture, at(names[i]));
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

START_TEST(an_unusable_picture_is_refused) {
    skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
    picture.rows = 4;
    ck_skg_fails(skg_picture_save(&picture, at("a.tif")), SKG_ERR_ARGUMENT, "its view has 7 x 5");
    picture = picture_of(SKG_TYPE_FLOAT32);
    picture.low = 2, picture.high = 1;
    ck_skg_fails(skg_picture_save(&picture, path), SKG_ERR_ARGUMENT, "range 2:1");
    picture = picture_of(3);
    ck_skg_fails(skg_picture_save(&picture, path), SKG_ERR_ARGUMENT, "type 3");
    picture = picture_of(SKG_TYPE_FLOAT32);
    picture.data = NULL;
    ck_skg_fails(skg_picture_save(&picture, path), SKG_ERR_ARGUMENT, "no data");
    picture = picture_of(SKG_TYPE_FLOAT32);
    picture.flat_field = nan("");
    ck_skg_fails(skg_picture_save(&picture, path), SKG_ERR_ARGUMENT, "flat field");
    picture = picture_of(SKG_TYPE_FLOAT32);
    picture.channels = 0;
    ck_skg_fails(skg_picture_save(&picture, path), SKG_ERR_ARGUMENT, "0 channels");
    ck_skg_fails(skg_picture_save(NULL, path), SKG_ERR_ARGUMENT, "skg_picture");
    ck_assert_int_eq(files_in_folder(), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, tiff_keeps_every_bit);
    tcase_add_test(tests, tiffs_that_are_turned_are_refused);
    tcase_add_test(tests, pages_of_other_sizes_are_refused);
    tcase_add_test(tests, metaimage_keeps_bits_and_place);
    tcase_add_test(tests, channels_have_names_of_their_own);
    tcase_add_test(tests, metaimage_interleaves_channels);
    tcase_add_test(tests, skewed_steps_are_no_metaimage);
    tcase_add_test(tests, a_wrong_path_is_refused);
    tcase_add_exit_test(tests, a_full_disk_leaves_nothing, 0);
    tcase_add_test(tests, an_unusable_picture_is_refused);
}

SKG_SUITE_MAIN("image", add_tests)
