/** @file
 * Reading a finished scan from the .h5 that skg_scan_file wrote, for reconstruction.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SCAN_READER_H
#define SKIAGRAPH_SCAN_READER_H

#include <skiagraph/scan.h>

#ifdef __cplusplus
extern "C" {
#endif

/** An .h5 that is open. */
typedef struct skg_scan_reader skg_scan_reader;

/** Opens a scan.
 *
 *     reader   result; the caller releases it
 *     errors   SKG_ERR_FILE; SKG_ERR_FORMAT if projections or the geometry are missing; SKG_ERR_UNSUPPORTED in a
 *              build without HDF5 */
SKG_API skg_status skg_scan_reader_open(const char *path, skg_scan_reader **reader);

/** Closes a scan. */
SKG_API void skg_scan_reader_release(skg_scan_reader **reader);

/** Gets the views of its projections, which are valid as long as the reader and not retained for the caller. */
SKG_API skg_status skg_scan_reader_scan_get(const skg_scan_reader *reader, skg_scan **scan);

/** Gets the axis of rotation.
 *
 *     axis     result: [3] direction, of length 1
 *     centre   result: [3] a point on it, mm
 *     errors   SKG_ERR_UNSUPPORTED if the scan is a table of poses */
SKG_API skg_status skg_scan_reader_axis_get(const skg_scan_reader *reader, double *axis, double *centre);

/** Reads a projection as -ln(I / I0). I0 is the mean flat field; the mean dark field is subtracted from both. Where
 * less than a millionth of I0 arrives, that is assumed, and where the flat field is not above the dark field, too.
 *
 *     image    result: [row][column]
 *     errors   SKG_ERR_ARGUMENT (index), SKG_ERR_FILE */
SKG_API skg_status skg_scan_reader_attenuation_get(skg_scan_reader *reader, int64_t index, float *image);

#ifdef __cplusplus
}
#endif
#endif
