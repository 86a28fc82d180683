/* PNG files in memory, by Cairo. These functions return an exit status and print the error; the caller frees the bytes. */
#ifndef CLI_MAP_SURFACE_PNG_H
#define CLI_MAP_SURFACE_PNG_H

#include <cairo.h>
#include <stddef.h>

int cli_png_of_surface(cairo_surface_t *surface, unsigned char **png, size_t *size);

/* Of grey levels, [rows][columns], from 0 (black) to 255 (white). */
int cli_png_of_greys(int columns, int rows, const unsigned char *greys, unsigned char **png, size_t *size);

#endif
