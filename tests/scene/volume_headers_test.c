/* Headers of files of volumes: what says where cells are is read or refused, and never passed over. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <stdio.h>
#include <string.h>

/* Of headers that say more than places and sizes: what is read, and what is refused. The values are 24 zeros. */
static skg_status load_header(const char *name, const char *header, double unit_mm, skg_volume **volume) {
    static const char values[2 * 3 * 2 * 4] = {0};
    char path[128];
    snprintf(path, sizeof path, "header-%d.%s", (int)getpid(), name);
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    fputs(header, file);
    fwrite(values, 1, sizeof values, file);
    fclose(file);
    const skg_status status = skg_volume_load(path, unit_mm, NULL, volume);
    remove(path);
    return status;
}

#define MHA(more)                                                                                            \
    "ObjectType = Image\nNDims = 3\nDimSize = 3 2 4\n" more                                                  \
    "ElementType = MET_SHORT\nElementDataFile = LOCAL\n"
#define NRRD(more)                                                                                           \
    "NRRD0004\ntype: short\ndimension: 3\nsizes: 3 2 4\nendian: little\nencoding: raw\n" more "\n"
#define DIRECTIONS "space directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (5,6,7)\n"
#define RAW(type, slices, more)                                                                              \
    "NRRD0004\ntype: " type "\ndimension: 3\nsizes: 3 2 " slices "\nencoding: raw\n" more "\n"
#define CM "space units: \"cm\" \"cm\" \"cm\"\n"
#define LONG_TYPE(type)                                                                                      \
    {                                                                                                        \
        "nrrd", RAW(type, "1", "endian: little\n" DIRECTIONS), NULL, {2, 3, 4}, {                            \
            5, 6, 7                                                                                          \
        }                                                                                                    \
    }
#define BAD_DIRECTIONS(says)                                                                                 \
    {                                                                                                        \
        "nrrd", NRRD("space directions: " says "\n"),                                                        \
            ".nrrd: its field \"space directions\" says \"" says "\"; write three vectors", {0}, {           \
            0                                                                                                \
        }                                                                                                    \
    }

START_TEST(headers_are_not_passed_over) {
    static const struct {
        const char *name, *header, *says; /* says: NULL: it is read, with these steps and this place */
        double steps[3], origin[3];
    } all[] = {
        {"mha", MHA("BinaryData = False\n"), "its values are text", {0}, {0}},
        {"mha", MHA("ElementToIntensityFunctionSlope = 2\n"), "its values mean others", {0}, {0}},
        {"mha", MHA("NDims = 2\n"), "its NDims is 2", {0}, {0}},
        {"mha", MHA("NDims = 4\nDimSize = 3 2 4 1\n"), "has 4 dimensions (DimSize)", {0}, {0}},
        {"mha", MHA("DimSize = 3 2 4 1\n"), "its NDims is 3, but DimSize has 4 sizes", {0}, {0}},
        {"mha", MHA("ElementSize = 2 3 4\n"), NULL, {2, 3, 4}, {0}},
        {"mha",
         MHA("BinaryData = True\nElementSpacing = 1 1 2\nElementSize = 2 3 4\n"),
         NULL,
         {1, 1, 2},
         {0}},
        {"mha",
         MHA("ElementSpacing = 2 3 4\nOffset = 5 6 7\nDistanceUnits = cm\n"),
         NULL,
         {20, 30, 40},
         {50, 60, 70}},
        {"mha", MHA("ElementSpacing = 2 3 4\nDistanceUnits = ?\n"), NULL, {2, 3, 4}, {0}},
        {"mha", MHA("ElementSpacing = 2 3\n"), "its ElementSpacing does not say", {0}, {0}},
        {"mha", MHA("ElementSpacing = \n"), "its ElementSpacing does not say", {0}, {0}},
        {"mha", MHA("ElementSpacing = 2 3 4\nOffset = 5 nan 7\n"), "its Offset does not say", {0}, {0}},
        {"mha", MHA("TransformMatrix = 1 0 0 0 1 0\n"), "its TransformMatrix does not say", {0}, {0}},
        {"mha", MHA("DistanceUnits = cubit\n"), "its DistanceUnits are \"cubit\"", {0}, {0}},
        LONG_TYPE("long long int"),
        LONG_TYPE("signed long long int"),
        LONG_TYPE("signed long long"),
        LONG_TYPE("unsigned long long int"),
        LONG_TYPE("ulonglong"),
        {"nrrd", NRRD("endian: middle\n"), "its endian is \"middle\"", {0}, {0}},
        {"nrrd", NRRD(DIRECTIONS "space units: \"cm\"\n"), "one of its axes has no unit", {0}, {0}},
        {"nrrd", NRRD(DIRECTIONS), NULL, {2, 3, 4}, {5, 6, 7}},
        {"nrrd", NRRD(DIRECTIONS "space units: \"cm\" \"cm\" \"cm\"\n"), NULL, {20, 30, 40}, {50, 60, 70}},
        {"nrrd",
         NRRD(DIRECTIONS "space units: \"cubits\" \"mm\" \"mm\"\n"),
         "or one that is no length",
         {0},
         {0}},
        {"nrrd", NRRD(DIRECTIONS "space: right-anterior-superior\n"), NULL, {-2, -3, 4}, {-5, -6, 7}},
        {"nrrd", NRRD(DIRECTIONS "space: LAS\n"), NULL, {2, -3, 4}, {5, -6, 7}},
        {"nrrd", NRRD(DIRECTIONS "space: left-posterior-superior\n"), NULL, {2, 3, 4}, {5, 6, 7}},
        {"nrrd", NRRD("spacings: 2 3 4\nunits: \"m\" \"m\" \"m\"\n"), NULL, {2000, 3000, 4000}, {0}},
        {"nrrd", NRRD("space directions: (2,0,0) ( 0 , 3, 0 )\t(0,0,4e0)\n"), NULL, {2, 3, 4}, {0}},
        {"nrrd", NRRD(DIRECTIONS "Space: Right-Anterior-Superior\n"), NULL, {-2, -3, 4}, {-5, -6, 7}},
        {"nrrd", NRRD(DIRECTIONS "space: ras\n"), NULL, {-2, -3, 4}, {-5, -6, 7}},
        {"nrrd",
         NRRD(
             "spacedirections: (2,0,0) (0,3,0) (0,0,4)\nSpaceOrigin: (5,6,7)\nspaceunits: \"CM\" \"cm\" \"cm\"\n"),
         NULL,
         {20, 30, 40},
         {50, 60, 70}},
        {"nrrd", NRRD(DIRECTIONS "old min: -1\nold max: 4\n"), "its values stand for others", {0}, {0}},
        BAD_DIRECTIONS("(2,0,0) (0,2,0) none"),
        BAD_DIRECTIONS("(2,0,0) (0,2,0)"),
        BAD_DIRECTIONS("(2;0;0) (0,2,0) (0,0,2)"),
        BAD_DIRECTIONS("(2,0) (0,2) (0,0)"),
        BAD_DIRECTIONS("(nan,0,0) (0,2,0) (0,0,2)"),
        BAD_DIRECTIONS("(2,0,0) (0,1e999,0) (0,0,2)"),
        BAD_DIRECTIONS("(2,0,0) (0,2,0) (0,0,2) (0,0,3)"),
        {"nrrd", NRRD("space directions: (2,0,0) (0,3,0) (0,0,0)\n"), "singular", {0}, {0}},
        {"nrrd",
         NRRD(DIRECTIONS "space origin: (1,2)\n"),
         "its field \"space origin\" says \"(1,2)\"",
         {0},
         {0}},
        {"nrrd", NRRD("spacings: 2 3\n"), "its field \"spacings\" says \"2 3\"; write three", {0}, {0}},
        {"nrrd", NRRD("spacings: 2 nan 3\n"), "its field \"spacings\" says \"2 nan 3\"", {0}, {0}},
        {"nrrd", NRRD("spacings: nan nan nan\n" DIRECTIONS), NULL, {2, 3, 4}, {5, 6, 7}},
        {"nrrd", NRRD("spacings: 2 3 4\naxis mins: 1 1 1\n"), "is placed by axis mins", {0}, {0}},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        skg_volume *volume = NULL;
        skg_volume_contents contents;
        const skg_status status = load_header(all[i].name, all[i].header, 0, &volume);
        if (all[i].says) {
            ck_assert_int_lt(status, 0);
            ck_assert_msg(strstr(skg_last_error(), all[i].says) != NULL, "%s", skg_last_error());
            continue;
        }
        ck_skg(status);
        skg_volume_contents_init(&contents);
        ck_skg(skg_volume_contents_get(volume, &contents));
        for (int k = 0; k < 3; k++) {
            ck_assert_double_eq(contents.affine[5 * k], all[i].steps[k]);
            ck_assert_double_eq(contents.affine[4 * k + 3], all[i].origin[k]);
        }
        skg_volume_release(&volume);
    }
}
END_TEST

/* The caller's words win over the file, and each assumption for a value that the file lacks is told. */
START_TEST(what_was_taken_is_told) {
    static const struct {
        const char *name, *header;
        double unit_mm, step; /* step: of x, mm */
        int64_t count;
        const char *says; /* the first remark */
    } all[] = {
        {"nrrd", NRRD(DIRECTIONS CM), 0, 20, 0, NULL},
        {"nrrd", NRRD(DIRECTIONS CM), 10, 20, 0, NULL},
        {"nrrd", NRRD(DIRECTIONS CM), 1, 2, 1, "read in mm, as was asked; the file itself is in cm"},
        {"nrrd", NRRD(DIRECTIONS), 10, 20, 0, NULL},
        {"nrrd", NRRD("spacings: 2 3 4\nunits: \"m\" \"mm\" \"m\"\n"), 10, 20, 1,
         "read in cm, as was asked; the file itself is in m, mm and m"},
        {"mha", MHA("ElementSpacing = 2 3 4\nDistanceUnits = mm\n"), 10, 20, 1,
         "read in cm, as was asked; the file itself is in mm"},
        {"mha", MHA("ElementSpacing = 2 3 4\nDistanceUnits = mm\n"), 1, 2, 0, NULL},
        {"mha", MHA(""), 0, 1, 1, "does not say how large its cells are, which are taken as 1 x 1 x 1 mm"},
        {"nrrd", NRRD("spacings: 2 3 4\n"), 0, 2, 0, NULL},
        {"nrrd", NRRD(""), 10, 10, 1, "taken as 10 x 10 x 10 mm; write it there (NRRD: space directions"},
        {"nrrd", NRRD("thicknesses: 2 3 4\n"), 0, 1, 1, "taken as 1 x 1 x 1 mm"},
        {"nrrd", RAW("short", "4", "spacings: 2 3 4\n"), 0, 2, 1,
         "has no endian, which NRRD demands of numbers of several bytes; little"},
        {"nrrd", RAW("short", "4", "thicknesses: 2 3 4\n"), 0, 1, 2, "taken as 1 x 1 x 1 mm"},
        {"nrrd", RAW("uchar", "8", "spacings: 2 3 4\n"), 0, 2, 0, NULL},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        skg_volume *volume = NULL;
        skg_volume_contents contents;
        int32_t level = 0;
        const char *sentence = "";
        const skg_status status = load_header(all[i].name, all[i].header, all[i].unit_mm, &volume);
        ck_skg(status);
        skg_volume_contents_init(&contents);
        ck_skg(skg_volume_contents_get(volume, &contents));
        ck_assert_double_eq(contents.affine[0], all[i].step);
        ck_assert_msg(contents.remarks == all[i].count, "%zu: %d", i, (int)contents.remarks);
        if (all[i].says) ck_skg(skg_volume_remark_get(volume, 0, &level, &sentence));
        if (all[i].says) ck_assert_msg(strstr(sentence, all[i].says) != NULL, "%zu: %s", i, sentence);
        if (all[i].says)
            ck_assert_int_eq(level, strstr(sentence, "as was asked") ? SKG_LOG_NOTE : SKG_LOG_WARNING);
        ck_skg_fails(skg_volume_remark_get(volume, contents.remarks, &level, &sentence), SKG_ERR_ARGUMENT,
                     "remark");
        skg_volume_release(&volume);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, headers_are_not_passed_over);
    tcase_add_test(tests, what_was_taken_is_told);
}

SKG_SUITE_MAIN("volume_headers", add_tests)
