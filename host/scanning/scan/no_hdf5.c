/* A build without HDF5. */
#include "scan/format.h"

#include <skiagraph/scan_reader.h>

const skg_scan_format skg_scan_format_hdf5 = {.extensions = {".h5", ".hdf5", ".nxs"}, .is_missing = 1};

static skg_status refuse(void) {
    return skg_fail(SKG_ERR_UNSUPPORTED, "this build of skiagraph has no HDF5; build it with libhdf5-dev");
}

void skg_scan_pack_options_init_sized(void *options, int32_t size) {
    const skg_scan_pack_options defaults = {.level = 4};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

skg_status skg_scan_file_pack(const char *from, const char *to, const skg_scan_pack_options *options) {
    (void)options;
    SKG_NEEDS(from);
    SKG_NEEDS(to);
    return refuse();
}

skg_status skg_scan_reader_open(const char *path, skg_scan_reader **reader) {
    SKG_NEEDS(reader);
    *reader = NULL;
    SKG_NEEDS(path);
    return refuse();
}

void skg_scan_reader_release(skg_scan_reader **reader) {
    (void)reader; /* there is none */
}

skg_status skg_scan_reader_scan_get(const skg_scan_reader *reader, skg_scan **scan) {
    SKG_NEEDS(reader);
    SKG_NEEDS(scan);
    return refuse();
}

skg_status skg_scan_reader_axis_get(const skg_scan_reader *reader, double *axis, double *centre) {
    SKG_NEEDS(reader);
    SKG_NEEDS(axis);
    SKG_NEEDS(centre);
    return refuse();
}

skg_status skg_scan_reader_attenuation_get(skg_scan_reader *reader, int64_t index, float *image) {
    (void)index;
    SKG_NEEDS(reader);
    SKG_NEEDS(image);
    return refuse();
}
