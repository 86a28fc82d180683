/* What the writers of image files share. Private. */
#ifndef SKG_IMAGE_PRIVATE_H
#define SKG_IMAGE_PRIVATE_H

#include "core/core.h"
#include "core/output.h"

#include <skiagraph/image.h>

enum { SKG_DESCRIPTION_LENGTH = 1024 };

/* The value at `index` of the first channel on, as double. */
double skg_picture_value(const skg_picture *picture, int64_t index);

/* What is shown for a value: -ln(I/I0), I/I0, or the value itself where there is no open beam to compare
 * with. */
double skg_picture_shown(const skg_picture *picture, double value);

/* In words, for the text of a PNG: "-ln(I/I0)", "I/I0", or the quantity with its unit. */
void skg_picture_curve(const skg_picture *picture, char *text, size_t length);

/* "energy (keV per pixel)", without brackets where there is no unit. */
void skg_picture_title(const skg_picture *picture, char *text, size_t length);

/* Up to `count` numbers with spaces between, each with as few digits as bring the double back. */
void skg_picture_numbers(const double *numbers, int count, char *text, size_t length);

/* The title with source, detector centre and steps, on one line. */
void skg_picture_describe(const skg_picture *picture, char *text, size_t length);

/* Each writes a checked picture to an open output file, and neither commits nor discards it. */
skg_status skg_png_write(const skg_picture *picture, skg_output_file *file);
skg_status skg_tiff_write(const skg_picture *picture, skg_output_file *file);
skg_status skg_metaimage_write(const skg_picture *picture, skg_output_file *file);

/* SKG_ERR_UNSUPPORTED when the detector's steps are skewed. */
skg_status skg_metaimage_check(const skg_picture *picture, const char *path);

#endif
