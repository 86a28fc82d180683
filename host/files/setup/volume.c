/* The keys of a sample that is a volume of cells: Volume, Values, Classes, Material. */
#include "core/context.h"
#include "setup/sections.h"

#include <inttypes.h>
#include <string.h>

enum { CLASSES_MAX = 256 };

/* Compositions of a volume, which its source points to while it is read. */
typedef struct {
    int64_t count;
    double from[CLASSES_MAX];
    skg_material *materials[CLASSES_MAX], *material;
} compositions;

static void release(compositions *c) {
    for (int64_t k = 0; k < c->count; k++) skg_material_release(&c->materials[k]);
    skg_material_release(&c->material);
}

/* Keys that say what a mesh is, or how its material is, and which a volume does not have. */
static skg_status refuse_others(const skg_json_object *sample) {
    static const char *const shapes[] = {"Path",   "Cube",      "Cuboid", "Cylinder",
                                         "Sphere", "StepWedge", "Group"};
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        const skg_json_node node = skg_json_member(sample, shapes[k]);
        if (node.value)
            return skg_json_fail(&node, SKG_ERR_FORMAT,
                                 "stands beside Volume; a sample is a mesh or a volume");
    }
    const skg_json_node density = skg_json_member(sample, "Density"),
                        poses = skg_json_member(sample, "FlipNormals");
    if (density.value)
        return skg_json_fail(&density, SKG_ERR_FORMAT,
                             "stands beside Volume, whose values say the density of each cell; leave it out");
    const skg_json_node form = skg_json_member(sample, "FormFactor");
    if (form.value)
        return skg_json_fail(&form, SKG_ERR_FORMAT,
                             "stands beside Volume, whose cells do not scatter; leave it out");
    if (poses.value)
        return skg_json_fail(&poses, SKG_ERR_FORMAT,
                             "stands beside Volume, which has no normals; leave it out");
    return SKG_OK;
}

/* The density of a composition does not matter, because values say it; so a material without one is taken at 1 g/cm3. */
static skg_status read_composition(skg_setup_reader *reader, const skg_json_node *node,
                                   skg_material **material) {
    const skg_json_node none = {.file = node->file};
    const skg_status status = skg_setup_read_material(reader, node, &none, NULL, material);
    if (status != SKG_ERR_MATERIAL) return status;
    json_t *one = json_real(1);
    skg_json_node density = *node;
    density.value = one;
    const skg_status again = one ? skg_setup_read_material(reader, node, &density, NULL, material) : status;
    json_decref(one);
    return again;
}

static skg_status read_classes(skg_setup_reader *reader, const skg_json_node *node, compositions *c) {
    int64_t count = 0;
    SKG_TRY(skg_json_array(node, "[[-1000, \"Air\"], [-400, \"Lung\"]]", &count));
    if (count < 1 || count > CLASSES_MAX)
        return skg_json_fail(node, SKG_ERR_FORMAT, "has %" PRId64 " classes; 1 to %d", count,
                             (int)CLASSES_MAX);
    for (int64_t k = 0; k < count; k++) {
        const skg_json_node row = skg_json_element(node, k);
        int64_t two = 0;
        SKG_TRY(skg_json_array(&row, "[-1000, \"Air\"]", &two));
        if (two != 2)
            return skg_json_fail(&row, SKG_ERR_FORMAT, "has %" PRId64 " elements; give [-1000, \"Air\"]",
                                 two);
        const skg_json_node from = skg_json_element(&row, 0), material = skg_json_element(&row, 1);
        SKG_TRY(skg_json_number(&from, &c->from[k]));
        if (k > 0 && c->from[k] <= c->from[k - 1])
            return skg_json_fail(&from, SKG_ERR_FORMAT, "is %g, not above the %g before it", c->from[k],
                                 c->from[k - 1]);
        SKG_TRY(read_composition(reader, &material, &c->materials[k]));
        c->count++;
    }
    return SKG_OK;
}

/* Above the densest element, osmium, 22.6 g/cm3; and a CT image without a cell that is nearer to air than to water. */
static const double DENSEST = 23, NO_AIR = -100;

/* A picture of another unit looks the same, so values that are none of a body's are told. */
static void doubt(const skg_setup_reader *reader, const char *place, const skg_volume_contents *contents,
                  int is_named) {
    if (contents->values == SKG_VOLUME_DENSITY && contents->high > DENSEST)
        skg_logger_say(
            &reader->log, SKG_LOG_WARNING,
            "%s: its densities go up to %g g/cm3, which nothing has; are they mg/cm3 or Hounsfield numbers?",
            place, contents->high);
    if (contents->values == SKG_VOLUME_HU && !is_named && contents->low > NO_AIR)
        skg_logger_say(
            &reader->log, SKG_LOG_WARNING,
            "%s: has no Values, so that its cells are taken for Hounsfield numbers, from %g to %g: none of them is air; if they "
            "are, say \"Values\": \"HU\"",
            place, contents->low, contents->high);
}

/* Passes on the remarks about a volume and its file, with the place in the scene file. */
static skg_status pass_remarks(const skg_setup_reader *reader, const char *place, const skg_volume *volume,
                               int64_t count) {
    for (int64_t k = 0; k < count; k++) {
        const char *sentence = NULL;
        int32_t level = 0;
        SKG_TRY(skg_volume_remark_get(volume, k, &level, &sentence));
        skg_logger_say(&reader->log, level, "%s: %s", place, sentence);
    }
    return SKG_OK;
}

/* Says what was done with cells beyond the scanners' range. */
static skg_status note(const skg_setup_reader *reader, const skg_json_node *node, const skg_volume *volume,
                       int is_named, int has_compositions) {
    skg_volume_contents contents;
    char place[256];
    skg_volume_contents_init(&contents);
    SKG_TRY(skg_volume_contents_get(volume, &contents));
    skg_json_place(node, place, sizeof place);
    SKG_TRY(pass_remarks(reader, place, volume, contents.remarks));
    doubt(reader, place, &contents, is_named);
    if (contents.beyond == 0 || has_compositions) return SKG_OK;
    skg_logger_say(&reader->log, SKG_LOG_WARNING,
                   "%s: %" PRId64
                   " cells are above HU 3000, up to HU %g, and are taken for bone of rising density; if they "
                   "are metal, name it by Classes",
                   place, contents.beyond, contents.high);
    return SKG_OK;
}

static skg_status read_values(const skg_json_object *sample, skg_volume_source *source) {
    static const char *const names[] = {"HU", "density", "mu"};
    static const char *const ways[] = {"cells", "linear"};
    const skg_json_node node = skg_json_member(sample, "Values"),
                        way = skg_json_member(sample, "Interpolation");
    int64_t choice = 0, linear = 0;
    if (node.value) SKG_TRY(skg_json_choice(&node, "kind of values", names, 3, &choice));
    if (way.value) SKG_TRY(skg_json_choice(&way, "interpolation", ways, 2, &linear));
    source->interpolation = (int32_t)linear;
    source->values = (int32_t)choice;
    return SKG_OK;
}

skg_status skg_setup_read_volume(skg_setup_reader *reader, const skg_json_object *sample,
                                 skg_volume **volume) {
    const skg_json_node file = skg_json_member(sample, "Volume"), unit = skg_json_member(sample, "Unit"),
                        classes = skg_json_member(sample, "Classes"),
                        material = skg_json_member(sample, "Material");
    compositions *c = NULL;
    const char *name = NULL, *path = NULL;
    double unit_mm = 0; /* the file's */
    skg_volume_source source;
    skg_status status = SKG_OK;
    skg_volume_source_init(&source);
    SKG_TRY(refuse_others(sample));
    SKG_TRY(read_values(sample, &source));
    SKG_TRY(skg_json_text(&file, &name));
    if (unit.value) SKG_TRY(skg_json_unit_of_length(&unit, &unit_mm));
    SKG_TRY(skg_setup_find_file(reader, name, &path));
    SKG_TRY(skg_alloc(1, sizeof *c, "classes of a volume", &c));
    if (classes.value) SKG_TRY_CLEANUP(read_classes(reader, &classes, c));
    if (material.value) SKG_TRY_CLEANUP(read_composition(reader, &material, &c->material));
    source.material = c->material;
    source.class_count = c->count, source.class_from = c->from, source.class_materials = c->materials;
    source.name = name;
    status = skg_json_at(&file, skg_volume_load(path, unit_mm, &source, volume));
    if (status == SKG_OK)
        status = note(reader, &file, *volume, skg_json_member(sample, "Values").value != NULL,
                      c->material || c->count);
cleanup:
    release(c);
    skg_free(&c);
    return status;
}
