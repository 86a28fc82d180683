/** @file
 * Image files: TIFF, MetaImage and PNG, written and read, on disk and in memory. A file that is written appears whole or not at all.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_IMAGE_H
#define SKIAGRAPH_IMAGE_H

#include <skiagraph/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How a PNG shows an image. */
enum skg_display {
    /** -ln(I / I0): dense matter is white. */
    SKG_DISPLAY_RADIOGRAPH = 0,
    /** I / I0: dense matter is dark. */
    SKG_DISPLAY_TRANSMISSION = 1
};

/** An image to write. Prepare with skg_picture_init: one channel of float. */
typedef struct {
    /** Set by skg_picture_init. */
    int32_t size;
    /** enum skg_type, of data and of .mha and .tif files */
    int32_t type;
    /** Number of columns. */
    int64_t columns;
    /** Number of rows. */
    int64_t rows;
    /** Number of channels; 1 by default. */
    int64_t channels;
    /** [channel][row][column], dense */
    const void *data;
    /** Name of the quantity, for the file's header, such as "energy"; NULL: "". */
    const char *name;
    /** Unit of the quantity, such as "keV per pixel"; NULL: "". */
    const char *unit;
    /** Where the detector is, for the file's header; NULL: pixels of 1 mm at no particular place. */
    const skg_view *view;
    /** enum skg_display, for .png */
    int32_t display;
    /** enum skg_quantity: what data holds, from which a display curve follows */
    int32_t quantity;
    /** I0 in the unit of data, for display curves. Not used for transmission and attenuation; 0: data is
     * shown as it is (path lengths). */
    double flat_field;
    /** Value that a .png shows as black. */
    double low;
    /** Value that a .png shows as white. Both 0: the image's own least and greatest value. */
    double high;
    /** [channels] names instead of `name`; may be NULL. */
    const char *const *channel_names;
} skg_picture;

SKG_INIT(skg_picture)

/** Writes an image to a file.
 *
 *     path     .png: 16 bits grey, row 0 on top, the first channel; a text chunk has display curve and range
 *              .tif, .tiff: float or double, one page per channel, whose description has the channel's name
 *              .mha: float or double, every channel, with spacing, origin and direction of the detector; a
 *              field ChannelNames has channel_names, separated by "; "
 *              -: as .mha, to standard output
 *     errors   SKG_ERR_ARGUMENT (unknown extension), SKG_ERR_OUTPUT; SKG_ERR_UNSUPPORTED for .mha if the
 *              detector's steps are not perpendicular, which MetaImage cannot express: use TIFF */
SKG_API skg_status skg_picture_save(const skg_picture *picture, const char *path);

/** Makes the file that skg_picture_save would write, byte by byte, in memory of the caller.
 *
 *     name       its extension says the format, as that of a path does: "frame.png". Messages have it; nothing of this name is opened
 *     bytes      result: [capacity], of which the file takes the first `size`; NULL: its size alone is wanted
 *     capacity   bytes of memory
 *     size       result: bytes of the file, also if they do not fit. Each call makes the file anew: memory for the pixels and
 *                64 KiB, which suffices for nearly all, saves the call that asks for the size
 *     errors     as of skg_picture_save; SKG_ERR_ARGUMENT if capacity does not suffice */
SKG_API skg_status skg_picture_encode(const skg_picture *picture, const char *name, void *bytes,
                                      int64_t capacity, int64_t *size);

/** Checks that skg_picture_save could write to a path, before a long computation: the extension is known,
 * and a file can be made beside it (one is, for a moment). Errors as of skg_picture_save. */
SKG_API skg_status skg_picture_path_check(const char *path);

/** Gets the values that a .png would show as black and as white if low and high were 0, so that all frames of
 * a sequence can use the same: the least and the greatest shown value that is finite. Of attenuations those that no photon
 * has made (126 ln 2, behind jaws) are left out. */
SKG_API skg_status skg_picture_range_get(const skg_picture *picture, double *low, double *high);

/** Gets a range for a .png from which outliers are left out: of the shown values of the first channel that are
 * finite, a share below `low` and a share above `high`. If both ends are the same value, the result is that of
 * skg_picture_range_get.
 *
 *     below, above   the shares, from 0 to below 0.5, such as 0.005: the value of the nearest rank
 *     low, high      results, in the unit of the display curve
 *     errors         SKG_ERR_ARGUMENT, SKG_ERR_MEMORY */
SKG_API skg_status skg_picture_window_get(const skg_picture *picture, double below, double above, double *low,
                                          double *high);

/** Quantity, size and pixel spacing of an image file. The library fills it; prepare with skg_picture_contents_init. */
typedef struct {
    /** Set by skg_picture_contents_init. */
    int32_t size;
    /** enum skg_quantity of the values, if the file says so as skg_picture_save writes it; otherwise -1. */
    int32_t quantity;
    /** Number of columns. */
    int64_t columns;
    /** Number of rows. */
    int64_t rows;
    /** Number of pages of a TIFF, or slices of a MetaImage. */
    int64_t pages;
    /** mm from a column to the next, and from a row to the next, as a MetaImage says them; 0: the file does not say. */
    double spacing_mm[2];
} skg_picture_contents;

SKG_INIT(skg_picture_contents)

/** Looks at an image file.
 *
 *     path       .mha or .mhd: of two or three dimensions, any type of number, not compressed, one channel
 *                .tif, .tiff: grey, 8 to 64 bits, in strips, compressed or not
 *                .png: grey, 1 to 16 bits
 *     contents   in and out: prepared with skg_picture_contents_init
 *     errors     SKG_ERR_FILE; SKG_ERR_FORMAT if it is no such file, or is damaged; SKG_ERR_UNSUPPORTED for colours, tiles,
 *                compressed MetaImages and other extensions */
SKG_API skg_status skg_picture_contents_get(const char *path, skg_picture_contents *contents);

/** Reads a page of an image file as numbers: those of the file, without display curve or scale.
 *
 *     page     0 <= page < number of pages
 *     values   result: [rows][columns] of skg_picture_contents
 *     errors   as above; SKG_ERR_ARGUMENT (page); SKG_ERR_UNSUPPORTED also for a page of a TIFF that has another size than the first */
SKG_API skg_status skg_picture_load(const char *path, int64_t page, double *values);

/** Looks at an image file in memory; otherwise as skg_picture_contents_get.
 *
 *     name     its extension says the format, as that of a path does; messages have it
 *     bytes    [size] the file, which is only read, and no longer than the call lasts
 *     errors   as above; SKG_ERR_UNSUPPORTED also for a MetaImage whose values are in another file */
SKG_API skg_status skg_picture_contents_decode(const char *name, const void *bytes, int64_t size,
                                               skg_picture_contents *contents);

/** Reads a page of an image file in memory; otherwise as skg_picture_load. name, bytes: as of skg_picture_contents_decode
 *
 *     page     0 <= page < number of pages
 *     values   result: [rows][columns] */
SKG_API skg_status skg_picture_decode(const char *name, const void *bytes, int64_t size, int64_t page,
                                      double *values);

#ifdef __cplusplus
}
#endif
#endif
