/* Adds a part to the generated thorax, fitted to its number of triangles. */
#include "phantom/makers.h"

#include "phantom/contacts.h"

#include <string.h>

/* Materials by how the labels of parts begin: a name of the material tables, and a density in g/cm3 where it is not
 * that of the tables. Bones are not listed, and given by a Hounsfield number, because a bone as a whole includes its
 * marrow. */
static const struct {
    const char *label, *material;
    double density;
} tissue[] = {{"skin", "Adipose", 0},
              {"lung", "Lung tissue", 0.24}, /* end-expiration: about 720 g in 3 l */
              {"trachea", "Air", 0},
              {"bronchus", "Air", 0},
              {"heart", "Blood", 0},
              {"aorta", "Blood", 0},
              {"ascending aorta", "Blood", 0},
              {"vena cava", "Blood", 0},
              {"brachiocephalic", "Blood", 0},
              {"pulmonary", "Blood", 0},
              {"oesophagus", "Muscle", 0},
              {"muscle", "Muscle", 0},
              {"disc", "Soft tissue", 1.10},
              {"spinal canal", "Water", 0},
              {"perirenal fat", "Adipose", 0},
              {"bowel gas", "Air", 0},
              {"bowel", "Soft tissue", 0.97}, /* mixed with fat and gas: an assumption */
              {"stomach gas", "Air", 0},
              {"diaphragm", "Muscle", 0},
              {"liver", "Liver", 0},
              {"gallbladder", "Water", 0},
              {"bile ducts", "Iopamidol 150", 0},
              {"common bile duct", "Iopamidol 150", 0},
              {"stomach", "Soft tissue", 0},
              {"spleen", "Spleen", 0},
              {"kidney", "Kidney", 0},
              {"needle", "Needle steel", 0}};

static void set_tissue(skg_thorax *thorax, int64_t i) {
    for (size_t t = 0; t < sizeof tissue / sizeof *tissue; t++)
        if (strncmp(thorax->part[i].label, tissue[t].label, strlen(tissue[t].label)) == 0) {
            thorax->part[i].material = tissue[t].material;
            thorax->part[i].density = tissue[t].density;
            return;
        }
}

skg_status skg_thorax_add(skg_thorax *thorax, const char *label, double hounsfield, int64_t inside,
                          skg_mesh_arrays *arrays) {
    if (thorax->parts == thorax->capacity) {
        int64_t capacity = 2 * thorax->capacity + 16;
        SKG_TRY(skg_realloc(capacity, sizeof *thorax->part, "thorax", &thorax->part));
        thorax->capacity = capacity;
    }
    skg_mesh *mesh;
    SKG_TRY(skg_mesh_adopt(NULL, label, arrays, &mesh));
    memset(thorax->part + thorax->parts, 0, sizeof *thorax->part);
    strncpy(thorax->part[thorax->parts].label, label, sizeof thorax->part->label - 1);
    thorax->part[thorax->parts].hounsfield = hounsfield;
    thorax->part[thorax->parts].inside = inside;
    set_tissue(thorax, thorax->parts);
    thorax->part[thorax->parts++].mesh = mesh;
    return SKG_OK;
}

skg_status skg_thorax_fit(skg_thorax *thorax, const char *label, double hounsfield, int64_t inside,
                          skg_mesh_arrays *arrays) {
    skg_mesh **others = NULL;
    int64_t count = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(thorax->parts, sizeof *others, label, &others));
    for (int64_t i = 0; i < thorax->parts; i++)
        if (thorax->part[i].inside == inside || (i == inside && thorax->part[i].inside >= 0))
            others[count++] = thorax->part[i].mesh;
    SKG_TRY_CLEANUP(skg_shape_retreat(label, count, others, arrays));
    SKG_TRY_CLEANUP(skg_thorax_add(thorax, label, hounsfield, inside, arrays));
cleanup:
    skg_free(&others);
    return status;
}
