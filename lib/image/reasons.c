/* Keeps the error messages of libpng and libtiff instead of printing them. */
#include "image/reasons.h"

#include <stdarg.h>
#include <stdio.h>

/* Keeps the first sentence. Returns 1, so that libtiff does not print it. */
static int on_error(TIFF *tiff, void *user, const char *module, const char *format, va_list arguments) {
    skg_tiff_reason *kept = user;
    (void)tiff;
    (void)module;
    if (!kept->text[0]) vsnprintf(kept->text, sizeof kept->text, format, arguments);
    return 1;
}

static int on_warning(TIFF *tiff, void *user, const char *module, const char *format, va_list arguments) {
    (void)tiff;
    (void)user;
    (void)module;
    (void)format;
    (void)arguments;
    return 1;
}

TIFFOpenOptions *skg_tiff_options(skg_tiff_reason *kept) {
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options) return NULL;
    TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, kept);
    TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, NULL);
    return options;
}

const char *skg_tiff_said(const skg_tiff_reason *kept) {
    return kept->text[0] ? kept->text : "libtiff gives no reason";
}

void skg_png_error(png_structp png, png_const_charp message) {
    const char **reason = png_get_error_ptr(png);
    *reason = message;
    png_longjmp(png, 1);
}

void skg_png_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}
