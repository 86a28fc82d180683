/* Reads grey TIFFs. */
#include "image/image.h"
#include "image/reasons.h"
#include "image/tiff_bytes.h"

#include <string.h>

/* Size and format of the values of a page. */
typedef struct {
    uint32_t columns, rows;
    uint16_t bits, samples, format;
} page_of;

/* Refuses values and orientations other than the plain ones. Photometric numbers from 2 on are colours. */
static skg_status check_meaning(const char *path, uint16_t photometric, uint16_t orientation) {
    if (photometric > PHOTOMETRIC_MINISBLACK)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: has colours; write it grey", path);
    if (photometric == PHOTOMETRIC_MINISWHITE)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: its least value is white (PhotometricInterpretation 0), so that values fall where more arrives; write it "
            "with PhotometricInterpretation 1",
            path);
    if (orientation != ORIENTATION_TOPLEFT)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: its rows do not run from the upper left corner (Orientation %d); write them so (Orientation 1)",
            path, (int)orientation);
    return SKG_OK;
}

static skg_status look(const char *path, TIFF *tiff, page_of *page) {
    uint16_t samples = 1, format = SAMPLEFORMAT_UINT, bits = 1, photometric = PHOTOMETRIC_MINISBLACK,
             orientation = ORIENTATION_TOPLEFT;
    if (!TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &page->columns) ||
        !TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &page->rows))
        return skg_fail(SKG_ERR_FORMAT, "%s: has no image", path);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &orientation);
    page->bits = bits, page->samples = samples, page->format = format;
    SKG_TRY(skg_picture_size_check(path, page->columns, page->rows, 1));
    if (samples != 1) return skg_fail(SKG_ERR_UNSUPPORTED, "%s: has colours; write it grey", path);
    SKG_TRY(check_meaning(path, photometric, orientation));
    if (TIFFIsTiled(tiff)) return skg_fail(SKG_ERR_UNSUPPORTED, "%s: is tiled; write it in strips", path);
    const int whole = bits == 8 || bits == 16 || bits == 32 || bits == 64;
    const int is_float = format == SAMPLEFORMAT_IEEEFP, known = format == SAMPLEFORMAT_UINT ||
                                                                format == SAMPLEFORMAT_INT ||
                                                                format == SAMPLEFORMAT_VOID || is_float;
    if (!whole || !known || (is_float && bits < 32))
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s: has %d bits of sample format %d; write 8, 16, 32 or 64 bits", path, bits,
                        format);
    return SKG_OK;
}

/* Scan lines have the byte order of the host. */
static skg_status read_rows(const char *path, TIFF *tiff, const page_of *page, double *values) {
    const int bytes = page->bits / 8;
    const char kind = page->format == SAMPLEFORMAT_IEEEFP ? 'f'
                      : page->format == SAMPLEFORMAT_INT  ? 'i'
                                                          : 'u';
    unsigned char *row = NULL;
    const int64_t line = (int64_t)TIFFScanlineSize64(tiff), least = (int64_t)page->columns * bytes;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(line > least ? line : least, 1, "row of a TIFF file", &row));
    for (uint32_t r = 0; r < page->rows && status == SKG_OK; r++) {
        if (TIFFReadScanline(tiff, row, r, 0) < 0)
            status = skg_fail(SKG_ERR_FORMAT, "%s: row %u cannot be read", path, r);
        for (uint32_t c = 0; c < page->columns && status == SKG_OK; c++) {
            const double value = skg_number_of_bytes(row + (size_t)c * (size_t)bytes, bytes, kind, 0);
            values[(size_t)r * page->columns + c] = value;
        }
    }
    skg_free(&row);
    return status;
}

/* Callers have memory for pages as large as the first. */
static skg_status check_size(const char *path, TIFF *tiff, int64_t page, const page_of *one) {
    page_of first = {0};
    if (page == 0) return SKG_OK;
    if (!TIFFSetDirectory(tiff, 0) || !TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &first.columns) ||
        !TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &first.rows) || !TIFFSetDirectory(tiff, (tdir_t)page))
        return skg_fail(SKG_ERR_FORMAT, "%s: page 0 cannot be read", path);
    if (first.columns == one->columns && first.rows == one->rows) return SKG_OK;
    return skg_fail(SKG_ERR_UNSUPPORTED,
                    "%s: page %d has %u x %u pixels, page 0 has %u x %u; write pages of one size", path,
                    (int)page, one->columns, one->rows, first.columns, first.rows);
}

static skg_status read_page(const char *path, TIFF *tiff, int64_t page, skg_picture_contents *contents,
                            double *values) {
    const char *description = NULL;
    page_of one = {0};
    contents->pages = TIFFNumberOfDirectories(tiff);
    if (contents->pages < 1) return skg_fail(SKG_ERR_FORMAT, "%s: is damaged: it has no page", path);
    SKG_TRY(skg_picture_page_check(path, page, contents->pages));
    if (!TIFFSetDirectory(tiff, (tdir_t)page))
        return skg_fail(SKG_ERR_FORMAT, "%s: page %d cannot be read", path, (int)page);
    SKG_TRY(look(path, tiff, &one));
    SKG_TRY(check_size(path, tiff, page, &one));
    contents->columns = one.columns, contents->rows = one.rows;
    if (TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &description) && description)
        contents->quantity = skg_quantity_of_title(description);
    return values ? read_rows(path, tiff, &one, values) : SKG_OK;
}

/* Opens a file by its path. m: it is not mapped into memory, so that a file that shrinks is an error. */
static TIFF *open_path(const char *path, skg_tiff_reason *kept) {
    TIFFOpenOptions *options = skg_tiff_options(kept);
    if (!options) return NULL;
    TIFF *tiff = TIFFOpenExt(path, "rm", options);
    TIFFOpenOptionsFree(options);
    return tiff;
}

skg_status skg_tiff_read(const skg_image_source *source, int64_t page, skg_picture_contents *contents,
                         double *values) {
    skg_tiff_reason kept = {""};
    skg_tiff_bytes bytes = {.name = source->name, .given = source->bytes, .size = source->size};
    TIFF *tiff = source->bytes ? skg_tiff_open_bytes(&bytes, "rm", &kept) : open_path(source->name, &kept);
    if (!tiff) return skg_fail(SKG_ERR_FORMAT, "%s: is no TIFF: %s", source->name, skg_tiff_said(&kept));
    const skg_status status = read_page(source->name, tiff, page, contents, values);
    TIFFClose(tiff);
    return status;
}
