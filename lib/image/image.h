/* The writers and readers of image files and what they share. Private. */
#ifndef SKG_IMAGE_PRIVATE_H
#define SKG_IMAGE_PRIVATE_H

#include "core/core.h"
#include "core/files.h"

#include <skiagraph/image.h>
#include <skiagraph/volume.h>

#include <string.h>

/* Bytes of the description with its closing zero. */
enum { SKG_DESCRIPTION_LENGTH = 1024 };

/* Whether the first byte of a number is its most significant one. */
static inline int skg_host_is_big_endian(void) {
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 0;
}

/* The value at `index`, counted from the first value of the first channel. */
double skg_picture_value(const skg_picture *picture, int64_t index);

/* The number that is shown for a value: -ln(I/I0) or I/I0, or the value itself if the picture has no flat field
 * I0. */
double skg_picture_shown(const skg_picture *picture, double value);

/* The smallest and the largest number that is shown in the first channel; 0 and 1 if none is finite. */
void skg_picture_shown_range(const skg_picture *picture, double *low, double *high);

/* The range without a share of values below it and one above it. */
skg_status skg_picture_shown_window(const skg_picture *picture, double below, double above, double *low,
                                    double *high);

/* The display curve in words, for the text of a PNG: "-ln(I/I0)", "I/I0", or the quantity with its unit. */
void skg_picture_curve(const skg_picture *picture, char *text, size_t length);

/* "energy (keV per pixel)"; without brackets if there is no unit. */
void skg_picture_title(const skg_picture *picture, char *text, size_t length);

/* Numbers separated by spaces, each with the fewest digits from which the same double is read. */
void skg_picture_numbers(const double *numbers, int count, char *text, size_t length);

/* The title, source, detector centre and steps on one line. */
void skg_picture_describe(const skg_picture *picture, char *text, size_t length);

/* Each writes a checked picture to an output file, and neither commits nor discards it. */
skg_status skg_png_write(const skg_picture *picture, skg_output_file *file);
skg_status skg_tiff_write(const skg_picture *picture, skg_output_file *file);
skg_status skg_metaimage_write(const skg_picture *picture, skg_output_file *file);

/* Memory of the caller that gets a file; `size` is what the file needs. name: for messages */
typedef struct {
    const char *name;
    void *bytes; /* NULL: the size alone is wanted */
    int64_t capacity, *size;
} skg_image_target;

/* Hands out the bytes of a file, or SKG_ERR_ARGUMENT if they do not fit. */
skg_status skg_image_put(const skg_image_target *target, const void *bytes, int64_t size);

/* Writes a checked TIFF into memory: libtiff goes back to earlier pages, which a stream into memory cannot. */
skg_status skg_tiff_encode(const skg_picture *picture, const skg_image_target *target);

/* A file that is read: by its path, or bytes in memory, whose name messages have. */
typedef struct {
    const char *name;
    const void *bytes; /* NULL: of the path `name` */
    int64_t size;
} skg_image_source;

/* Opens it at its begin; the caller closes the stream. */
skg_status skg_image_open(const skg_image_source *source, FILE **stream);

/* Each looks at a file, and reads a page of it if values is not NULL. The number of rows and columns is at most 32768. */
skg_status skg_png_read(const skg_image_source *source, int64_t page, skg_picture_contents *contents,
                        double *values);
skg_status skg_tiff_read(const skg_image_source *source, int64_t page, skg_picture_contents *contents,
                         double *values);
skg_status skg_metaimage_read(const skg_image_source *source, int64_t page, skg_picture_contents *contents,
                              double *values);

/* A grid of three dimensions in a file. */
typedef struct {
    int64_t size[3];
    /* from the indices of a cell to its centre, in the file's unit; see skg_volume_source */
    double affine[16];
    double unit_mm[3];  /* mm per unit of x, y, z that the file names; 0: none */
    int32_t type;       /* enum skg_volume_type */
    int32_t no_spacing; /* 1: the file does not say how large cells are; 1 of its unit is taken */
    /* 1: it does not say the order of bytes, as it has to; the least significant first is taken */
    int32_t no_order;
    int32_t reserved;
    void *cells; /* the caller frees them */
    char no_hounsfield
        [96]; /* what the file says of its numbers that Hounsfield numbers do not have; empty: nothing */
} skg_grid;

/* How the cells of a grid lie in a file. kind: as of skg_number_of_bytes */
typedef struct {
    int bytes, swapped, compressed; /* compressed: 1: by zlib or gzip */
    char kind;
    int64_t first;       /* byte of the expanded file at which they begin, from where the stream stands */
    double slope, shift; /* a value is the number in the file times slope plus shift; slope 0: the number */
} skg_grid_file;

/* The first bytes of what a file holds, up to `most`; *count: so many there were. Only `compressed` of `file` is read. The stream is
 * then at its begin. */
skg_status skg_grid_read_head(const char *path, FILE *stream, const skg_grid_file *file, size_t most,
                              void *bytes, size_t *count);

/* Reads the cells of a grid of known size, of which *stream is at the first. */
skg_status skg_grid_read_cells(const char *path, FILE *stream, const skg_grid_file *file, skg_grid *grid);

/* Each reads a volume with its place. */
skg_status skg_metaimage_read_grid(const char *path, skg_grid *grid);
skg_status skg_nrrd_read_grid(const char *path, skg_grid *grid);
skg_status skg_nifti_read_grid(const char *path, skg_grid *grid);

/* Reads a folder of DICOM slices as a grid, and says whether a path is a folder. */
skg_status skg_dicom_read_grid(const char *path, skg_grid *grid);
int skg_dicom_is_folder(const char *path);

/* The value of a number of `bytes` bytes of a file. kind: 'u' unsigned, 'i' signed, 'f' float; swapped: 1: of the other byte order. */
double skg_number_of_bytes(const void *at, int bytes, char kind, int swapped);

/* The quantity that a heading of skg_picture_title begins with; -1: none. */
int32_t skg_quantity_of_title(const char *title);

/* SKG_ERR_FORMAT if an image has no pixels or too many. */
skg_status skg_picture_size_check(const char *path, double columns, double rows, double pages);

/* SKG_ERR_ARGUMENT if there is no such page. */
skg_status skg_picture_page_check(const char *path, int64_t page, int64_t pages);

/* SKG_ERR_UNSUPPORTED if the steps of the detector are not at right angles. */
skg_status skg_metaimage_check(const skg_picture *picture, const char *path);

#endif
