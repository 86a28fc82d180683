/* Shape of a source: a point, a parallel beam, or a focal spot. */
#include "setup/keys.h"
#include "setup/sections.h"

#include <math.h>

/* Names of focal spots in the order of SKG_SPOT_LINE and so on, and the number of sizes of each. */
static const char *const spot_names[] = {"Line",   "Rectangle", "Cube",     "Disc",
                                         "Sphere", "Gaussian",  "FocalSpot"};
static const char *const spot_examples[] = {
    "[\"Line\", 1, \"mm\"]",        "[\"Rectangle\", 1, 0.6, \"mm\"]", "[\"Cube\", 5, \"mm\"]",
    "[\"Disc\", 1, \"mm\"]",        "[\"Sphere\", 1, \"mm\"]",         "[\"Gaussian\", 0.6, 0.6, \"mm\"]",
    "[\"FocalSpot\", 1, \"mm\", 4]"};
static const int spot_sizes[] = {1, 2, 1, 1, 1, 2, 1};
enum { FOCAL_SPOT = 6 };

/* gVXR's focal spot is a cube about the position, sampled at the centres of n x n x n equal cubes. */
static skg_status read_focal_spot(const skg_json_node *node, skg_spot *spot) {
    const skg_json_node pieces = skg_json_element(node, 3);
    spot->shape = SKG_SPOT_CUBE;
    return skg_json_integer(&pieces, 1, 40, &spot->grid);
}

static skg_status read_spot(const skg_json_node *node, skg_spot *spot) {
    int64_t choice = 0, count = 0;
    double mm = 0;
    SKG_TRY(skg_json_array(node, "[\"Disc\", 1, \"mm\"]", &count));
    const skg_json_node first = skg_json_element(node, 0);
    SKG_TRY(skg_json_choice(&first, "shape of an extended source", spot_names, FOCAL_SPOT + 1, &choice));
    const int sizes = spot_sizes[choice], wanted = sizes + (choice == FOCAL_SPOT ? 3 : 2);
    if (count != wanted)
        return skg_json_fail(node, SKG_ERR_FORMAT, "has %d entries; write it like %s", (int)count,
                             spot_examples[choice]);
    const skg_json_node unit = skg_json_element(node, 1 + sizes);
    SKG_TRY(skg_json_unit_of_length(&unit, &mm));
    for (int k = 0; k < 3; k++) {
        const skg_json_node size = skg_json_element(node, 1 + (k < sizes ? k : 0));
        SKG_TRY(skg_json_number(&size, &spot->extent[k]));
        spot->extent[k] *= mm;
        if (!(spot->extent[k] >= 0) || !isfinite(spot->extent[k]))
            return skg_json_fail(&size, SKG_ERR_FORMAT,
                                 "is no size of a focal spot; give a length of 0 or more");
    }
    spot->shape = (int32_t)choice + SKG_SPOT_LINE;
    return choice == FOCAL_SPOT ? read_focal_spot(node, spot) : SKG_OK;
}

/* {"Share": 0.1, "Diameter": [30, "mm"]} */
static skg_status read_off_focal(const skg_json_node *node, skg_spot *spot) {
    skg_json_object object;
    skg_json_node share, diameter;
    SKG_TRY(skg_json_read_object(node, &skg_keys_off_focal, &object));
    SKG_TRY(skg_json_need(&object, "Share", "0.1", &share));
    SKG_TRY(skg_json_need(&object, "Diameter", "[30, \"mm\"]", &diameter));
    SKG_TRY(skg_json_number(&share, &spot->off_focal));
    SKG_TRY(skg_json_lengths(&diameter, "[30, \"mm\"]", 1, &spot->off_focal_mm));
    if (!(spot->off_focal > 0 && spot->off_focal < 1))
        return skg_json_fail(&share, SKG_ERR_FORMAT, "is %g; give a share of the photons above 0, below 1",
                             spot->off_focal);
    if (!(spot->off_focal_mm > 0))
        return skg_json_fail(&diameter, SKG_ERR_FORMAT, "is no diameter of a disc; give a length above 0");
    return SKG_OK;
}

static skg_status read_sampling(const skg_json_object *source, skg_spot *spot) {
    const skg_json_node samples = skg_json_member(source, "Samples"), grid = skg_json_member(source, "Grid");
    const skg_json_node tolerance = skg_json_member(source, "SampleTolerance"),
                        axis = skg_json_member(source, "Axis");
    if (samples.value) SKG_TRY(skg_json_integer(&samples, 0, 65536, &spot->samples));
    if (grid.value) SKG_TRY(skg_json_integer(&grid, 1, 256, &spot->grid));
    if (axis.value) SKG_TRY(skg_json_direction(&axis, spot->axis));
    const skg_json_node off = skg_json_member(source, "OffFocal");
    if (off.value) SKG_TRY(read_off_focal(&off, spot));
    if (!tolerance.value) return SKG_OK;
    SKG_TRY(skg_json_number(&tolerance, &spot->tolerance));
    if (!(spot->tolerance > 0 && spot->tolerance < 1))
        return skg_json_fail(&tolerance, SKG_ERR_FORMAT,
                             "is %g; give a fraction of the flat field above 0, below 1", spot->tolerance);
    return SKG_OK;
}

/* A point has nothing to sample. */
static skg_status pass_over_sampling(const skg_json_object *source) {
    static const char *const keys[] = {"Samples", "Grid", "SampleTolerance", "Axis", "OffFocal"};
    for (int k = 0; k < 5; k++) {
        const skg_json_node node = skg_json_member(source, keys[k]);
        if (!node.value) continue;
        SKG_TRY(skg_json_remark(
            &node, "has no effect: the source is no focal spot; give a Shape such as [\"Disc\", 1, \"mm\"]"));
    }
    return SKG_OK;
}

skg_status skg_setup_read_source_shape(skg_setup_reader *reader, const skg_json_object *source,
                                       int32_t *parallel) {
    static const char *const shapes[] = {"PointSource", "Point",        "Cone",
                                         "ConeBeam",    "ParallelBeam", "Parallel"};
    skg_spot *spot = &reader->setup->spot;
    skg_json_node node;
    int64_t choice = 0;
    skg_spot_init(spot);
    *parallel = 0;
    node = skg_json_member(source, "Shape");
    if (!json_is_array(node.value)) SKG_TRY(pass_over_sampling(source));
    if (!node.value) {
        *parallel = skg_json_member(source, "Direction").value != NULL; /* only a parallel beam has one */
        return SKG_OK;
    }
    if (json_is_array(node.value)) {
        SKG_TRY(read_spot(&node, spot));
        return read_sampling(source, spot);
    }
    SKG_TRY(skg_json_choice(&node, "shape of a source", shapes, 6, &choice));
    *parallel = choice >= 4;
    return SKG_OK;
}
