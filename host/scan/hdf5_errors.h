/* HDF5 prints its errors unless it is told not to. Private. */
#ifndef SKG_HDF5_ERRORS_H
#define SKG_HDF5_ERRORS_H

#include "core/core.h"

#include <hdf5.h>

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

#endif
