/* Attributes and datasets of numbers for files of HDF5. */
#include "scan/hdf5_files.h"

hid_t skg_hdf5_element_type(const skg_scan_file *file) {
    return file->options.type == SKG_TYPE_FLOAT64  ? H5T_NATIVE_DOUBLE
           : file->options.type == SKG_TYPE_UINT16 ? H5T_NATIVE_UINT16
                                                   : H5T_NATIVE_FLOAT;
}

int skg_hdf5_put_text(hid_t object, const char *name, const char *text) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, strlen(text) + 1);
    const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const int done = attribute >= 0 && H5Awrite(attribute, type, text) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
    return done;
}

int skg_hdf5_put_number(hid_t object, const char *name, hid_t type, const void *number) {
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const int done = attribute >= 0 && H5Awrite(attribute, type, number) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return done;
}

int skg_hdf5_put_set(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *size,
                     const void *values, const char *units) {
    const hid_t space = H5Screate_simple(rank, size, NULL), how = H5Pcreate(H5P_DATASET_CREATE);
    int done = H5Pset_layout(how, H5D_CONTIGUOUS) >= 0 && H5Pset_alloc_time(how, H5D_ALLOC_TIME_EARLY) >= 0 &&
               H5Pset_fill_time(how, H5D_FILL_TIME_NEVER) >= 0 &&
               H5Pset_obj_track_times(how, 0) >= 0; /* the bytes of a scan do not depend on the clock */
    const hid_t set = done ? H5Dcreate2(parent, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT) : -1;
    done = set >= 0;
    if (done && values) done = H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    if (done && units) done = skg_hdf5_put_text(set, "units", units);
    if (set >= 0) H5Dclose(set);
    H5Pclose(how);
    H5Sclose(space);
    return done;
}
