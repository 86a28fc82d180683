/* Geometry files of Nikon scanners (.xtekct): the input is the file. The scan that loads is asked for its views. */
#include "fuzz/fuzz.h"

#include <skiagraph/scan.h>

#include <math.h>
#include <stdlib.h>

/* Ends the process if a number of a view is not finite: a plan would refuse it, and nobody could say why. */
static void expect_finite(const double *numbers, int count) {
    for (int k = 0; k < count; k++)
        if (!isfinite(numbers[k])) {
            fputs("a scan has a number that is not finite\n", stderr);
            abort();
        }
}

static void use_view(const skg_scan *scan, int64_t index) {
    skg_view view;
    double angle = 0;
    skg_view_init(&view);
    fuzz_expect_sentence(skg_scan_angle_get(scan, index, &angle));
    if (skg_scan_view_get(scan, index, &view) != SKG_OK) abort();
    expect_finite(&angle, 1);
    expect_finite(view.source, 3);
    expect_finite(view.centre, 3);
    expect_finite(view.column_step, 3);
    expect_finite(view.row_step, 3);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    skg_scan *scan = NULL;
    char folder[64];
    double white = 0, axis[3], centre[3];
    int64_t count = 0;
    const char *path = fuzz_write("scan.xtekct", data, size);
    fuzz_expect_sentence(skg_scan_load_xtekct(path, &white, folder, sizeof folder, &scan));
    if (!scan) return 0;
    if (skg_scan_projection_count(scan, &count) != SKG_OK || count < 1) abort();
    use_view(scan, 0);
    use_view(scan, count - 1);
    fuzz_expect_sentence(skg_scan_axis_get(scan, axis, centre));
    expect_finite(axis, 3);
    expect_finite(centre, 3);
    skg_scan_release(&scan);
    return 0;
}
