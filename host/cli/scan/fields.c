/* Flat and dark fields of a scan: made, read out and written. */
#include "scan/steps.h"

#include "common/file.h"
#include "common/say.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

enum { NAME_LENGTH = 400 };

/* Flat or dark fields, which the caller frees. */
static skg_status make(cli_acquisition *a, int is_dark, void **images) {
    const int64_t count = is_dark ? a->darks : a->flats;
    const size_t pixels = (size_t)(a->session.view.columns * a->session.view.rows);
    const size_t bytes = pixels * (a->options.type == SKG_TYPE_FLOAT64 ? 8 : 4);
    void *kev = calloc((size_t)count + 1, bytes), *grey = calloc((size_t)count + 1, (size_t)grey_bytes(a));
    skg_status status = kev && grey ? SKG_OK : SKG_ERR_MEMORY;
    if (status == SKG_OK && count > 0)
        status = is_dark ? skg_scan_dark_fields_render(a->plan, a->scan, &a->options, count, kev)
                         : skg_scan_flat_fields_render(a->plan, a->session.scene, a->scan, &a->options, count,
                                                       kev);
    if (!SKG_FAILED(status) && a->is_grey) status = grey_fields(a, is_dark, kev, grey);
    *images = a->is_grey ? grey : kev;
    free(a->is_grey ? kev : grey);
    return status;
}

int fields_write(cli_acquisition *a) {
    void *white = NULL, *dark = NULL;
    skg_status status = make(a, 0, &white);
    if (!SKG_FAILED(status)) status = make(a, 1, &dark);
    if (!SKG_FAILED(status)) status = skg_scan_file_fields_write(a->file, a->flats, white, a->darks, dark);
    free(white);
    free(dark);
    if (status == SKG_ERR_MEMORY) return cli_error(CLI_DEVICE, "out of host memory for flat fields");
    return !SKG_FAILED(status) ? CLI_DONE : cli_fail(status);
}

int fields_describe(const cli_acquisition *a, char *text, size_t size) {
    char white[NAME_LENGTH], dark[NAME_LENGTH];
    *text = '\0';
    if (!a->has_fields || a->stem) return CLI_DONE;
    skg_status status = skg_scan_fields_name_get(a->place, 0, white, sizeof white);
    if (status == SKG_OK) status = skg_scan_fields_name_get(a->place, 1, dark, sizeof dark);
    if (status != SKG_OK) return cli_fail(status);
    snprintf(text, size, "flat fields: %" PRId64 ", %s; dark fields: %" PRId64 ", %s", a->flats,
             a->flats > 0 ? white : "none", a->darks, a->darks > 0 ? dark : "none");
    return CLI_DONE;
}
