#include "map/png.h"

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
