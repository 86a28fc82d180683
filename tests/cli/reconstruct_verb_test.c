/* The verb reconstruct with projections in stacks, in folders of TIFFs, and from a Nikon scanner. */
#include "cli/command.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

enum { SIDE = 40, VOXELS = SIDE * SIDE * SIDE };

/* A cube of 0.2 per cm, beside the axis, so that no wrong sense of rotation or mirror image gives the same volume. */
static const char body[] =
    "{\"Source\": {\"Position\": [0, -400, 0, \"mm\"], \"Shape\": \"PointSource\",\n"
    "    \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]},\n"
    "  \"Detector\": {\"Position\": [0, 200, 0, \"mm\"], \"UpVector\": [0, 0, -1],\n"
    "    \"NumberOfPixels\": [80, 48], \"Spacing\": [1.5, 1.5, \"mm\"]},\n"
    "  \"Scan\": {\"NumberOfProjections\": 60, \"StartAngle\": -170, \"FinalAngle\": 190},\n"
    "  \"Samples\": [{\"Label\": \"body\", \"Cuboid\": [30, 16, 20, \"mm\"], \"Material\": [\"mu\", 0.2],\n"
    "    \"Transform\": [[\"Translation\", 4, 9, 3, \"mm\"]]}]}\n";

static float first[VOXELS], second[VOXELS];

static void set_up_scan(void) {
    set_up();
    write_text("body.json", body);
    ck_run(0, "scan body.json -o out --geometry poses.csv --flats 2 --darks 1 --quiet");
}

static void tear_down_scan(void) {
    char line[128];
    snprintf(line, sizeof line, "rm -rf %s", folder);
    ck_assert_int_eq(system(line), 0);
}

static void shell(const char *line) {
    char text[512];
    snprintf(text, sizeof text, "cd %s && %s", folder, line);
    ck_assert_int_eq(system(text), 0);
}

static void reconstruct(const char *what, float *volume) {
    char path[512];
    ck_run(0, "reconstruct %s -o volume.mha --size %d --voxel 1 --filter hann --quiet", what, SIDE);
    snprintf(path, sizeof path, "%s/volume.mha", folder);
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_int_eq(fseek(stream, -(long)(VOXELS * sizeof *volume), SEEK_END), 0);
    ck_assert_uint_eq(fread(volume, sizeof *volume, VOXELS, stream), VOXELS);
    fclose(stream);
}

/* 2e-5 of the cube: roundings of poses and of logarithms. */
static void ck_same(void) {
    for (int i = 0; i < VOXELS; i++) ck_assert_double_eq_tol((double)second[i], (double)first[i], 4e-6);
}

static double voxel(const float *volume, double x, double y, double z) {
    const double middle = 0.5 * (SIDE - 1);
    return (double)
        volume[((int)lrint(z + middle) * SIDE + (int)lrint(y + middle)) * SIDE + (int)lrint(x + middle)];
}

START_TEST(a_folder_is_a_stack) {
    reconstruct("out/ --geometry poses.csv", first);
    ck_assert_double_eq_tol(voxel(first, 4, 9, 3), 0.2, 0.004);  /* 2 %: 60 projections */
    ck_assert_double_eq_tol(voxel(first, -4, -9, -3), 0, 0.004); /* 2 % of the cube, beside it */
    ck_run(0, "scan body.json -o stack.tif --quiet");
    reconstruct("stack.tif --geometry poses.csv", second);
    ck_same();
    ck_run(0, "scan body.json -o stack.raw --flats 2 --quiet");
    reconstruct("stack.mhd --geometry poses.csv", second);
    ck_same();
    ck_run(0, "scan body.json -o lines --quantity attenuation --quiet");
    reconstruct("lines --geometry poses.csv", second);
    ck_same();
    shell("rm out/flat* out/dark*"); /* scan.txt has the flat field */
    reconstruct("out --geometry poses.csv", second);
    ck_same();
}
END_TEST

static void ck_near(double tolerance) {
    for (int i = 0; i < VOXELS; i++) ck_assert_double_eq_tol((double)second[i], (double)first[i], tolerance);
}

/* A map of 80 x 48 floats: 0.8 to 1.2 of a gain, or 0 to 400 of an offset. */
static void write_map(const char *name, float least, float most) {
    enum { PIXELS = 80 * 48 };
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "wb");
    ck_assert_ptr_nonnull(stream);
    for (int i = 0; i < PIXELS; i++) {
        const float value = least + (most - least) * (float)(i * 37 % 101) / 100;
        ck_assert_uint_eq(fwrite(&value, sizeof value, 1, stream), 1);
    }
    ck_assert_int_eq(fclose(stream), 0);
}

/* Kinds of values of pixels, and whether one number for all of them is enough. Of 16 bits, half a grey value of 5000 behind the cube and of
 * 45000 beside it is 1e-4 and 1e-5 of an attenuation, which the filter makes 2e-4 of 0.2 per cm at most. The
 * cube takes the place of 2.3e-4 per cm of air. */
static const struct {
    const char *set;
    int varies;
    double tolerance;
} kinds[] = {
    {"Detector.GreyValues='{\"Dark\":5000,\"Full\":50000}'", 0, 2e-4},
    {"Detector.GreyValues='{\"PerJoule\":1e15,\"Dark\":3,\"Bits\":0}'", 0, 4e-6},
    {"Detector.GreyValues='{\"Curve\":[[0,100],[1e-9,60000]],\"Bits\":0}'", 0, 4e-6},
    {"Detector.GreyValues='{\"Gain\":{\"Path\":\"gain.raw\"},\"Dark\":500,\"Full\":50000}'", 1, 2e-4},
    {"Detector.GreyValues='{\"Offset\":{\"Path\":\"offset.raw\"}}'", 1, 2e-4},
    {"Falloff=true", 1, 4e-6},
    {"World=Air", 1, 3e-4}};
enum { KINDS = sizeof kinds / sizeof *kinds };

START_TEST(pixels_of_any_values) {
    static const char *const places[] = {"any.mha", "any.tif", "any"};
    static const char *const flats[] = {"any-flats.mha", "any-flats.tif", "any/flat-00000.tif"};
    char line[128], path[512];
    write_map("gain.raw", 0.8F, 1.2F);
    write_map("offset.raw", 0, 400);
    reconstruct("out --geometry poses.csv", first);
    for (int p = 0; p < 3; p++) {
        ck_run(0, "scan body.json --set %s -o %s --quiet", kinds[_i].set, places[p]);
        snprintf(line, sizeof line, "%s --geometry poses.csv", places[p]);
        reconstruct(line, second);
        ck_near(kinds[_i].tolerance);
        snprintf(path, sizeof path, "%s/%s", folder, flats[p]);
        ck_assert_int_eq(access(path, F_OK) == 0, kinds[_i].varies);
        if (!kinds[_i].varies) continue;
        ck_assert_int_eq(unlink(path), 0);
        ck_run_fails(3, "fields are missing, which differ from pixel to pixel",
                     "reconstruct %s --geometry poses.csv -o a.mha", places[p]);
        ck_run(0, "scan body.json --set %s -o %s --quiet --flats 1", kinds[_i].set, places[p]);
        ck_run(0, "reconstruct %s --geometry poses.csv -o a.mha --size 8 --quiet", places[p]);
    }
}
END_TEST

/* The dark fields of an offset are needed, too; and a header that older versions wrote is told of. */
START_TEST(what_a_header_lacks_is_told) {
    write_map("offset.raw", 0, 400);
    ck_run(0, "scan body.json --set %s -o dark.mha --flats 1 --darks 0 --quiet", kinds[4].set);
    ck_run_fails(3, "its dark fields are missing", "reconstruct dark.mha --geometry poses.csv -o a.mha");
    shell(
        "rm out/flat* out/dark* && sed -i '/^Dark/d; /^FlatFieldVaries/d; s/^FlatField = .*/FlatField = 120000/' "
        "out/scan.txt");
    ck_run(0, "reconstruct out --geometry poses.csv -o a.mha --size 8");
    ck_assert_msg(strstr(complained, "has FlatField but not Dark") &&
                      strstr(complained, "has 0.5 of FlatField"),
                  "%s", complained);
}
END_TEST

/* A dead pixel is told of, and what is no number is refused where it stands. */
START_TEST(dead_pixels_are_told) {
    enum { COLUMNS = 80, ROWS = 48, COUNT = 60 };
    static float values[COUNT][ROWS][COLUMNS];
    ck_run(0, "scan body.json -o t.mha --quantity transmission --geometry t.csv --quiet");
    for (int is_nan = 0; is_nan < 2; is_nan++) {
        char path[512];
        snprintf(path, sizeof path, "%s/t.mha", folder);
        FILE *stream = fopen(path, "r+b");
        ck_assert_ptr_nonnull(stream);
        ck_assert_int_eq(fseek(stream, -(long)sizeof values, SEEK_END), 0);
        ck_assert_uint_eq(fread(values, sizeof values, 1, stream), 1);
        for (int k = 0; k < COUNT; k++) values[k][3][5] = 0;
        if (is_nan) values[7][4][6] = NAN;
        ck_assert_int_eq(fseek(stream, -(long)sizeof values, SEEK_END), 0);
        ck_assert_uint_eq(fwrite(values, sizeof values, 1, stream), 1);
        ck_assert_int_eq(fclose(stream), 0);
        if (is_nan) {
            ck_run_fails(2, "row 4, column 6", "reconstruct t.mha --geometry t.csv -o v.mha --size 8");
        } else {
            ck_run(0, "reconstruct t.mha --geometry t.csv -o v.mha --size 8");
            ck_assert_msg(strstr(complained, "warning: 60 pixels of the projections") != NULL, "%s",
                          complained);
        }
    }
}
END_TEST

START_TEST(what_a_folder_lacks_is_named) {
    ck_run_fails(3, "out: holds projections without the places", "reconstruct out -o a.mha");
    ck_run_fails(3, "name the .mhd", "reconstruct out.raw --geometry poses.csv -o a.mha");
    shell("mv out/projection-00007.tif spare.tif");
    ck_run_fails(3, "out: projection 7 is missing, between projection-00006.tif and projection-00008.tif",
                 "reconstruct out --geometry poses.csv -o a.mha");
    shell("mv spare.tif out/preview.tif");
    ck_run_fails(3, "out/preview.tif: has no number", "reconstruct out/ --geometry poses.csv -o a.mha");
    shell("mv out/preview.tif out/other-00007.tif");
    ck_run_fails(3, "two scans, projection-00000.tif and other-00007.tif",
                 "reconstruct out --geometry poses.csv -o a.mha");
    shell("mv out/other-00007.tif out/projection-6.tif");
    ck_run_fails(3, "projection 6 is there twice", "reconstruct out --geometry poses.csv -o a.mha");
    shell("rm out/projection-6.tif out/projection-0000?.tif");
    ck_run_fails(3, "has 60 poses, but out has 50 projections",
                 "reconstruct out --geometry poses.csv -o a.mha");
    shell("rm out/proj*");
    ck_run_fails(3, "out: has no projections", "reconstruct out --geometry poses.csv -o a.mha");
}
END_TEST

/* A Nikon scanner's file of this scan, in CIL's frame: InitialAngle 10, a step of 6 degrees, 16 bits with a white level. */
static const char nikon[] =
    "\xef\xbb\xbf[XTekCT]\r\nName=body\r\nProjections=60\r\nInitialAngle=10\r\nANGULARSTEP=6.0\r\n"
    "SrcToObject=400\r\nSrcToDetector=600\r\nDetectorPixelsX=80\r\nDetectorPixelsY=48\r\n"
    "DetectorPixelSizeX=1.5\r\nDetectorPixelSizeY = 1.5\r\nWhiteLevel=60000\r\nUnits=mm\r\n"
    "DetectorOffsetX=0.0\r\nInputFolderName=images\r\n%s\r\n[Xrays]\r\nDetectorKV=105\r\n";

static void write_nikon(const char *more) {
    char text[1024];
    snprintf(text, sizeof text, nikon, more);
    write_text("body.xtekct", text);
}

START_TEST(a_nikon_scan_is_its_scan) {
    reconstruct("out --geometry poses.csv", first);
    shell("cp -r out images && rm images/flat* images/dark* images/scan.txt");
    write_nikon("");
    reconstruct("body.xtekct", second); /* the flat field of these files is 60000 keV, too */
    ck_same();
    reconstruct("images --geometry body.xtekct", second);
    ck_same();
    write_nikon("DetectorOffsetX=2");
    ck_run_fails(3, "DetectorOffsetX is 2, and what it does", "reconstruct body.xtekct -o a.mha");
    write_nikon("HelicalPitch=2");
    ck_run_fails(3, "HelicalPitch is 2", "reconstruct body.xtekct -o a.mha");
    write_nikon("ObjectTilt=15");
    ck_run_fails(3,
                 "leans out of the detector's plane by 15 degrees; the method of Feldkamp takes up to 5.74",
                 "reconstruct body.xtekct -o a.mha");
    write_nikon("ObjectRoll=7");
    ck_run_fails(3, "across the axis of rotation but lean by 7 degrees", "reconstruct body.xtekct -o a.mha");
    write_nikon("InputFolderName=none");
    ck_run_fails(3, "its InputFolderName, none, is no folder", "reconstruct body.xtekct -o a.mha");
    write_nikon("Projections=59");
    ck_run_fails(3, "Projections is both 60 and 59", "reconstruct body.xtekct -o a.mha");
    write_nikon("Units=inch");
    ck_run_fails(3, "Units is inch", "reconstruct body.xtekct -o a.mha");
    write_text("few.xtekct", "[XTekCT]\nProjections=60\n");
    ck_run_fails(3, "few.xtekct: DetectorPixelsX is missing", "reconstruct few.xtekct -o a.mha");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scan, tear_down_scan);
    tcase_add_test(tests, a_folder_is_a_stack);
    tcase_add_loop_test(tests, pixels_of_any_values, 0, KINDS);
    tcase_add_test(tests, what_a_header_lacks_is_told);
    tcase_add_test(tests, dead_pixels_are_told);
    tcase_add_test(tests, what_a_folder_lacks_is_named);
    tcase_add_test(tests, a_nikon_scan_is_its_scan);
}

SKG_SUITE_MAIN("reconstruct", add_tests)
