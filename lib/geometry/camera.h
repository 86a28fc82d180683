/* Source and detector as the kernels use them: the matrix from world coordinates to pixels and path parameter.
 * Private.
 *
 * For a point source S and pixel centres D0 + i Du + j Dv, a point V has h = [Du Dv D0-S]^-1 (V - S) = (t i, t j, t),
 * where t is 0 at the source and 1 at the pixel. For a parallel beam along d, h = [Du Dv d]^-1 (V - D0) =
 * (i, j, t - 1). */
#ifndef SKG_CAMERA_H
#define SKG_CAMERA_H

#include "core/core.h"
#include "skg_shared.h"

#include <skiagraph/scene.h>

typedef struct {
    int32_t parallel; /* 1 or 0 */
    int64_t columns, rows;
    double origin[3];    /* S, or D0 with a parallel beam */
    double matrix[3][3]; /* of h */
    double determinant;  /* of the inverse of the matrix; its sign is the handedness of the picture */
    double first[3];     /* from S to the centre of pixel (0, 0); with a parallel beam: d */
    double column[3], row[3];
    double corner[3]; /* from the detector's centre to the centre of pixel (0, 0) */
    double start[3];  /* parallel: paths start at t = start[0] + start[1] i + start[2] j */
} skg_camera;

/* Makes the camera of a view.
 *
 * source         another point to look from, such as a sample of an extended source; NULL: that of the view; ignored
 *                by parallel beams
 * shift_column   offset of the rays from the centres of the pixels, in pixels; shift_row likewise
 * errors         SKG_ERR_SCENE if the view is degenerate */
skg_status skg_camera_make(const skg_view *view, const double *source, double shift_column, double shift_row,
                           skg_camera *camera);

/* h of a world point. */
void skg_camera_see(const skg_camera *camera, const double world[3], double h[3]);

/* Fills the projection of a part's entry (skg_shared.h), but neither its place in the tables, nor its contributions, nor which
 * of its faces are steep, nor how far edges are moved.
 *
 * pose        4x4, row by row
 * origin      of the offsets of the mesh, mm
 * reference   the path parameter that depths of the part are relative to
 * flipped     the triangles of the mesh are turned over */
void skg_camera_part(const skg_camera *camera, const double *pose, const double *origin, double reference,
                     int32_t flipped, skg_part_double *part);

/* The area of a pixel in mm2. */
double skg_camera_pixel_area(const skg_camera *camera);

/* The distance in mm from a point source to the plane of the detector: to the foot of the perpendicular, which may lie
 * beyond the pixels. */
double skg_camera_foot(const skg_camera *camera);

/* The factors that make lengths of sums: the lengths of the rays, and 1 / scale. */
void skg_camera_rays(const skg_camera *camera, double scale, skg_ray_double *ray);

/* The same in single precision. */
void skg_rays_round(const skg_ray_double *from, skg_ray_float *to);

#endif
