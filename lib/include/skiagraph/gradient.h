/** @file
 * Gradients: the derivative of a number that depends on an image, such as the difference from a measured one, by the
 * poses of parts, by source and detector, by vertices and by densities.
 *
 * The caller says how the number, the loss, changes with each value of the image (skg_adjoint). One pass over the
 * triangles then gives its derivative by everything else, in the time of some images, however much moves. It is the derivative of the
 * image as it is computed: of the path lengths of the rays to the centres of the pixels, or to all samples of pixel and
 * source, with the energies and planes that the plan chose. Noise and the steps of the detector count as constant.
 *
 *     method    A ray's hit with a face moves by b_k (n . dv_k) / (n . d) when corner k of the face moves by dv_k, with the
 *               barycentric coordinate b_k of the hit, the face's normal n and the ray's direction d. So the derivative of a path
 *               length is a signed sum over its hits. Lengths through closed meshes are continuous across silhouettes,
 *               which need no term of their own (docs/numerics.md)
 *     edges     A face that contains rays, such as the side of a box in a parallel beam, is hit by none, but the mean of a pixel
 *               changes with its place. Faces narrower than 1e-4 pixels in the image add the derivative of that mean. Of a part
 *               that competes by priority they count where the part wins, less what it takes from others there
 *     bits      Sums over hits are integers: they depend neither on the strategy nor on the number of threads
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_GRADIENT_H
#define SKIAGRAPH_GRADIENT_H

#include <skiagraph/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The derivative of a loss by every value of an image: [channel][row][column], dense. Prepare with skg_adjoint_init:
 * double. */
typedef struct {
    /** Set by skg_adjoint_init. */
    int32_t size;
    /** enum skg_type: SKG_TYPE_FLOAT32 or SKG_TYPE_FLOAT64 */
    int32_t type;
    /** Number of channels; it must be the image's. */
    int64_t channels;
    /** Number of rows; it must be the image's. */
    int64_t rows;
    /** Number of columns; it must be the image's. */
    int64_t columns;
    /** The caller's memory; it is read before the call that submits returns. */
    const void *data;
    /** A cl_mem of the plan's context that holds it instead of data (opencl.h); NULL: data. */
    void *buffer;
    /** Byte of the buffer at which it begins. */
    int64_t offset;
} skg_adjoint;

SKG_INIT(skg_adjoint)

/** Parameters of a gradient, and the caller's memory that receives its components, each array written as a whole. Prepare with
 * skg_gradient_init: no parameters.
 *
 * A twist is (tx, ty, tz in mm, rx, ry, rz in radians), in world axes about the world's origin: a body with the pose T moves to
 * exp(twist) T. */
typedef struct {
    /** Set by skg_gradient_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** [parts][6] by the twist of each part alone, per mm and per radian; NULL: not wanted. Parts inside it do not move with
     * it. NaN of volumes of cells, which have no derivative by their place. */
    double *poses;
    /** [3] by the position of the source, per mm; in a parallel beam from infinity, by its direction. The pixels stay. NULL:
     * not wanted. */
    double *source;
    /** [6] by the twist of the detector, per mm and per radian. The source stays. NULL: not wanted. */
    double *detector;
    /** [parts] by the positions of the mesh of each part, per mm in the mesh's own axes: [vertices][3], or NULL for parts of which
     * they are not wanted. NULL: of no part. The derivative of a place is divided evenly among the vertices that stand there.
     * Parts that share a mesh each have their own; the sum is that of the mesh. */
    double *const *vertices;
    /** [parts] by the density of each part over that of its material, or of all cells of a volume over their own; NULL: not wanted. In a
     * world, for frames with densities of their own, and for parts that compete by priority or displace a volume it costs an image of
     * path lengths a part; of a volume, an image for each of its planes. */
    double *densities;
    /** [parts][nodes] by the attenuation coefficient of the material of each part at each energy of the plan (skg_plan_node_count,
     * skg_plan_node_get), per 1/cm; NULL: not wanted. It costs an image of path lengths a part, and for each energy a pass over the
     * image and 8 bytes for each of its rays. NaN of volumes of cells, which have no common coefficient. A pixel of an attenuation above 87, in precision double above 700, counts as
     * constant if the plan has several energies. */
    double *attenuations;
    /** Number of energies that `attenuations` has memory for: that of the plan. */
    int64_t nodes;
} skg_gradient;

SKG_INIT(skg_gradient)

/** Starts the gradient of a loss for one frame: a job like those of frame.h, with skg_job_wait, skg_job_test, skg_job_progress, which
 * counts the samples of the source and rays of a pixel that are drawn apart, and skg_job_cancel.
 *
 *     frame      the frame whose image the adjoint belongs to; NULL: as plan and scene stand
 *     adjoint    d loss / d image
 *     gradient   what is wanted, and where it goes: filled when the job was waited for. Undefined if the job fails or was cancelled
 *     job        result
 *     sums       the device is given the frame as far as its sums, and its image where the quantity is -ln of a mean; nothing if the
 *                same frame was rendered just before, whose sums are taken. All else alternates between device and host, and is done
 *                while the job is asked or waited for, or when another job is submitted to the context: each of these calls may
 *                last as long as a pass
 *     waits      for the number of hits, if parts compete by priority, and for the self-test, the first time; for nothing else
 *     snapshot   frame, scene and an adjoint in host memory may be changed when the call returns. An adjoint in a cl_mem is read in the
 *                order of the context's queue; whether its values are finite is known when the job is waited for
 *     errors     SKG_ERR_ARGUMENT if the adjoint has another size than the image, a value that is not finite, or a largest
 *                magnitude that is not 0 and below 1e-30 or above 1e30;
 *                SKG_ERR_UNSUPPORTED, with the reason, for half precision, scatter, leaky meshes, parts that reach the plane of
 *                the source, positions set on the device, and ratios to a flat field that differs from pixel to pixel if
 *                they have noise or steps; for source and detector also for the heel effect, a bow-tie filter, a grid, an
 *                oblique scintillator, jaws, and a world with ratios or in a parallel beam; beside volumes of cells for source,
 *                detector and the vertices of the volume, and for everything if the values of one are linear between its cells
 *     range      SKG_RANGE if a derivative by a path length is not finite
 *     stale      SKG_STALE as skg_plan_submit */
SKG_API skg_status skg_plan_gradient_submit(skg_plan *plan, const skg_frame *frame,
                                            const skg_adjoint *adjoint, const skg_gradient *gradient,
                                            skg_job **job);

/** Makes the gradient of a loss for one frame: skg_plan_gradient_submit and skg_job_wait. */
SKG_API skg_status skg_plan_gradient(skg_plan *plan, const skg_frame *frame, const skg_adjoint *adjoint,
                                     const skg_gradient *gradient);

/** A direction: how fast parts, vertices, source and detector move, and how fast matter changes. Prepare with skg_direction_init:
 * nothing changes. Twists, axes and units are those of skg_gradient. All numbers have to be finite. */
typedef struct {
    /** Set by skg_direction_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** [parts][6] the twist of each part; NULL: none moves. */
    const double *poses;
    /** [3] of the source; NULL: it stays. */
    const double *source;
    /** [6] the twist of the detector; NULL: it stays. */
    const double *detector;
    /** [parts] of the positions of the mesh of each part: [vertices][3], or NULL for parts whose vertices stay. NULL: of no part. */
    const double *const *vertices;
    /** [parts] of the density of each part over that of its material; NULL: none changes. It costs an image of path lengths for each
     * part whose number is not 0. */
    const double *densities;
    /** [parts][nodes] of the attenuation coefficient of the material of each part at each energy of the plan, 1/cm; NULL: none
     * changes. Likewise, and for each energy a pass over the image and 16 bytes for each of its rays. */
    const double *attenuations;
    /** Number of energies of `attenuations`: that of the plan (skg_plan_node_count). */
    int64_t nodes;
} skg_direction;

SKG_INIT(skg_direction)

/** Starts the derivatives of a frame's image along directions, of which further ones cost less than the first: a job as
 * skg_plan_gradient_submit starts.
 *
 *     frame         NULL: as plan and scene stand
 *     count         of directions, at least 1
 *     directions    [count] what moves or changes; they may be changed when the call returns
 *     derivatives   where they go when the job was waited for: an output of the kind SKG_OUTPUT_IMAGE whose frames are the directions,
 *                   [direction][channel][row][column], in the plan's quantity for a unit of the direction; its frame_stride leads from a
 *                   direction to the next. They are computed in double: SKG_TYPE_FLOAT64 needs no fp64 of the device,
 *                   SKG_TYPE_FLOAT32 has the same numbers rounded, and dense doubles in host memory need no memory beside. The job may
 *                   write there until then. Undefined if it fails or was cancelled
 *     saturated     result: [directions] number of slopes of faces at their corners that were cut off at 2^24 times the mean
 *                   slope, because the sums over hits are 64-bit integers; may be NULL
 *     memory        while the job runs, 8 bytes for each ray and plane of a direction with densities, and for each ray and energy of
 *                   one with attenuations
 *     limits        as above: faces that contain rays change the means of their pixels
 *     job           result
 *     errors        as of skg_plan_gradient_submit; SKG_ERR_ARGUMENT for fewer than one direction, for numbers that are not
 *                   finite, and for an output of another kind or one that does not hold the directions; SKG_ERR_UNSUPPORTED also for a
 *                   blur that depends on depth, and for a volume of cells that
 *                   moves, or whose attenuation coefficients change */
SKG_API skg_status skg_plan_derivatives_submit(skg_plan *plan, const skg_frame *frame, int64_t count,
                                               const skg_direction *directions, const skg_output *derivatives,
                                               int64_t *saturated, skg_job **job);

/** Makes the derivatives of a frame's image along directions: skg_plan_derivatives_submit and skg_job_wait. */
SKG_API skg_status skg_plan_derivatives(skg_plan *plan, const skg_frame *frame, int64_t count,
                                        const skg_direction *directions, const skg_output *derivatives,
                                        int64_t *saturated);

#ifdef __cplusplus
}
#endif
#endif
