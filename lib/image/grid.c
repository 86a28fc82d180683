/* The cells of a grid in a file: raw or compressed by zlib, of any type of number. */
#include "image/image.h"

#include <string.h>
#include <zlib.h>

/* Reader of the file's values from front to back. */
typedef struct {
    const char *path;
    FILE *stream;
    int compressed;
    int code;   /* of the expansion: Z_OK while it goes on, Z_STREAM_END behind the checksum */
    int behind; /* 1: something else stands behind that */
    z_stream inflating;
    unsigned char buffer[1 << 16];
} source;

static skg_status fail_short(const source *s, int64_t slice, int64_t slices) {
    if (s->compressed && s->code != Z_OK && s->code != Z_STREAM_END)
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: what is compressed is damaged in slice %lld of %lld; take another copy", s->path,
                        (long long)slice, (long long)slices);
    return skg_fail(SKG_ERR_FORMAT, "%s: ends in slice %lld of %lld; is it the whole file?", s->path,
                    (long long)slice, (long long)slices);
}

static skg_status open_source(source *s, const skg_grid_file *file) {
    s->compressed = file->compressed;
    if (!s->compressed) return SKG_OK;
    /* 15 bits of window, and 32: the header of gzip or of zlib */
    if (inflateInit2(&s->inflating, 15 + 32) != Z_OK)
        return skg_fail(SKG_ERR_MEMORY, "%s: no memory to expand it", s->path);
    return SKG_OK;
}

static void close_source(source *s) {
    if (s->compressed) inflateEnd(&s->inflating);
}

static int is_readable(const source *s) {
    return s->code == Z_OK || s->code == Z_STREAM_END;
}

/* Fills the buffer if it is empty. Returns 0 at the end of the file. */
static int fill_buffer(source *s) {
    z_stream *z = &s->inflating;
    if (z->avail_in > 0) return 1;
    z->next_in = s->buffer;
    z->avail_in = (uInt)fread(s->buffer, 1, sizeof s->buffer, s->stream);
    return z->avail_in > 0;
}

/* Goes on behind the end of a member of gzip, of which a file may have several; zeros behind the last one fill a block. */
static void begin_member(source *s) {
    z_stream *z = &s->inflating;
    while (fill_buffer(s) && *z->next_in == 0) z->next_in++, z->avail_in--;
    if (z->avail_in == 0) return;
    s->behind = *z->next_in != 0x1f;
    s->code = s->behind ? Z_DATA_ERROR : inflateReset(z);
}

/* Reads so many bytes. Returns how many there were. */
static size_t read_bytes(source *s, void *to, size_t count) {
    if (!s->compressed) return fread(to, 1, count, s->stream);
    z_stream *z = &s->inflating;
    size_t done = 0;
    while (done < count && is_readable(s) && fill_buffer(s)) {
        const size_t left = count - done;
        if (s->code == Z_STREAM_END) begin_member(s);
        if (s->code != Z_OK) continue;
        z->next_out = (unsigned char *)to + done;
        z->avail_out = left < 1u << 30 ? (uInt)left : 1u << 30;
        const uInt room = z->avail_out;
        s->code = inflate(z, Z_NO_FLUSH);
        done += room - z->avail_out;
    }
    return done;
}

/* Nothing may stand behind the cells, and what is compressed ends with a checksum. */
static skg_status check_end(source *s, const skg_grid *grid) {
    unsigned char more;
    if (read_bytes(s, &more, 1) == 1)
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: holds more than the %lld x %lld x %lld cells of its header; correct one of them",
                        s->path, (long long)grid->size[0], (long long)grid->size[1],
                        (long long)grid->size[2]);
    if (!s->compressed || s->code == Z_STREAM_END) return SKG_OK;
    if (s->code == Z_OK)
        return skg_fail(SKG_ERR_FORMAT, "%s: ends before the checksum of its values; is it the whole file?",
                        s->path);
    return skg_fail(SKG_ERR_FORMAT,
                    s->behind ? "%s: has bytes behind its compressed values; write the file anew"
                              : "%s: its values do not agree with their checksum; take another copy",
                    s->path);
}

static int is_scaled(const skg_grid_file *file) {
    return file->slope != 0 && !(file->slope == 1 && file->shift == 0);
}

/* Passes over what stands before the cells. */
static skg_status pass_over(source *s, int64_t bytes) {
    unsigned char none[4096];
    for (size_t some; bytes > 0; bytes -= (int64_t)some) {
        some = bytes < (int64_t)sizeof none ? (size_t)bytes : sizeof none;
        if (read_bytes(s, none, some) != some)
            return skg_fail(SKG_ERR_FORMAT, "%s: ends before its values", s->path);
    }
    return SKG_OK;
}

/* The type in which the cells of a file are kept. */
static int32_t cell_type(const skg_grid_file *file) {
    if (is_scaled(file)) return file->bytes <= 2 ? SKG_VOLUME_FLOAT32 : SKG_VOLUME_FLOAT64;
    if (file->kind == 'f') return file->bytes == 4 ? SKG_VOLUME_FLOAT32 : SKG_VOLUME_FLOAT64;
    if (file->bytes == 1) return SKG_VOLUME_INT16;
    if (file->bytes == 2) return file->kind == 'u' ? SKG_VOLUME_UINT16 : SKG_VOLUME_INT16;
    return SKG_VOLUME_FLOAT64;
}

static void take_slice(const unsigned char *slice, const skg_grid_file *file, int64_t first, int64_t count,
                       skg_grid *grid) {
    for (int64_t k = 0; k < count; k++) {
        const double number =
            skg_number_of_bytes(slice + k * file->bytes, file->bytes, file->kind, file->swapped);
        const double value = is_scaled(file) ? number * file->slope + file->shift : number;
        const int64_t at = first + k;
        if (grid->type == SKG_VOLUME_INT16) ((int16_t *)grid->cells)[at] = (int16_t)value;
        if (grid->type == SKG_VOLUME_UINT16) ((uint16_t *)grid->cells)[at] = (uint16_t)value;
        if (grid->type == SKG_VOLUME_FLOAT32) ((float *)grid->cells)[at] = (float)value;
        if (grid->type == SKG_VOLUME_FLOAT64) ((double *)grid->cells)[at] = value;
    }
}

skg_status skg_grid_read_head(const char *path, FILE *stream, const skg_grid_file *file, size_t most,
                              void *bytes, size_t *count) {
    source *s = NULL;
    rewind(stream);
    SKG_TRY(skg_alloc(1, sizeof *s, "volume", &s));
    s->path = path, s->stream = stream;
    const skg_status status = open_source(s, file);
    if (status == SKG_OK) {
        *count = read_bytes(s, bytes, most);
        close_source(s);
    }
    skg_free(&s);
    rewind(stream);
    return status;
}

skg_status skg_grid_read_cells(const char *path, FILE *stream, const skg_grid_file *file, skg_grid *grid) {
    static const size_t sizes[] = {sizeof(int16_t), sizeof(uint16_t), sizeof(float), sizeof(double)};
    const int64_t plane = grid->size[0] * grid->size[1];
    unsigned char *slice = NULL;
    source *s = NULL;
    skg_status status = SKG_OK;
    grid->type = cell_type(file);
    SKG_TRY_CLEANUP(skg_alloc(1, sizeof *s, "volume", &s));
    s->path = path, s->stream = stream;
    SKG_TRY_CLEANUP(open_source(s, file));
    SKG_TRY_CLEANUP(pass_over(s, file->first));
    SKG_TRY_CLEANUP(skg_alloc(plane * grid->size[2], sizes[grid->type], "cells of a volume", &grid->cells));
    SKG_TRY_CLEANUP(skg_alloc(plane, (size_t)file->bytes, "slice of a volume", &slice));
    for (int64_t z = 0; z < grid->size[2] && status == SKG_OK; z++) {
        if (read_bytes(s, slice, (size_t)(plane * file->bytes)) != (size_t)(plane * file->bytes))
            status = fail_short(s, z, grid->size[2]);
        else
            take_slice(slice, file, z * plane, plane, grid);
    }
    if (status == SKG_OK) status = check_end(s, grid);
cleanup:
    if (s) close_source(s);
    skg_free(&s);
    skg_free(&slice);
    if (status != SKG_OK) skg_free(&grid->cells);
    return status;
}
