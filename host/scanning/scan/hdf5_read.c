/* Reading a finished scan from HDF5. */
#include "core/files.h"
#include "core/maths.h"
#include "core/text.h"
#include "scan/hdf5_files.h"

#include <skiagraph/scan_reader.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

struct skg_scan_reader {
    char *path;
    hid_t root, data;
    skg_scan *scan;
    double axis[3], centre[3];
    int has_axis, is_attenuation;
    int64_t projections, rows, columns;
    float *white, *dark; /* [rows][columns]: means of the fields */
};

static int read_attribute(hid_t root, const char *group, const char *name, hid_t type, void *to) {
    const hid_t attribute = H5Aopen_by_name(root, group, name, H5P_DEFAULT, H5P_DEFAULT);
    const int done = attribute >= 0 && H5Aread(attribute, type, to) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    return done;
}

static int read_text(hid_t root, const char *group, const char *name, char *to, size_t size) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, size);
    const int done = read_attribute(root, group, name, type, to);
    H5Tclose(type);
    return done;
}

/* The size of a dataset of three dimensions; 0: it is not there, or has others. */
static int size_of(hid_t set, hsize_t size[3]) {
    const hid_t space = set >= 0 ? H5Dget_space(set) : -1;
    const int done = space >= 0 && H5Sget_simple_extent_ndims(space) == 3 &&
                     H5Sget_simple_extent_dims(space, size, NULL) == 3;
    if (space >= 0) H5Sclose(space);
    return done;
}

/* Image k of a dataset, as floats. */
static int read_image(hid_t set, int64_t k, int64_t rows, int64_t columns, float *image) {
    const hsize_t start[3] = {(hsize_t)k, 0, 0}, count[3] = {1, (hsize_t)rows, (hsize_t)columns};
    const hid_t file = H5Dget_space(set), memory = H5Screate_simple(3, count, NULL);
    const int done = H5Sselect_hyperslab(file, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
                     H5Dread(set, H5T_NATIVE_FLOAT, memory, file, H5P_DEFAULT, image) >= 0;
    H5Sclose(memory);
    H5Sclose(file);
    return done;
}

static skg_status refuse(const skg_scan_reader *reader, const char *what) {
    return skg_fail(SKG_ERR_FORMAT, "%s: %s", reader->path, what);
}

/* The mean of flat or dark fields; zeros if there are none. */
static skg_status read_fields(skg_scan_reader *reader, const char *name, float **mean) {
    const int64_t pixels = reader->rows * reader->columns;
    hsize_t size[3] = {0};
    float *image = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(pixels, sizeof **mean, "flat field", mean));
    const hid_t set = H5Dopen2(reader->root, name, H5P_DEFAULT);
    if (set < 0) return SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(pixels, sizeof *image, "flat field", &image));
    if (!size_of(set, size) || (int64_t)size[1] != reader->rows || (int64_t)size[2] != reader->columns)
        status = refuse(reader, "its flat or dark fields have another size than its projections");
    for (int64_t f = 0; f < (int64_t)size[0] && status == SKG_OK; f++) {
        if (!read_image(set, f, reader->rows, reader->columns, image))
            status = refuse(reader, "a flat or dark field cannot be read");
        for (int64_t i = 0; i < pixels && status == SKG_OK; i++) (*mean)[i] += image[i] / (float)size[0];
    }
cleanup:
    skg_free(&image);
    H5Dclose(set);
    return status;
}

static int read_doubles(hid_t root, const char *name, int64_t count, double *to) {
    const hid_t set = H5Dopen2(root, name, H5P_DEFAULT), space = set >= 0 ? H5Dget_space(set) : -1;
    const int done = space >= 0 && H5Sget_simple_extent_npoints(space) == (hssize_t)count &&
                     H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, to) >= 0;
    if (space >= 0) H5Sclose(space);
    if (set >= 0) H5Dclose(set);
    return done;
}

static skg_status read_poses(skg_scan_reader *reader, double *vectors, double *poses) {
    static const char *const names[] = {"geometry/source", "geometry/centre", "geometry/column_step",
                                        "geometry/row_step"};
    skg_view view;
    int32_t projection = SKG_PROJECTION_POINT;
    for (int v = 0; v < 4; v++) {
        if (!read_doubles(reader->root, names[v], 3 * reader->projections, vectors))
            return refuse(reader, "it has no geometry of ours; only scans of skiagraph are reconstructed");
        for (int64_t k = 0; k < reader->projections; k++)
            memcpy(poses + 12 * k + 3 * v, vectors + 3 * k, 3 * sizeof *poses);
    }
    double radius = 0; /* of a flat detector, which has none */
    read_attribute(reader->root, "geometry", "projection", H5T_NATIVE_INT32, &projection);
    read_attribute(reader->root, "geometry", "detector_radius", H5T_NATIVE_DOUBLE, &radius);
    reader->has_axis =
        read_attribute(reader->root, "geometry", "axis", H5T_NATIVE_DOUBLE, reader->axis) &&
        read_attribute(reader->root, "geometry", "centre_of_rotation", H5T_NATIVE_DOUBLE, reader->centre);
    skg_view_init(&view);
    view.projection = projection;
    view.columns = reader->columns;
    view.rows = reader->rows;
    view.radius = radius;
    return skg_scan_create_table(&view, NULL, reader->projections, poses, &reader->scan);
}

static skg_status read_geometry(skg_scan_reader *reader) {
    double *vectors = NULL, *poses = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(reader->projections, 3 * sizeof *vectors, "geometry", &vectors));
    SKG_TRY_CLEANUP(skg_alloc(reader->projections, 12 * sizeof *poses, "geometry", &poses));
    SKG_TRY_CLEANUP(read_poses(reader, vectors, poses));
cleanup:
    skg_free(&vectors);
    skg_free(&poses);
    return status;
}

static skg_status check_finished(const skg_scan_reader *reader) {
    double *done = NULL;
    int64_t missing = 0;
    SKG_TRY(skg_alloc(reader->projections, sizeof *done, "progress", &done));
    if (read_doubles(reader->root, "process/done", reader->projections, done))
        for (int64_t k = 0; k < reader->projections; k++) missing += done[k] != 1;
    skg_free(&done);
    if (missing == 0) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT,
                    "%s: %" PRId64 " of %" PRId64 " projections are missing; finish the scan first",
                    reader->path, missing, reader->projections);
}

static skg_status open_reader(skg_scan_reader *reader) {
    hsize_t size[3];
    char quantity[64] = "";
    SKG_TRY(skg_input_check(reader->path, INT64_MAX));
    reader->root = H5Fopen(reader->path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (reader->root < 0) return skg_hdf5_fail(reader->path);
    reader->data = H5Dopen2(reader->root, "exchange/data", H5P_DEFAULT);
    if (reader->data < 0 || !size_of(reader->data, size))
        return refuse(reader, "it has no dataset /exchange/data");
    reader->projections = (int64_t)size[0];
    reader->rows = (int64_t)size[1];
    reader->columns = (int64_t)size[2];
    SKG_TRY(check_finished(reader));
    read_text(reader->root, "exchange", "quantity", quantity, sizeof quantity);
    reader->is_attenuation = strncmp(quantity, "attenuation", 11) == 0;
    SKG_TRY(read_fields(reader, "exchange/data_white", &reader->white));
    SKG_TRY(read_fields(reader, "exchange/data_dark", &reader->dark));
    return read_geometry(reader);
}

skg_status skg_scan_reader_open(const char *path, skg_scan_reader **result) {
    SKG_PLAIN;
    skg_scan_reader *reader = NULL;
    skg_hdf5_errors before;
    skg_status status = SKG_OK;
    SKG_NEEDS(result);
    *result = NULL;
    SKG_NEEDS(path);
    SKG_TRY(skg_alloc(1, sizeof *reader, "reader of a scan", &reader));
    reader->root = reader->data = -1;
    skg_hdf5_be_silent(&before);
    SKG_TRY_CLEANUP(skg_copy_text(path, &reader->path));
    SKG_TRY_CLEANUP(open_reader(reader));
    *result = reader;
    reader = NULL;
cleanup:
    skg_scan_reader_release(&reader);
    skg_hdf5_be_as_before(&before);
    return status;
}

void skg_scan_reader_release(skg_scan_reader **reader) {
    if (!reader || !*reader) return;
    if ((*reader)->data >= 0) H5Dclose((*reader)->data);
    if ((*reader)->root >= 0) H5Fclose((*reader)->root);
    skg_scan_release(&(*reader)->scan);
    skg_free(&(*reader)->white);
    skg_free(&(*reader)->dark);
    skg_free(&(*reader)->path);
    skg_free(reader);
}

skg_status skg_scan_reader_scan_get(const skg_scan_reader *reader, skg_scan **scan) {
    SKG_NEEDS(reader);
    SKG_NEEDS(scan);
    *scan = reader->scan;
    return SKG_OK;
}

skg_status skg_scan_reader_axis_get(const skg_scan_reader *reader, double *axis, double *centre) {
    SKG_NEEDS(reader);
    SKG_NEEDS(axis);
    SKG_NEEDS(centre);
    if (!reader->has_axis)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its scan is a table of poses, which has no axis",
                        reader->path);
    memcpy(axis, reader->axis, sizeof reader->axis);
    memcpy(centre, reader->centre, sizeof reader->centre);
    return SKG_OK;
}

/* -ln(I / I0), where at least a millionth of I0 arrives. A pixel that does not see the beam counts as one that nothing reaches. */
static float attenuation(const skg_scan_reader *reader, int64_t i, float value) {
    const double flat = (double)reader->white[i] - (double)reader->dark[i];
    const double share = flat > 0 ? ((double)value - (double)reader->dark[i]) / flat : 0;
    return (float)-log(share < 1e-6 ? 1e-6 : share); /* NaN stays */
}

skg_status skg_scan_reader_attenuation_get(skg_scan_reader *reader, int64_t index, float *image) {
    SKG_PLAIN;
    skg_hdf5_errors before;
    SKG_NEEDS(reader);
    SKG_NEEDS(image);
    if (index < 0 || index >= reader->projections)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: no projection %" PRId64 "; projections are 0 to %" PRId64,
                        reader->path, index, reader->projections - 1);
    skg_hdf5_be_silent(&before);
    const int done = read_image(reader->data, index, reader->rows, reader->columns, image);
    skg_hdf5_be_as_before(&before);
    if (!done)
        return skg_fail(SKG_ERR_FILE, "%s: projection %" PRId64 " cannot be read", reader->path, index);
    for (int64_t i = 0; i < reader->rows * reader->columns && !reader->is_attenuation; i++)
        image[i] = attenuation(reader, i, image[i]);
    return SKG_OK;
}
