/* The eye of the 3D view. Its matrices are float, by cglm; X-ray images never pass through them. Private. */
#ifndef SKG_SHOW_CAMERA_H
#define SKG_SHOW_CAMERA_H

#include "core/core.h"

#include <skiagraph/scene_picture.h>
#include <skiagraph/types.h>

typedef struct {
    double centre[3];  /* mm: where the axis of the eye passes the scene; positions are relative to it */
    double axes[3][3]; /* right, up and towards the eye, length 1 */
    double pixel;      /* mm that a pixel covers at the centre */
    double distance;   /* mm from the eye to the centre */
    double
        nearest; /* what is less than this in front of the eye is not drawn, mm; 0: everything is in the picture */
    float matrix[16]; /* from positions to clip coordinates, column after column */
} skg_show_camera;

/* Where the beam starts that meets a point of the detector: the source, or a point from which a parallel ray passes all
 * `low` to `high`. */
void skg_show_beam_start(const skg_view *view, const double low[3], const double high[3], const double at[3],
                         double start[3]);

/* A corner of the detector's area: of the edge of pixels, not of their centres. column, row: 0 or 1. */
void skg_show_detector_corner(const skg_view *view, int column, int row, double corner[3]);

/* Where the edges of the beam meet the plane of the detector, in turn around it. Errors: of skg_collimation_corners_get. */
skg_status skg_show_beam_corners(const skg_view *view, const skg_look *look, double corners[4][3]);

/* Places the eye as the look says, or so that everything is in the picture: the box of the parts (mm), source, detector, path.
 * Errors: SKG_ERR_ARGUMENT for directions that are not finite. */
skg_status skg_show_camera_make(const skg_view *view, const skg_look *look, const double low[3],
                                const double high[3], skg_show_camera *camera);

/* mm that a pixel covers at a point: with a target its size in the picture does not depend on the depth, otherwise that at the
 * centre. */
double skg_show_camera_pixel(const skg_show_camera *camera, const double point[3]);

/* mm that a point lies in front of the eye. */
double skg_show_camera_depth(const skg_show_camera *camera, const double point[3]);

/* Column and row of a point in the picture. */
void skg_show_camera_place(const skg_show_camera *camera, const skg_look *look, const double point[3],
                           double place[2]);

#endif
