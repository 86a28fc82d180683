/* Reads volumes from NIfTI files (nifti.nimh.nih.gov: nifti1.h and nifti2.h), of one file each, plain or by gzip. */
#include "core/text.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

enum { LONG_HEADER = 540, SHORT_HEADER = 348, DIMENSIONS = 8 };

/* Where the members of a header stand, and how many bytes its numbers have. */
typedef struct {
    int size, magic, dim, datatype, bits, spacing, offset, slope, shift, units, qform, sform, quaternion,
        place, rows;
    int dim_bytes, real_bytes, offset_bytes, code_bytes;
    char offset_kind;
} layout;

static const layout layouts[2] = {{.size = SHORT_HEADER,
                                   .magic = 344,
                                   .dim = 40,
                                   .datatype = 70,
                                   .bits = 72,
                                   .spacing = 76,
                                   .offset = 108,
                                   .slope = 112,
                                   .shift = 116,
                                   .units = 123,
                                   .qform = 252,
                                   .sform = 254,
                                   .quaternion = 256,
                                   .place = 268,
                                   .rows = 280,
                                   .dim_bytes = 2,
                                   .real_bytes = 4,
                                   .offset_bytes = 4,
                                   .code_bytes = 2,
                                   .offset_kind = 'f'},
                                  {.size = LONG_HEADER,
                                   .magic = 4,
                                   .dim = 16,
                                   .datatype = 12,
                                   .bits = 14,
                                   .spacing = 104,
                                   .offset = 168,
                                   .slope = 176,
                                   .shift = 184,
                                   .units = 500,
                                   .qform = 344,
                                   .sform = 348,
                                   .quaternion = 352,
                                   .place = 376,
                                   .rows = 400,
                                   .dim_bytes = 8,
                                   .real_bytes = 8,
                                   .offset_bytes = 8,
                                   .code_bytes = 4,
                                   .offset_kind = 'i'}};

typedef struct {
    const char *path;
    const layout *at;
    int swapped;
    unsigned char bytes[LONG_HEADER];
} header;

static double number(const header *h, int at, int bytes, char kind) {
    return skg_number_of_bytes(h->bytes + at, bytes, kind, h->swapped);
}
static double real(const header *h, int first, int index) {
    return number(h, first + index * h->at->real_bytes, h->at->real_bytes, 'f');
}

static skg_status read_header(FILE *stream, const skg_grid_file *file, header *h) {
    size_t got = 0;
    SKG_TRY(skg_grid_read_head(h->path, stream, file, LONG_HEADER, h->bytes, &got));
    for (int k = 0; k < 2 && !h->at && got >= (size_t)layouts[k].size; k++)
        for (int swapped = 0; swapped < 2; swapped++)
            if (skg_number_of_bytes(h->bytes, 4, 'i', swapped) == layouts[k].size)
                h->at = &layouts[k], h->swapped = swapped;
    if (!h->at)
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: is no NIfTI file: it begins with the size of no header of NIfTI-1 or NIfTI-2",
                        h->path);
    const unsigned char *magic = h->bytes + h->at->magic;
    if (magic[0] != 'n' || (magic[1] != '+' && magic[1] != 'i'))
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: lacks the mark of NIfTI (n+1, n+2), as a file of Analyze 7.5 does, whose axes are not known; convert it",
            h->path);
    if (magic[1] != '+')
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: its values are in a file of their own (.hdr and .img); write one file, .nii or .nii.gz",
            h->path);
    return SKG_OK;
}

static skg_status read_type(const header *h, skg_grid_file *file) {
    static const struct {
        int code, bytes;
        char kind;
    } types[] = {{2, 1, 'u'},   {4, 2, 'i'},   {8, 4, 'i'},   {16, 4, 'f'},   {64, 8, 'f'},
                 {256, 1, 'i'}, {512, 2, 'u'}, {768, 4, 'u'}, {1024, 8, 'i'}, {1280, 8, 'u'}};
    const int code = (int)number(h, h->at->datatype, 2, 'i'), bits = (int)number(h, h->at->bits, 2, 'i');
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        if (types[t].code == code) {
            file->bytes = types[t].bytes, file->kind = types[t].kind;
            if (bits != 0 && bits != 8 * types[t].bytes)
                return skg_fail(
                    SKG_ERR_FORMAT,
                    "%s: its header says %d bits a value and type %d, which has %d; correct one of them",
                    h->path, bits, code, 8 * types[t].bytes);
            return SKG_OK;
        }
    return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its type, %d, is none of a number", h->path, code);
}

static skg_status read_size(const header *h, skg_grid *grid) {
    double dim[DIMENSIONS];
    for (int k = 0; k < DIMENSIONS; k++)
        dim[k] = number(h, h->at->dim + k * h->at->dim_bytes, h->at->dim_bytes, 'i');
    int used = 3;
    for (int k = 4; k < DIMENSIONS && k <= dim[0]; k++)
        if (dim[k] > 1) used = k;
    if (!(dim[0] >= 3 && dim[0] < DIMENSIONS) || used > 3)
        return skg_fail(SKG_ERR_FORMAT, "%s: has %g dimensions; a volume has 3, of one number each", h->path,
                        used > 3 ? used : dim[0]);
    SKG_TRY(skg_picture_size_check(h->path, dim[1], dim[2], dim[3]));
    for (int k = 0; k < 3; k++) grid->size[k] = (int64_t)dim[k + 1];
    return SKG_OK;
}

/* The rotation of a unit quaternion whose real part is not given and not below 0; axes: [row][column], the last one turned round if
 * the file says so. */
static void rotate(const header *h, double axes[3][3]) {
    const double b = real(h, h->at->quaternion, 0), c = real(h, h->at->quaternion, 1);
    const double d = real(h, h->at->quaternion, 2), rest = 1 - (b * b + c * c + d * d);
    const double a = rest > 1e-7 ? sqrt(rest) : 0, scale = rest > 1e-7 ? 1 : 1 / sqrt(b * b + c * c + d * d);
    const double q[4] = {a, b * scale, c * scale, d * scale},
                 turned = real(h, h->at->spacing, 0) < 0 ? -1 : 1;
    const double r[3][3] = {{q[0] * q[0] + q[1] * q[1] - q[2] * q[2] - q[3] * q[3],
                             2 * (q[1] * q[2] - q[0] * q[3]), 2 * (q[1] * q[3] + q[0] * q[2])},
                            {2 * (q[1] * q[2] + q[0] * q[3]),
                             q[0] * q[0] + q[2] * q[2] - q[1] * q[1] - q[3] * q[3],
                             2 * (q[2] * q[3] - q[0] * q[1])},
                            {2 * (q[1] * q[3] - q[0] * q[2]), 2 * (q[2] * q[3] + q[0] * q[1]),
                             q[0] * q[0] + q[3] * q[3] - q[1] * q[1] - q[2] * q[2]}};
    for (int row = 0; row < 3; row++)
        for (int k = 0; k < 3; k++)
            axes[row][k] = r[row][k] * real(h, h->at->spacing, k + 1) * (k == 2 ? turned : 1);
}

/* Of the two ways in which a file says where its cells are, the matrix is taken if there is one. x and y of NIfTI point to the right
 * and to the front; ours to the left and back, as MetaImage's. */
static skg_status read_place(const header *h, skg_grid *grid) {
    static const double units[8] = {0, 1e3, 1, 1e-3, -1, -1, -1, -1}; /* not said, m, mm, um, others */
    const int code = h->at->code_bytes, has_matrix = number(h, h->at->sform, code, 'i') > 0;
    const int unit =
        h->at->size == LONG_HEADER ? (int)number(h, h->at->units, 4, 'i') : h->bytes[h->at->units];
    const double mm = units[unit & 7];
    double axes[3][3];
    if (!has_matrix && !(number(h, h->at->qform, code, 'i') > 0))
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: does not say where its axes point (qform_code and sform_code are 0); write it with one of them",
            h->path);
    if (mm < 0)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: its axes have a unit that is no length; write them in mm",
                        h->path);
    if (!has_matrix) rotate(h, axes);
    for (int row = 0; row < 3; row++) {
        const double sign = row < 2 ? -1 : 1;
        grid->unit_mm[row] = mm;
        for (int k = 0; k < 3; k++)
            grid->affine[4 * row + k] =
                sign * (has_matrix ? real(h, h->at->rows, 4 * row + k) : axes[row][k]);
        grid->affine[4 * row + 3] =
            sign * (has_matrix ? real(h, h->at->rows, 4 * row + 3) : real(h, h->at->place, row));
    }
    grid->affine[15] = 1;
    return SKG_OK;
}

/* Slope and intercept. A slope of 0 or NaN says that there is none. */
static skg_status read_scale(const header *h, skg_grid_file *file) {
    file->slope = real(h, h->at->slope, 0), file->shift = real(h, h->at->shift, 0);
    if (isnan(file->slope)) file->slope = 0;
    if (isfinite(file->slope) && (file->slope == 0 || isfinite(file->shift))) return SKG_OK;
    return skg_fail(
        SKG_ERR_FORMAT,
        "%s: its values are to be multiplied by %g and shifted by %g; correct scl_slope and scl_inter",
        h->path, file->slope, file->shift);
}

skg_status skg_nifti_read_grid(const char *path, skg_grid *grid) {
    header h = {.path = path};
    skg_grid_file file = {.bytes = 0};
    FILE *stream = NULL;
    skg_status status = SKG_OK;
    *grid = (skg_grid){.type = 0};
    SKG_TRY(skg_input_open(path, SKG_INPUT_LARGE, &stream, NULL));
    file.compressed = fgetc(stream) == 0x1f && fgetc(stream) == 0x8b;
    SKG_TRY_CLEANUP(read_header(stream, &file, &h));
    SKG_TRY_CLEANUP(read_type(&h, &file));
    SKG_TRY_CLEANUP(read_size(&h, grid));
    SKG_TRY_CLEANUP(read_place(&h, grid));
    file.swapped = h.swapped;
    SKG_TRY_CLEANUP(read_scale(&h, &file));
    const double first = number(&h, h.at->offset, h.at->offset_bytes, h.at->offset_kind);
    if (!(first >= h.at->size && first < 1 << 30)) {
        status = skg_fail(SKG_ERR_FORMAT, "%s: its values begin at byte %g, within the header or nowhere",
                          path, first);
        goto cleanup;
    }
    file.first = (int64_t)first;
    status = skg_grid_read_cells(path, stream, &file, grid);
cleanup:
    if (stream) fclose(stream);
    return status;
}
