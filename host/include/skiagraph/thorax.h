/** @file
 * A generated thorax at end-expiration, for trials and lessons without patient data.
 *
 * x points to the patient's left, y to the back, z to the head; the origin is the top of the right half of
 * the diaphragm. Sizes are from the literature and from averages of real bones. Every mesh is closed and
 * outward. Two meshes are disjoint or one lies inside the other, except the needle, which passes through
 * others; with fewer than 42,000 triangles facets may cut into a neighbour by up to 3 mm. Labels are English:
 * "rib 5 left", "liver", "lung right", "skin".
 *
 * The skin is a layer of fat, 10 to 25 mm thick; inside it "muscle" fills what the other parts leave: the wall of
 * the chest and the belly, the back, the shoulders, and the soft tissue between the lungs. A bone of cortex holds
 * its marrow, a lung its vessels, fat a kidney, stomach and bowel their gas. There are no arms.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_THORAX_H
#define SKIAGRAPH_THORAX_H

#include <skiagraph/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The parts of a generated thorax. */
typedef struct skg_thorax skg_thorax;

/** Options of a thorax. Prepare with skg_thorax_options_init. */
typedef struct {
    /** Set by skg_thorax_options_init. */
    int32_t size;
    /** 0: the full thorax. 1: the simple one, 67 parts without muscle, great vessels, marrow, vessels of the lungs,
     * shoulder blades and bowel, in a body of fat; for comparison with earlier figures. */
    int32_t simple;
    /** Approximate number of triangles, 10,000 to 20,000,000; 42,000 by default (the paper's scene has
     * 41,710). The full thorax has at least about 18,000. */
    int64_t triangles;
} skg_thorax_options;

SKG_INIT(skg_thorax_options)

/** Makes a thorax.
 *
 *     options   NULL: the defaults
 *     thorax    result; the caller releases it
 *     errors    SKG_ERR_ARGUMENT if the number of triangles is out of range */
SKG_API skg_status skg_thorax_create(const skg_thorax_options *options, skg_thorax **thorax);

/** Frees a thorax. */
SKG_API void skg_thorax_release(skg_thorax **thorax);

/** A part of a thorax. The library fills it; prepare with skg_thorax_part_init. Texts and mesh are valid as
 * long as the thorax; the mesh is not retained for the caller. */
typedef struct {
    /** Set by skg_thorax_part_init. */
    int32_t size;
    /** 1: it passes through other parts on purpose, as the needle does. Give it a higher priority than theirs
     * (skg_part.priority): it then displaces them. */
    int32_t through;
    /** Number of the part that it lies inside; -1: none. */
    int64_t inside;
    /** Closed, outward. */
    skg_mesh *mesh;
    /** Unique. */
    const char *label;
    /** As skg_material_create_named takes it, such as "Liver", "Needle steel"; NULL for bones. */
    const char *material;
    /** Hounsfield number at about 120 kV, which decides the material if `material` is NULL. */
    double hounsfield;
    /** g/cm3; 0: that of the tables. */
    double density_g_cm3;
} skg_thorax_part;

SKG_INIT(skg_thorax_part)

/** Number of parts of a thorax. */
SKG_API skg_status skg_thorax_part_count(const skg_thorax *thorax, int64_t *count);

/** Gets part 0 <= index < count. */
SKG_API skg_status skg_thorax_part_get(const skg_thorax *thorax, int64_t index, skg_thorax_part *part);

/** Writes one PLY file per part and a scene file, thorax.json (docs/scene-files.md), into a folder that
 * exists. The scene has a tube of 80 kV 1 m in front of a detector behind the patient's back, head up, the
 * patient's right on the viewer's left, and the breathing and events of a percutaneous cholangiography.
 * Errors: SKG_ERR_OUTPUT. */
SKG_API skg_status skg_thorax_save(const skg_thorax *thorax, const char *folder);

#ifdef __cplusplus
}
#endif
#endif
