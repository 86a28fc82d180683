/* PNG files in memory, by Cairo. */
#include "map/surface_png.h"

#include "common/say.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    unsigned char *bytes;
    size_t size;
} growing;

static cairo_status_t append(void *to, const unsigned char *bytes, unsigned int count) {
    growing *all = to;
    unsigned char *more = realloc(all->bytes, all->size + count);
    if (!more) return CAIRO_STATUS_NO_MEMORY;
    memcpy(more + all->size, bytes, count);
    all->bytes = more, all->size += count;
    return CAIRO_STATUS_SUCCESS;
}

int cli_png_of_surface(cairo_surface_t *surface, unsigned char **png, size_t *size) {
    growing all = {0};
    const cairo_status_t status = cairo_surface_write_to_png_stream(surface, append, &all);
    *png = all.bytes, *size = all.size;
    if (status == CAIRO_STATUS_SUCCESS) return CLI_DONE;
    free(all.bytes);
    *png = NULL;
    return cli_error(CLI_DEVICE, "a picture cannot be drawn: %s", cairo_status_to_string(status));
}

int cli_png_of_greys(int columns, int rows, const unsigned char *greys, unsigned char **png, size_t *size) {
    /* Cairo writes a surface that has opacities only as grey levels. */
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, columns, rows);
    unsigned char *pixels = cairo_image_surface_get_data(surface); /* NULL: the surface has failed */
    const int stride = cairo_image_surface_get_stride(surface);
    cairo_surface_flush(surface);
    for (int row = 0; pixels && row < rows; row++)
        memcpy(pixels + (ptrdiff_t)stride * row, greys + (ptrdiff_t)columns * row, (size_t)columns);
    cairo_surface_mark_dirty(surface);
    const int exit_status = cli_png_of_surface(surface, png, size);
    cairo_surface_destroy(surface);
    return exit_status;
}
