/** @file
 * Reconstruction of circular scans by the method of Feldkamp, Davis and Kress (J. Opt. Soc. Am. A 1 (1984) 612-619),
 * to look at what a scan gives. Programs such as RTK, ASTRA, TIGRE and CIL do more.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_RECONSTRUCT_H
#define SKIAGRAPH_RECONSTRUCT_H

#include <skiagraph/progress.h>
#include <skiagraph/scan.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A volume that is being reconstructed. */
typedef struct skg_fdk skg_fdk;

/** Filters of the rows of a projection. */
enum skg_fdk_filter {
    /** The band-limited ramp. */
    SKG_FDK_FILTER_RAMP = 0,
    /** The ramp times a Hann window: less noise, less sharp. */
    SKG_FDK_FILTER_HANN = 1
};

/** Treatment of projections that the detector cuts off. */
enum skg_fdk_truncation {
    /** Nothing: values rise towards the edge of what the detector sees. */
    SKG_FDK_TRUNCATION_NONE = 0,
    /** Rows are continued beyond the detector as the projection of an ellipse that fits their outermost columns; where none does, by
     * their mirror image about the edge, which falls to 0 (B. Ohnesorge et al., Med. Phys. 27 (2000) 39-46). */
    SKG_FDK_TRUNCATION_EXTRAPOLATE = 1
};

/** Volume, filter and weights of a reconstruction. Prepare with skg_fdk_options_init: axis z through the origin, 128 voxels of 1 mm along
 * each side, the ramp. */
typedef struct {
    /** Set by skg_fdk_options_init. */
    int32_t size;
    /** enum skg_fdk_filter */
    int32_t filter;
    /** Direction of the axis of rotation. */
    double axis[3];
    /** A point on it, mm. */
    double centre[3];
    /** Numbers of voxels along x, y and z, 1 to 4096 each. */
    int64_t voxels[3];
    /** Edge of a voxel, mm. */
    double voxel_mm;
    /** Centre of the volume, mm. */
    double middle[3];
    /** Steps are projections. Retained by the reconstruction; NULL: nobody wants to know. */
    skg_progress *progress;
    /** enum skg_fdk_truncation */
    int32_t truncation;
    /** 0 */
    int32_t reserved;
} skg_fdk_options;

SKG_INIT(skg_fdk_options)

/** Coverage of the bodies by the detector. The library fills it; prepare with skg_fdk_report_init. */
typedef struct {
    /** Set by skg_fdk_report_init. */
    int32_t size;
    /** 1: the detector is displaced by more than a column, and a full turn is weighted for it. */
    int32_t displaced;
    /** The radius about the axis within which every line is measured, mm. */
    double covered_mm;
    /** The radius about the axis that the near side of a displaced detector reaches, mm; otherwise as covered_mm. */
    double overlap_mm;
    /** The share of the rows that were added so far whose values do not fall to 5 % of the largest of the projection at an edge of the
     * detector that has to show air: truncated ones. */
    double truncated;
    /** Range of the axis that the rows of all projections see, mm from the centre of rotation along the axis. Voxels beyond it hold 0 or too
     * little. */
    double along_mm[2];
} skg_fdk_report;

SKG_INIT(skg_fdk_report)

/** Begins a reconstruction.
 *
 *     scan      retained. The angles are those of its views about the axis. A full turn needs no weights, unless the
 *               detector is displaced by more than a column (half-fan): then Wang's (Med. Phys. 29 (2002) 1634-1636); from 180
 *               degrees plus the fan on, Parker's weights are used (Med. Phys. 9 (1982) 254-257). A parallel beam needs 180
 *               degrees. What a scan sees once more beyond whole turns, or half turns of a parallel beam, its first and last
 *               projections share. Of a curved detector whose axis goes through the source, columns are at equal
 *               angles (Kak and Slaney 1988, sections 3.4.2 and 3.6)
 *     options   NULL: the defaults
 *     fdk       result; the caller releases it
 *     errors    SKG_ERR_ARGUMENT (an option); SKG_ERR_UNSUPPORTED if the scan is not circular (it may move along the
 *               axis by a row, or 2 % of all rows, as seen at the axis), if its range is too short,
 *               if the axis leans against the detector's columns or the beam by more than 5.7 degrees, or of other curved detectors */
SKG_API skg_status skg_fdk_create(skg_scan *scan, const skg_fdk_options *options, skg_fdk **fdk);

/** Frees a reconstruction. */
SKG_API void skg_fdk_release(skg_fdk **fdk);

/** Adds a projection: weights and filters it, and projects it back. All threads of OpenMP are used, and the sum does
 * not depend on their number.
 *
 *     index   of the projection; each one once, in any order
 *     image   [row][column] of -ln(I / I0), finite
 *     errors  SKG_ERR_CANCELLED: the projection was not added; SKG_ERR_ARGUMENT (the index, or a pixel that is not finite),
 *             SKG_ERR_MEMORY */
SKG_API skg_status skg_fdk_add(skg_fdk *fdk, int64_t index, const float *image);

/** Gets what the detector saw, of the projections that were added so far. */
SKG_API skg_status skg_fdk_report_get(const skg_fdk *fdk, skg_fdk_report *report);

/** Gets the volume, 1/cm: [z][y][x]. It is valid as long as the reconstruction. */
SKG_API skg_status skg_fdk_volume_get(const skg_fdk *fdk, const float **volume);

/** Writes the volume as MetaImage, with its place in the scene. Errors: SKG_ERR_ARGUMENT if the path does not end in
 * .mha, SKG_ERR_OUTPUT. */
SKG_API skg_status skg_fdk_save(const skg_fdk *fdk, const char *path);

#ifdef __cplusplus
}
#endif
#endif
