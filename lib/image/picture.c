/* Pictures: they are checked before a writer sees them, and the extension of the path chooses the writer. */
#include "image/image.h"

#include "core/text.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    const char *extension;
    skg_status (*write)(const skg_picture *picture, skg_output_file *file);
    skg_status (*check)(const skg_picture *picture, const char *path);
    skg_status (*encode)(const skg_picture *picture, const skg_image_target *target); /* NULL: by `write` */
} format;

static const format formats[] = {
    {.extension = ".png", .write = skg_png_write},
    {.extension = ".tif", .write = skg_tiff_write, .encode = skg_tiff_encode},
    {.extension = ".tiff", .write = skg_tiff_write, .encode = skg_tiff_encode},
    {.extension = ".mha", .write = skg_metaimage_write, .check = skg_metaimage_check},
};

void skg_picture_init_sized(void *picture, int32_t size) {
    const skg_picture defaults = {.channels = 1};
    skg_struct_init(picture, size, &defaults, sizeof defaults);
}

static skg_status check_range(const skg_picture *picture) {
    if (picture->low == 0 && picture->high == 0) return SKG_OK;
    if (!isfinite(picture->low) || !isfinite(picture->high) || picture->low >= picture->high)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "range %g:%g: the low end has to be below the high end, both finite", picture->low,
                        picture->high);
    return SKG_OK;
}

/* Reads the caller's struct and refuses a picture that no writer can use. */
static skg_status prepare(const skg_picture *theirs, skg_picture *picture) {
    skg_picture_init(picture);
    SKG_TRY(skg_struct_read(theirs, "skg_picture", picture, sizeof *picture));
    if (picture->type < SKG_TYPE_FLOAT32 || picture->type > SKG_TYPE_UINT16)
        return skg_fail(SKG_ERR_ARGUMENT, "picture: type %" PRId32 " is no SKG_TYPE_ value", picture->type);
    if (picture->columns < 1 || picture->rows < 1 || picture->channels < 1 || picture->columns > INT32_MAX ||
        picture->rows > INT32_MAX || picture->channels > UINT16_MAX)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "picture: %" PRId64 " columns, %" PRId64 " rows, %" PRId64
                        " channels; each has to be at least 1, and a file has to hold them",
                        picture->columns, picture->rows, picture->channels);
    if (!picture->data) return skg_fail(SKG_ERR_ARGUMENT, "picture: no data");
    if (picture->display != SKG_DISPLAY_RADIOGRAPH && picture->display != SKG_DISPLAY_TRANSMISSION)
        return skg_fail(SKG_ERR_ARGUMENT, "picture: display %" PRId32 " is no SKG_DISPLAY_ value",
                        picture->display);
    if (picture->quantity < SKG_QUANTITY_ENERGY || picture->quantity > SKG_QUANTITY_ATTENUATION)
        return skg_fail(SKG_ERR_ARGUMENT, "picture: quantity %" PRId32 " is none that images have",
                        picture->quantity);
    if (!(picture->flat_field >= 0) || isinf(picture->flat_field))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "picture: a flat field of %g; it has to be finite, and 0 if there is none",
                        picture->flat_field);
    if (picture->view && (picture->view->columns != picture->columns || picture->view->rows != picture->rows))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "picture: %" PRId64 " x %" PRId64 " pixels, but its view has %" PRId64 " x %" PRId64,
                        picture->columns, picture->rows, picture->view->columns, picture->view->rows);
    for (int64_t c = 0; picture->channel_names && c < picture->channels; c++)
        if (!picture->channel_names[c])
            return skg_fail(SKG_ERR_ARGUMENT, "picture: channel %" PRId64 " has no name", c);
    if (picture->channel_names) picture->name = picture->channel_names[0];
    return check_range(picture);
}

static int is_standard_output(const char *path) {
    return strcmp(path, "-") == 0;
}

static skg_status find_format(const char *path, const format **found) {
    if (!path || !*path) return skg_fail(SKG_ERR_ARGUMENT, "picture: no path to write to");
    if (is_standard_output(path)) path = ".mha";
    const char *name = strrchr(path, '/');
    const char *dot = strrchr(name ? name : path, '.');
    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++)
        if (skg_same_name(dot, formats[i].extension)) {
            *found = &formats[i];
            return SKG_OK;
        }
    return skg_fail(SKG_ERR_ARGUMENT, "%s: the extension %s%s is no image format; use .png, .tif or .mha",
                    path, dot ? dot : "", dot ? "" : "is missing and");
}

skg_status skg_picture_path_check(const char *path) {
    const format *writer = NULL;
    skg_output_file file;
    SKG_TRY(find_format(path, &writer));
    if (is_standard_output(path)) return SKG_OK;
    SKG_TRY(skg_output_open(path, &file));
    skg_output_discard(&file);
    return SKG_OK;
}

static skg_status write_to_standard_output(const format *writer, const skg_picture *picture) {
    skg_output_file file = {.stream = stdout};
    SKG_TRY(skg_copy_text("standard output", &file.path));
    skg_status status = writer->write(picture, &file);
    skg_free(&file.path);
    if (status == SKG_OK && (fflush(stdout) != 0 || ferror(stdout)))
        status = skg_output_fail("standard output", errno, "not everything was taken");
    return status;
}

skg_status skg_picture_save(const skg_picture *theirs, const char *path) {
    SKG_PLAIN;
    skg_picture picture;
    const format *writer = NULL;
    skg_output_file file;
    SKG_TRY(prepare(theirs, &picture));
    SKG_TRY(find_format(path, &writer));
    if (writer->check) SKG_TRY(writer->check(&picture, path));
    if (is_standard_output(path)) return write_to_standard_output(writer, &picture);
    SKG_TRY(skg_output_open(path, &file));
    skg_status status = writer->write(&picture, &file);
    if (status == SKG_OK) return skg_output_commit(&file);
    skg_output_discard(&file);
    return status;
}

/* Writes into a stream that is memory. */
static skg_status encode_by_stream(const format *writer, const skg_picture *picture,
                                   const skg_image_target *target) {
    char *bytes = NULL;
    size_t size = 0;
    skg_output_file file = {.stream = open_memstream(&bytes, &size)};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_copy_text(target->name, &file.path));
    if (file.stream) SKG_TRY_CLEANUP(writer->write(picture, &file));
    if (!file.stream || fflush(file.stream) != 0 || ferror(file.stream))
        SKG_TRY_CLEANUP(skg_fail(SKG_ERR_MEMORY, "%s: out of host memory", target->name));
    status = skg_image_put(target, bytes, (int64_t)size);
cleanup:
    if (file.stream) fclose(file.stream);
    free(bytes);
    skg_free(&file.path);
    return status;
}

skg_status skg_picture_encode(const skg_picture *theirs, const char *name, void *bytes, int64_t capacity,
                              int64_t *size) {
    SKG_PLAIN;
    skg_picture picture;
    const format *writer = NULL;
    SKG_NEEDS(name);
    SKG_NEEDS(size);
    const skg_image_target target = {.name = name, .bytes = bytes, .capacity = capacity, .size = size};
    SKG_TRY(prepare(theirs, &picture));
    SKG_TRY(find_format(name, &writer));
    if (writer->check) SKG_TRY(writer->check(&picture, name));
    return writer->encode ? writer->encode(&picture, &target) : encode_by_stream(writer, &picture, &target);
}

skg_status skg_picture_range_get(const skg_picture *theirs, double *low, double *high) {
    SKG_PLAIN;
    skg_picture picture;
    SKG_TRY(prepare(theirs, &picture));
    SKG_NEEDS(low);
    SKG_NEEDS(high);
    skg_picture_shown_range(&picture, low, high);
    return SKG_OK;
}

skg_status skg_picture_window_get(const skg_picture *theirs, double below, double above, double *low,
                                  double *high) {
    SKG_PLAIN;
    SKG_NEEDS(low);
    SKG_NEEDS(high);
    skg_picture picture;
    SKG_TRY(prepare(theirs, &picture));
    if (!(below >= 0 && below < 0.5 && above >= 0 && above < 0.5))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "skg_picture_window_get: shares %g and %g; give shares from 0 to below 0.5", below,
                        above);
    return skg_picture_shown_window(&picture, below, above, low, high);
}
