/* A folder with one TIFF file for each projection, which appears whole or not at all, and scan.txt, which says of which
 * scan they are. */
#include "core/files.h"
#include "scan/format.h"

#include <skiagraph/image.h>

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAME_LENGTH = 200 };

static skg_status member(const char *path, const char *name, char **result) {
    char ending[NAME_LENGTH + 1];
    const size_t length = strlen(path);
    snprintf(ending, sizeof ending, "%s%s", length > 0 && path[length - 1] == '/' ? "" : "/", name);
    return skg_scan_path_with(path, ending, result);
}

static skg_status projection_path(const skg_scan_file *file, int64_t index, char **result) {
    char name[NAME_LENGTH];
    const char *stem = file->options.stem;
    const int length = stem ? snprintf(name, sizeof name, "%s_%04" PRId64 ".tif", stem, index)
                            : snprintf(name, sizeof name, "projection-%05" PRId64 ".tif", index);
    if (length >= NAME_LENGTH) return skg_output_fail(file->path, ENAMETOOLONG, "");
    return member(file->path, name, result);
}

static skg_status lay_out(skg_scan_file *file, const char *temporary) {
    char *path = NULL, text[160], levels[SKG_SCAN_LEVELS_LENGTH];
    skg_output_file output = {0};
    skg_status status = SKG_OK;
    (void)temporary;
    if (mkdir(file->path, 0777) != 0 && errno != EEXIST) return skg_output_fail(file->path, errno, "");
    SKG_TRY_CLEANUP(member(file->path, "scan.txt", &path));
    SKG_TRY_CLEANUP(skg_output_open(path, &output));
    skg_scan_write_identity(file, text, sizeof text);
    skg_scan_write_levels(file, levels);
    fprintf(output.stream, "%sProjections = %" PRId64 "\nQuantity = %s\nUnit = %s\n%s", text,
            file->projections, file->options.name, file->options.unit, levels);
    SKG_TRY_CLEANUP(skg_output_commit(&output));
cleanup:
    skg_output_discard(&output);
    skg_free(&path);
    return status;
}

static skg_status identify(const char *path, skg_scan_identity *identity) {
    char *text = NULL;
    SKG_TRY(member(path, "scan.txt", &text));
    skg_status status = skg_scan_read_identity(text, identity);
    skg_free(&text);
    return status;
}

static skg_status find_done(skg_scan_file *file) {
    for (int64_t k = 0; k < file->projections; k++) {
        char *path = NULL;
        SKG_TRY(projection_path(file, file->first + k, &path));
        file->done[k] = access(path, F_OK) == 0;
        file->done_count += file->done[k];
        skg_free(&path);
    }
    return SKG_OK;
}

static skg_status write_picture(const skg_scan_file *file, const skg_view *view, const void *image,
                                const char *path) {
    skg_picture picture;
    skg_picture_init(&picture);
    picture.type = file->options.type;
    picture.columns = view->columns;
    picture.rows = view->rows;
    picture.data = image;
    picture.name = file->options.name;
    picture.unit = file->options.unit;
    picture.view = view;
    return skg_picture_save(&picture, path);
}

static skg_status write_one(skg_scan_file *file, int64_t index, const void *image, double phase) {
    char *path = NULL;
    skg_view view;
    (void)phase;
    skg_view_init(&view);
    SKG_TRY(skg_scan_view_get(file->options.scan, index, &view));
    SKG_TRY(projection_path(file, index, &path));
    skg_status status = write_picture(file, &view, image, path);
    skg_free(&path);
    return status;
}

/* flat-00000.tif; with a stem STEM_flat_0000.tif, or STEM_flat.tif if there is one. */
static skg_status field_path(const skg_scan_file *file, const char *kind, int64_t field, int64_t count,
                             char **result) {
    char name[NAME_LENGTH], number[32] = "";
    const char *stem = file->options.stem;
    if (count > 1) snprintf(number, sizeof number, "_%04" PRId64, field);
    const int length = stem ? snprintf(name, sizeof name, "%s_%s%s.tif", stem, kind, number)
                            : snprintf(name, sizeof name, "%s-%05" PRId64 ".tif", kind, field);
    if (length >= NAME_LENGTH) return skg_output_fail(file->path, ENAMETOOLONG, "");
    return member(file->path, name, result);
}

static skg_status write_field(skg_scan_file *file, const char *kind, int64_t field, int64_t count,
                              const void *image) {
    char *path = NULL;
    SKG_TRY(field_path(file, kind, field, count, &path));
    skg_status status = write_picture(file, &file->view, image, path);
    skg_free(&path);
    return status;
}

/* Removes fields without a stem from number `from` on: an earlier scan may have had more. */
static skg_status remove_fields(const skg_scan_file *file, const char *kind, int64_t from) {
    int is_gone = 0;
    for (int64_t f = from; !is_gone && !file->options.stem; f++) {
        char *path = NULL;
        SKG_TRY(field_path(file, kind, f, 0, &path));
        is_gone = unlink(path) != 0;
        skg_free(&path);
    }
    return SKG_OK;
}

static skg_status write_fields(skg_scan_file *file, int64_t flats, const void *white, int64_t darks,
                               const void *dark) {
    SKG_TRY(remove_fields(file, "flat", flats));
    SKG_TRY(remove_fields(file, "dark", darks));
    for (int64_t f = 0; f < flats; f++)
        SKG_TRY(write_field(file, "flat", f, flats, (const char *)white + f * file->bytes));
    for (int64_t d = 0; d < darks; d++)
        SKG_TRY(write_field(file, "dark", d, darks, (const char *)dark + d * file->bytes));
    return SKG_OK;
}

/* Removes the projections of another scan, as many as this one has; its own would take their names. */
static skg_status remove_all(skg_scan_file *file) {
    char *text = NULL;
    SKG_TRY(member(file->path, "scan.txt", &text));
    unlink(text);
    skg_free(&text);
    for (int64_t k = 0; k < file->projections; k++) {
        char *path = NULL;
        SKG_TRY(projection_path(file, file->first + k, &path));
        unlink(path);
        skg_free(&path);
    }
    SKG_TRY(remove_fields(file, "flat", 0));
    return remove_fields(file, "dark", 0);
}

const skg_scan_format skg_scan_format_folder = {.lay_out = lay_out,
                                                .identify = identify,
                                                .write = write_one,
                                                .write_fields = write_fields,
                                                .find_done = find_done,
                                                .remove = remove_all};
