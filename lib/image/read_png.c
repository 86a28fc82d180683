/* Reads grey PNGs. */
#include "image/image.h"
#include "image/reasons.h"

#include <png.h>
#include <setjmp.h>
#include <string.h>

/* Nothing is allocated here, so that libpng may jump out of it. Samples become 16 bits, 8 of them without a scale: bytes keep their
 * numbers. */
static int read_header(png_structp png, png_infop info, FILE *stream) {
    if (setjmp(png_jmpbuf(png))) return 0;
    png_init_io(png, stream);
    png_read_info(png, info);
    if (png_get_bit_depth(png, info) < 8) png_set_packing(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return 1;
}

static int read_rows(png_structp png, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png))) return 0;
    png_read_image(png, rows);
    return 1;
}

static skg_status read_values(const char *path, png_structp png, png_infop info,
                              const skg_picture_contents *contents, const char **reason, double *values) {
    const size_t line = png_get_rowbytes(png, info);
    const int bytes = png_get_bit_depth(png, info) == 16 ? 2 : 1;
    png_bytep pixels = NULL;
    png_bytepp rows = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(contents->rows, line, "PNG", &pixels));
    SKG_TRY_CLEANUP(skg_alloc(contents->rows, sizeof *rows, "PNG", &rows));
    for (int64_t r = 0; r < contents->rows; r++) rows[r] = pixels + (size_t)r * line;
    if (!read_rows(png, rows)) SKG_TRY_CLEANUP(skg_fail(SKG_ERR_FORMAT, "%s: is damaged: %s", path, *reason));
    for (int64_t p = 0; p < contents->rows * contents->columns; p++) {
        const png_byte *at = rows[p / contents->columns] + p % contents->columns * bytes;
        values[p] = bytes == 2 ? at[0] * 256.0 + at[1] : at[0];
    }
cleanup:
    skg_free(&rows);
    skg_free(&pixels);
    return status;
}

static skg_status read_page(const char *path, png_structp png, png_infop info, FILE *stream, int64_t page,
                            skg_picture_contents *contents, const char **reason, double *values) {
    if (!read_header(png, info, stream)) return skg_fail(SKG_ERR_FORMAT, "%s: is no PNG: %s", path, *reason);
    SKG_TRY(skg_picture_size_check(path, png_get_image_width(png, info), png_get_image_height(png, info), 1));
    contents->columns = png_get_image_width(png, info), contents->rows = png_get_image_height(png, info);
    contents->pages = 1;
    SKG_TRY(skg_picture_page_check(path, page, 1));
    if (png_get_color_type(png, info) != PNG_COLOR_TYPE_GRAY)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: has colours or transparency; write it grey", path);
    return values ? read_values(path, png, info, contents, reason, values) : SKG_OK;
}

skg_status skg_png_read(const skg_image_source *source, int64_t page, skg_picture_contents *contents,
                        double *values) {
    const char *path = source->name;
    const char *reason = "libpng gives no reason";
    FILE *stream = NULL;
    SKG_TRY(skg_image_open(source, &stream));
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reason, skg_png_error, skg_png_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    const skg_status status = info ? read_page(path, png, info, stream, page, contents, &reason, values)
                                   : skg_fail(SKG_ERR_MEMORY, "%s: no memory to read it", path);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(stream);
    return status;
}
