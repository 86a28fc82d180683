/* Source and detector: camera, jaws, samples, exposure. Private. */
#ifndef SKG_OPTICS_H
#define SKG_OPTICS_H

#include "core/core.h"
#include "scene/curve.h"
#include "skg_shared.h"

#include <skiagraph/collimation.h>
#include <skiagraph/plan.h>
#include <skiagraph/scene.h>

/* --- Source and detector as the kernels use them: the matrix from world coordinates to pixels and path parameter.
 * *
 * For a point source S and pixel centres D0 + i Du + j Dv, a point V has h = [Du Dv D0-S]^-1 (V - S) = (t i, t j, t),
 * where t is 0 at the source and 1 at the pixel. For a parallel beam along d, h = [Du Dv d]^-1 (V - D0) =
 * (i, j, t - 1). */

/* How a curved detector lies on the flat one of its camera (geometry/curve.c). */
typedef struct {
    skg_curvature curve;              /* radius 0: the detector is flat */
    double middle_column, middle_row; /* of the detector: that of its middle, with the shift of the rays */
    double first_line, line_step;     /* mm: the edge of the camera's first row; from one to the next */
    double first_place, place_step;   /* mm: of its columns */
    double area;                      /* of a pixel, mm2 */
} skg_bends;

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
    skg_bends bends;  /* curved: the camera's rows are the columns of the detector */
} skg_camera;

/* Whether the detector is curved. */
static inline int skg_camera_is_curved(const skg_camera *camera) {
    return camera->bends.curve.radius > 0;
}

/* Finds the flat detector of a curved one's camera: its columns are the rows of the view. */
void skg_bends_find(const skg_view *view, const double *source, double shift_column, double shift_row,
                    skg_view *flat, skg_bends *bends);

/* The line of a row of a curved detector's camera: y, in rows; how column i stands on it, at i + more (i - middle) + moved; t of its
 * pixels; and what intensities fall by (skg_shared.h). */
typedef struct {
    double y, more, moved, t, fall;
} skg_bent_line;
void skg_bends_row(const skg_camera *camera, double row, skg_bent_line *line);

/* The column about which rows are stretched. */
double skg_bends_middle(const skg_camera *camera);

/* Writes the table of the kernels: SKG_LINES_SIZE(rows) numbers, double or float. */
void skg_bends_table(const skg_camera *camera, int is_double, void *lines);

/* Turns places on the camera's flat detector, from and to, into columns and rows of the raster that may see them. */
void skg_bends_extent(const skg_camera *camera, double columns[2], double rows[2]);

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

/* Where a part stands. */
typedef struct {
    const double *pose;    /* 4x4, row by row */
    const double *origin;  /* of the offsets of the mesh, mm */
    double reference;      /* the path parameter that depths of the part are relative to */
    int32_t flipped;       /* 1: the triangles of the mesh are turned over */
    int32_t exact;         /* 1: the place of the origin has twice the digits on the way */
    const int32_t *shared; /* [2] the pixel that columns and rows are counted from; NULL: the part's own */
} skg_camera_place;

/* Fills the projection of a part's entry (skg_shared.h), but neither its place in the tables, nor its contributions, nor which
 * of its faces are steep, nor how far edges are moved. */
void skg_camera_part(const skg_camera *camera, const skg_camera_place *place, skg_part_double *part);

/* The area of a pixel in mm2. */
double skg_camera_pixel_area(const skg_camera *camera);

/* The distance in mm from a point source to the plane of the detector: to the foot of the perpendicular, which may lie
 * beyond the pixels. */
double skg_camera_foot(const skg_camera *camera);

/* The factors that make lengths of sums: the lengths of the rays, and 1 / scale. */
void skg_camera_rays(const skg_camera *camera, double scale, skg_ray_double *ray);

/* Rounds the factors to single precision. */
void skg_rays_round(const skg_ray_double *from, skg_ray_float *to);

/* --- How much of an absolute beam a view receives. */

/* The microsteradians of a pixel at the foot of the perpendicular from the source to the plane of the detector: what the
 * photons of an absolute spectrum are multiplied by. 1 for a parallel beam, which has no distance. */
double skg_view_exposure(const skg_view *view);

/* --- The field of a beam behind its collimator. */

/* The field of a view's beam: a rectangle in a plane parallel to the detector. */
typedef struct {
    double centre[3];         /* mm, world: where the ray from the source's middle to the detector's centre
                                 crosses the plane; of a parallel beam the detector's centre */
    double column[3], row[3]; /* unit vectors along the detector's column and row steps */
    double low[2], high[2];   /* mm from the centre along them */
} skg_field;

/* Fails with SKG_ERR_ARGUMENT or SKG_ERR_SCENE unless the numbers of a collimation are usable in some view. */
skg_status skg_collimation_check(const skg_collimation *collimation);

/* Whether a collimation stops rays to pixels of its own detector. NULL: it does not. */
int skg_collimation_limits(const skg_collimation *collimation);

/* Finds the field of a view.
 *
 * collimation   NULL or open: the detector's own rectangle (outer edges of the pixels), on the detector's plane
 * errors        SKG_ERR_SCENE if the jaws lie behind the detector, or the margin leaves nothing of its rectangle */
skg_status skg_field_make(const skg_collimation *collimation, const skg_view *view, skg_field *field);

/* Finds the pixels of a camera whose rays pass the field: the columns from window[0] to before window[1] and the rows from
 * window[2] to before window[3], none if an end is not above its first.
 *
 * errors   SKG_ERR_SCENE if the camera's source does not lie before the jaws */
skg_status skg_field_window(const skg_field *field, const skg_camera *camera, int32_t window[4]);

/* --- The ends of rays: samples of the focal spot and of the pixel. */

/* The samples of a plan. With spot_count and shifts 1, and zero otherwise: a point, and the centres of the pixels. */
typedef struct {
    skg_spot spot;      /* of shape SKG_SPOT_POINT if there is none */
    int64_t spot_count; /* samples of the source */
    int64_t shifts;     /* samples along each side of a pixel */
    int64_t fine;       /* of these, how many one pass has pixels for: 1, or `shifts` */
} skg_samples;

/* Reads and checks spot (NULL: a point) and supersampling. spot_count is 1 if it has to be found adaptively. */
skg_status skg_samples_make(const skg_spot *spot, int32_t supersampling, skg_samples *samples);

/* Rays of a pixel. */
int64_t skg_samples_count(const skg_samples *samples);

/* Passes of a frame. Each makes fine x fine rays of a pixel, on a detector of as many times finer pixels. */
int64_t skg_samples_passes(const skg_samples *samples);

/* Sample 0 <= index < count of a view: a point of the source, and the shift from the centre of the pixels in
 * columns and rows. The samples of the pixel run fastest. */
void skg_samples_at(const skg_samples *samples, const skg_view *view, int64_t index, double source[3],
                    double shift[2]);

/* The view on the detector of a pass: the same place, fine times the columns and rows. */
void skg_samples_view(const skg_samples *samples, const skg_view *view, skg_view *fine);

/* Makes the camera of pass 0 <= pass < passes. SKG_ERR_SCENE if the view is degenerate. */
skg_status skg_samples_camera(const skg_samples *samples, const skg_view *view, int64_t pass,
                              skg_camera *camera);

#endif
