/* Image files in memory: what is encoded has the bytes of a saved file, and is decoded; the rest is refused. */
#include "image/image_files.h"

#include <stdint.h>
#include <stdlib.h>

enum { MOST = 65536 };

static const char *const names[] = {"a.png", "a.tif", "a.mha"};
enum { NAMES = sizeof names / sizeof *names };

static unsigned char made[MOST], saved[MOST];
static double decoded[PIXELS];

static int64_t encode(const skg_picture *picture, const char *name) {
    int64_t size = 0;
    ck_skg(skg_picture_encode(picture, name, made, MOST, &size));
    return size;
}

static int64_t read_back(const char *name) {
    FILE *stream = fopen(at(name), "rb");
    ck_assert_ptr_nonnull(stream);
    const size_t size = fread(saved, 1, MOST, stream);
    fclose(stream);
    return (int64_t)size;
}

START_TEST(encoded_bytes_are_those_of_a_file) {
    skg_picture picture = picture_of(_i & 1 ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32);
    picture.channels = CHANNELS; /* pages of a TIFF, which is read where pages are linked */
    for (int k = 0; k < NAMES; k++) {
        int64_t asked = 0;
        const int64_t size = encode(&picture, names[k]);
        ck_skg(skg_picture_save(&picture, at(names[k])));
        ck_assert_int_eq(size, read_back(names[k]));
        ck_assert_mem_eq(made, saved, (size_t)size);
        ck_skg(skg_picture_encode(&picture, names[k], NULL, 0, &asked));
        ck_assert_int_eq(asked, size);
    }
}
END_TEST

START_TEST(encoded_pictures_are_decoded) {
    skg_picture picture = picture_of(SKG_TYPE_FLOAT64);
    for (int k = 0; k < NAMES; k++) {
        const int is_png = k == 0;
        skg_picture_contents contents;
        skg_picture_contents_init(&contents);
        const int64_t size = encode(&picture, names[k]);
        ck_skg(skg_picture_contents_decode(names[k], made, size, &contents));
        ck_assert(contents.columns == COLUMNS && contents.rows == ROWS && contents.pages == 1);
        ck_assert_int_eq(contents.quantity, is_png ? -1 : SKG_QUANTITY_ENERGY);
        ck_skg(skg_picture_decode(names[k], made, size, 0, decoded));
        if (!is_png) ck_assert_mem_eq(decoded, doubles, sizeof decoded);
        for (int p = 0; is_png && p < PIXELS; p++)
            ck_assert(decoded[p] >= 0 && decoded[p] <= 65535 && decoded[p] == (double)(int)decoded[p]);
        ck_skg_fails(skg_picture_decode(names[k], made, size, 1, decoded), SKG_ERR_ARGUMENT,
                     "there is no page 1; the file has 1");
    }
}
END_TEST

/* Nothing is written beyond the capacity, nor before the size is known to fit. */
START_TEST(memory_that_does_not_suffice_is_left) {
    const skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
    for (int k = 0; k < NAMES; k++) {
        char reason[128];
        int64_t told = 0;
        const int64_t size = encode(&picture, names[k]);
        memset(made, 0x5a, sizeof made);
        snprintf(reason, sizeof reason, "%s: has %d bytes, and there is memory for %d", names[k], (int)size,
                 (int)size - 1);
        ck_skg_fails(skg_picture_encode(&picture, names[k], made, size - 1, &told), SKG_ERR_ARGUMENT, reason);
        ck_assert_int_eq(told, size);
        for (int i = 0; i < MOST; i++) ck_assert_int_eq(made[i], 0x5a);
    }
    ck_assert_int_eq(files_in_folder(), 0);
}
END_TEST

/* Every shorter piece of a file is refused, or, where only what ends the file is cut off, has the same values. */
START_TEST(truncated_files_are_refused) {
    /* A PNG's end chunk; the texts that a TIFF has behind its directory; nothing of a MetaImage. */
    static const int64_t spare[NAMES] = {12, 200, 0};
    const skg_picture picture = picture_of(SKG_TYPE_FLOAT64);
    for (int k = 0; k < NAMES; k++) {
        int64_t refused = 0;
        const int64_t size = encode(&picture, names[k]);
        double whole[PIXELS];
        ck_skg(skg_picture_decode(names[k], made, size, 0, whole));
        for (int64_t cut = 0; cut < size; cut++) {
            /* memory of this size, so that a sanitizer sees what is read beyond it */
            unsigned char *piece = malloc((size_t)cut + 1);
            memcpy(piece, made, (size_t)cut);
            piece = realloc(piece, cut > 0 ? (size_t)cut : 1);
            const skg_status status = skg_picture_decode(names[k], piece, cut, 0, decoded);
            if (status == SKG_OK)
                ck_assert_mem_eq(decoded, whole, sizeof decoded);
            else if (status == SKG_ERR_UNSUPPORTED) /* the name of a data file that was to be LOCAL */
                ck_skg_fails(status, SKG_ERR_UNSUPPORTED, "a.mha: its values are in another file");
            else
                ck_skg_fails(status, SKG_ERR_FORMAT, names[k]);
            refused += status != SKG_OK;
            free(piece);
        }
        ck_assert_msg(size - refused <= spare[k], "%s: %d bytes at the end are not missed", names[k],
                      (int)(size - refused));
    }
}
END_TEST

START_TEST(what_is_no_image_is_refused) {
    static const struct {
        const char *name, *bytes, *reason;
        skg_status status;
    } cases[] = {{"a.png", "garbage", "a.png: is no PNG", SKG_ERR_FORMAT},
                 {"a.tif", "garbage", "a.tif: is no TIFF", SKG_ERR_FORMAT},
                 {"a.mha", "garbage", "a.mha: is no MetaImage", SKG_ERR_FORMAT},
                 {"a.mhd", "DimSize = 2 2\nElementType = MET_CHAR\nElementDataFile = a.raw\n",
                  "a.mhd: its values are in another file (ElementDataFile = a.raw)", SKG_ERR_UNSUPPORTED},
                 {"a.png", "", "a.png: is empty: it has 0 bytes", SKG_ERR_FORMAT},
                 {"a.jpg", "garbage", "a.jpg: the extension .jpg is none", SKG_ERR_UNSUPPORTED},
                 {"a", "garbage", "a: the extension is missing", SKG_ERR_UNSUPPORTED}};
    skg_picture_contents contents;
    skg_picture_contents_init(&contents);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        ck_skg_fails(
            skg_picture_decode(cases[k].name, cases[k].bytes, (int64_t)strlen(cases[k].bytes), 0, decoded),
            cases[k].status, cases[k].reason);
    ck_skg_fails(skg_picture_contents_decode("a.tif", "garbage", 7, &contents), SKG_ERR_FORMAT,
                 "a.tif: is no TIFF");
    ck_skg_fails(skg_picture_decode("a.tif", NULL, 7, 0, decoded), SKG_ERR_ARGUMENT,
                 "the argument bytes is NULL");
}
END_TEST

START_TEST(pictures_that_no_file_has_are_refused) {
    skg_picture picture = picture_of(SKG_TYPE_FLOAT32);
    int64_t size = 0;
    ck_skg_fails(skg_picture_encode(&picture, "a.gif", made, MOST, &size), SKG_ERR_ARGUMENT,
                 "a.gif: the extension .gif is no image format");
    picture.data = NULL;
    ck_skg_fails(skg_picture_encode(&picture, "a.png", made, MOST, &size), SKG_ERR_ARGUMENT,
                 "picture: no data");
    picture = picture_of(SKG_TYPE_FLOAT32);
    view.row_step[0] = 0.1;
    ck_skg_fails(skg_picture_encode(&picture, "a.mha", made, MOST, &size), SKG_ERR_UNSUPPORTED,
                 "a.mha: the detector's columns and rows meet at");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_loop_test(tests, encoded_bytes_are_those_of_a_file, 0, 2);
    tcase_add_test(tests, encoded_pictures_are_decoded);
    tcase_add_test(tests, memory_that_does_not_suffice_is_left);
    tcase_add_test(tests, truncated_files_are_refused);
    tcase_add_test(tests, what_is_no_image_is_refused);
    tcase_add_test(tests, pictures_that_no_file_has_are_refused);
}

SKG_SUITE_MAIN("image memory", add_tests)
