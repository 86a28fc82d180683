/* Reads the objects in the beam besides the samples: Bowtie of a source, Grid of a detector. */
#include "beam/bowtie.h"
#include "beam/grid.h"
#include "core/files.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <string.h>

static const char *const profile_example = "[[-20, 30], [0, 3], [20, 30]], in degrees and mm";

/* [[degrees, mm], ...] or a file of two columns. */
static skg_status read_profile(skg_setup_reader *reader, const skg_json_node *node, double mm,
                               skg_bowtie *bowtie) {
    double *angles = NULL, *paths = NULL;
    int64_t count = 0;
    skg_status status = SKG_OK;
    if (json_is_string(node->value)) {
        const char *name = NULL, *path = NULL;
        SKG_TRY(skg_json_text(node, &name));
        SKG_TRY(skg_setup_find_file(reader, name, &path));
        status = skg_read_columns(path, NULL, &count, &angles, &paths);
        SKG_TRY_CLEANUP(skg_json_at(node, status));
    } else {
        SKG_TRY(skg_json_array(node, profile_example, &count));
        SKG_TRY_CLEANUP(skg_alloc(count + 1, sizeof *angles, "bow-tie", &angles));
        SKG_TRY_CLEANUP(skg_alloc(count + 1, sizeof *paths, "bow-tie", &paths));
        for (int64_t k = 0; k < count; k++) {
            const skg_json_node row = skg_json_element(node, k);
            double numbers[2];
            SKG_TRY_CLEANUP(skg_json_numbers(&row, "[angle, path]", 2, numbers));
            angles[k] = numbers[0], paths[k] = numbers[1];
        }
    }
    SKG_TRY_CLEANUP(skg_alloc(2 * count + 1, sizeof *paths, "bow-tie", &reader->setup->bowtie_rows));
    for (int64_t k = 0; k < count; k++) {
        reader->setup->bowtie_rows[k] = angles[k];
        reader->setup->bowtie_rows[count + k] = paths[k] * mm;
    }
    bowtie->count = count;
    bowtie->angle_deg = reader->setup->bowtie_rows, bowtie->path_mm = reader->setup->bowtie_rows + count;
cleanup:
    skg_free(&angles);
    skg_free(&paths);
    return status;
}

skg_status skg_setup_read_bowtie(skg_setup_reader *reader, const skg_json_node *node) {
    skg_bowtie *bowtie = &reader->setup->bowtie;
    skg_json_object object;
    skg_json_node material, profile;
    double mm = 1;
    skg_bowtie_init(bowtie);
    if (!node->value) return SKG_OK;
    SKG_TRY(skg_json_read_object(node, &skg_keys_bowtie, &object));
    SKG_TRY(skg_json_need(&object, "Material", "\"Al\"", &material));
    SKG_TRY(skg_json_need(&object, "Profile", profile_example, &profile));
    const skg_json_node density = skg_json_member(&object, "Density"),
                        unit = skg_json_member(&object, "Unit");
    const skg_json_node direction = skg_json_member(&object, "Direction");
    SKG_TRY(skg_setup_read_material(reader, &material, &density, "bow-tie", &bowtie->material));
    if (unit.value) SKG_TRY(skg_json_unit_of_length(&unit, &mm));
    if (direction.value) SKG_TRY(skg_json_direction(&direction, bowtie->direction));
    SKG_TRY(read_profile(reader, &profile, mm, bowtie));
    SKG_TRY(skg_json_at(&profile, skg_bowtie_check(bowtie)));
    reader->setup->said.bowtie = bowtie;
    return SKG_OK;
}

static skg_status read_grid_numbers(const skg_json_object *object, skg_grid *grid) {
    skg_json_node ratio, lines, strip;
    SKG_TRY(skg_json_need(object, "Ratio", "12", &ratio));
    SKG_TRY(skg_json_need(object, "LinesPerCm", "40", &lines));
    SKG_TRY(skg_json_need(object, "StripThickness", "[0.05, \"mm\"]", &strip));
    SKG_TRY(skg_json_number(&ratio, &grid->ratio));
    SKG_TRY(skg_json_number(&lines, &grid->lines_per_cm));
    const skg_json_node focus = skg_json_member(object, "FocusDistance");
    const skg_json_node direction = skg_json_member(object, "Direction");
    if (focus.value) SKG_TRY(skg_json_lengths(&focus, "[1000, \"mm\"]", 1, &grid->focus_mm));
    if (focus.value && !(grid->focus_mm > 0))
        return skg_json_fail(&focus, SKG_ERR_SCENE,
                             "is %g mm; give the distance from the grid to its focus, or leave FocusDistance "
                             "out for parallel strips",
                             grid->focus_mm);
    SKG_TRY(skg_json_lengths(&strip, "[0.05, \"mm\"]", 1, &grid->strip_mm));
    return direction.value ? skg_json_direction(&direction, grid->direction) : SKG_OK;
}

skg_status skg_setup_read_grid(skg_setup_reader *reader, const skg_json_object *detector) {
    const skg_json_node node = skg_json_member(detector, "Grid"), no_density = {0};
    skg_grid *grid = &reader->setup->grid;
    skg_json_object object;
    skg_grid_init(grid);
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_read_object(&node, &skg_keys_grid, &object));
    SKG_TRY(read_grid_numbers(&object, grid));
    const skg_json_node interspace = skg_json_member(&object, "Interspace");
    const skg_json_node strip = skg_json_member(&object, "Strip");
    if (interspace.value)
        SKG_TRY(skg_setup_read_material(reader, &interspace, &no_density, "interspace", &grid->interspace));
    if (strip.value) SKG_TRY(skg_setup_read_material(reader, &strip, &no_density, "strips", &grid->strip));
    SKG_TRY(skg_json_at(&node, skg_grid_check(grid)));
    reader->setup->said.grid = grid;
    return SKG_OK;
}

void skg_setup_in_beam_free(skg_setup *setup) {
    skg_material_release(&setup->bowtie.material);
    skg_material_release(&setup->grid.interspace);
    skg_material_release(&setup->grid.strip);
    skg_free(&setup->bowtie_rows);
}
