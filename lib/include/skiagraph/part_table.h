/** @file
 * A table of the parts of a scene, for a report: density, volume, mass, mean path, share of the attenuation.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_PART_TABLE_H
#define SKIAGRAPH_PART_TABLE_H

#include <skiagraph/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A table of parts. */
typedef struct skg_part_table skg_part_table;

/** Measures the parts of a plan's scene at its view: an image of path lengths for each.
 *
 *     plan     without scatter, in single or double precision
 *     table    result; the caller releases it
 *     errors   those of frames */
SKG_API skg_status skg_part_table_create(skg_plan *plan, skg_part_table **table);

/** Releases the handle, and sets it to NULL. */
SKG_API void skg_part_table_release(skg_part_table **table);

/** Gets the mean energy of the beam, at which shares hold, keV. */
SKG_API skg_status skg_part_table_energy_get(const skg_part_table *table, double *kev);

/** Measurements of a part. The library fills it; prepare with skg_part_row_init. */
typedef struct {
    /** Set by skg_part_row_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** g/cm3; of a volume of cells their mean. NAN: not known. */
    double density_g_cm3;
    /** Volume of the mesh times its pose, without the parts that lie inside; overlaps that priority or clip decide are not taken off.
     * NAN: its mesh, or that of a part inside, is not closed. */
    double volume_mm3;
    /** Density times volume. NAN: one of them is not known. */
    double mass_g;
    /** Mean net length of the rays that meet the part; 0: none does. */
    double mean_path_mm;
    /** The part's share of the sum, over all pixels and parts, of attenuation coefficient times length, at the mean energy of the beam.
     * NAN: nothing attenuates, or a part is a volume of cells. */
    double share;
} skg_part_row;

SKG_INIT(skg_part_row)

/** Number of rows: the parts of the scene, in their order. */
SKG_API skg_status skg_part_row_count(const skg_part_table *table, int64_t *count);

/** Gets row 0 <= index < number of rows. */
SKG_API skg_status skg_part_row_get(const skg_part_table *table, int64_t index, skg_part_row *row);

#ifdef __cplusplus
}
#endif
#endif
