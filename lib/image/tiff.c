/* TIFF: floats or doubles without conversion, one page for each channel. */
#include "core/maths.h"
#include "core/text.h"
#include "image/image.h"
#include "image/reasons.h"

#include <skiagraph/version.h>

#include <errno.h>
#include <string.h>
#include <tiffio.h>
#include <unistd.h>

/* Bytes of pixels beyond which a BigTIFF is written: the offsets of a classic TIFF have 32 bits, and its tags
 * take the rest of the 4.29e9. */
static const double classic_limit = 4.0e9;

static int set_tags(TIFF *tiff, const skg_picture *picture, int64_t channel) {
    skg_picture page = *picture;
    char description[SKG_DESCRIPTION_LENGTH];
    const int bits = (int)(8 * skg_element_bytes(picture->type));
    const int format = picture->type == SKG_TYPE_UINT16 ? SAMPLEFORMAT_UINT : SAMPLEFORMAT_IEEEFP;
    if (page.channel_names) page.name = page.channel_names[channel];
    skg_picture_describe(&page, description, sizeof description);
    int done = TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, (uint32_t)picture->columns) &&
               TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, (uint32_t)picture->rows) &&
               TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits) &&
               TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1) &&
               TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, format) &&
               TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) &&
               TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE) &&
               TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) &&
               TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0)) &&
               TIFFSetField(tiff, TIFFTAG_SOFTWARE, "skiagraph " SKG_VERSION) &&
               TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, description);
    if (done && picture->channels > 1)
        done = TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, FILETYPE_PAGE) &&
               TIFFSetField(tiff, TIFFTAG_PAGENUMBER, (int)channel, (int)picture->channels);
    if (done && picture->view) /* pixels per cm, from mm per pixel */
        done = TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_CENTIMETER) &&
               TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 10 / skg_length(picture->view->column_step)) &&
               TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 10 / skg_length(picture->view->row_step));
    return done;
}

/* row: a buffer for one row, because libtiff may change its data. */
static int write_pages(TIFF *tiff, const skg_picture *picture, void *row) {
    size_t row_bytes = (size_t)picture->columns * (size_t)skg_element_bytes(picture->type);
    for (int64_t channel = 0; channel < picture->channels; channel++) {
        if (!set_tags(tiff, picture, channel)) return 0;
        for (int64_t r = 0; r < picture->rows; r++) {
            size_t at = (size_t)(channel * picture->rows + r) * row_bytes;
            memcpy(row, (const char *)picture->data + at, row_bytes);
            if (TIFFWriteScanline(tiff, row, (uint32_t)r, 0) < 0) return 0;
        }
        if (!TIFFWriteDirectory(tiff)) return 0;
    }
    return 1;
}

skg_status skg_tiff_write(const skg_picture *picture, skg_output_file *file) {
    skg_tiff_reason kept = {""};
    TIFF *tiff = NULL;
    char *row = NULL;
    int written = 0;
    const int64_t element = skg_element_bytes(picture->type);
    double bytes =
        (double)picture->columns * (double)picture->rows * (double)picture->channels * (double)element;
    SKG_TRY(skg_alloc(picture->columns, (size_t)element, "row of a TIFF file", &row));
    /* TIFFClose closes the descriptor that it was given. The stream keeps its own, which is synced later. */
    int descriptor = dup(fileno(file->stream));
    TIFFOpenOptions *options = skg_tiff_options(&kept);
    if (descriptor >= 0 && options) {
        tiff = TIFFFdOpenExt(descriptor, file->path, bytes > classic_limit ? "w8" : "w", options);
    }
    if (options) TIFFOpenOptionsFree(options);
    errno = 0;
    if (tiff) {
        written = write_pages(tiff, picture, row);
        TIFFClose(tiff);
    } else if (descriptor >= 0) {
        close(descriptor);
    }
    skg_free(&row);
    if (written && !kept.text[0]) return SKG_OK;
    return skg_output_fail(file->path, errno, skg_tiff_said(&kept));
}
