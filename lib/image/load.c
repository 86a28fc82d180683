/* Reading image files, on disk and in memory: the extension chooses the reader. */
#include "image/image.h"

#include "core/text.h"

#include <inttypes.h>
#include <string.h>

typedef skg_status (*reader)(const skg_image_source *source, int64_t page, skg_picture_contents *contents,
                             double *values);

static const struct {
    const char *extension;
    reader read;
} readers[] = {{".mha", skg_metaimage_read},
               {".mhd", skg_metaimage_read},
               {".tif", skg_tiff_read},
               {".tiff", skg_tiff_read},
               {".png", skg_png_read}};

void skg_picture_contents_init_sized(void *contents, int32_t size) {
    const skg_picture_contents defaults = {.quantity = -1};
    skg_struct_init(contents, size, &defaults, sizeof defaults);
}

static skg_status find_reader(const skg_image_source *source, reader *found) {
    const char *path = source->name, *name = strrchr(path, '/');
    const char *dot = strrchr(name ? name : path, '.');
    for (size_t i = 0; dot && i < sizeof readers / sizeof *readers; i++)
        if (skg_same_name(dot, readers[i].extension)) {
            *found = readers[i].read;
            return source->bytes ? SKG_OK : skg_input_check(path, SKG_INPUT_LARGE);
        }
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "%s: the extension %s%s is none of an image that can be read; convert it to .mha, .tif or "
        ".png",
        path, dot ? dot : "", dot ? "" : "is missing and");
}

/* Looks at a file. */
static skg_status look(const skg_image_source *source, skg_picture_contents *theirs) {
    skg_picture_contents ours;
    reader read = NULL;
    skg_picture_contents_init(&ours);
    SKG_TRY(find_reader(source, &read));
    SKG_TRY(read(source, 0, &ours, NULL));
    return skg_struct_write(&ours, sizeof ours, "skg_picture_contents", theirs);
}

/* Reads a page. */
static skg_status load(const skg_image_source *source, int64_t page, double *values) {
    skg_picture_contents contents;
    reader read = NULL;
    skg_picture_contents_init(&contents);
    SKG_TRY(find_reader(source, &read));
    return read(source, page, &contents, values);
}

static skg_status check_size(const skg_image_source *source) {
    if (source->size > 0) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT, "%s: is empty: it has %" PRId64 " bytes", source->name, source->size);
}

skg_status skg_picture_contents_get(const char *path, skg_picture_contents *contents) {
    SKG_PLAIN;
    SKG_NEEDS(path);
    SKG_NEEDS(contents);
    return look(&(skg_image_source){.name = path}, contents);
}

skg_status skg_picture_load(const char *path, int64_t page, double *values) {
    SKG_PLAIN;
    SKG_NEEDS(path);
    SKG_NEEDS(values);
    return load(&(skg_image_source){.name = path}, page, values);
}

skg_status skg_picture_contents_decode(const char *name, const void *bytes, int64_t size,
                                       skg_picture_contents *contents) {
    SKG_PLAIN;
    SKG_NEEDS(name);
    SKG_NEEDS(bytes);
    SKG_NEEDS(contents);
    const skg_image_source source = {.name = name, .bytes = bytes, .size = size};
    SKG_TRY(check_size(&source));
    return look(&source, contents);
}

skg_status skg_picture_decode(const char *name, const void *bytes, int64_t size, int64_t page,
                              double *values) {
    SKG_PLAIN;
    SKG_NEEDS(name);
    SKG_NEEDS(bytes);
    SKG_NEEDS(values);
    const skg_image_source source = {.name = name, .bytes = bytes, .size = size};
    SKG_TRY(check_size(&source));
    return load(&source, page, values);
}
