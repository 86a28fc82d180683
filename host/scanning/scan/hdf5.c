/* HDF5 in the layout of Data Exchange (De Carlo et al., J. Synchrotron Rad. 21 (2014) 1224-1230), with our geometry and
 * progress beside it. HDF5 lays the file out; its datasets are contiguous and allocated at once, so that projections are
 * written in place without it. Its own metadata never changes again, and whoever opens the file finds it whole. */
#include "core/files.h"
#include "core/maths.h"
#include "core/text.h"
#include "scan/format.h"
#include "scan/hdf5_files.h"
#include "trajectory/types.h"

#include <skiagraph/version.h>

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static herr_t keep_reason(unsigned level, const H5E_error2_t *error, void *user) {
    if (level == 0 && error->desc) snprintf(user, 256, "%s", error->desc);
    return 0;
}

static skg_status fail(const char *path) {
    char reason[256] = "HDF5 does not say why";
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_reason, reason);
    return skg_output_fail(path, 0, reason);
}

/* Geometry of each projection: [3] source, centre, column step, row step; time; angle in degrees. */
typedef struct {
    double *vectors[4], *time, *theta;
} geometry;

static void geometry_free(geometry *g) {
    for (int v = 0; v < 4; v++) skg_free(&g->vectors[v]);
    skg_free(&g->time);
    skg_free(&g->theta);
}

static skg_status find_geometry(const skg_scan_file *file, geometry *g) {
    const skg_scan *scan = file->options.scan;
    const int64_t n = file->projections;
    for (int v = 0; v < 4; v++) SKG_TRY(skg_alloc(n, 3 * sizeof(double), "geometry", &g->vectors[v]));
    SKG_TRY(skg_alloc(n, sizeof(double), "geometry", &g->time));
    SKG_TRY(skg_alloc(n, sizeof(double), "geometry", &g->theta));
    for (int64_t k = 0; k < n; k++) {
        skg_view view;
        skg_view_init(&view);
        SKG_TRY(skg_scan_view_get(scan, file->first + k, &view));
        SKG_TRY(skg_scan_time_get(scan, file->first + k, &g->time[k], NULL));
        SKG_TRY(skg_scan_angle_get(scan, file->first + k, &g->theta[k]));
        g->theta[k] *= 180 / SKG_PI;
        const double *from[] = {view.source, view.centre, view.column_step, view.row_step};
        for (int v = 0; v < 4; v++) memcpy(g->vectors[v] + 3 * k, from[v], 3 * sizeof(double));
    }
    return SKG_OK;
}

static int make_exchange(hid_t root, const skg_scan_file *file, const geometry *g) {
    const hsize_t n = (hsize_t)file->projections, rows = (hsize_t)file->view.rows;
    const hsize_t columns = (hsize_t)file->view.columns, data[3] = {n, rows, columns};
    const hsize_t flats[3] = {(hsize_t)file->options.flats, rows, columns};
    const hsize_t darks[3] = {(hsize_t)file->options.darks, rows, columns};
    const hid_t group = H5Gcreate2(root, "exchange", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = skg_hdf5_element_type(file);
    const char *unit = file->options.unit;
    if (group < 0) return 0;
    const int done =
        skg_hdf5_put_set(group, "data", type, 3, data, NULL, unit) &&
        (!file->options.flats || skg_hdf5_put_set(group, "data_white", type, 3, flats, NULL, unit)) &&
        (!file->options.darks || skg_hdf5_put_set(group, "data_dark", type, 3, darks, NULL, unit)) &&
        skg_hdf5_put_set(group, "theta", H5T_NATIVE_DOUBLE, 1, &n, g->theta, "degrees") &&
        skg_hdf5_put_text(group, "quantity", file->options.name) &&
        skg_hdf5_put_number(group, "flat_field", H5T_NATIVE_DOUBLE, &file->options.flat_field);
    H5Gclose(group);
    return done;
}

/* Writes the axis and the centre of rotation of a scan that turns, for reconstructions. */
static int write_rotation(hid_t group, const skg_scan_file *file) {
    const hsize_t size = 3;
    const hid_t space = H5Screate_simple(1, &size, NULL);
    const skg_scan_options *o = &file->options.scan->options;
    const struct {
        const char *name;
        const double *vector;
    } vectors[] = {{"axis", o->axis}, {"centre_of_rotation", o->centre}};
    int done = skg_hdf5_put_number(group, "projection", H5T_NATIVE_INT32, &file->view.projection) &&
               (file->view.radius == 0 ||
                skg_hdf5_put_number(group, "detector_radius", H5T_NATIVE_DOUBLE, &file->view.radius));
    for (int v = 0; v < 2 && done && (!skg_scan_is_table(file->options.scan) || o->step_rad != 0); v++) {
        const hid_t attribute =
            H5Acreate2(group, vectors[v].name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
        done = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_DOUBLE, vectors[v].vector) >= 0;
        if (attribute >= 0) H5Aclose(attribute);
    }
    H5Sclose(space);
    return done;
}

static int make_geometry(hid_t root, const skg_scan_file *file, const geometry *g) {
    static const char *const names[] = {"source", "centre", "column_step", "row_step"};
    const hsize_t size[2] = {(hsize_t)file->projections, 3};
    const hid_t group = H5Gcreate2(root, "geometry", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    int done = group >= 0 && write_rotation(group, file);
    for (int v = 0; v < 4 && done; v++)
        done = skg_hdf5_put_set(group, names[v], H5T_NATIVE_DOUBLE, 2, size, g->vectors[v], "mm");
    done = done && skg_hdf5_put_set(group, "time", H5T_NATIVE_DOUBLE, 1, size, g->time, "s") &&
           skg_hdf5_put_set(group, "phase", H5T_NATIVE_DOUBLE, 1, size, NULL,
                            "1 = a breath, from end-inspiration");
    if (group >= 0) H5Gclose(group);
    return done;
}

static int make_process(hid_t root, const skg_scan_file *file) {
    const hsize_t n = (hsize_t)file->projections;
    const hid_t group = H5Gcreate2(root, "process", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (group < 0) return 0;
    const int done =
        skg_hdf5_put_set(group, "done", H5T_NATIVE_UINT8, 1, &n, file->done, NULL) &&
        skg_hdf5_put_set(group, "checksum", H5T_NATIVE_UINT32, 1, &n, file->checksums, "CRC-32C") &&
        skg_hdf5_put_text(group, "hash", file->options.hash) &&
        skg_hdf5_put_number(group, "samples", H5T_NATIVE_INT64, &file->options.samples) &&
        skg_hdf5_put_text(group, "program", "skiagraph " SKG_VERSION);
    H5Gclose(group);
    return done;
}

/* Whether the file is to be NXtomo, too. */
static int is_nexus(const skg_scan_file *file) {
    const char *dot = strrchr(file->path, '.');
    return dot && skg_same_name(dot, ".nxs");
}

/* The file is aligned to pages, so that projections are. */
static skg_status make_file(skg_scan_file *file, const char *path, const geometry *g) {
    enum { PAGE = 4096, HELD = 64 << 10 };
    if (is_nexus(file) && file->view.radius > 0)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: NXtomo has no curved detector; write .h5", file->path);
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    int done = H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_LATEST) >= 0 &&
               H5Pset_alignment(access, PAGE, PAGE) >= 0;
    const hid_t root = done ? H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access) : -1;
    done = root >= 0 && skg_hdf5_put_text(root, "implements", "exchange") && make_exchange(root, file, g) &&
           make_geometry(root, file, g) && make_process(root, file) &&
           (!is_nexus(file) || skg_hdf5_put_nexus(root, file, g->theta));
    skg_status status = done ? SKG_OK : fail(file->path);
    if (root >= 0 && !skg_hdf5_close(root, done, HELD) && status == SKG_OK)
        status = skg_output_fail(file->path, errno, "HDF5 could not finish it");
    H5Pclose(access);
    return status;
}

static skg_status lay_out(skg_scan_file *file, const char *temporary) {
    geometry g = {0};
    skg_hdf5_errors before;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(find_geometry(file, &g));
    skg_hdf5_be_silent(&before);
    status = make_file(file, temporary, &g);
    skg_hdf5_be_as_before(&before);
    if (status == SKG_OK) status = skg_scan_reserve(temporary);
    if (status != SKG_OK) unlink(temporary);
cleanup:
    geometry_free(&g);
    return status;
}

/* The place of a dataset in the file; 0: it is not there. */
static int64_t place_of(hid_t root, const char *name) {
    const hid_t set = H5Dopen2(root, name, H5P_DEFAULT);
    if (set < 0) return 0;
    const haddr_t place = H5Dget_offset(set);
    H5Dclose(set);
    return place == HADDR_UNDEF ? 0 : (int64_t)place;
}

static skg_status locate(skg_scan_file *file) {
    skg_hdf5_errors before;
    skg_hdf5_be_silent(&before);
    const hid_t root = H5Fopen(file->path, H5F_ACC_RDONLY, H5P_DEFAULT);
    skg_status status = root < 0 ? fail(file->path) : SKG_OK;
    if (root >= 0) {
        file->data_at = place_of(root, "exchange/data");
        file->white_at = place_of(root, "exchange/data_white");
        file->dark_at = place_of(root, "exchange/data_dark");
        file->phase_at = place_of(root, "geometry/phase");
        file->done_at = place_of(root, "process/done");
        file->checksum_at = place_of(root, "process/checksum");
        H5Fclose(root);
    }
    skg_hdf5_be_as_before(&before);
    if (status == SKG_OK && !file->data_at && file->done_at)
        return skg_fail(
            SKG_ERR_OUTPUT,
            "%s: is a packed copy of this scan, which is finished; name another output to scan again",
            file->path);
    if (status == SKG_OK && (!file->data_at || !file->done_at))
        return skg_fail(SKG_ERR_OUTPUT,
                        "%s: has no place for projections; something else has changed it: remove it",
                        file->path);
    return status;
}

static int read_identity(const char *path, skg_scan_identity *identity) {
    const hid_t root = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (root < 0) return 0;
    const hid_t hash = H5Aopen_by_name(root, "process", "hash", H5P_DEFAULT, H5P_DEFAULT);
    const hid_t samples = H5Aopen_by_name(root, "process", "samples", H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, sizeof identity->hash);
    const int done = hash >= 0 && samples >= 0 && H5Aread(hash, type, identity->hash) >= 0 &&
                     H5Aread(samples, H5T_NATIVE_INT64, &identity->samples) >= 0;
    H5Tclose(type);
    if (hash >= 0) H5Aclose(hash);
    if (samples >= 0) H5Aclose(samples);
    H5Fclose(root);
    return done;
}

static skg_status identify(const char *path, skg_scan_identity *identity) {
    skg_hdf5_errors before;
    struct stat there;
    *identity = (skg_scan_identity){0};
    if (stat(path, &there) != 0 || !S_ISREG(there.st_mode)) return SKG_OK;
    skg_hdf5_be_silent(&before);
    if (H5Fis_hdf5(path) <= 0 || !read_identity(path, identity)) *identity = (skg_scan_identity){0};
    skg_hdf5_be_as_before(&before);
    return SKG_OK;
}

const skg_scan_format skg_scan_format_hdf5 = {.extensions = {".h5", ".hdf5", ".nxs"},
                                              .lay_out = lay_out,
                                              .locate = locate,
                                              .identify = identify,
                                              .has_progress_inside = 1};
