/* PNG: the first channel in 16 bit grey, through its display curve. */
#include "image/image.h"
#include "image/reasons.h"

#include <skiagraph/version.h>

#include <errno.h>
#include <math.h>
#include <png.h>
#include <string.h>

static void set_texts(png_structp png, png_infop info, const skg_picture *picture) {
    char description[SKG_DESCRIPTION_LENGTH], curve[256], range[128];
    png_text texts[4];
    memset(texts, 0, sizeof texts);
    skg_picture_describe(picture, description, sizeof description);
    skg_picture_curve(picture, curve, sizeof curve);
    snprintf(range, sizeof range, "black %.9g, white %.9g", picture->low, picture->high);
    char software[] = "skiagraph " SKG_VERSION;
    char keys[4][16] = {"Software", "Description", "Display", "Range"};
    char *values[4] = {software, description, curve, range};
    for (int i = 0; i < 4; i++) {
        texts[i].compression = PNG_TEXT_COMPRESSION_NONE;
        texts[i].key = keys[i];
        texts[i].text = values[i];
    }
    png_set_text(png, info, texts, 4);
}

/* Grey levels from 0 (black, at or below low) to 65535 (white, at or above high), the most significant byte first. */
static void show_row(const skg_picture *picture, int64_t row, png_bytep bytes) {
    for (int64_t c = 0; c < picture->columns; c++) {
        double shown = skg_picture_shown(picture, skg_picture_value(picture, row * picture->columns + c));
        double grey = (shown - picture->low) / (picture->high - picture->low);
        /* A value that is not a number is black. */
        long level = !(grey > 0) ? 0 : grey >= 1 ? 65535 : lround(grey * 65535);
        bytes[2 * c] = (png_byte)(level >> 8);
        bytes[2 * c + 1] = (png_byte)(level & 255);
    }
}

/* Returns 1 if everything was written. Nothing is allocated here, so that libpng may jump out of it. */
static int write_all(png_structp png, png_infop info, const skg_picture *picture, FILE *stream,
                     png_bytep bytes) {
    if (setjmp(png_jmpbuf(png))) return 0;
    png_init_io(png, stream);
    png_set_IHDR(png, info, (png_uint_32)picture->columns, (png_uint_32)picture->rows, 16,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    set_texts(png, info, picture);
    png_write_info(png, info);
    for (int64_t row = 0; row < picture->rows; row++) {
        show_row(picture, row, bytes);
        png_write_row(png, bytes);
    }
    png_write_end(png, NULL);
    return 1;
}

skg_status skg_png_write(const skg_picture *theirs, skg_output_file *file) {
    skg_status status = SKG_OK;
    skg_picture picture = *theirs;
    const char *reason = NULL;
    png_structp png = NULL;
    png_infop info = NULL;
    png_bytep bytes = NULL;
    if (picture.low == 0 && picture.high == 0) skg_picture_shown_range(theirs, &picture.low, &picture.high);
    SKG_TRY(skg_alloc(2 * picture.columns, 1, "row of a PNG file", &bytes));
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &reason, skg_png_error, skg_png_warning);
    info = png ? png_create_info_struct(png) : NULL;
    if (!info) {
        status = skg_fail(SKG_ERR_MEMORY, "%s: out of host memory", file->path);
        goto cleanup;
    }
    errno = 0;
    if (!write_all(png, info, &picture, file->stream, bytes))
        status = skg_output_fail(file->path, errno, reason);
cleanup:
    png_destroy_write_struct(&png, &info);
    skg_free(&bytes);
    return status;
}
