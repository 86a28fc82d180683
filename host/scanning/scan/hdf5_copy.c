/* Values are read and written again. H5Ocopy of HDF5 1.10 copies objects as they stand in the file, and crashes in one of fifty
 * files in which a few bits are wrong. */
#include "scan/hdf5_files.h"

#include "core/core.h"

enum { LONGEST_ATTRIBUTE = 4096 };

static int is_plain(hid_t type) {
    const H5T_class_t kind = H5Tget_class(type);
    return kind == H5T_INTEGER || kind == H5T_FLOAT || (kind == H5T_STRING && H5Tis_variable_str(type) == 0);
}

static int copy_value(hid_t old, hid_t to, const char *name, hid_t type, hid_t space) {
    char bytes[LONGEST_ATTRIBUTE];
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    const size_t size = H5Tget_size(type);
    if (!is_plain(type) || count < 1 || size < 1 || (size_t)count > sizeof bytes / size) return 0;
    if (H5Aread(old, type, bytes) < 0) return 0;
    const hid_t new = H5Acreate2(to, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const int done = new >= 0 && H5Awrite(new, type, bytes) >= 0;
    if (new >= 0) H5Aclose(new);
    return done;
}

/* Copies an attribute, which may be missing. */
static int copy_attribute(hid_t from, hid_t to, const char *name) {
    if (H5Aexists(from, name) <= 0) return 1;
    const hid_t old = H5Aopen(from, name, H5P_DEFAULT);
    if (old < 0) return 0;
    const hid_t type = H5Aget_type(old), space = H5Aget_space(old);
    const int done = type >= 0 && space >= 0 && copy_value(old, to, name, type, space);
    if (type >= 0) H5Tclose(type);
    if (space >= 0) H5Sclose(space);
    H5Aclose(old);
    return done;
}

/* As the scan's own datasets: contiguous, without the time of day. */
static hid_t make_set(hid_t to, const char *name, hid_t type, hid_t space) {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    hid_t set = -1;
    if (H5Pset_layout(how, H5D_CONTIGUOUS) >= 0 && H5Pset_alloc_time(how, H5D_ALLOC_TIME_EARLY) >= 0 &&
        H5Pset_fill_time(how, H5D_FILL_TIME_NEVER) >= 0 && H5Pset_obj_track_times(how, 0) >= 0)
        set = H5Dcreate2(to, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    H5Pclose(how);
    return set;
}

static int copy_values(hid_t old, hid_t to, const char *name, hid_t type, hid_t space) {
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    const size_t size = H5Tget_size(type);
    char *bytes = NULL;
    if (!is_plain(type) || count < 1 || size < 1 || skg_alloc((int64_t)count, size, name, &bytes) != SKG_OK)
        return 0;
    hid_t new = -1;
    if (H5Dread(old, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) >= 0) new = make_set(to, name, type, space);
    const int done = new >= 0 && H5Dwrite(new, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) >= 0 &&
                     copy_attribute(old, new, "units");
    if (new >= 0) H5Dclose(new);
    skg_free(&bytes);
    return done;
}

int skg_hdf5_copy_set(hid_t from, hid_t to, const char *name) {
    if (H5Lexists(from, name, H5P_DEFAULT) <= 0) return 1;
    const hid_t old = H5Dopen2(from, name, H5P_DEFAULT);
    if (old < 0) return 0;
    const hid_t type = H5Dget_type(old), space = H5Dget_space(old);
    const int done = type >= 0 && space >= 0 && copy_values(old, to, name, type, space);
    if (type >= 0) H5Tclose(type);
    if (space >= 0) H5Sclose(space);
    H5Dclose(old);
    return done;
}

static int copy_members(hid_t from, hid_t to, const char *const *sets, const char *const *attributes) {
    for (; *sets; sets++)
        if (!skg_hdf5_copy_set(from, to, *sets)) return 0;
    for (; *attributes; attributes++)
        if (!copy_attribute(from, to, *attributes)) return 0;
    return 1;
}

static int copy_group(hid_t from, hid_t to, const char *name, const char *const *sets,
                      const char *const *attributes) {
    const hid_t old = H5Gopen2(from, name, H5P_DEFAULT);
    const hid_t new = old >= 0 ? H5Gcreate2(to, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT) : -1;
    const int done = new >= 0 && copy_members(old, new, sets, attributes);
    if (new >= 0) H5Gclose(new);
    if (old >= 0) H5Gclose(old);
    return done;
}

int skg_hdf5_copy_groups(hid_t from, hid_t to) {
    static const char *const places[] = {"source", "centre", "column_step", "row_step",
                                         "time",   "phase",  NULL};
    static const char *const rotation[] = {"projection", "axis", "centre_of_rotation", "detector_radius",
                                           NULL};
    static const char *const progress[] = {"done", "checksum", NULL};
    static const char *const origin[] = {"hash", "samples", "program", NULL};
    return copy_group(from, to, "geometry", places, rotation) &&
           copy_group(from, to, "process", progress, origin);
}
