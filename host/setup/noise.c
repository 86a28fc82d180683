/* What the detector does to an image: LSF, PSF and Noise. */
#include "core/columns.h"
#include "core/units.h"
#include "setup/sections.h"

#include <inttypes.h>

static const skg_json_key noise_keys[] = {
    {"Quantum", NULL, SKG_KEY_READ}, {"Electronic", NULL, SKG_KEY_READ}, {"Step", NULL, SKG_KEY_READ},
    {"Swank", NULL, SKG_KEY_READ},   {"Seed", NULL, SKG_KEY_READ},
};

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
static skg_status read_lines(skg_setup *setup, const skg_json_node *node) {
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
    SKG_TRY(skg_alloc(counts[0] + counts[1], sizeof(double), "LSF", &setup->blur_samples));
    SKG_TRY(skg_json_numbers(&along[0], lines_example, counts[0], setup->blur_samples));
    SKG_TRY(skg_json_numbers(&along[1], lines_example, counts[1], setup->blur_samples + counts[0]));
    setup->blur.columns = counts[0];
    setup->blur.rows = counts[1];
    setup->blur.along_row = setup->blur_samples;
    setup->blur.along_column = setup->blur_samples + counts[0];
    return SKG_OK;
}

/* A text file of numbers, one list for both directions. */
static skg_status read_lines_file(skg_setup_reader *reader, const skg_json_node *node) {
    skg_setup *setup = reader->setup;
    const char *path = NULL;
    int64_t count = 0;
    SKG_TRY(skg_setup_find_file(reader, json_string_value(node->value), &path));
    skg_status status = skg_read_list(path, &count, &setup->blur_samples);
    SKG_TRY(skg_json_at(node, status));
    SKG_TRY(check_odd(node, count));
    setup->blur.columns = setup->blur.rows = count;
    setup->blur.along_row = setup->blur.along_column = setup->blur_samples;
    return SKG_OK;
}

/* Rows of the same length. */
static skg_status read_points(skg_setup *setup, const skg_json_node *node) {
    int64_t rows = 0, columns = 0;
    SKG_TRY(skg_json_array(node, rows_example, &rows));
    SKG_TRY(check_odd(node, rows));
    skg_json_node row = skg_json_element(node, 0);
    SKG_TRY(skg_json_array(&row, "[0.1, 0.6, 0.1]", &columns));
    SKG_TRY(check_odd(&row, columns));
    SKG_TRY(skg_alloc(rows * columns, sizeof(double), "PSF", &setup->blur_samples));
    for (int64_t j = 0; j < rows; j++) {
        row = skg_json_element(node, j);
        SKG_TRY(
            skg_json_numbers(&row, "rows of the same length", columns, setup->blur_samples + j * columns));
    }
    setup->blur.columns = columns;
    setup->blur.rows = rows;
    setup->blur.point = setup->blur_samples;
    return SKG_OK;
}

skg_status skg_setup_read_blur(skg_setup_reader *reader, const skg_json_object *detector) {
    skg_json_node lines = skg_json_member(detector, "LSF"), points = skg_json_member(detector, "PSF");
    skg_detector_blur_init(&reader->setup->blur);
    if (lines.value && points.value)
        return skg_json_fail(&points, SKG_ERR_FORMAT, "give either LSF or PSF, not both");
    if (json_is_string(lines.value)) return read_lines_file(reader, &lines);
    if (lines.value) return read_lines(reader->setup, &lines);
    return points.value ? read_points(reader->setup, &points) : SKG_OK;
}

/* An energy with its unit; 0 where it is absent. */
static skg_status read_energy(const skg_json_object *noise, const char *name, double *kev) {
    skg_json_node node = skg_json_member(noise, name);
    const char *unit = NULL;
    int64_t count = 0;
    double per_unit = 0;
    *kev = 0;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_array(&node, "[2.5, \"keV\"]", &count));
    if (count != 2)
        return skg_json_fail(&node, SKG_ERR_FORMAT, "has %" PRId64 " elements; write [2.5, \"keV\"]", count);
    skg_json_node number = skg_json_element(&node, 0), unit_node = skg_json_element(&node, 1);
    SKG_TRY(skg_json_number(&number, kev));
    if (!(*kev >= 0))
        return skg_json_fail(&number, SKG_ERR_FORMAT, "is %g; give an energy of 0 or more", *kev);
    SKG_TRY(skg_json_text(&unit_node, &unit));
    skg_status status = skg_unit_of_energy(unit, &per_unit);
    SKG_TRY(skg_json_at(&unit_node, status));
    *kev *= per_unit;
    return SKG_OK;
}

/* Noise is true, false, or an object. */
skg_status skg_setup_read_noise(skg_setup_reader *reader, const skg_json_node *node) {
    skg_setup_noise *noise = &reader->setup->noise;
    skg_json_object object;
    noise->swank = 1;
    if (!node->value) return SKG_OK;
    if (json_is_boolean(node->value)) return skg_json_flag(node, &noise->quantum);
    SKG_TRY(skg_json_read_object(node, noise_keys, sizeof noise_keys / sizeof *noise_keys, &object));
    skg_json_node quantum = skg_json_member(&object, "Quantum"), swank = skg_json_member(&object, "Swank"),
                  seed = skg_json_member(&object, "Seed");
    noise->quantum = 1;
    if (quantum.value) SKG_TRY(skg_json_flag(&quantum, &noise->quantum));
    if (swank.value) SKG_TRY(skg_json_number(&swank, &noise->swank));
    if (!(noise->swank > 0 && noise->swank <= 1))
        return skg_json_fail(&swank, SKG_ERR_FORMAT, "is %g; a Swank factor is above 0 and at most 1",
                             noise->swank);
    if (seed.value) SKG_TRY(skg_json_integer(&seed, INT32_MIN, INT32_MAX, &noise->seed));
    SKG_TRY(read_energy(&object, "Electronic", &noise->electronic_kev));
    return read_energy(&object, "Step", &noise->step_kev);
}
