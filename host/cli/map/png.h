/* PNG files in memory. */
#ifndef SKG_CLI_MAP_PNG_H
#define SKG_CLI_MAP_PNG_H

#include <cairo.h>

#include <stddef.h>

/* The bytes of a surface as PNG, which the caller frees. Returns an exit status and prints the error. */
int cli_png_of_surface(cairo_surface_t *surface, unsigned char **png, size_t *size);

#endif
