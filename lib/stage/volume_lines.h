/* Rays in the axes of a volume, and those of a curved detector on the device. Private. */
#ifndef SKG_VOLUME_LINES_H
#define SKG_VOLUME_LINES_H

#include "device/device.h"
#include "geometry/optics.h"

#include <math.h>

/* The rays of a camera in the axes of a volume, in double. A ray is at base + t way; both change from pixel to pixel. */
typedef struct {
    double base[3][3], way[3][3]; /* of pixel (0, 0), what a column adds, and a row */
} skg_cell_rays;

/* Bits behind the point of path parameters. */
enum { SKG_PATH_BITS = 40 };

static inline SKG_LONG skg_cell_fixed(double x, int32_t bits) {
    return llrint(ldexp(x, bits));
}

/* Whether the paths of a beam come from infinity. */
static inline int32_t skg_starts_nowhere(const skg_camera *camera) {
    return camera->parallel && camera->start[0] < -1e29;
}

/* The lines of a curved detector for a volume (skg_cell_line), as they are uploaded pass for pass. All zero: none. */
enum { SKG_LINE_SLOTS = 4 };
typedef struct {
    skg_buffer memory;
    skg_cell_line *slots[SKG_LINE_SLOTS]; /* each [rows] */
    int64_t rows[SKG_LINE_SLOTS];
    cl_event read[SKG_LINE_SLOTS]; /* of the last write from a slot; NULL: none */
    int32_t slot;                  /* that the device has, if is_there */
    int32_t is_there;
} skg_cell_lines;

/* Uploads the lines of a curved detector unless the device has them; of a flat one there are none. It waits for nothing but the write of
 * SKG_LINE_SLOTS passes ago. */
skg_status skg_cell_lines_write(skg_cell_lines *lines, skg_context *context, const skg_camera *camera,
                                const skg_cell_rays *rays, int32_t bits);
void skg_cell_lines_release(skg_cell_lines *lines);

#endif
