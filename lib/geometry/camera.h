/* Source and detector as the kernels see them: the matrix that takes world coordinates to pixels and path
 * parameter. Private.
 *
 * Point source S, pixel centres D0 + i Du + j Dv: h = [Du Dv D0-S]^-1 (V - S) = (t i, t j, t), where t is 0
 * at the source and 1 at the pixel. Parallel beam along d: h = [Du Dv d]^-1 (V - D0) = (i, j, t - 1). */
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
    double determinant;  /* of its inverse: its sign is the handedness of the picture */
    double first[3];     /* from S to the centre of pixel (0, 0); with a parallel beam: d */
    double column[3], row[3];
    double start[3]; /* parallel: paths start at t = start[0] + start[1] i + start[2] j */
} skg_camera;

/* A view's camera. source: another point to look from (a sample of an extended source), NULL for the view's
 * own; ignored by parallel beams. shift_column, shift_row: sub-pixel sample, in pixels. SKG_ERR_SCENE where
 * the view is degenerate. */
skg_status skg_camera_make(const skg_view *view, const double *source, double shift_column, double shift_row,
                           skg_camera *camera);

/* h of a world point. */
void skg_camera_see(const skg_camera *camera, const double world[3], double h[3]);

/* Fills what a part's entry knows of the picture (not its place in the tables, not its writes, not what is steep). pose: 4x4,
 * row by row; origin: of the mesh's offsets, mm; reference: as of skg_geometry_part; flipped: the mesh is
 * drawn with its triangles turned round. */
void skg_camera_part(const skg_camera *camera, const double *pose, const double *origin, double reference,
                     int32_t flipped, skg_part_double *part);

/* mm2 of a pixel. */
double skg_camera_pixel_area(const skg_camera *camera);

/* Point source: mm to the pixel of the detector that is nearest the foot of the perpendicular. */
double skg_camera_nearest_ray(const skg_camera *camera);

/* What sums are multiplied by: lengths of the rays, and 1 / scale. */
void skg_rays_round(const skg_ray_double *from, skg_ray_float *to);
void skg_camera_rays(const skg_camera *camera, double scale, skg_ray_double *ray);

#endif
