/* Image files read back: what was written, and what other programs write. */
#include "image/image_files.h"

#include <skiagraph/options.h>

#include <stdint.h>

static double read_values[PIXELS];

static skg_picture_contents contents_of(const char *file) {
    skg_picture_contents contents;
    skg_picture_contents_init(&contents);
    ck_skg(skg_picture_contents_get(file, &contents));
    return contents;
}

START_TEST(what_was_written_is_read) {
    static const char *const names[] = {"a.mha", "a.tif"};
    for (int q = SKG_QUANTITY_ENERGY; q <= SKG_QUANTITY_ATTENUATION; q++)
        for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
            skg_picture picture = picture_of(SKG_TYPE_FLOAT64);
            ck_skg(skg_quantity_get(q, &picture.name, &picture.unit));
            for (int i = 0; i < PIXELS; i++) doubles[i] = sin(i) / 3;
            ck_skg(skg_picture_save(&picture, at(names[k])));
            const skg_picture_contents contents = contents_of(path);
            ck_assert_int_eq(contents.columns, COLUMNS);
            ck_assert_int_eq(contents.rows, ROWS);
            ck_assert_int_eq(contents.pages, 1);
            ck_assert_int_eq(contents.quantity, q);
            ck_skg(skg_picture_load(path, 0, read_values));
            ck_assert_mem_eq(read_values, doubles, sizeof read_values);
        }
}
END_TEST

START_TEST(png_levels_are_read) {
    skg_picture picture = picture_of(SKG_TYPE_FLOAT64);
    picture.flat_field = 0, picture.low = 0, picture.high = 65535;
    for (int i = 0; i < PIXELS; i++) doubles[i] = 300 * i;
    ck_skg(skg_picture_save(&picture, at("a.png")));
    ck_assert_int_eq(contents_of(path).quantity, -1);
    ck_skg(skg_picture_load(path, 0, read_values));
    ck_assert_mem_eq(read_values, doubles, sizeof read_values);
}
END_TEST

static void write_file(const char *name, const char *header, const void *data, size_t size) {
    FILE *stream = fopen(at(name), "wb");
    ck_assert_ptr_nonnull(stream);
    fputs(header, stream);
    fwrite(data, 1, size, stream);
    fclose(stream);
}

#define HEAD "ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 3 1 2\n"

/* Numbers of other types, in the other byte order, and of a second slice. */
START_TEST(other_types_are_read) {
    static const unsigned char big[12] = {0, 1, 0xff, 0xfe, 0x80, 0, 0, 7, 0x7f, 0xff, 0xff, 0xff};
    static const signed char bytes[6] = {1, -2, 3, -4, 5, -128};
    write_file("a.mha",
               HEAD "BinaryDataByteOrderMSB = True\nElementType = MET_SHORT\nElementDataFile = LOCAL\n", big,
               sizeof big);
    ck_assert_int_eq(contents_of(path).pages, 2);
    ck_skg(skg_picture_load(path, 0, read_values));
    ck_assert(read_values[0] == 1 && read_values[1] == -2 && read_values[2] == -32768);
    ck_skg(skg_picture_load(path, 1, read_values));
    ck_assert(read_values[0] == 7 && read_values[1] == 32767 && read_values[2] == -1);
    write_file("a.mha",
               HEAD "BinaryDataByteOrderMSB = True\nElementType = MET_USHORT\nElementDataFile = LOCAL\n", big,
               sizeof big);
    ck_skg(skg_picture_load(path, 0, read_values));
    ck_assert(read_values[1] == 65534 && read_values[2] == 32768);
    write_file("a.mha", HEAD "ElementType = MET_CHAR\nElementDataFile = LOCAL\n", bytes, sizeof bytes);
    ck_skg(skg_picture_load(path, 1, read_values));
    ck_assert(read_values[0] == -4 && read_values[2] == -128);
    ck_skg_fails(skg_picture_load(path, 2, read_values), SKG_ERR_ARGUMENT,
                 "there is no page 2; the file has 2");
    ck_skg_fails(skg_picture_load(path, -1, read_values), SKG_ERR_ARGUMENT, "there is no page -1");
}
END_TEST

/* In the file's unit, mm where it names none; 0 where it says nothing that is a length. */
START_TEST(spacing_is_read_in_mm) {
    static const struct {
        const char *says;
        double across, down;
    } cases[] = {{"", 0, 0},
                 {"ElementSpacing = 0.5 -2 1\n", 0.5, 2},
                 {"ElementSpacing = 0.5 2 1\nDistanceUnits = ?\n", 0.5, 2},
                 {"DistanceUnits = cm\nElementSpacing = 0.5 2 1\n", 5, 20},
                 {"ElementSpacing = 0.5 2 1\nDistanceUnits = kg\n", 0, 0}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        char header[512];
        snprintf(header, sizeof header, HEAD "%sElementType = MET_CHAR\nElementDataFile = LOCAL\n",
                 cases[c].says);
        write_file("a.mha", header, "abcdef", 6);
        const skg_picture_contents contents = contents_of(path);
        /* of one product, and of a number that is read from text */
        ck_assert_double_eq_tol(contents.spacing_mm[0], cases[c].across, 1e-12);
        ck_assert_double_eq_tol(contents.spacing_mm[1], cases[c].down, 1e-12);
    }
}
END_TEST

START_TEST(wrong_files_are_named) {
    static const struct {
        const char *name, *text, *reason;
        skg_status status;
    } cases[] = {
        {"a.mha", "nothing", "is no MetaImage", SKG_ERR_FORMAT},
        {"a.mha", HEAD "ElementType = MET_FLOAT\nElementDataFile = LOCAL\n123", "ends before its last value",
         SKG_ERR_FORMAT},
        {"a.mha", HEAD "CompressedData = True\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n",
         "is compressed", SKG_ERR_UNSUPPORTED},
        {"a.mha", HEAD "ElementType = MET_OTHER\nElementDataFile = LOCAL\n", "its ElementType is none",
         SKG_ERR_UNSUPPORTED},
        {"a.mha", HEAD "ElementType = MET_FLOAT\nElementDataFile = gone.raw\n", "gone.raw", SKG_ERR_FILE},
        {"a.mha", "DimSize = 3 -1\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n", "3 x -1 pixels",
         SKG_ERR_FORMAT},
        {"a.tif", "nothing", "is no TIFF", SKG_ERR_FORMAT},
        {"a.png", "nothing", "is no PNG", SKG_ERR_FORMAT},
        {"a.jpg", "nothing", "the extension .jpg is none", SKG_ERR_UNSUPPORTED}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        write_file(cases[k].name, cases[k].text, "", 0);
        ck_skg_fails(skg_picture_load(path, 0, read_values), cases[k].status, cases[k].reason);
        unlink(path);
    }
    ck_skg_fails(skg_picture_load(at("gone.tif"), 0, read_values), SKG_ERR_FILE, "gone.tif");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, what_was_written_is_read);
    tcase_add_test(tests, png_levels_are_read);
    tcase_add_test(tests, other_types_are_read);
    tcase_add_test(tests, spacing_is_read_in_mm);
    tcase_add_test(tests, wrong_files_are_named);
}

SKG_SUITE_MAIN("load", add_tests)
