/* Image files: TIFF, MetaImage and PNG. A file appears whole or not at all. */
#ifndef SKIAGRAPH_IMAGE_H
#define SKIAGRAPH_IMAGE_H

#include <skiagraph/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    SKG_DISPLAY_RADIOGRAPH = 0,  /* -ln(I/I0): dense is white */
    SKG_DISPLAY_TRANSMISSION = 1 /* I/I0: dense is dark */
};

/* An image to write. Prepare with skg_picture_init. */
typedef struct {
    int32_t size;
    int32_t type; /* SKG_TYPE_FLOAT32 or SKG_TYPE_FLOAT64: of data, and of .mha and .tif files */
    int64_t columns, rows, channels;
    const void *data;     /* [channel][row][column], dense */
    const char *name;     /* of the quantity, for the header: "energy"; NULL: "" */
    const char *unit;     /* "keV per pixel"; NULL: "" */
    const skg_view *view; /* geometry for the header; NULL: pixels of 1 mm, no place */
    int32_t display;      /* .png: SKG_DISPLAY_... */
    int32_t quantity; /* SKG_QUANTITY_ENERGY, ... : what data holds, so that a display curve can be formed */
    double
        flat_field; /* value of the open beam in data's unit (I0), for display curves; unused for transmission
                    and attenuation; 0 where data is shown as it is (path lengths) */
    double low, high; /* .png: shown from black to white; both 0: the image's own minimum and maximum */
    const char *const *channel_names; /* [channels]: in the place of name, for each channel; may be NULL */
} skg_picture;

SKG_API void skg_picture_init(skg_picture *picture);

/* Writes by extension: .png (16 bit grey, row 0 on top, first channel, display curve and range stated in a
 * text chunk), .tif or .tiff and .mha (float32 or float64, every channel). MetaImage carries spacing, origin
 * and direction of the detector; skewed steps cannot be such a direction and are refused
 * (SKG_ERR_UNSUPPORTED): use TIFF. Each TIFF page's description has its channel's name; a MetaImage with
 * channel_names has a field ChannelNames, "; " between them. Errors: SKG_ERR_ARGUMENT (unknown extension,
 * named with those known), SKG_ERR_OUTPUT. */
SKG_API skg_status skg_picture_write(const skg_picture *picture, const char *path);

/* Whether skg_picture_write could write there, to know it before a long computation: the extension is one of
 * those, and a file can be made (one is, for a moment, beside it). Errors as above. */
SKG_API skg_status skg_picture_check_path(const char *path);

/* The range that skg_picture_write would show when low = high = 0, so that a sequence can use one for all
 * frames. */
SKG_API skg_status skg_picture_range(const skg_picture *picture, double *low, double *high);

#ifdef __cplusplus
}
#endif
#endif
