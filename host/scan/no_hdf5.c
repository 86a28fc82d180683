/* A build without HDF5. */
#include "scan/file.h"

const skg_scan_format skg_scan_format_hdf5 = {.extensions = {".h5", ".hdf5"}, .is_missing = 1};
