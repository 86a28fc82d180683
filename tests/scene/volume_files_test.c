/* Volumes from files and arrays: where cells are, and what is refused. */
#include "suite.h"

#include <float.h>
#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { COLUMNS = 3, ROWS = 2, SLICES = 4, CELLS = COLUMNS * ROWS * SLICES };

static const int16_t numbers[CELLS] = {-1000, -980, -700, -120, -60,  -10,  20,   60,   110,  250, 330, 480,
                                       560,   690,  850,  990,  1100, 1210, 1320, 1430, 1540, 40,  0,   -300};

static void source_of(skg_volume_source *source, const void *cells, int32_t type, int32_t values) {
    skg_volume_source_init(source);
    source->columns = COLUMNS, source->rows = ROWS, source->slices = SLICES;
    source->cells = cells, source->type = type, source->values = values;
}

/* Values below 0 by the noise of a reconstruction count as 0, and a sentence says of how many cells. values: those of the source */
static void noise_below_zero(const skg_volume_source *source, double *values) {
    skg_volume *noisy = NULL, *clean = NULL;
    skg_volume_contents of_noisy, of_clean;
    int32_t level = 0;
    const char *sentence = "";
    skg_volume_contents_init(&of_noisy);
    skg_volume_contents_init(&of_clean);
    values[7] = -0.0625, values[9] = -0.03125;
    ck_skg(skg_volume_create(source, &noisy));
    values[7] = values[9] = 0;
    ck_skg(skg_volume_create(source, &clean));
    ck_skg(skg_volume_contents_get(noisy, &of_noisy));
    ck_skg(skg_volume_contents_get(clean, &of_clean));
    ck_assert(of_noisy.low == 0 && of_noisy.mass == of_clean.mass && of_noisy.remarks == 1 &&
              of_clean.remarks == 0);
    ck_skg(skg_volume_remark_get(noisy, 0, &level, &sentence));
    ck_assert_int_eq(level, SKG_LOG_WARNING);
    ck_assert_str_eq(sentence, "2 of its values are below 0, down to -0.0625, and count as 0");
    skg_volume_release(&noisy);
    skg_volume_release(&clean);
    values[9] = 1;
}

START_TEST(bad_volumes_are_refused) {
    double values[CELLS];
    float floats[CELLS] = {0};
    skg_material *mu = NULL, *water = NULL;
    skg_volume *volume = NULL;
    skg_volume_source source, good;
    for (int k = 0; k < CELLS; k++) values[k] = 1;
    ck_skg(skg_material_create_mu("mu", 1, &mu));
    ck_skg(skg_material_create_named("Water", &water));
    source_of(&good, values, SKG_VOLUME_FLOAT64, SKG_VOLUME_DENSITY);
    source = good;
    ck_skg_fails(skg_volume_create(&source, &volume), SKG_ERR_MATERIAL, "give it a material or classes");
    source.material = mu;
    ck_skg_fails(skg_volume_create(&source, &volume), SKG_ERR_MATERIAL, "no density can change it");
    source.values = SKG_VOLUME_MU;
    ck_skg_fails(skg_volume_create(&source, &volume), SKG_ERR_MATERIAL, "need no material");
    good.material = water;
    source = good;
    values[7] = (double)NAN;
    ck_skg_fails(skg_volume_create(&source, &volume), SKG_ERR_ARGUMENT, "column 1, row 0, slice 1 is nan");
    values[7] = -5;
    ck_skg_fails(skg_volume_create(&source, &volume), SKG_ERR_ARGUMENT,
                 "column 1, row 0, slice 1 is -5; densities");
    noise_below_zero(&source, values);
    values[7] = 1;
    source.affine[0] = 0;
    ck_skg_fails(skg_volume_create(&source, &volume), SKG_ERR_SCENE, "singular");
    source = good, source.affine[5] = (double)NAN;
    ck_skg_fails(skg_volume_create(&source, &volume), SKG_ERR_SCENE, "not finite");
    source = good, source.slices = 0;
    ck_skg_fails(skg_volume_create(&source, &volume), SKG_ERR_ARGUMENT, "3 x 2 x 0 cells");
    source = good, source.cells = NULL;
    ck_skg_fails(skg_volume_create(&source, &volume), SKG_ERR_ARGUMENT, "no cells");
    source_of(&source, floats, SKG_VOLUME_FLOAT32, SKG_VOLUME_HU);
    floats[0] = 1e6f;
    ck_skg_fails(skg_volume_create(&source, &volume), SKG_ERR_ARGUMENT, "Hounsfield numbers from 0 to 1e+06");
    ck_skg_fails(skg_volume_load("nowhere.mha", 1, NULL, &volume), SKG_ERR_FILE, "nowhere.mha");
    ck_skg_fails(skg_volume_load("a.stl", 1, NULL, &volume), SKG_ERR_UNSUPPORTED, ".stl");
    skg_material_release(&mu);
    skg_material_release(&water);
}
END_TEST

/* Writes a MetaImage whose second axis is z, downward. */
static void write_file(const char *path, int cells) {
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    fprintf(
        file,
        "ObjectType = Image\nNDims = 3\nBinaryDataByteOrderMSB = False\nTransformMatrix = 1 0 0 0 0 -1 0 1 0\n"
        "Offset = 5 6 7\nElementSpacing = 2 3 4\nDimSize = 3 2 4\nElementType = MET_SHORT\n"
        "ElementDataFile = LOCAL\n");
    for (int k = 0; k < cells; k++) {
        const unsigned char bytes[2] = {(unsigned char)(numbers[k % CELLS] & 255),
                                        (unsigned char)(numbers[k % CELLS] >> 8 & 255)};
        fwrite(bytes, 1, 2, file);
    }
    fclose(file);
}

START_TEST(files_say_where_cells_are) {
    static const double expected[16] = {2, 0, 0, 5, 0, 0, 4, 6, 0, -3, 0, 7, 0, 0, 0, 1};
    char path[128];
    const char *name = NULL;
    double share = 0, all = 0;
    skg_volume *volume = NULL;
    skg_volume_contents contents;
    snprintf(path, sizeof path, "volume-%d.mha", (int)getpid());
    write_file(path, CELLS - 1);
    ck_skg_fails(skg_volume_load(path, 1, NULL, &volume), SKG_ERR_FORMAT, "ends in slice 3 of 4");
    write_file(path, CELLS + 1);
    ck_skg_fails(skg_volume_load(path, 1, NULL, &volume), SKG_ERR_FORMAT,
                 "holds more than the 3 x 2 x 4 cells");
    write_file(path, CELLS);
    ck_skg_fails(skg_volume_load(path, -1, NULL, &volume), SKG_ERR_ARGUMENT, "unit of -1 mm");
    ck_skg(skg_volume_load(path, 1, NULL, &volume));
    remove(path);
    skg_volume_contents_init(&contents);
    ck_skg(skg_volume_contents_get(volume, &contents));
    ck_assert_int_eq(contents.columns, 3);
    ck_assert_int_eq(contents.slices, 4);
    ck_assert_int_eq(contents.bits, 16);
    ck_assert_double_eq(contents.low, -1000);
    ck_assert_double_eq(contents.high, 1540);
    ck_assert_mem_eq(contents.affine, expected, sizeof expected);
    ck_assert_double_eq(contents.spacing[1], 3);
    for (int k = 0; k < contents.classes; k++) {
        ck_skg(skg_volume_class_get(volume, k, &name, &share));
        all += share;
    }
    ck_assert_double_eq_tol(all, 1, 64 * DBL_EPSILON);
    skg_volume_release(&volume);
}
END_TEST

/* One volume in NRRD, raw and, as another program has written it, by gzip. */
START_TEST(nrrd_files_are_read) {
    static const unsigned char zipped[] = {
        31,  139, 8,   0,   0,   0,   0,   0,   2,   3,   1,  48, 0,   207, 255, 24,  252, 44,
        252, 68,  253, 136, 255, 196, 255, 246, 255, 20,  0,  60, 0,   110, 0,   250, 0,   74,
        1,   224, 1,   48,  2,   178, 2,   82,  3,   222, 3,  76, 4,   186, 4,   40,  5,   150,
        5,   4,   6,   40,  0,   0,   0,   212, 254, 187, 65, 26, 140, 48,  0,   0,   0};
    static const double expected[16] = {2, 0, 0, 5, 0, 0, 4, 6, 0, -3, 0, 7, 0, 0, 0, 1};
    char path[128];
    skg_volume *volume = NULL;
    skg_volume_contents contents;
    snprintf(path, sizeof path, "volume-%d.nrrd", (int)getpid());
    for (int gzip = 0; gzip < 2; gzip++) {
        FILE *file = fopen(path, "wb");
        ck_assert_ptr_nonnull(file);
        fprintf(
            file,
            "NRRD0004\n# a comment\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 3 2 4\n"
            "space directions: (2,0,0) (0,0,-3) (0,4,0)\nkinds: domain domain domain\nendian: %s\nencoding: %s\n"
            "space origin: (5,6,7)\nkey:=value\n\n",
            gzip ? "little" : "big", gzip ? "gzip" : "raw");
        for (int k = 0; k < CELLS && !gzip; k++)
            fputc(numbers[k] >> 8 & 255, file), fputc(numbers[k] & 255, file);
        if (gzip) fwrite(zipped, 1, sizeof zipped, file);
        fclose(file);
        ck_skg(skg_volume_load(path, 1, NULL, &volume));
        skg_volume_contents_init(&contents);
        ck_skg(skg_volume_contents_get(volume, &contents));
        ck_assert_double_eq(contents.low, -1000);
        ck_assert_double_eq(contents.high, 1540);
        ck_assert_mem_eq(contents.affine, expected, sizeof expected);
        skg_volume_release(&volume);
    }
    FILE *file = fopen(path, "wb");
    fprintf(file, "NRRD0004\ntype: short\ndimension: 3\nsizes: 3 2 4\nencoding: gzip\n\n");
    fwrite(zipped, 1, sizeof zipped / 2, file);
    fclose(file);
    ck_skg_fails(skg_volume_load(path, 1, NULL, &volume), SKG_ERR_FORMAT, "is it the whole file");
    remove(path);
}
END_TEST

/* A header of NIfTI-1 or -2 in memory. big: of the other byte order than x86's */
typedef struct {
    unsigned char bytes[544];
    int version, big;
} nifti_header;

static void put(nifti_header *h, int at, const void *value, int bytes) {
    for (int k = 0; k < bytes; k++)
        h->bytes[at + k] = ((const unsigned char *)value)[h->big ? bytes - 1 - k : k];
}
static void put_int(nifti_header *h, int at, long value, int bytes) {
    const int16_t two = (int16_t)value;
    const int32_t four = (int32_t)value;
    const int64_t eight = value;
    put(h, at, bytes == 2 ? (const void *)&two : bytes == 4 ? (const void *)&four : &eight, bytes);
}
static void put_reals(nifti_header *h, int at, const double *values, int count) {
    for (int k = 0; k < count; k++) {
        const float single = (float)values[k];
        if (h->version == 1)
            put(h, at + 4 * k, &single, 4);
        else
            put(h, at + 8 * k, &values[k], 8);
    }
}

/* 3 x 2 x 4 cells of 16 bits, 2 x 3 x 4 mm. ways: 0: of no place; 1: a quaternion of a quarter turn about z; 2: a matrix, too, in cm */
static nifti_header nifti_of(int version, int big, int ways) {
    static const double spacing[4] = {1, 2, 3, 4}, quaternion[6] = {0, 0, 0.70710678118654752440, 5, 6, 7};
    static const double rows[12] = {.2, 0, 0, .5, 0, 0, .4, .6, 0, -.3, 0, .7}, scale[2] = {2, -10};
    static const int dim[8] = {3, 3, 2, 4, 1, 1, 1, 1};
    nifti_header h = {.version = version, .big = big};
    const int second = version == 2;
    put_int(&h, 0, second ? 540 : 348, 4);
    memcpy(h.bytes + (second ? 4 : 344), "n+2", 3);
    if (!second) h.bytes[346] = '1';
    for (int k = 0; k < 8; k++) put_int(&h, second ? 16 + 8 * k : 40 + 2 * k, dim[k], second ? 8 : 2);
    put_int(&h, second ? 12 : 70, 4, 2);
    put_reals(&h, second ? 104 : 76, spacing, 4);
    if (second)
        put_int(&h, 168, 544, 8);
    else
        put_reals(&h, 108, (const double[]){352}, 1);
    put_reals(&h, second ? 176 : 112, scale, 2);
    put_int(&h, second ? 344 : 252, ways > 0, second ? 4 : 2);
    put_int(&h, second ? 348 : 254, ways > 1, second ? 4 : 2);
    put_reals(&h, second ? 352 : 256, quaternion, 6);
    put_reals(&h, second ? 400 : 280, rows, 12);
    if (second)
        put_int(&h, 500, ways > 1 ? 0 : 2, 4);
    else
        h.bytes[123] = ways > 1 ? 0 : 2;
    return h;
}

static skg_status load_nifti_in(const nifti_header *h, int cells, double unit_mm, skg_volume **volume) {
    char path[128];
    snprintf(path, sizeof path, "volume-%d.nii", (int)getpid());
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    fwrite(h->bytes, 1, h->version == 2 ? 544 : 352, file);
    for (int k = 0; k < cells; k++) {
        const int low = numbers[k] & 255, high = numbers[k] >> 8 & 255;
        fputc(h->big ? high : low, file), fputc(h->big ? low : high, file);
    }
    fclose(file);
    const skg_status status = skg_volume_load(path, unit_mm, NULL, volume);
    remove(path);
    return status;
}

static skg_status load_nifti(const nifti_header *h, int cells, skg_volume **volume) {
    return load_nifti_in(h, cells, 0, volume);
}

/* x and y of NIfTI point to the right and front. A quarter turn takes its columns to y and its rows to -x. */
START_TEST(nifti_files_are_read) {
    static const double turned[16] = {0, 3, 0, -5, -2, 0, 0, -6, 0, 0, 4, 7, 0, 0, 0, 1};
    static const double matrix[16] = {-.2, 0, 0, -.5, 0, 0, -.4, -.6, 0, -.3, 0, .7, 0, 0, 0, 1};
    skg_volume *volume = NULL;
    skg_volume_contents contents;
    for (int k = 0; k < 8; k++) {
        const int version = 1 + k % 2, big = k / 2 % 2, ways = 1 + k / 4;
        nifti_header h = nifti_of(version, big, ways);
        const double *expected = ways > 1 ? matrix : turned;
        ck_skg(load_nifti(&h, CELLS, &volume));
        skg_volume_contents_init(&contents);
        ck_skg(skg_volume_contents_get(volume, &contents));
        ck_assert_int_eq(contents.slices, 4);
        ck_assert_double_eq(contents.low, -2010); /* of -1000: times 2, less 10 */
        ck_assert_double_eq(contents.high, 3070);
        /* Places are floats in NIfTI-1: half of 2^-23 of 7. */
        for (int i = 0; i < 16; i++) ck_assert_double_eq_tol(contents.affine[i], expected[i], 7 * 0x1p-24);
        skg_volume_release(&volume);
    }
    nifti_header h = nifti_of(2, 0, 1); /* says mm */
    int32_t level = 0;
    const char *sentence = NULL;
    ck_skg(load_nifti_in(&h, CELLS, 10, &volume));
    ck_skg(skg_volume_contents_get(volume, &contents));
    ck_assert_double_eq_tol(contents.affine[1], 30, 64 * DBL_EPSILON * 30);
    ck_skg(skg_volume_remark_get(volume, 0, &level, &sentence));
    ck_assert_str_eq(sentence, "read in cm, as was asked; the file itself is in mm");
    skg_volume_release(&volume);
    h = nifti_of(1, 0, 0);
    ck_skg_fails(load_nifti(&h, CELLS, &volume), SKG_ERR_UNSUPPORTED, "does not say where its axes point");
    h = nifti_of(1, 0, 1);
    ck_skg_fails(load_nifti(&h, CELLS - 1, &volume), SKG_ERR_FORMAT, "ends in slice 3 of 4");
    h.bytes[344 + 1] = 'i';
    ck_skg_fails(load_nifti(&h, CELLS, &volume), SKG_ERR_UNSUPPORTED, "in a file of their own");
    h = nifti_of(1, 0, 1), put_int(&h, 40, 4, 2), put_int(&h, 48, 5, 2);
    ck_skg_fails(load_nifti(&h, CELLS, &volume), SKG_ERR_FORMAT, "has 4 dimensions");
    h = nifti_of(2, 0, 1), put_int(&h, 12, 128, 2);
    ck_skg_fails(load_nifti(&h, CELLS, &volume), SKG_ERR_UNSUPPORTED, "its type, 128");
    h = nifti_of(2, 0, 1), put_int(&h, 168, 100, 8);
    ck_skg_fails(load_nifti(&h, CELLS, &volume), SKG_ERR_FORMAT, "begin at byte 100");
    h = nifti_of(1, 0, 1), put_int(&h, 72, 8, 2);
    ck_skg_fails(load_nifti(&h, CELLS, &volume), SKG_ERR_FORMAT, "8 bits a value and type 4, which has 16");
    h = nifti_of(2, 1, 1), put_reals(&h, 184, (const double[]){(double)INFINITY}, 1);
    ck_skg_fails(load_nifti(&h, CELLS, &volume), SKG_ERR_FORMAT, "shifted by inf; correct scl_slope");
    h = nifti_of(1, 0, 1), put_reals(&h, 112, (const double[]){-(double)INFINITY}, 1);
    ck_skg_fails(load_nifti(&h, CELLS, &volume), SKG_ERR_FORMAT, "multiplied by -inf");
    h = nifti_of(1, 0, 1), put_reals(&h, 112, (const double[]){(double)NAN, (double)NAN}, 2);
    ck_skg(load_nifti(&h, CELLS, &volume));
    skg_volume_release(&volume);
    h = nifti_of(1, 0, 1), memset(h.bytes + 344, 0, 4);
    ck_skg_fails(load_nifti(&h, CELLS, &volume), SKG_ERR_UNSUPPORTED, "lacks the mark of NIfTI");
    h = nifti_of(2, 0, 1), h.bytes[0] = 0;
    ck_skg_fails(load_nifti(&h, CELLS, &volume), SKG_ERR_FORMAT, "is no NIfTI file");
}
END_TEST

/* Values beyond what scanners give are counted; padding far below air is air. */
START_TEST(values_beyond_tissue_are_counted) {
    static const int16_t cells[CELLS] = {-3024, -1024, 3000, 3001, 12000};
    double share = 0;
    const char *name = NULL;
    skg_volume *volume = NULL;
    skg_volume_source source;
    skg_volume_contents contents;
    source_of(&source, cells, SKG_VOLUME_INT16, SKG_VOLUME_HU);
    ck_skg(skg_volume_create(&source, &volume));
    skg_volume_contents_init(&contents);
    ck_skg(skg_volume_contents_get(volume, &contents));
    ck_assert_int_eq(contents.beyond, 2);
    ck_skg(skg_volume_class_get(volume, 0, &name, &share));
    ck_assert_str_eq(name, "Air");
    ck_assert_double_eq_tol(share, 2.0 / CELLS, 64 * DBL_EPSILON);
    skg_volume_release(&volume);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, bad_volumes_are_refused);
    tcase_add_test(tests, files_say_where_cells_are);
    tcase_add_test(tests, values_beyond_tissue_are_counted);
    tcase_add_test(tests, nrrd_files_are_read);
    tcase_add_test(tests, nifti_files_are_read);
}

SKG_SUITE_MAIN("volume_files", add_tests)
