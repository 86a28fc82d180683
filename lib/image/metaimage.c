/* MetaImage (.mha): a text header and the values, in one file. Format as ITK's MetaIO documents it. */
#include "core/maths.h"
#include "core/text.h"
#include "image/image.h"

#include <skiagraph/version.h>

#include <math.h>
#include <string.h>

/* The largest cosine between the steps that counts as a right angle: the far corner of a detector of 32768 pixels is
 * then off by a thirtieth of a pixel. */
static const double max_skew = 1e-6;

skg_status skg_metaimage_check(const skg_picture *picture, const char *path) {
    const skg_view *view = picture->view;
    if (!view) return SKG_OK;
    const double *u = view->column_step, *v = view->row_step;
    double cosine = skg_dot(u, v) / sqrt(skg_dot(u, u) * skg_dot(v, v));
    if (fabs(cosine) <= max_skew) return SKG_OK;
    return skg_fail(SKG_ERR_UNSUPPORTED,
                    "%s: the detector's columns and rows meet at %.4g degrees, and a MetaImage can only say "
                    "90; write .tif instead",
                    path, acos(cosine) * 180 / SKG_PI);
}

/* The detector is a slice of a volume, one layer thick. The header has the spacing, the direction of each axis in a
 * row of its own, and the centre of pixel (0, 0). */
static void write_place(const skg_view *view, FILE *stream) {
    double axes[9], spacing[3], first[3];
    char text[320];
    spacing[0] = skg_length(view->column_step);
    spacing[1] = skg_length(view->row_step);
    spacing[2] = 1;
    for (int k = 0; k < 3; k++) {
        axes[k] = view->column_step[k] / spacing[0];
        axes[3 + k] = view->row_step[k] / spacing[1];
        first[k] = view->centre[k] - (double)(view->columns - 1) / 2 * view->column_step[k] -
                   (double)(view->rows - 1) / 2 * view->row_step[k];
    }
    skg_cross(axes, axes + 3, axes + 6);
    skg_picture_numbers(axes, 9, text, sizeof text);
    fprintf(stream, "TransformMatrix = %s\n", text);
    skg_picture_numbers(first, 3, text, sizeof text);
    fprintf(stream, "Offset = %s\nCenterOfRotation = 0 0 0\n", text);
    skg_picture_numbers(spacing, 3, text, sizeof text);
    fprintf(stream, "ElementSpacing = %s\n", text);
}

/* Values are written in the byte order of the host, which the header names. */
static void write_header(const skg_picture *picture, FILE *stream) {
    char title[200]; /* readers keep comments of up to 255 characters */
    const skg_view *view = picture->view;
    skg_picture_title(picture, title, sizeof title);
    fprintf(stream,
            "ObjectType = Image\nNDims = %d\nComment = %s; skiagraph " SKG_VERSION
            "\nBinaryData = True\nBinaryDataByteOrderMSB = %s\n"
            "CompressedData = False\n",
            view ? 3 : 2, title, skg_host_is_big_endian() ? "True" : "False");
    if (view)
        write_place(view, stream);
    else
        fprintf(stream, "ElementSpacing = 1 1\n");
    fprintf(stream, "DimSize = %lld %lld%s\n", (long long)picture->columns, (long long)picture->rows,
            view ? " 1" : "");
    if (picture->channels > 1)
        fprintf(stream, "ElementNumberOfChannels = %lld\n", (long long)picture->channels);
    if (picture->channels > 1 && picture->channel_names) { /* readers keep fields that they do not know */
        fprintf(stream, "ChannelNames = ");
        for (int64_t c = 0; c < picture->channels; c++)
            fprintf(stream, "%s%s", c > 0 ? "; " : "", picture->channel_names[c]);
        fputc('\n', stream);
    }
    fprintf(stream, "ElementType = %s\nElementDataFile = LOCAL\n",
            picture->type == SKG_TYPE_FLOAT64  ? "MET_DOUBLE"
            : picture->type == SKG_TYPE_UINT16 ? "MET_USHORT"
                                               : "MET_FLOAT");
}

/* Collects one row. MetaImage has the channels of a pixel side by side. */
static void gather(const skg_picture *picture, int64_t row, char *to) {
    size_t element = (size_t)skg_element_bytes(picture->type);
    for (int64_t c = 0; c < picture->columns; c++)
        for (int64_t channel = 0; channel < picture->channels; channel++) {
            int64_t at = (channel * picture->rows + row) * picture->columns + c;
            memcpy(to, (const char *)picture->data + (size_t)at * element, element);
            to += element;
        }
}

/* Failures to write are found by skg_output_commit. */
skg_status skg_metaimage_write(const skg_picture *picture, skg_output_file *file) {
    char *row = NULL;
    size_t element = (size_t)skg_element_bytes(picture->type);
    int64_t elements = picture->columns * picture->channels;
    SKG_TRY(skg_alloc(elements, element, "row of a MetaImage", &row));
    write_header(picture, file->stream);
    for (int64_t r = 0; r < picture->rows; r++) {
        gather(picture, r, row);
        if (fwrite(row, element, (size_t)elements, file->stream) != (size_t)elements) break;
    }
    skg_free(&row);
    return SKG_OK;
}
