/** @file
 * Volumes of cells: a CT image, or any other grid of values, as a part of a scene.
 *
 * Each cell has one value throughout. The value decides what it is made of: its composition and its density. Path
 * lengths are those between the planes of the cells, so that images are exact for such a body.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_VOLUME_H
#define SKIAGRAPH_VOLUME_H

#include <skiagraph/material.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A grid of cells. It never changes, and may be shared by threads. */
typedef struct skg_volume skg_volume;

/** Physical quantity of the values of cells. */
enum skg_volume_values {
    /** Hounsfield numbers. Density and, without a material or classes, composition follow from them as in
     * skg_material_create_hounsfield; they are rounded to whole numbers. Below -1000 is air; above 3000 bone of rising density
     * goes on, of which a note says how many cells there are. */
    SKG_VOLUME_HU = 0,
    /** Densities, g/cm3, at least 0 but for noise, which counts as 0. They need a material or classes. */
    SKG_VOLUME_DENSITY = 1,
    /** Linear attenuation coefficients at every energy, 1/cm, at least 0 but for noise, which counts as 0. */
    SKG_VOLUME_MU = 2
};

/** Interpolation of the values between the centres of cells. */
enum skg_volume_interpolation {
    /** Each cell has one value throughout. */
    SKG_VOLUME_CELLS = 0,
    /** The attenuation changes linearly along each axis between the centres of eight cells, and not within the outer half
     * of the cells at the surface. Integrals along rays are exact for it, too. */
    SKG_VOLUME_LINEAR = 1
};

/** Element type of cells in memory. */
enum skg_volume_type {
    /** int16_t */
    SKG_VOLUME_INT16 = 0,
    /** uint16_t */
    SKG_VOLUME_UINT16 = 1,
    /** float, 32 bits */
    SKG_VOLUME_FLOAT32 = 2,
    /** double, 64 bits */
    SKG_VOLUME_FLOAT64 = 3
};

/** Cells, values and materials of a volume to be made. The arrays are the caller's, and copied. Prepare with skg_volume_source_init:
 * Hounsfield numbers, cells of 1 mm. */
typedef struct {
    /** Set by skg_volume_source_init. */
    int32_t size;
    /** enum skg_volume_values */
    int32_t values;
    /** enum skg_volume_type, of cells */
    int32_t type;
    /** enum skg_volume_interpolation */
    int32_t interpolation;
    /** Number of cells along the first axis, 1 to 32768. */
    int64_t columns;
    /** Number of cells along the second axis. */
    int64_t rows;
    /** Number of cells along the third axis. */
    int64_t slices;
    /** [slices][rows][columns]; finite. */
    const void *cells;
    /** 4 x 4, row by row: from (column, row, slice) to the centre of this cell, mm. Affine, not singular; it may mirror and shear. */
    double affine[16];
    /** The composition of all cells, of which values say the density; NULL: by classes, or by Schneider's table. Retained. Not with
     * SKG_VOLUME_MU. */
    skg_material *material;
    /** Number of classes; 0: none. Not together with a material, and not with SKG_VOLUME_MU. */
    int64_t class_count;
    /** [class_count] rising: the value from which on a cell is of this class; those below the first are of the first. */
    const double *class_from;
    /** [class_count] compositions, of which values say the density. Retained. */
    skg_material *const *class_materials;
    /** For messages; NULL: "volume". Copied. */
    const char *name;
} skg_volume_source;

SKG_INIT(skg_volume_source)

/** Makes a volume.
 *
 *     volume    result; the caller releases it
 *     errors    SKG_ERR_ARGUMENT: sizes, types, a singular affine, a value that is not finite, or below 0 by more than noise (a quarter of the largest), with its place;
 *               SKG_ERR_MATERIAL: no material, or one without elements; SKG_ERR_MEMORY
 *     method    whole numbers of at most 65,536 different values take 16 bits a cell. Other densities and
 *               coefficients take 32 bits, in 2^-30 of the largest; with classes, 65,536 levels */
SKG_API skg_status skg_volume_create(const skg_volume_source *source, skg_volume **volume);

/** Reads a volume from a file, or from a folder of DICOM slices.
 *
 *     path      .mha, .mhd: MetaImage; .nrrd, .nhdr: NRRD, raw or gzip; .nii, .nii.gz: NIfTI-1 and -2. Three dimensions, one number a cell, compressed or not; positions
 *               are those of the file. What it leaves open, and what is taken for it, skg_volume_remark_get says. A folder: the slices of one series that lie in it
 *               (DICOM, not compressed), in the order of their places, evenly apart, rescaled each; other files in it are passed over
 *     unit_mm   mm per unit of the file's lengths, above 0: it wins over the unit that the file names; 0: that one, mm where there is none
 *     source    values, material, classes and name; sizes, type, cells and affine are those of the file. NULL: Hounsfield numbers
 *     errors    SKG_ERR_FILE; SKG_ERR_FORMAT; SKG_ERR_UNSUPPORTED; as above */
SKG_API skg_status skg_volume_load(const char *path, double unit_mm, const skg_volume_source *source,
                                   skg_volume **volume);

/** Adds an owner to a volume. */
SKG_API skg_status skg_volume_retain(skg_volume *volume);

/** Removes an owner; the last one frees the volume. */
SKG_API void skg_volume_release(skg_volume **volume);

/** Size, spacing and range of values of a volume. The library fills it; prepare with skg_volume_contents_init. */
typedef struct {
    /** Set by skg_volume_contents_init. */
    int32_t size;
    /** enum skg_volume_values */
    int32_t values;
    /** Bits of a cell: 16 or 32. */
    int32_t bits;
    /** Number of compositions that cells have. */
    int32_t classes;
    /** Number of cells along the first axis. */
    int64_t columns;
    /** Number of cells along the second axis. */
    int64_t rows;
    /** Number of cells along the third axis. */
    int64_t slices;
    /** Bytes of all cells. */
    int64_t bytes;
    /** mm along the three axes. */
    double spacing[3];
    /** From (column, row, slice) to mm, as in skg_volume_source. */
    double affine[16];
    /** The least value. */
    double low;
    /** The greatest value. */
    double high;
    /** Mass of all cells, g; 0: not known (SKG_VOLUME_MU). */
    double mass;
    /** Cells whose Hounsfield number is above 3000. */
    int64_t beyond;
    /** Sentences about it and its file (skg_volume_remark_get). */
    int64_t remarks;
} skg_volume_contents;

SKG_INIT(skg_volume_contents)

/** Gets size, spacing and range of values of a volume. */
SKG_API skg_status skg_volume_contents_get(const skg_volume *volume, skg_volume_contents *contents);

/** Gets composition 0 <= index < classes of a volume.
 *
 *     name     result: its name, valid as long as the volume
 *     share    result: the share of the cells that are of it */
SKG_API skg_status skg_volume_class_get(const skg_volume *volume, int64_t index, const char **name,
                                        double *share);

/** Gets sentence 0 <= index < remarks about a volume: how many of its values count as 0 because noise has taken them below it; that its
 * file names another unit than the caller, or does not say the size of cells or the order of bytes, and what was taken.
 *
 *     level      result: SKG_LOG_WARNING or SKG_LOG_NOTE (context.h)
 *     sentence   result: what follows the name of the volume and a colon, valid as long as the volume
 *
 * @since 0.1.0 */
SKG_API skg_status skg_volume_remark_get(const skg_volume *volume, int64_t index, int32_t *level,
                                         const char **sentence);

#ifdef __cplusplus
}
#endif
#endif
