/* Scans in HDF5: the input is the file, which is read as a finished scan and packed. */
#include "fuzz/fuzz.h"

#include <skiagraph/scan_file.h>
#include <skiagraph/scan_reader.h>

#include <stdlib.h>
#include <string.h>

enum { PIXELS_MAX = 1 << 16 };

static void read_scan(const char *path) {
    skg_scan_reader *reader = NULL;
    skg_scan *scan = NULL;
    skg_view view;
    skg_view_init(&view);
    fuzz_expect_sentence(skg_scan_reader_open(path, &reader));
    if (!reader) return;
    if (skg_scan_reader_scan_get(reader, &scan) != SKG_OK || skg_scan_view_get(scan, 0, &view) != SKG_OK)
        abort();
    if (view.columns * view.rows <= PIXELS_MAX) {
        float *image = calloc((size_t)(view.columns * view.rows) + 1, sizeof *image);
        if (!image) abort();
        fuzz_expect_sentence(skg_scan_reader_attenuation_get(reader, 0, image));
        free(image);
    }
    skg_scan_reader_release(&reader);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char path[512];
    strcpy(path, fuzz_write("s.h5", data, size));
    read_scan(path);
    fuzz_expect_sentence(skg_scan_file_pack(path, fuzz_path("packed.h5"), NULL));
    return 0;
}
