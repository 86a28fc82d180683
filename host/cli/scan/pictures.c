/* --dicom: the projections of a finished scan as pictures, a file each. */
#include "scan/steps.h"

#include "common/file.h"
#include "common/say.h"
#include "core/text.h"
#include "dicom/dicom.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int pictures_read_flag(const cli_arguments *arguments, cli_acquisition *a) {
    a->pictures = cli_value(arguments, "--dicom");
    if (!a->pictures) return CLI_DONE;
    if (cli_given(arguments, "--shard"))
        return cli_error(CLI_USAGE, "--dicom writes a whole scan; give it with --join, not with --shard");
    if (cli_names_folder(a->place))
        return cli_error(CLI_USAGE,
                         "%s: --dicom reads the finished scan, which has to be one file, such as .h5",
                         a->place);
    char *probe = cli_path_in(a->pictures, "projection-00000.dcm");
    int exit_status = probe ? cli_make_folder(a->pictures) : cli_error(CLI_DEVICE, "out of host memory");
    if (exit_status == CLI_DONE) exit_status = cli_dicom_check(probe);
    free(probe);
    return exit_status;
}

static int write_picture(const cli_acquisition *a, int64_t index, skg_picture *picture, void *data) {
    char beside[64];
    skg_view view;
    skg_view_init(&view);
    cli_dicom_facts facts = {.study = a->hash, .number = index + 1, .beside = beside};
    snprintf(beside, sizeof beside, "projection %" PRId64 " of %" PRId64, index, a->projections);
    skg_status status = skg_scan_file_read(a->file, index, data);
    if (status == SKG_OK) status = skg_scan_view_get(a->file_options.scan, index, &view);
    if (status == SKG_OK) status = cli_dicom_facts_of(a->session.scene, a->session.spectrum, &view, &facts);
    if (status != SKG_OK) return cli_fail(status);
    picture->view = &view;
    char *path = cli_path_in(a->pictures, "projection-%05" PRId64 ".dcm", index);
    if (!path) return cli_error(CLI_DEVICE, "out of host memory for %s", a->pictures);
    const int exit_status = cli_dicom_save(picture, &facts, path, NULL);
    free(path);
    return exit_status;
}

int pictures_write(cli_acquisition *a) {
    const skg_view *view = &a->session.view;
    int64_t done = 0;
    skg_picture picture;
    skg_picture_init(&picture);
    skg_status status = skg_scan_file_done_count(a->file, &done);
    if (status != SKG_OK) return cli_fail(status);
    if (done < a->projections) return CLI_DONE; /* written when the scan is whole */
    void *data = calloc((size_t)(view->columns * view->rows), sizeof(double));
    if (!data) return cli_error(CLI_DEVICE, "out of host memory for a projection");
    picture.type = a->file_options.type;
    picture.columns = view->columns, picture.rows = view->rows;
    picture.data = data;
    picture.name = a->file_options.name, picture.unit = a->file_options.unit;
    picture.quantity = a->session.options.quantity;
    int exit_status = CLI_DONE;
    for (int64_t k = 0; k < a->projections && exit_status == CLI_DONE; k++)
        exit_status = write_picture(a, k, &picture, data);
    free(data);
    if (exit_status == CLI_DONE)
        cli_tell("%s has %" PRId64 " %s", a->pictures, a->projections,
                 skg_plural(a->projections, "projection", "projections"));
    return exit_status;
}
