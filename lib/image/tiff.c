/* TIFF: floats or doubles without conversion, one page for each channel. */
#include "core/maths.h"
#include "core/text.h"
#include "image/image.h"
#include "image/reasons.h"
#include "image/tiff_bytes.h"

#include <skiagraph/version.h>

#include <errno.h>
#include <string.h>
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

/* How libtiff opens it. */
static const char *mode_of(const skg_picture *picture) {
    const double bytes = (double)picture->columns * (double)picture->rows * (double)picture->channels *
                         (double)skg_element_bytes(picture->type);
    return bytes > classic_limit ? "w8" : "w";
}

/* Writes all pages and closes the TIFF. tiff: NULL: it could not be opened */
static skg_status write_and_close(TIFF *tiff, const skg_picture *picture, const char *path,
                                  const skg_tiff_reason *kept) {
    char *row = NULL;
    int written = 0;
    const skg_status status =
        skg_alloc(picture->columns, (size_t)skg_element_bytes(picture->type), "row of a TIFF file", &row);
    errno = 0;
    if (tiff && status == SKG_OK) written = write_pages(tiff, picture, row);
    if (tiff) TIFFClose(tiff);
    skg_free(&row);
    if (status != SKG_OK || (written && !kept->text[0])) return status;
    return skg_output_fail(path, errno, skg_tiff_said(kept));
}

skg_status skg_tiff_write(const skg_picture *picture, skg_output_file *file) {
    skg_tiff_reason kept = {""};
    TIFF *tiff = NULL;
    /* TIFFClose closes the descriptor that it was given. The stream keeps its own, which is synced later. */
    int descriptor = dup(fileno(file->stream));
    TIFFOpenOptions *options = skg_tiff_options(&kept);
    if (descriptor >= 0 && options) tiff = TIFFFdOpenExt(descriptor, file->path, mode_of(picture), options);
    if (options) TIFFOpenOptionsFree(options);
    if (!tiff && descriptor >= 0) close(descriptor);
    return write_and_close(tiff, picture, file->path, &kept);
}

skg_status skg_tiff_encode(const skg_picture *picture, const skg_image_target *target) {
    skg_tiff_reason kept = {""};
    skg_tiff_bytes file = {.name = target->name};
    TIFF *tiff = skg_tiff_open_bytes(&file, mode_of(picture), &kept);
    skg_status status = write_and_close(tiff, picture, target->name, &kept);
    if (file.status != SKG_OK) status = skg_fail(SKG_ERR_MEMORY, "%s: out of host memory", target->name);
    if (status == SKG_OK) status = skg_image_put(target, file.written, file.size);
    skg_free(&file.written);
    return status;
}
