/* Errors of HDF5, which prints them unless it is told not to, and copies of what is not images. Private. */
#ifndef SKG_SCAN_HDF5_FILES_H
#define SKG_SCAN_HDF5_FILES_H

#include "core/core.h"
#include "scan/format.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <string.h>
#include <unistd.h>

typedef struct {
    H5E_auto2_t print;
    void *data;
} skg_hdf5_errors;

static inline void skg_hdf5_be_silent(skg_hdf5_errors *before) {
    H5Eget_auto2(H5E_DEFAULT, &before->print, &before->data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

static inline void skg_hdf5_be_as_before(const skg_hdf5_errors *before) {
    H5Eset_auto2(H5E_DEFAULT, before->print, before->data);
}

/* Of a file that H5Fopen refused. */
static inline skg_status skg_hdf5_fail(const char *path) {
    return skg_fail(SKG_ERR_FILE, "%s: cannot be read: %s", path,
                    access(path, R_OK) != 0 ? strerror(errno)
                                            : "it is no HDF5 file; give the .h5 that a scan wrote");
}

/* The type of the pixels of a file. */
hid_t skg_hdf5_element_type(const skg_scan_file *file);

/* Writes an attribute. Returns 0 on failure, as the two that follow. */
int skg_hdf5_put_text(hid_t object, const char *name, const char *text);
int skg_hdf5_put_number(hid_t object, const char *name, hid_t type, const void *number);

/* Makes a contiguous dataset, and writes it if values are given. units: NULL: none. */
int skg_hdf5_put_set(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *size,
                     const void *values, const char *units);

/* Adds /entry as the definition NXtomo of NeXus has it, over the datasets of /exchange. theta: degrees of each projection. */
int skg_hdf5_put_nexus(hid_t root, const skg_scan_file *file, const double *theta);

/* Copies a dataset of numbers with its units; it may be missing. Returns 0 on failure. */
int skg_hdf5_copy_set(hid_t from, hid_t to, const char *name);

/* Copies the groups geometry and process of a scan. Returns 0 on failure. */
int skg_hdf5_copy_groups(hid_t from, hid_t to);

/* Closes a file that was written to, also on a full disk. Returns 0 if the file is not whole.
 *
 * written   0: something could not be written, and the file is lost
 * bytes     at most so many HDF5 still holds of it */
int skg_hdf5_close(hid_t file, int written, int64_t bytes);

#endif
