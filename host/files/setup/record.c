/* Reads how projections are recorded: the keys Scan, GreyValues and Poses. */
#include "core/core.h"
#include "core/files.h"
#include "core/maths.h"
#include "core/text.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

skg_status skg_setup_read_rows(const skg_json_node *node, int64_t width, const char *example, int64_t *count,
                               double **rows) {
    SKG_TRY(skg_json_array(node, example, count));
    SKG_TRY(skg_alloc(*count * width, sizeof **rows, "table", rows));
    skg_status status = SKG_OK;
    for (int64_t i = 0; i < *count && status == SKG_OK; i++) {
        const skg_json_node row = skg_json_element(node, i);
        status = skg_json_numbers(&row, example, width, *rows + i * width);
    }
    if (status != SKG_OK) skg_free(rows);
    return status;
}

/* A number that is not negative. */
static skg_status read_number(const skg_json_object *object, const char *name, double *number) {
    const skg_json_node node = skg_json_member(object, name);
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_number(&node, number));
    return *number >= 0 ? SKG_OK : skg_json_fail(&node, SKG_ERR_FORMAT, "is %g; give 0 or more", *number);
}

static skg_status read_count(const skg_json_object *object, const char *name, int64_t least, int64_t *count) {
    const skg_json_node node = skg_json_member(object, name);
    return node.value ? skg_json_integer(&node, least, INT32_MAX, count) : SKG_OK;
}

static skg_status read_pairs(const skg_json_object *object, const char *name, int64_t *count,
                             double **pairs) {
    const skg_json_node node = skg_json_member(object, name);
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_setup_read_rows(&node, 2, "[[0, 100], [1, 200]]", count, pairs));
    for (int64_t i = 0; i < *count; i++)
        if (i > 0 && (*pairs)[2 * i] <= (*pairs)[2 * i - 2])
            return skg_json_fail(&node, SKG_ERR_FORMAT, "does not rise from row %" PRId64 " to the next",
                                 i - 1);
    return *count >= 2 ? SKG_OK : skg_json_fail(&node, SKG_ERR_FORMAT, "has fewer than two rows");
}

/* Element i of a raw image as a number. */
static float element_of(const unsigned char *bytes, int64_t size, int is_float, int is_signed, int is_big) {
    unsigned char ordered[8];
    uint64_t number = 0;
    for (int64_t b = 0; b < size; b++) ordered[b] = bytes[is_big ? size - 1 - b : b];
    for (int64_t b = 0; b < size; b++) number |= (uint64_t)ordered[b] << (8 * b);
    if (is_float && size == 4) {
        const uint32_t bits = (uint32_t)number;
        float value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    if (is_float) {
        double value;
        memcpy(&value, &number, sizeof value);
        return (float)value;
    }
    const int64_t half = (int64_t)1 << (8 * size - 1), value = (int64_t)number;
    return (float)(is_signed && value >= half ? value - 2 * half : value);
}

/* A raw image of the size of the detector. The caller frees it. */
static skg_status load_map(const char *path, int64_t pixels, int64_t format, int is_big, int64_t header,
                           float **map) {
    static const int64_t sizes[] = {1, 1, 2, 2, 4, 8};
    const int64_t size = sizes[format];
    unsigned char *bytes = NULL;
    skg_status status = SKG_OK;
    FILE *file = NULL;
    SKG_TRY(skg_input_open(path, SKG_INPUT_LARGE, &file, NULL));
    SKG_TRY_CLEANUP(skg_alloc(pixels, (size_t)size, "map of pixels", &bytes));
    SKG_TRY_CLEANUP(skg_alloc(pixels, sizeof **map, "map of pixels", map));
    if (fseek(file, (long)header, SEEK_SET) != 0 ||
        fread(bytes, (size_t)size, (size_t)pixels, file) != (size_t)pixels)
        status = skg_fail(SKG_ERR_FORMAT, "%s: is too short for %" PRId64 " pixels of %" PRId64 " bytes",
                          path, pixels, size);
    for (int64_t i = 0; i < pixels && status == SKG_OK; i++)
        (*map)[i] = element_of(bytes + i * size, size, format >= 4, format % 2 == 1, is_big);
cleanup:
    skg_free(&bytes);
    fclose(file);
    return status;
}

/* format: of the map if it does not say */
static skg_status read_map(skg_setup_reader *reader, const skg_json_node *node, int64_t format,
                           float **pixels) {
    static const char *const formats[] = {"uint8", "int8", "uint16", "int16", "float32", "float64"};
    static const char *const orders[] = {"little", "big"};
    const skg_view *view = &reader->setup->view;
    int64_t order = 0, header = 0;
    const char *name = NULL, *path = NULL;
    skg_json_object map;
    skg_json_node file;
    SKG_TRY(skg_json_read_object(node, &skg_keys_pixel_map, &map));
    SKG_TRY(skg_json_need(&map, "Path", "\"bad.raw\"", &file));
    const skg_json_node kind = skg_json_member(&map, "Format"), bytes = skg_json_member(&map, "ByteOrder");
    if (kind.value) SKG_TRY(skg_json_choice(&kind, "format of pixels", formats, 6, &format));
    if (bytes.value) SKG_TRY(skg_json_choice(&bytes, "order of bytes", orders, 2, &order));
    SKG_TRY(read_count(&map, "Header", 0, &header));
    SKG_TRY(skg_json_text(&file, &name));
    SKG_TRY(skg_setup_find_file(reader, name, &path));
    return skg_json_at(&file, load_map(path, view->columns * view->rows, format, order == 1, header, pixels));
}

/* A map under a name; none if there is no such key. */
static skg_status read_map_of(skg_setup_reader *reader, const skg_json_object *object, const char *name,
                              int64_t format, float **pixels) {
    const skg_json_node node = skg_json_member(object, name);
    return node.value ? read_map(reader, &node, format, pixels) : SKG_OK;
}

/* [[number, grey value], ...] of columns or rows of which every pixel is bad. */
static skg_status read_bad_lines(skg_setup_reader *reader, const skg_json_object *object, const char *name,
                                 int is_row, float **pixels) {
    const skg_view *view = &reader->setup->view;
    const skg_json_node node = skg_json_member(object, name);
    const int64_t lines = is_row ? view->rows : view->columns, across = is_row ? view->columns : view->rows;
    double *pairs = NULL;
    int64_t count = 0;
    skg_status status = SKG_OK;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_setup_read_rows(&node, 2, "[[3, 0], [17, 65535]], numbers and grey values", &count, &pairs));
    if (!*pixels) {
        status = skg_alloc(view->columns * view->rows, sizeof **pixels, "map of pixels", pixels);
        for (int64_t i = 0; status == SKG_OK && i < view->columns * view->rows; i++) (*pixels)[i] = -1;
    }
    for (int64_t k = 0; k < count && status == SKG_OK; k++) {
        const double line = pairs[2 * k], grey = pairs[2 * k + 1];
        if (!(line >= 0 && line < (double)lines && floor(line) >= line && grey >= 0))
            status = skg_json_fail(&node, SKG_ERR_FORMAT,
                                   "line %g with grey value %g; give a whole number from 0 to %" PRId64
                                   ", and 0 or more",
                                   line, grey, lines - 1);
        for (int64_t i = 0; i < across && status == SKG_OK; i++)
            (*pixels)[is_row ? (int64_t)line * across + i : i * lines + (int64_t)line] = (float)grey;
    }
    skg_free(&pairs);
    return status;
}

static skg_status read_maps(skg_setup_reader *reader, const skg_json_object *object, skg_grey_section *grey) {
    enum { INT16 = 3, FLOAT32 = 4 };
    SKG_TRY(read_map_of(reader, object, "BadPixels", INT16, &grey->bad_pixels));
    SKG_TRY(read_bad_lines(reader, object, "BadColumns", 0, &grey->bad_pixels));
    SKG_TRY(read_bad_lines(reader, object, "BadRows", 1, &grey->bad_pixels));
    SKG_TRY(read_map_of(reader, object, "Gain", FLOAT32, &grey->gain));
    SKG_TRY(read_map_of(reader, object, "Offset", FLOAT32, &grey->offset));
    grey->readout.bad_pixels = grey->bad_pixels;
    grey->readout.gain = grey->gain, grey->readout.offset = grey->offset;
    return SKG_OK;
}

/* Lag: [[share, frames], ...], and Ghosting: [[change, frames], ...]. A lag of one pixel checks them. */
static skg_status read_lag(const skg_json_object *object, skg_grey_section *grey) {
    const skg_json_node lag = skg_json_member(object, "Lag"), ghosting = skg_json_member(object, "Ghosting");
    skg_readout *r = &grey->readout;
    skg_lag *made = NULL;
    if (lag.value)
        SKG_TRY(skg_setup_read_rows(&lag, 2, "[[0.03, 1.5], [0.005, 40]], shares and frames", &r->lag_count,
                                    &grey->lag));
    if (ghosting.value)
        SKG_TRY(skg_setup_read_rows(&ghosting, 2, "[[-0.01, 200]], changes of the sensitivity and frames",
                                    &r->ghosting_count, &grey->ghosting));
    r->lag = grey->lag, r->ghosting = grey->ghosting;
    skg_status status = skg_json_at(&lag, skg_lag_create(1, r->lag_count, r->lag, &made));
    if (status == SKG_OK && r->ghosting_count > 0)
        status = skg_json_at(&ghosting, skg_lag_ghosting_set(made, 1, r->ghosting_count, r->ghosting));
    skg_lag_release(&made);
    return status;
}

skg_status skg_setup_read_grey_values(skg_setup_reader *reader, const skg_json_object *detector) {
    const skg_json_node node = skg_json_member(detector, "GreyValues");
    skg_grey_section *grey = &reader->setup->grey;
    skg_readout *r = &grey->readout;
    skg_json_object object;
    int64_t bits = 16;
    skg_readout_init(r);
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_read_object(&node, &skg_keys_grey_values, &object));
    grey->is_given = 1;
    SKG_TRY(read_number(&object, "Dark", &r->dark));
    SKG_TRY(read_number(&object, "Full", &r->full));
    SKG_TRY(read_number(&object, "PerJoule", &r->per_joule));
    SKG_TRY(read_number(&object, "SNR", &r->snr));
    SKG_TRY(read_pairs(&object, "Curve", &r->curve_count, &grey->curve));
    SKG_TRY(read_pairs(&object, "NoiseCurve", &r->noise_count, &grey->noise));
    r->curve = grey->curve, r->noise = grey->noise;
    SKG_TRY(read_count(&object, "Bits", 0, &bits));
    if (bits != 0 && (bits < 8 || bits > 16))
        return skg_json_fail(&node, SKG_ERR_FORMAT, "Bits is %" PRId64 "; give 8 to 16, or 0 for floats",
                             bits);
    r->bits = (int32_t)bits;
    SKG_TRY(read_count(&object, "Frames", 1, &r->frames));
    SKG_TRY(read_count(&object, "Seed", 0, &r->seed));
    SKG_TRY(read_number(&object, "Saturation", &r->saturation));
    SKG_TRY(read_lag(&object, grey));
    return read_maps(reader, &object, grey);
}

void skg_grey_section_free(skg_grey_section *section) {
    skg_free(&section->curve);
    skg_free(&section->noise);
    skg_free(&section->lag);
    skg_free(&section->ghosting);
    skg_free(&section->bad_pixels);
    skg_free(&section->gain);
    skg_free(&section->offset);
}

static skg_status read_fields(const skg_json_object *scan, const char *name, int64_t *count, int64_t *frames,
                              int32_t *noise) {
    const skg_json_node node = skg_json_member(scan, name);
    skg_json_object fields;
    *count = 1, *frames = 1, *noise = 1;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_read_object(&node, &skg_keys_fields, &fields));
    const skg_json_node noisy = skg_json_member(&fields, "Noise");
    SKG_TRY(read_count(&fields, "Number", 0, count));
    SKG_TRY(read_count(&fields, "Frames", 1, frames));
    return noisy.value ? skg_json_flag(&noisy, noise) : SKG_OK;
}

skg_status skg_setup_read_record(skg_setup_reader *reader, const skg_json_object *scan) {
    static const char *const layouts[] = {"CTSimU"};
    skg_scan_section *section = &reader->setup->scan;
    const skg_json_node intensity = skg_json_member(scan, "Intensity"),
                        layout = skg_json_member(scan, "Layout");
    int64_t choice = 0, projections = 0;
    SKG_TRY(read_fields(scan, "Flats", &section->flats, &section->flat_frames, &section->flat_noise));
    SKG_TRY(read_fields(scan, "Darks", &section->darks, &section->dark_frames, &section->dark_noise));
    section->fields = skg_json_member(scan, "Flats").value || skg_json_member(scan, "Darks").value;
    if (layout.value) SKG_TRY(skg_json_choice(&layout, "layout of files", layouts, 1, &choice));
    section->ctsimu = layout.value != NULL;
    if (!intensity.value) return SKG_OK;
    SKG_TRY(skg_scan_projection_count(section->scan, &projections));
    SKG_TRY(skg_alloc(projections, sizeof(double), "intensities", &section->intensities));
    SKG_TRY(skg_json_numbers(&intensity, "a number for each projection", projections, section->intensities));
    static const double ROUNDING = 1e-6; /* of numbers that were divided and printed */
    if (fabs(section->intensities[0] - 1) > ROUNDING)
        return skg_json_fail(
            &intensity, SKG_ERR_FORMAT,
            "begins with %g, but is over that of the first projection: the first number is 1; divide all "
            "of them by it",
            section->intensities[0]);
    return SKG_OK;
}

/* Puts the poses of one more part beside those of the others. */
static skg_status add_moving(skg_scan_section *section, int64_t projections, int64_t part,
                             const double *poses) {
    const int64_t had = section->moving_count, has = had + 1;
    double *all = NULL;
    SKG_TRY(skg_realloc(has, sizeof *section->moving, "moving parts", &section->moving));
    SKG_TRY(skg_alloc(projections * has * 16, sizeof *all, "poses", &all));
    for (int64_t k = 0; k < projections; k++) {
        double *to = all + k * has * 16;
        if (had > 0) memcpy(to, section->poses + k * had * 16, (size_t)had * 16 * sizeof *to);
        memcpy(to + had * 16, poses + k * 16, 16 * sizeof *to);
    }
    skg_free(&section->poses);
    section->poses = all;
    section->moving[had] = part;
    section->moving_count = has;
    return SKG_OK;
}

skg_status skg_setup_read_poses(skg_setup_reader *reader, const skg_json_node *node, const double *own,
                                int64_t part) {
    skg_scan_section *section = &reader->setup->scan;
    double *columns = NULL;
    int64_t count = 0, projections = 0;
    if (!section->scan) return skg_json_fail(node, SKG_ERR_FORMAT, "needs the key Scan");
    SKG_TRY(skg_scan_projection_count(section->scan, &projections));
    SKG_TRY(skg_setup_read_rows(node, 16, "16 numbers for each projection", &count, &columns));
    skg_status status = SKG_OK;
    if (count != projections)
        status = skg_json_fail(node, SKG_ERR_FORMAT, "has %" PRId64 " poses, but the scan has %" PRId64,
                               count, projections);
    for (int64_t k = 0; k < count; k++) {
        double rows[16];
        for (int i = 0; i < 16; i++) rows[i] = columns[16 * k + 4 * (i % 4) + i / 4];
        skg_pose_multiply(rows, own, columns + 16 * k);
    }
    if (status == SKG_OK) status = add_moving(section, projections, part, columns);
    /* The other verbs show the first projection. */
    if (status == SKG_OK)
        status = skg_json_at(node, skg_scene_part_pose_set(reader->setup->scene, part, columns));
    skg_free(&columns);
    return status;
}

void skg_scan_record_init_sized(void *record, int32_t size) {
    const skg_scan_record defaults = {.flats = 1, .flat_frames = 1, .darks = 1, .dark_frames = 1};
    skg_struct_init(record, size, &defaults, sizeof defaults);
}

skg_status skg_setup_record_get(const skg_setup *setup, skg_scan_record *record) {
    SKG_NEEDS(setup);
    const skg_scan_section *s = &setup->scan;
    const skg_scan_record ours = {.ctsimu = s->ctsimu,
                                  .grey_values = setup->grey.is_given,
                                  .fields = s->fields,
                                  .flats = s->flats,
                                  .flat_frames = s->flat_frames,
                                  .flat_noise = s->flat_noise,
                                  .darks = s->darks,
                                  .dark_frames = s->dark_frames,
                                  .dark_noise = s->dark_noise,
                                  .known = s->known,
                                  .intensities = s->intensities,
                                  .moving_count = s->moving_count,
                                  .moving_parts = s->moving,
                                  .moving_poses = s->poses};
    return skg_struct_write(&ours, sizeof ours, "skg_scan_record", record);
}

skg_status skg_setup_readout_get(const skg_setup *setup, skg_readout *readout) {
    SKG_NEEDS(setup);
    if (!setup->grey.is_given) return SKG_OK;
    return skg_struct_write(&setup->grey.readout, sizeof setup->grey.readout, "skg_readout", readout);
}
