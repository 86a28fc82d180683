/* Copying what is not images from one HDF5 file to another. Private. */
#ifndef SKG_SCAN_HDF5_COPY_H
#define SKG_SCAN_HDF5_COPY_H

#include <hdf5.h>

/* Copies a dataset of numbers with its units; it may be missing. Returns 0 on failure. */
int skg_hdf5_copy_set(hid_t from, hid_t to, const char *name);

/* Copies the groups geometry and process of a scan. Returns 0 on failure. */
int skg_hdf5_copy_groups(hid_t from, hid_t to);

#endif
