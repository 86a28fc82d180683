/** @file
 * Scans: where source and detector are in each projection of a CT scan, and when. A scan is geometry only; it
 * knows neither parts nor beam. Scene files describe one under the key Scan (docs/scene-files.md), and
 * skg_setup_scan_get gives it. scan_run.h computes the projections.
 *
 * A scan describes turning samples in front of a source and a detector that stand still. Its views turn
 * source and detector the other way, which gives the same images.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SCAN_H
#define SKIAGRAPH_SCAN_H

#include <skiagraph/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The projections of a scan. */
typedef struct skg_scan skg_scan;

/** How a scan moves. Prepare with skg_scan_options_init: one projection, no rotation, axis z through the
 * origin, an ideal detector. Angles are counter-clockwise as seen from the tip of the axis.
 *
 * - Circular: step_rad. A half scan has a range of 180 degrees plus the fan (skg_scan_short_range_get).
 * - Helical: also pitch_mm.
 * - Laminography: the axis is oblique to the beam.
 * - Tomosynthesis: source_travel_mm for a source on a line; detector_fixed for a source on an arc.
 *
 * Projection k of n has the angle a = start_rad + k step_rad. Its view is the view of the scan with the
 * detector displaced, turned by -a about the axis, moved by -pitch_mm (a - start_rad) / (2 pi) along the axis,
 * and finally displaced by travel, drift and jitter. The displacements of jitter are in the axes of the
 * world. */
typedef struct {
    /** Set by skg_scan_options_init. */
    int32_t size;
    /** 1: the detector stays, and only the source turns and travels. */
    int32_t detector_fixed;
    /** Number of projections, 1 to 10,000,000. */
    int64_t projections;
    /** Angle of the first projection. */
    double start_rad;
    /** Angle from one projection to the next; may be negative. */
    double step_rad;
    /** Direction of the axis of rotation; any length but 0. */
    double axis[3];
    /** A point on the axis, mm. */
    double centre[3];
    /** How far the samples move along the axis in a full turn, mm. */
    double pitch_mm;
    /** From the source of the first projection to that of the last, mm; the middle is where the view has it. */
    double source_travel_mm[3];
    /** Displacement of the detector along its columns' step and its rows' step, mm. */
    double detector_offset_mm[2];
    /** Rotation of the detector about its centre: about the direction of its columns' step, then of its rows'
     * step, then of its normal (columns' step x rows' step), each as they are before the rotation. */
    double detector_tilt_rad[3];
    /** By how much the rows' step leans towards the columns' step; -1.2 to 1.2. */
    double detector_skew_rad;
    /** How far the source is displaced in the last projection, mm; growing from 0 in the first. */
    double source_drift_mm[3];
    /** How far the detector is displaced in the last projection, mm; growing from 0 in the first. */
    double detector_drift_mm[3];
    /** Standard deviation of a random displacement of the source along x, y and z, mm. */
    double source_jitter_mm;
    /** Standard deviation of a random displacement of the detector along x, y and z, mm. */
    double detector_jitter_mm;
    /** Standard deviation of a random error of the angle. */
    double angle_jitter_rad;
    /** Seed of the jitter. It decides the jitter of each projection, whatever the others are. */
    int64_t jitter_seed;
    /** Time of the first projection, s. */
    double start_s;
    /** Time from one projection to the next, s; 0 or more. */
    double interval_s;
    /** How long a projection is exposed, s; its time is the middle of the exposure. 0 (an instant) to
     * interval_s. */
    double exposure_s;
} skg_scan_options;

SKG_INIT(skg_scan_options)

/** Makes a scan.
 *
 *     view      copied: source and detector at angle 0
 *     options   copied
 *     scan      result; the caller releases it
 *     errors    SKG_ERR_SCENE (the view cannot be imaged), SKG_ERR_ARGUMENT with the option that is out of
 *               range */
SKG_API skg_status skg_scan_create(const skg_view *view, const skg_scan_options *options, skg_scan **scan);

/** Makes a scan from a table of poses, such as the calibrated ones of a C-arm.
 *
 *     view      copied: kind of projection, numbers of columns and rows
 *     options   copied: the times, offset, tilt and skew of the detector, drift and jitter of positions. Options
 *               of the rotation give the nominal angles only, and the number of projections has no effect. NULL: the
 *               defaults
 *     count     number of projections, 1 to 10,000,000
 *     poses     [count][12]: x, y, z of source, centre of the detector, step of its columns and of its rows,
 *               mm; copied
 *     scan      result; the caller releases it
 *     errors    SKG_ERR_SCENE with the projection whose view cannot be imaged */
SKG_API skg_status skg_scan_create_table(const skg_view *view, const skg_scan_options *options, int64_t count,
                                         const double *poses, skg_scan **scan);

/** Reads a table of poses from a text file: a line for each projection with the 12 numbers of
 * skg_scan_create_table, separated by commas, semicolons or blanks. Empty lines, lines that begin with # and
 * headings are skipped. This is also the layout of ASTRA's cone_vec. A 13th number, the same in every line, is the radius of a
 * curved detector, instead of that of the view (cyl_cone_vec of ASTRA). A comment before them that begins with "parallel beam", as
 * skg_scan_geometry_save writes it, makes the projection parallel whatever that of the view; with "from infinity" the first three
 * numbers are the direction of the rays (parallel3d_vec of ASTRA).
 *
 *     errors   SKG_ERR_FILE, SKG_ERR_FORMAT with the line, and as of skg_scan_create_table */
SKG_API skg_status skg_scan_load_table(const skg_view *view, const skg_scan_options *options,
                                       const char *path, skg_scan **scan);

/** Reads the scan of a Nikon .xtekct file. Lengths are in mm, angles in degrees.
 *
 * The frame is that of CIL's NikonDataReader with the axis of rotation through the origin: the beam goes along y, z is up, columns
 * count against x and rows against z, and projection k has the angle 180 - InitialAngle - k AngularStep. Read are Projections, DetectorPixelsX and Y, DetectorPixelSizeX and Y, SrcToObject, SrcToDetector, InitialAngle,
 * AngularStep, and ObjectOffsetX, ObjectRoll, ObjectTilt, or CentreOfRotationTop and Bottom instead. Angles that were measured (.ang,
 * _ctdata.txt) are not read.
 *
 *     white_level   result: WhiteLevel, the value of the projections without object; 0: the file has none; NULL: not wanted
 *     folder        result: [size] bytes, InputFolderName, where the projections are, from the file's own folder on; empty: there;
 *                   NULL: not wanted
 *     scan          result; the caller releases it
 *     errors        SKG_ERR_FILE; SKG_ERR_FORMAT with the key that is missing or has no possible value; SKG_ERR_UNSUPPORTED for
 *                   another key of source, detector, object or axis that is not 0, such as DetectorOffsetX, which
 *                   CIL does not use */
SKG_API skg_status skg_scan_load_xtekct(const char *path, double *white_level, char *folder, int64_t size,
                                        skg_scan **scan);

/** Makes a scan of some projections of another one, such as those of a phase of the breath.
 *
 *     whole     retained
 *     count     number of projections, at least 1
 *     indices   [count] their numbers in `whole`; copied
 *     scan      result; the caller releases it
 *     errors    SKG_ERR_ARGUMENT (a number) */
SKG_API skg_status skg_scan_create_subset(skg_scan *whole, int64_t count, const int64_t *indices,
                                          skg_scan **scan);

/** Adds an owner to a scan. */
SKG_API skg_status skg_scan_retain(skg_scan *scan);

/** Removes an owner; the last one frees the scan. */
SKG_API void skg_scan_release(skg_scan **scan);

/** Number of projections of a scan. */
SKG_API skg_status skg_scan_projection_count(const skg_scan *scan, int64_t *count);

/** Gets the view of a projection, as it is in the middle of its exposure: skg_plan_view_set takes it, and skg_frame
 * points to one.
 *
 *     index    0 <= index < number of projections
 *     view     in and out: prepared with skg_view_init
 *     errors   SKG_ERR_ARGUMENT (index) */
SKG_API skg_status skg_scan_view_get(const skg_scan *scan, int64_t index, skg_view *view);

/** Gets the view at a position between projections: 2.5 is the middle between projections 2 and 3. Jitter, the
 * pose in a table of poses, and all of a subset, are those of the nearest projection.
 *
 *     position   -0.5 to the number of projections
 *     view       in and out: prepared with skg_view_init */
SKG_API skg_status skg_scan_view_at(const skg_scan *scan, double position, skg_view *view);

/** Gets the nominal angle of a projection. */
SKG_API skg_status skg_scan_angle_get(const skg_scan *scan, int64_t index, double *angle_rad);

/** Gets the axis about which a scan turns.
 *
 *     axis     result: [3] direction, of length 1
 *     centre   result: [3] a point on it, mm
 *     errors   SKG_ERR_UNSUPPORTED if the scan is a table of poses */
SKG_API skg_status skg_scan_axis_get(const skg_scan *scan, double *axis, double *centre);

/** Gets when a projection is exposed, s.
 *
 *     middle_s     result: the middle of the exposure
 *     exposure_s   result: its length; 0 is an instant; may be NULL */
SKG_API skg_status skg_scan_time_get(const skg_scan *scan, int64_t index, double *middle_s,
                                     double *exposure_s);

/** Gets the shortest range of a circular scan that reconstruction can use: 180 degrees plus the angle of the
 * fan, which the detector has about the axis.
 *
 *     view        a point source
 *     options     axis and centre
 *     range_rad   result: from the first to the last projection
 *     errors      SKG_ERR_SCENE if the beam is parallel or the source is on the axis */
SKG_API skg_status skg_scan_short_range_get(const skg_view *view, const skg_scan_options *options,
                                            double *range_rad);

/** Writes the geometry of a scan for reconstruction tools.
 *
 *     path     .csv: the table of skg_scan_load_table, which is the cone_vec of ASTRA without its first line
 *              .xml: the geometry of RTK (ThreeDCircularProjectionGeometry). The projections have to be read
 *              with the spacing of the detector and their centre at the origin, as our stacks have them. RTK
 *              turns about y: the volume that it reconstructs has the centre of rotation as its origin, y
 *              along the axis, z towards the source at angle 0, and x = y x z. Of a table of poses it has the
 *              axes of the scene
 *              .tigre.py: a Python file that makes `geo` and `angles` for TIGRE. z of the volume runs along the axis, from
 *              the detector's first row to its last one, and x to the source at angle 0. All kinds of scans of point sources
 *              are written; each projection has its own distances, offsets and rotation of the detector
 *              transforms.json: cameras of NeRF and Gaussian splatting (instant-ngp, nerfstudio): x along the columns, y against
 *              the rows, z from the scene to the source, in mm and in the axes of the scan; point sources only.
 *              .cil.py: a Python file that makes `geometry` for CIL (AcquisitionGeometry). z as for TIGRE, y from the source
 *              to the axis. Scans that only turn are Cone3D or Parallel3D; others have positions and directions for each
 *              projection (Cone3D_SOUV)
 *     errors   SKG_ERR_ARGUMENT (extension), SKG_ERR_OUTPUT; SKG_ERR_UNSUPPORTED for a view that a tool cannot express: a
 *              parallel beam (RTK, TIGRE, and CIL if the scan does more than turn), a detector that is skewed (all but .csv)
 *              or seen from behind (RTK), pixels of different sizes (TIGRE, CIL) */
SKG_API skg_status skg_scan_geometry_save(const skg_scan *scan, const char *path);

/** Writes the geometry with a note at the end, such as where the flat fields are: a comment of .csv, .xml and .py; transforms.json has
 * none.
 *
 *     note   one line of up to 1000 bytes; NULL: none */
SKG_API skg_status skg_scan_geometry_save_noted(const skg_scan *scan, const char *path, const char *note);

#ifdef __cplusplus
}
#endif
#endif
