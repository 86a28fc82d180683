/* Keeps the error messages of libpng and libtiff instead of printing them. Private. */
#ifndef SKG_REASONS_H
#define SKG_REASONS_H

#include <png.h>
#include <tiffio.h>

/* "": libtiff has said nothing. */
typedef struct {
    char text[256];
} skg_tiff_reason;

/* Options with which libtiff keeps its first error in *kept and prints nothing; the caller frees them with TIFFOpenOptionsFree. NULL: no memory */
TIFFOpenOptions *skg_tiff_options(skg_tiff_reason *kept);

const char *skg_tiff_said(const skg_tiff_reason *kept);

/* For png_create_..._struct, whose error pointer is a const char **: the reason is kept, and libpng jumps back to setjmp. */
void skg_png_error(png_structp png, png_const_charp message);
void skg_png_warning(png_structp png, png_const_charp message);

#endif
