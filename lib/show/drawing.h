/* The 3D view: camera, model, markers. Private. */
#ifndef SKG_DRAWING_H
#define SKG_DRAWING_H

#include "core/core.h"
#include "scene/scene.h"

#include <skiagraph/scene_picture.h>
#include <skiagraph/types.h>

/* --- The eye of the 3D view. Its matrices are float, by cglm; X-ray images never pass through them. */

typedef struct {
    double centre[3];  /* mm: where the axis of the eye passes the scene; positions are relative to it */
    double axes[3][3]; /* right, up and towards the eye, length 1 */
    double pixel;      /* mm that a pixel covers at the centre */
    double distance;   /* mm from the eye to the centre */
    /* what is less than this in front of the eye is not drawn, mm; 0: everything is in the picture */
    double nearest;
    float matrix[16]; /* from positions to clip coordinates, column after column */
} skg_show_camera;

/* Where the beam starts that meets a point of the detector: the source, or a point from which a parallel ray passes all
 * `low` to `high`. */
void skg_show_beam_start(const skg_view *view, const double low[3], const double high[3], const double at[3],
                         double start[3]);

/* A place on the detector's area, in widths and heights: 0 and 1 are the edges of pixels, not their centres. */
void skg_show_detector_place(const skg_view *view, double column, double row, double place[3]);

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

/* --- The 3D view as triangles for the device */

/* A red, green, blue and opacity from 0 to 255 in one number, red lowest. */
#define SKG_SHOW_COLOUR(red, green, blue, opacity)                                                           \
    ((uint32_t)(red) | (uint32_t)(green) << 8 | (uint32_t)(blue) << 16 | (uint32_t)(opacity) << 24)

/* Triangles that grow while they are added. All zero: none. */
typedef struct {
    double centre[3]; /* mm; positions are relative to it */
    float *positions; /* [vertices][3] */
    int32_t *corners; /* [triangles][3] */
    /* [triangles][3][4] of each corner, times 32767; of the detector places in the image, times 16384 */
    int16_t *normals;
    uint32_t *colours; /* [triangles] SKG_SHOW_COLOUR */
    int64_t vertices, triangles;
    int64_t sections; /* the first triangles, whose inside is drawn without shading */
    int64_t images;   /* the last triangles, which show the detector's image */
    int64_t vertex_capacity, triangle_capacity;
} skg_show_model;

void skg_show_model_free(skg_show_model *model);

/* Makes room for so many vertices and triangles more. SKG_ERR_SCENE beyond 2^31 / 3 of either. */
skg_status skg_show_model_reserve(skg_show_model *model, int64_t vertices, int64_t triangles);

/* Adds a vertex (mm, in the world), for which there is room. */
void skg_show_model_add_vertex(skg_show_model *model, const double position[3]);

/* Adds a triangle of vertices that are there, for which there is room. normals: [3][3] of length 1 at its corners. */
void skg_show_model_add_triangle(skg_show_model *model, const int64_t corners[3], double normals[3][3],
                                 uint32_t colour);

/* --- The parts of a scene as triangles of the 3D view. */

/* Adds every part whose opacity in look->colours is not 0, as far as the look's cut and the eye leave it.
 *
 * errors    SKG_ERR_SCENE if a vertex is not finite */
skg_status skg_show_parts_add(skg_show_model *model, const skg_scene *scene, const skg_look *look,
                              const skg_show_camera *camera);

/* The pose of a part: the look's, or the scene's. */
const double *skg_show_pose_of(const skg_scene *scene, const skg_look *look, int64_t part);

/* Widens a box (mm, in the world) by a mesh at a pose: by the corners of the mesh's own box. */
void skg_show_part_bounds(const skg_mesh *mesh, const double *pose, double low[3], double high[3]);

/* --- Triangles of the 3D view that planes cut. */

/* Of the triangles from `first` on, removes what lies beyond a plane: points p with dot(plane, p) > plane[3], mm in the world.
 * Triangles that cross it are cut; what is left of them stays in order, but for second triangles, which come last. */
skg_status skg_show_clip(skg_show_model *model, int64_t first, const double plane[4]);

/* Likewise what is nearer to the eye than camera->nearest, or behind it. */
skg_status skg_show_clip_near(skg_show_model *model, const skg_show_camera *camera, int64_t first);

/* --- Draws the triangles of the 3D view on the device. */

/* Draws and waits. image: [image_rows][image_columns] grey values of the detector. rgba: as skg_scene_picture. */
skg_status skg_show_draw(skg_context *context, const skg_show_model *model, const skg_show_camera *camera,
                         const skg_look *look, int64_t image_columns, int64_t image_rows,
                         const uint8_t *image, uint8_t *rgba);

/* --- Objects of the 3D view besides the parts: source, beam, detector, axes, path */

/* Adds everything but the parts. low, high: the box of the parts, mm. The two triangles of the detector come last, as
 * the kernel wants them. */
skg_status skg_show_markers_add(skg_show_model *model, const skg_view *view, const skg_look *look,
                                const skg_show_camera *camera, const double low[3], const double high[3]);

/* Adds a triangle of the detector's area, likewise. places: [3][2] fractions of the image's width and height at its corners. */
void skg_show_model_add_image(skg_show_model *model, const int64_t corners[3], double places[3][2]);

#endif
