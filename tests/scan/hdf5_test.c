/* Contents of an .h5, as HDF5's own library reads it: Data Exchange, geometry, progress. */
#include "suite.h"
#include "support/run.h"

#include <hdf5.h>
#include <skiagraph/scan_reader.h>
#include <skiagraph/scanning.h>

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = 24, PIXELS = SIDE * SIDE, COUNT = 5, FLATS = 2 };

#define PI 3.14159265358979323846

static const char hash[] = "00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff";

static char folder[64], path[128];
static skg_view view;
static skg_scene *scene;
static skg_mesh *blob;
static skg_plan *plan;
static skg_scan *scan;

static void open_scene(void) {
    run_open();
    strcpy(folder, "/tmp/skg-hdf5-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/scan.h5", folder);
    view = run_view(SIDE, 6);
    solid s = solid_blob(60, 40, 20, 1);
    blob = run_mesh(&s);
    solid_free(&s);
    ck_skg(skg_scene_create(run_context, &scene));
    run_part(scene, "blob", blob, 0.2, NULL, -1);
    plan = run_plan(scene, &view, (run_choice){0});
    skg_scan_options options;
    skg_scan_options_init(&options);
    options.projections = COUNT;
    options.step_rad = PI / 10;
    options.axis[1] = 1;
    options.axis[2] = 0;
    options.start_s = 3;
    options.interval_s = 0.5;
    ck_skg(skg_scan_create(&view, &options, &scan));
}

static void close_scene(void) {
    skg_scan_release(&scan);
    skg_plan_release(&plan);
    skg_mesh_release(&blob);
    skg_scene_release(&scene);
    unlink(path);
    ck_assert_int_eq(rmdir(folder), 0);
    run_close();
}

static void read_set(hid_t root, const char *name, hid_t type, hsize_t count, void *to) {
    const hid_t set = H5Dopen2(root, name, H5P_DEFAULT);
    ck_assert_msg(set >= 0, "no %s", name);
    const hid_t space = H5Dget_space(set);
    ck_assert_int_eq(H5Sget_simple_extent_npoints(space), (hssize_t)count);
    ck_assert_int_ge(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to), 0);
    H5Sclose(space);
    H5Dclose(set);
}

static skg_status keep(const skg_scan_batch *batch, void *user) {
    static const double phases[COUNT] = {0.5, 0.25, 0.125, 0, 0.75};
    return skg_scan_file_write(user, batch->count, batch->indices, batch->images, phases + batch->indices[0]);
}

START_TEST(what_hdf5_reads) {
    static float images[COUNT][PIXELS], expected[PIXELS], white[FLATS][PIXELS], dark[PIXELS];
    double vectors[COUNT][3], numbers[COUNT];
    unsigned char done[COUNT];
    char text[65] = "";
    skg_scan_file *file = NULL;
    skg_scan_file_options options;
    skg_scan_run_options run;
    skg_channel channel;
    skg_channel_init(&channel);
    ck_skg(skg_plan_channel_get(plan, 0, &channel));
    skg_scan_file_options_init(&options);
    options.scan = scan;
    options.hash = hash;
    options.name = channel.name;
    options.unit = channel.unit;
    options.flat_field = channel.flat_field;
    options.samples = 1;
    options.flats = FLATS;
    ck_skg(skg_scan_file_open(path, &options, &file));
    ck_skg(skg_scan_flat_fields_render(plan, scene, scan, NULL, FLATS, white));
    ck_skg(skg_scan_file_fields_write(file, FLATS, white, 1, dark));
    ck_skg_fails(skg_scan_file_fields_write(file, 1, white, 1, dark), SKG_ERR_ARGUMENT, "room for 2");
    skg_scan_run_options_init(&run);
    run.batch = 1;
    run.only_count = 2;
    run.only = (const int64_t[]){1, 4};
    ck_skg(skg_scan_run_each(plan, scan, &run, keep, file));
    ck_skg(skg_scan_file_finish(file));
    skg_scan_file_release(&file);
    const hid_t root = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    ck_assert_int_ge(root, 0);
    read_set(root, "exchange/data", H5T_NATIVE_FLOAT, COUNT * PIXELS, images);
    read_set(root, "exchange/data_white", H5T_NATIVE_FLOAT, FLATS * PIXELS, white);
    read_set(root, "exchange/data_dark", H5T_NATIVE_FLOAT, PIXELS, dark);
    for (int i = 0; i < PIXELS; i++)
        ck_assert((double)white[1][i] == channel.flat_field && (double)dark[i] == 0);
    for (int64_t k = 1; k < COUNT; k += 3) {
        skg_output output;
        skg_view of;
        skg_view_init(&of);
        skg_output_init(&output);
        output.data = expected;
        ck_skg(skg_scan_view_get(scan, k, &of));
        ck_skg(skg_plan_view_set(plan, &of));
        ck_skg(skg_plan_image(plan, &output));
        ck_assert_mem_eq(images[k], expected, sizeof expected);
        read_set(root, "geometry/source", H5T_NATIVE_DOUBLE, 3 * COUNT, vectors);
        ck_assert_mem_eq(vectors[k], of.source, sizeof of.source);
        read_set(root, "geometry/row_step", H5T_NATIVE_DOUBLE, 3 * COUNT, vectors);
        ck_assert_mem_eq(vectors[k], of.row_step, sizeof of.row_step);
    }
    read_set(root, "exchange/theta", H5T_NATIVE_DOUBLE, COUNT, numbers);
    ck_assert_double_eq_tol(numbers[3], 54, 1e-13); /* some roundings of 54 */
    read_set(root, "geometry/time", H5T_NATIVE_DOUBLE, COUNT, numbers);
    ck_assert_double_eq(numbers[4], 5);
    read_set(root, "geometry/phase", H5T_NATIVE_DOUBLE, COUNT, numbers);
    ck_assert_double_eq(numbers[1], 0.25);
    ck_assert_double_eq(numbers[4], 0.75);
    read_set(root, "process/done", H5T_NATIVE_UCHAR, COUNT, done);
    ck_assert_mem_eq(done, "\0\1\0\0\1", COUNT);
    const hid_t attribute = H5Aopen_by_name(root, "process", "hash", H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, sizeof text);
    ck_assert_int_ge(H5Aread(attribute, type, text), 0);
    ck_assert_str_eq(text, hash);
    H5Tclose(type);
    H5Aclose(attribute);
    H5Fclose(root);
}
END_TEST

/* A file of this scan with some flat fields that differ, and all projections or all but one. */
static void make_file(int64_t projections) {
    static float white[FLATS][PIXELS], dark[PIXELS];
    skg_scan_file *file = NULL;
    skg_scan_file_options options;
    skg_scan_run_options run;
    skg_scan_file_options_init(&options);
    skg_scan_run_options_init(&run);
    options.scan = scan;
    options.hash = hash;
    options.name = "energy";
    options.unit = "keV per pixel";
    options.samples = 1;
    options.flats = FLATS;
    for (int i = 0; i < PIXELS; i++) white[0][i] = 100 + 100 * (float)i / PIXELS, white[1][i] = 100;
    ck_skg(skg_scan_file_open(path, &options, &file));
    ck_skg(skg_scan_file_fields_write(file, FLATS, white, 1, dark));
    run.to = projections;
    run.batch = 1;
    ck_skg(skg_scan_run_each(plan, scan, &run, keep, file));
    ck_skg(skg_scan_file_finish(file));
    skg_scan_file_release(&file);
}

static void read_all(const char *name, float *images) {
    const hid_t root = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
    ck_assert(root >= 0);
    read_set(root, "exchange/data", H5T_NATIVE_FLOAT, (hsize_t)COUNT * PIXELS, images);
    H5Fclose(root);
}

/* A packed copy has the bits of the scan in chunks, is read in its place, and is not continued. */
START_TEST(a_packed_copy_is_the_same_scan) {
    static float images[COUNT][PIXELS], copies[COUNT][PIXELS], lines[2][PIXELS];
    char packed[140];
    double numbers[2][COUNT];
    skg_scan_reader *readers[2] = {NULL};
    snprintf(packed, sizeof packed, "%s/packed.h5", folder);
    make_file(COUNT - 1);
    ck_skg_fails(skg_scan_file_pack(path, packed, NULL), SKG_ERR_FORMAT, "finish the scan first");
    ck_assert_int_ne(access(packed, F_OK), 0);
    make_file(0);
    ck_skg(skg_scan_file_pack(path, packed, NULL));
    read_all(path, images[0]);
    read_all(packed, copies[0]);
    ck_assert_mem_eq(images, copies, sizeof images);
    const char *const names[] = {path, packed};
    for (int r = 0; r < 2; r++) {
        const hid_t root = H5Fopen(names[r], H5F_ACC_RDONLY, H5P_DEFAULT);
        const hid_t set = H5Dopen2(root, "exchange/data", H5P_DEFAULT), how = H5Dget_create_plist(set);
        ck_assert_int_eq(H5Pget_layout(how), r ? H5D_CHUNKED : H5D_CONTIGUOUS);
        ck_assert_int_eq(H5Pget_nfilters(how), r ? 2 : 0);
        read_set(root, "geometry/phase", H5T_NATIVE_DOUBLE, COUNT, numbers[r]);
        H5Pclose(how);
        H5Dclose(set);
        H5Fclose(root);
        ck_skg(skg_scan_reader_open(names[r], &readers[r]));
        ck_skg(skg_scan_reader_attenuation_get(readers[r], 3, lines[r]));
        skg_scan_reader_release(&readers[r]);
    }
    ck_assert_mem_eq(numbers[0], numbers[1], sizeof numbers[0]);
    ck_assert_mem_eq(lines[0], lines[1], sizeof lines[0]);
    skg_scan_file *file = NULL;
    skg_scan_file_options options;
    skg_scan_file_options_init(&options);
    options.scan = scan;
    options.hash = hash;
    options.samples = 1;
    options.flats = FLATS;
    ck_skg_fails(skg_scan_file_open(packed, &options, &file), SKG_ERR_OUTPUT, "packed copy");
    unlink(packed);
}
END_TEST

/* Where the flat field is not above the dark field a pixel sees nothing of the beam: it is dark, and not open. */
START_TEST(a_pixel_without_a_flat_field_is_dark) {
    static float white[FLATS][PIXELS], line[PIXELS];
    skg_scan_reader *reader = NULL;
    make_file(0);
    const hid_t root = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    read_set(root, "exchange/data_white", H5T_NATIVE_FLOAT, (hsize_t)FLATS * PIXELS, white);
    for (int k = 0; k < FLATS; k++) white[k][7] = 0;
    const hid_t set = H5Dopen2(root, "exchange/data_white", H5P_DEFAULT);
    ck_assert(H5Dwrite(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, white) >= 0);
    H5Dclose(set);
    H5Fclose(root);
    ck_skg(skg_scan_reader_open(path, &reader));
    ck_skg(skg_scan_reader_attenuation_get(reader, 3, line));
    skg_scan_reader_release(&reader);
    ck_assert_double_eq_tol((double)line[7], -log(1e-6), 1e-6); /* float, of 13.8 */
    ck_assert_double_lt((double)line[8], 10);
}
END_TEST

/* 60000 where the mean of both flat fields is strongest, which is 100 + 100 (PIXELS - 1) / (2 PIXELS). */
START_TEST(a_packed_copy_in_grey_values) {
    static float images[COUNT][PIXELS], copies[COUNT][PIXELS];
    char packed[140], quantity[32] = "";
    const double top = 100 + 100 * (double)(PIXELS - 1) / (2 * PIXELS);
    skg_scan_pack_options options;
    skg_scan_pack_options_init(&options);
    snprintf(packed, sizeof packed, "%s/packed.h5", folder);
    make_file(0);
    options.grey16 = 1;
    ck_skg(skg_scan_file_pack(path, packed, &options));
    read_all(path, images[0]);
    read_all(packed, copies[0]);
    for (int k = 0; k < COUNT; k++)
        for (int i = 0; i < PIXELS; i++) {
            const double grey = fmin(fmax(60000 * (double)images[k][i] / top, 0), 65535);
            ck_assert_double_eq_tol((double)copies[k][i], grey,
                                    0.501); /* half a grey value, and roundings of top */
        }
    const hid_t root = H5Fopen(packed, H5F_ACC_RDONLY, H5P_DEFAULT), type = H5Tcopy(H5T_C_S1);
    const hid_t attribute = H5Aopen_by_name(root, "exchange", "quantity", H5P_DEFAULT, H5P_DEFAULT);
    H5Tset_size(type, sizeof quantity);
    ck_assert_int_ge(H5Aread(attribute, type, quantity), 0);
    ck_assert_str_eq(quantity, "grey value");
    H5Aclose(attribute);
    H5Tclose(type);
    H5Fclose(root);
    unlink(packed);
    options.level = 10;
    ck_skg_fails(skg_scan_file_pack(path, packed, &options), SKG_ERR_ARGUMENT, "give 0 to 9");
    options.level = 0;
    ck_skg_fails(skg_scan_file_pack(path, path, &options), SKG_ERR_ARGUMENT, "the scan itself");
    ck_skg_fails(skg_scan_file_pack(packed, path, &options), SKG_ERR_FILE, "cannot be read");
    snprintf(packed, sizeof packed, "%s/nowhere/packed.h5", folder);
    ck_skg_fails(skg_scan_file_pack(path, packed, &options), SKG_ERR_OUTPUT, "nowhere");
}
END_TEST

/* NXtomo: dark fields, flat fields and projections are one dataset, and what they are stands beside it. */
START_TEST(nexus_shows_all_images) {
    enum { ALL = 1 + FLATS + COUNT };
    static float images[ALL][PIXELS], white[FLATS][PIXELS], dark[PIXELS], projection[PIXELS];
    static const int keys[ALL] = {2, 1, 1};
    int found[ALL];
    double angles[ALL], column = 0;
    char nexus[128], text[8] = "";
    skg_scan_file *file = NULL;
    skg_scan_file_options options;
    snprintf(nexus, sizeof nexus, "%s/scan.nxs", folder);
    skg_scan_file_options_init(&options);
    options.scan = scan;
    options.hash = hash;
    options.name = "photons";
    options.unit = "photons per pixel";
    options.flat_field = 9;
    options.samples = 1;
    options.flats = FLATS;
    for (int i = 0; i < PIXELS; i++)
        projection[i] = (float)i, white[0][i] = 9, white[1][i] = 8, dark[i] = 0.5F;
    ck_skg(skg_scan_file_open(nexus, &options, &file));
    ck_skg(skg_scan_file_fields_write(file, FLATS, white, 1, dark));
    ck_skg(skg_scan_file_write(file, 1, (const int64_t[]){3}, projection, (const double[]){0}));
    ck_skg(skg_scan_file_finish(file));
    skg_scan_file_release(&file);
    const hid_t root = H5Fopen(nexus, H5F_ACC_RDONLY, H5P_DEFAULT);
    ck_assert_int_ge(root, 0);
    read_set(root, "entry/data/data", H5T_NATIVE_FLOAT, ALL * PIXELS, images);
    ck_assert_mem_eq(images[0], dark, sizeof dark);
    ck_assert_mem_eq(images[1], white, sizeof white);
    ck_assert_mem_eq(images[1 + FLATS + 3], projection, sizeof projection);
    read_set(root, "entry/instrument/detector/image_key", H5T_NATIVE_INT, ALL, found);
    ck_assert_mem_eq(found, keys, sizeof keys);
    read_set(root, "entry/sample/rotation_angle", H5T_NATIVE_DOUBLE, ALL, angles);
    ck_assert_double_eq(angles[1], 0);
    ck_assert_double_eq_tol(angles[ALL - 1], 72, 1e-13); /* some roundings */
    /* The origin is on the axis: its shadow has no distance from the line of the source through it. */
    read_set(root, "entry/instrument/detector/x_rotation_axis_pixel_position", H5T_NATIVE_DOUBLE, 1, &column);
    double across = 0, along = 0, normal[3], from[3];
    for (int k = 0; k < 3; k++)
        normal[k] = view.column_step[(k + 1) % 3] * view.row_step[(k + 2) % 3] -
                    view.column_step[(k + 2) % 3] * view.row_step[(k + 1) % 3];
    for (int k = 0; k < 3; k++)
        across += (view.centre[k] - view.source[k]) * normal[k], along -= view.source[k] * normal[k];
    for (int k = 0; k < 3; k++) from[k] = view.source[k] * (1 - across / along) - view.centre[k];
    double step = 0, place = 0;
    for (int k = 0; k < 3; k++)
        place += from[k] * view.column_step[k], step += view.column_step[k] * view.column_step[k];
    ck_assert_double_eq_tol(column, place / step + (SIDE - 1) / 2.0,
                            1e-9); /* some roundings of numbers up to 1e4 */
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, sizeof text);
    read_set(root, "entry/definition", type, 1, text);
    ck_assert_str_eq(text, "NXtomo");
    H5Tclose(type);
    H5Fclose(root);
    unlink(nexus);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, what_hdf5_reads);
    tcase_add_test(tests, nexus_shows_all_images);
    tcase_add_test(tests, a_packed_copy_is_the_same_scan);
    tcase_add_test(tests, a_pixel_without_a_flat_field_is_dark);
    tcase_add_test(tests, a_packed_copy_in_grey_values);
}

SKG_SUITE_MAIN("hdf5", add_tests)
