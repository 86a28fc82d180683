/* PNG files, read back by libpng. */
#include "image/image_files.h"

#include <float.h>
#include <math.h>
#include <png.h>

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
    skg_picture picture = picture_of(SKG_TYPE_FLOAT64);
    picture.flat_field = 6000;
    for (int i = 0; i < PIXELS; i++) doubles[i] = 6000 * exp(-0.1 * i);
    ck_skg(skg_picture_save(&picture, at("a.png")));
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
    ck_skg(skg_picture_save(&picture, path));
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
    skg_picture picture = picture_of(SKG_TYPE_FLOAT64);
    /* One picture from transmissions and from attenuations. */
    picture.quantity = SKG_QUANTITY_ATTENUATION;
    for (int i = 0; i < PIXELS; i++) doubles[i] = 0.125 * i;
    ck_skg(skg_picture_save(&picture, at("a.png")));
    read_png(path, levels, texts, sizeof texts);
    picture.quantity = SKG_QUANTITY_TRANSMISSION;
    for (int i = 0; i < PIXELS; i++) doubles[i] = exp(-0.125 * i);
    ck_skg(skg_picture_save(&picture, path));
    read_png(path, again, texts, sizeof texts);
    for (int i = 0; i < PIXELS; i++) ck_assert_int_le(abs(levels[i] - again[i]), 1);
    /* Lengths, without an open beam, are shown as they are, and exactly: 0 to 34 of 35 pixels. */
    picture.quantity = SKG_QUANTITY_ENERGY, picture.name = "path length", picture.unit = "mm";
    for (int i = 0; i < PIXELS; i++) doubles[i] = i;
    ck_skg(skg_picture_save(&picture, path));
    read_png(path, levels, texts, sizeof texts);
    for (int i = 0; i < PIXELS; i++) ck_assert_int_eq(levels[i], lround(i * 65535 / 34.0));
    ck_assert_ptr_nonnull(strstr(texts, "Display=path length (mm);Range=black 0, white 34;"));
    ck_skg(skg_picture_range_get(&picture, &low, &high));
    ck_assert(low == 0 && high == 34);
}
END_TEST

START_TEST(ranges_leave_out_what_is_not_finite) {
    double low, high;
    uint16_t levels[PIXELS];
    char texts[2048];
    skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
    picture.quantity = SKG_QUANTITY_TRANSMISSION;
    for (int i = 0; i < PIXELS; i++) floats[i] = 0.5f;
    floats[0] = 0, floats[1] = -0.25f, floats[2] = nanf(""), floats[3] = 1;
    ck_skg(skg_picture_range_get(&picture, &low, &high));
    ck_assert(low == 0 && fabs(high - log(2)) < 4 * DBL_EPSILON);
    ck_skg(skg_picture_save(&picture, at("a.png")));
    read_png(path, levels, texts, sizeof texts);
    ck_assert_int_eq(levels[0], 65535); /* nothing comes through: dense */
    ck_assert_int_eq(levels[1], 65535);
    ck_assert_int_eq(levels[2], 0);
    ck_assert_int_eq(levels[3], 0);
    /* An empty field is black in a radiograph, white in a transmission. */
    for (int i = 0; i < PIXELS; i++) floats[i] = 1;
    ck_skg(skg_picture_save(&picture, path));
    read_png(path, levels, texts, sizeof texts);
    ck_assert_int_eq(levels[17], 0);
    picture.display = SKG_DISPLAY_TRANSMISSION;
    ck_skg(skg_picture_save(&picture, path));
    read_png(path, levels, texts, sizeof texts);
    ck_assert_int_eq(levels[17], 65535);
}
END_TEST

/* Behind jaws an attenuation is 126 ln 2; the others keep their contrast, and the data their values. */
START_TEST(ranges_leave_out_where_no_photon_arrives) {
    double low, high;
    uint16_t levels[PIXELS];
    char texts[2048];
    skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
    picture.quantity = SKG_QUANTITY_ATTENUATION, picture.flat_field = 0;
    for (int i = 0; i < PIXELS; i++) floats[i] = i < 10 ? (float)(126 * log(2)) : (float)i;
    ck_skg(skg_picture_range_get(&picture, &low, &high));
    ck_assert(low == 10 && high == 34);
    ck_skg(skg_picture_window_get(&picture, 0, 0, &low, &high));
    ck_assert(low == 10 && high == 34);
    ck_skg(skg_picture_save(&picture, at("a.png")));
    read_png(path, levels, texts, sizeof texts);
    ck_assert(levels[0] == 65535 && levels[10] == 0 && levels[34] == 65535);
    picture.low = 0, picture.high = 100; /* what is asked for rules */
    ck_skg(skg_picture_save(&picture, path));
    read_png(path, levels, texts, sizeof texts);
    ck_assert_int_eq(levels[0], lround(126 * log(2) * 655.35));
    picture.low = picture.high = 0, picture.quantity = SKG_QUANTITY_ENERGY; /* 87.3 keV are some */
    ck_skg(skg_picture_range_get(&picture, &low, &high));
    ck_assert(high > 87);
}
END_TEST

/* The lengths 0 to 34, out of order. */
START_TEST(windows_leave_out_outliers) {
    double low, high;
    skg_picture picture = picture_of(SKG_TYPE_FLOAT64);
    picture.flat_field = 0;
    for (int i = 0; i < PIXELS; i++)
        doubles[i] = (double)(i * 12 % PIXELS); /* 12 and 35 have no common factor */
    ck_skg(skg_picture_window_get(&picture, 0, 0, &low, &high));
    ck_assert(low == 0 && high == 34);
    ck_skg(skg_picture_window_get(&picture, 0.1, 0.2, &low, &high)); /* ranks 3.4 and 27.2 of 34 */
    ck_assert(low == 3 && high == 27);
    /* Values that are not finite are left out. */
    for (int i = 0; i < PIXELS; i++)
        if (doubles[i] == 34 || doubles[i] == 0) doubles[i] = doubles[i] == 34 ? HUGE_VAL : (double)NAN;
    ck_skg(skg_picture_window_get(&picture, 0, 0, &low, &high));
    ck_assert(low == 1 && high == 33);
    /* One pixel stands out of a field: the window would be empty. */
    for (int i = 0; i < PIXELS; i++) doubles[i] = i == 5 ? 3 : 1;
    ck_skg(skg_picture_window_get(&picture, 0.1, 0.1, &low, &high));
    ck_assert(low == 1 && high == 3);
    ck_skg_fails(skg_picture_window_get(&picture, 0.5, 0, &low, &high), SKG_ERR_ARGUMENT, "below 0.5");
    ck_skg_fails(skg_picture_window_get(&picture, 0, -0.1, &low, &high), SKG_ERR_ARGUMENT, "below 0.5");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, png_shows_dense_white_or_dark);
    tcase_add_test(tests, png_knows_what_the_data_are);
    tcase_add_test(tests, windows_leave_out_outliers);
    tcase_add_test(tests, ranges_leave_out_what_is_not_finite);
    tcase_add_test(tests, ranges_leave_out_where_no_photon_arrives);
}

SKG_SUITE_MAIN("png", add_tests)
