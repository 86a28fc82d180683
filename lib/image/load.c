/* Reading image files: the extension chooses the reader. */
#include "image/image.h"

#include "core/text.h"

#include <string.h>

typedef skg_status (*reader)(const char *path, int64_t page, skg_picture_contents *contents, double *values);

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

static skg_status find_reader(const char *path, reader *found) {
    const char *name = strrchr(path, '/');
    const char *dot = strrchr(name ? name : path, '.');
    for (size_t i = 0; dot && i < sizeof readers / sizeof *readers; i++)
        if (skg_same_name(dot, readers[i].extension)) {
            *found = readers[i].read;
            return skg_input_check(path, SKG_INPUT_LARGE);
        }
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "%s: the extension %s%s is none of an image that can be read; convert it to .mha, .tif or "
        ".png",
        path, dot ? dot : "", dot ? "" : "is missing and");
}

skg_status skg_picture_contents_get(const char *path, skg_picture_contents *contents) {
    SKG_PLAIN;
    skg_picture_contents ours;
    reader read = NULL;
    SKG_NEEDS(path);
    SKG_NEEDS(contents);
    skg_picture_contents_init(&ours);
    SKG_TRY(find_reader(path, &read));
    SKG_TRY(read(path, 0, &ours, NULL));
    return skg_struct_write(&ours, sizeof ours, "skg_picture_contents", contents);
}

skg_status skg_picture_load(const char *path, int64_t page, double *values) {
    SKG_PLAIN;
    skg_picture_contents contents;
    reader read = NULL;
    SKG_NEEDS(path);
    SKG_NEEDS(values);
    skg_picture_contents_init(&contents);
    SKG_TRY(find_reader(path, &read));
    return read(path, page, &contents, values);
}
