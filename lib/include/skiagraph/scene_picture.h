/** @file
 * A picture of a scene: source, beam, detector and parts, seen from outside. It shows whether everything stands
 * where it should before an X-ray image is computed.
 *
 * Positions are in mm. The picture has perspective unless the look says otherwise, and always holds everything:
 * parts, source, detector and the path of the source.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SCENE_PICTURE_H
#define SKIAGRAPH_SCENE_PICTURE_H

#include <skiagraph/collimation.h>
#include <skiagraph/context.h>
#include <skiagraph/scene.h>
#include <skiagraph/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Largest number of columns and rows of a picture of a scene. */
#define SKG_LOOK_PIXELS_MAX 8192

/** How a picture of a scene is drawn. Prepare with skg_look_init: 1024 x 768 pixels from the side of the source,
 * in perspective, without an image on the detector. */
typedef struct {
    /** Set by skg_look_init. */
    int32_t size;
    /** 1: parallel lines stay parallel; 0: perspective */
    int32_t orthographic;
    /** Number of columns of the picture, 1 to SKG_LOOK_PIXELS_MAX. */
    int64_t columns;
    /** Number of rows of the picture, 1 to SKG_LOOK_PIXELS_MAX. */
    int64_t rows;
    /** Direction from the scene to the eye, of any length. Zero: obliquely from the side of the source. */
    double from[3];
    /** Direction that is up in the picture. Zero: against the detector's rows, so that row 0 is on top. */
    double up[3];
    /** [view.rows][view.columns] grey values that are shown on the detector, dense; NULL: the detector is plain. */
    const uint8_t *image;
    /** [parts][4] red, green, blue and opacity of each part, 0 to 255; opacity 0 leaves a part out. NULL: those of
     * skg_look_colours_get. */
    const uint8_t *colours;
    /** [path_count][3] points of a line to draw, such as the positions of the source in a scan; may be NULL. */
    const double *path;
    /** Number of points of the path. */
    int64_t path_count;
    /** [2][3] least and greatest corner of a box, mm, that the picture shows and where the axes stand, instead of the
     * box of the parts: with the same box, frames of parts that move have the same eye. With it every part may be left
     * out. NULL: the box of the parts. */
    const double *bounds;
    /** Jaws: the beam is drawn as they leave it, and around their opening. NULL: the beam meets the corners of the
     * detector. */
    const skg_collimation *collimation;
    /** [3] point in the middle of the picture, mm. The eye then stands at `distance` from it, wherever the scene is, and
     * nothing behind the eye or directly in front of it is drawn. NULL: everything is in the picture. */
    const double *target;
    /** With a target: mm from the eye to it, above 0. The picture is 2 distance tan(14 degrees) high at the target, with
     * and without perspective. */
    double distance;
    /** [4] a, b, c, d: parts are drawn only where a x + b y + c z is at most d, mm. What is seen of their inside is drawn
     * without shading. NULL: parts are whole. */
    const double *cut;
    /** [3] red, green and blue of the background, 0 to 255; NULL: a light grey. On a dark one, the frame of the detector,
     * the opening of the jaws and the path are light. */
    const uint8_t *background;
    /** [parts][16] poses instead of those of the scene, row by row, mm; NULL: those of the scene. */
    const double *poses;
} skg_look;

SKG_INIT(skg_look)

/** Gets the colours in which parts are drawn unless the look has others. Tissues and metals are coloured by their
 * density; if it is unknown, by that of water with the same attenuation at 70 keV. Parts that attenuate nothing
 * are coloured by their number. A part that holds several others, or the whole scene, is translucent.
 *
 *     colours   result: [parts][4] red, green, blue and opacity, 0 to 255
 *     errors    SKG_ERR_MEMORY */
SKG_API skg_status skg_look_colours_get(const skg_scene *scene, uint8_t *colours);

/** Draws a picture of a scene on the device of the context and waits for it.
 *
 *     look      NULL: as skg_look_init prepares it
 *     rgba      result: [rows][columns][4] red, green, blue and 255, 0 to 255 (sRGB), row 0 on top
 *     errors    SKG_ERR_SCENE (no parts, every part left out, a vertex that is not finite, a view that
 *               skg_view_check refuses, jaws that the view cannot have), SKG_ERR_ARGUMENT (sizes; a direction, target,
 *               cut or pose that is not finite; a distance that is not above 0),
 *               SKG_ERR_DEVICE_MEMORY, SKG_ERR_MEMORY
 *     method    Triangles are sorted into tiles of the picture; in each tile the device keeps the nearest opaque
 *               surface, then adds the translucent ones in front of it, nearest first (depth peeling, Everitt
 *               2001; at most 8 layers). 2 x 2 samples a pixel. The bytes do not depend on the number of threads. */
SKG_API skg_status skg_scene_picture(skg_context *context, const skg_scene *scene, const skg_view *view,
                                     const skg_look *look, uint8_t *rgba);

/** Gets where points of the world appear in the picture that skg_scene_picture draws with the same arguments, for
 * labels.
 *
 *     points    [count][3] mm
 *     places    result: [count][2] column and row; pixel centres are whole numbers
 *     errors    as skg_scene_picture */
SKG_API skg_status skg_scene_places_get(const skg_scene *scene, const skg_view *view, const skg_look *look,
                                        int64_t count, const double *points, double *places);

#ifdef __cplusplus
}
#endif
#endif
