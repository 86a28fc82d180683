/* Blur and noise power of a detector: LSF, PSF, MTF and DQE, and the Depths of a scintillator. */
#include "core/files.h"
#include "core/maths.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <inttypes.h>

static const char lines_example[] = "[0.1, 0.8, 0.1]";
static const char rows_example[] = "[[0, 0.1, 0], [0.1, 0.6, 0.1], [0, 0.1, 0]]";

/* The number of samples is odd, so that there is a middle one. */
static skg_status check_odd(const skg_json_node *node, int64_t count) {
    if (count % 2 == 1) return SKG_OK;
    return skg_json_fail(node, SKG_ERR_FORMAT,
                         "has %" PRId64 " samples; give an odd number, so that there is a middle one", count);
}

static int is_list_of_lists(const skg_json_node *node) {
    const skg_json_node first = skg_json_element(node, 0);
    return json_is_array(first.value);
}

/* One list for both directions, or one along the rows and one along the columns. */
static skg_status read_lines(const skg_json_node *node, skg_setup_blur *blur) {
    skg_json_node along[2] = {*node, *node};
    int64_t counts[2] = {0, 0}, lists = 0;
    SKG_TRY(skg_json_array(node, lines_example, &lists));
    if (is_list_of_lists(node)) {
        if (lists != 2)
            return skg_json_fail(node, SKG_ERR_FORMAT,
                                 "has %" PRId64
                                 " lists; give one along the rows and one along the columns, or one for both",
                                 lists);
        for (int64_t k = 0; k < 2; k++) along[k] = skg_json_element(node, k);
    }
    for (int k = 0; k < 2; k++) {
        SKG_TRY(skg_json_array(&along[k], lines_example, &counts[k]));
        SKG_TRY(check_odd(&along[k], counts[k]));
    }
    SKG_TRY(skg_alloc(counts[0] + counts[1], sizeof(double), "LSF", &blur->samples));
    SKG_TRY(skg_json_numbers(&along[0], lines_example, counts[0], blur->samples));
    SKG_TRY(skg_json_numbers(&along[1], lines_example, counts[1], blur->samples + counts[0]));
    blur->shape.columns = counts[0];
    blur->shape.rows = counts[1];
    blur->shape.along_row = blur->samples;
    blur->shape.along_column = blur->samples + counts[0];
    return SKG_OK;
}

/* A text file of numbers, one list for both directions. */
static skg_status read_lines_file(skg_setup_reader *reader, const skg_json_node *node, skg_setup_blur *blur) {
    const char *path = NULL;
    int64_t count = 0;
    SKG_TRY(skg_setup_find_file(reader, json_string_value(node->value), &path));
    skg_status status = skg_read_list(path, &count, &blur->samples);
    SKG_TRY(skg_json_at(node, status));
    SKG_TRY(check_odd(node, count));
    blur->shape.columns = blur->shape.rows = count;
    blur->shape.along_row = blur->shape.along_column = blur->samples;
    return SKG_OK;
}

/* Rows of the same length. */
static skg_status read_points(const skg_json_node *node, skg_setup_blur *blur) {
    int64_t rows = 0, columns = 0;
    SKG_TRY(skg_json_array(node, rows_example, &rows));
    SKG_TRY(check_odd(node, rows));
    skg_json_node row = skg_json_element(node, 0);
    SKG_TRY(skg_json_array(&row, "[0.1, 0.6, 0.1]", &columns));
    SKG_TRY(check_odd(&row, columns));
    SKG_TRY(skg_alloc(rows * columns, sizeof(double), "PSF", &blur->samples));
    for (int64_t j = 0; j < rows; j++) {
        row = skg_json_element(node, j);
        SKG_TRY(skg_json_numbers(&row, "rows of the same length", columns, blur->samples + j * columns));
    }
    blur->shape.columns = columns;
    blur->shape.rows = rows;
    blur->shape.point = blur->samples;
    return SKG_OK;
}

/* Rows of frequency and MTF, for both directions of the pixels. */
static skg_status read_transfer(const skg_setup_reader *reader, const skg_json_node *node,
                                skg_setup_blur *blur) {
    const skg_view *view = &reader->setup->view;
    const double pixel_mm[2] = {skg_length(view->column_step), skg_length(view->row_step)};
    double *rows = NULL, *columns = NULL;
    int64_t count = 0, samples[2] = {0, 0};
    skg_status status = SKG_OK;
    SKG_TRY(skg_setup_read_rows(node, 2, "[[0, 1], [2.5, 0.4]], in line pairs per mm", &count, &rows));
    SKG_TRY_CLEANUP(skg_alloc(2 * count, sizeof *columns, "MTF", &columns));
    SKG_TRY_CLEANUP(skg_alloc(2 * SKG_LINE_SAMPLES_MAX, sizeof(double), "MTF", &blur->samples));
    for (int64_t i = 0; i < count; i++) columns[i] = rows[2 * i], columns[count + i] = rows[2 * i + 1];
    for (int d = 0; d < 2; d++) {
        status = skg_line_spread_get(count, columns, columns + count, pixel_mm[d],
                                     blur->samples + d * SKG_LINE_SAMPLES_MAX, &samples[d]);
        SKG_TRY_CLEANUP(skg_json_at(node, status));
    }
    blur->shape.columns = samples[0], blur->shape.rows = samples[1];
    blur->shape.pixel_mm[0] = pixel_mm[0], blur->shape.pixel_mm[1] = pixel_mm[1];
    blur->shape.along_row = blur->samples, blur->shape.along_column = blur->samples + SKG_LINE_SAMPLES_MAX;
cleanup:
    skg_free(&rows);
    skg_free(&columns);
    return status;
}

/* LSF, PSF or MTF of an object; columns stay 0 without any of them. */
static skg_status read_any(skg_setup_reader *reader, const skg_json_object *object, skg_setup_blur *blur) {
    const skg_json_node lines = skg_json_member(object, "LSF"), points = skg_json_member(object, "PSF");
    const skg_json_node transfer = skg_json_member(object, "MTF");
    skg_detector_blur_init(&blur->shape);
    if ((lines.value != NULL) + (points.value != NULL) + (transfer.value != NULL) > 1)
        return skg_json_fail(points.value ? &points : &transfer, SKG_ERR_FORMAT,
                             "give one of LSF, PSF and MTF, not both");
    if (json_is_string(lines.value)) return read_lines_file(reader, &lines, blur);
    if (lines.value) return read_lines(&lines, blur);
    if (points.value) return read_points(&points, blur);
    return transfer.value ? read_transfer(reader, &transfer, blur) : SKG_OK;
}

/* [[0, 0.7], [2.5, 0.3]]: line pairs per mm and DQE. */
static skg_status read_dqe(skg_setup_reader *reader, const skg_json_node *node) {
    skg_setup *setup = reader->setup;
    double *rows = NULL;
    int64_t count = 0;
    skg_dqe_init(&setup->dqe);
    if (!node->value) return SKG_OK;
    SKG_TRY(skg_setup_read_rows(node, 2, "[[0, 0.7], [2.5, 0.3]], in line pairs per mm", &count, &rows));
    const skg_status status = skg_alloc(2 * count, sizeof *rows, "DQE", &setup->dqe_columns);
    for (int64_t i = 0; i < count && status == SKG_OK; i++)
        setup->dqe_columns[i] = rows[2 * i], setup->dqe_columns[count + i] = rows[2 * i + 1];
    skg_free(&rows);
    setup->dqe.count = count;
    setup->dqe.per_mm = setup->dqe_columns, setup->dqe.dqe = setup->dqe_columns + count;
    return status;
}

skg_status skg_setup_read_blur(skg_setup_reader *reader, const skg_json_object *detector) {
    const skg_json_node dqe = skg_json_member(detector, "DQE");
    SKG_TRY(read_any(reader, detector, &reader->setup->blur));
    return read_dqe(reader, &dqe);
}

skg_status skg_setup_read_depths(skg_setup_reader *reader, const skg_json_node *node) {
    skg_setup *setup = reader->setup;
    int64_t count = 0;
    skg_depth_blur_init(&setup->depths);
    if (!node->value) return SKG_OK;
    SKG_TRY(
        skg_json_array(node, "[{\"To\": 0.5, \"LSF\": [1]}, {\"To\": 1, \"LSF\": [0.1, 0.8, 0.1]}]", &count));
    if (count < 1 || count > SKG_DEPTHS_MAX)
        return skg_json_fail(node, SKG_ERR_FORMAT, "has %" PRId64 " depths; give 1 to %d", count,
                             (int)SKG_DEPTHS_MAX);
    for (int64_t d = 0; d < count; d++) {
        const skg_json_node element = skg_json_element(node, d);
        skg_json_object object;
        skg_json_node to;
        SKG_TRY(skg_json_read_object(&element, &skg_keys_depth, &object));
        SKG_TRY(skg_json_need(&object, "To", "0.5", &to));
        SKG_TRY(skg_json_number(&to, &setup->depth_to[d]));
        SKG_TRY(read_any(reader, &object, &setup->depth_blurs[d]));
        if (setup->depth_blurs[d].shape.columns == 0)
            return skg_json_fail(&element, SKG_ERR_FORMAT, "has no blur; give LSF, PSF or MTF");
        setup->depth_shapes[d] = setup->depth_blurs[d].shape;
    }
    setup->depths.count = count;
    setup->depths.to = setup->depth_to;
    setup->depths.blur = setup->depth_shapes;
    return SKG_OK;
}

void skg_setup_blur_free(skg_setup *setup) {
    skg_free(&setup->blur.samples);
    for (int d = 0; d < SKG_DEPTHS_MAX; d++) skg_free(&setup->depth_blurs[d].samples);
    skg_free(&setup->dqe_columns);
}
