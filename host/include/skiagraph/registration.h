/** @file
 * Registration: moves a body of a scene, or source and detector, until its images agree with radiographs.
 *
 *     skg_registration_create(context, scene, spectrum, &plan_options, NULL, &registration);
 *     skg_registration_part_add(registration, spine);
 *     skg_registration_image_add(registration, &frontal);
 *     skg_registration_image_add(registration, &lateral);
 *     skg_registration_run(registration);
 *     skg_registration_result_get(registration, &result);
 *
 *     method    Levenberg and Marquardt on the derivatives of the images (gradient.h), with H. B. Nielsen's damping
 *               (IMM-REP-1999-05, Technical University of Denmark), on a pyramid of images whose pixels are means of 2, 4, ...
 *               pixels as transmission; the model's rays are means as well. Steps of more than 15 mm are cut
 *     model     of SKG_REGISTRATION_LOSS_LSQ: -ln(exp(-(b + h (b - a) + r + sum of g s + P c)) + P d), where b is the attenuation of the
 *               parts that move with what they lie inside, a that of the latter alone, r that of the rest, and s are shares of what does
 *               not move, all rendered once: what the parts lie inside, with volumes of cells; light, soft and dense materials (by
 *               their attenuation: below 0.7 of water's, above 1.08 of it). P are polynomials over the image, of order 2, at the finest
 *               level of several of order 4. c takes what adds to the attenuation (tissue that the scene lacks, another gain), d what
 *               adds to the transmission (scatter), g and h other densities and energies. They are found with the pose, h only where
 *               it explains more than noise does (25 of its squares for each radiograph). Where source or detector
 *               are free, g and h are 0. 1e-4 is added to the transmissions of model and radiograph
 *     energy    one: that of the spectrum, or the one at which the scene attenuates as it does with the spectrum
 *     detector  noise, blur, steps, scatter, jaws, focal spot, heel, bow-tie filter and grid of the plan's options are left out
 *
 * Lengths are in mm, angles in radians. A registration is used by one thread at a time.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_REGISTRATION_H
#define SKIAGRAPH_REGISTRATION_H

#include <skiagraph/plan.h>
#include <skiagraph/progress.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A registration: what moves, the radiographs, and what was found. */
typedef struct skg_registration skg_registration;

/** Unknowns of a registration. The geometry, source or detector or both, is one for each radiograph. */
enum skg_registration_free {
    /** The pose of the parts, which move as one. */
    SKG_REGISTRATION_FREE_POSE = 1,
    /** The place of the source. */
    SKG_REGISTRATION_FREE_SOURCE = 2,
    /** The pose of the detector. */
    SKG_REGISTRATION_FREE_DETECTOR = 4
};

/** Losses that a registration can minimise. */
enum skg_registration_loss {
    /** Mean square of the difference of attenuations, less what the polynomials take. */
    SKG_REGISTRATION_LOSS_LSQ = 0,
    /** 1 less the correlation of the attenuations: blind to gain and offset. */
    SKG_REGISTRATION_LOSS_NCC = 1,
    /** 1 less the correlation of their differences from pixel to pixel, along rows and along columns. */
    SKG_REGISTRATION_LOSS_GRADIENT_NCC = 2
};

/** Verdict on the result of a registration. */
enum skg_registration_verdict {
    /** The registration has not run. */
    SKG_REGISTRATION_VERDICT_NONE = 0,
    /** The images agree: what is left is noise. */
    SKG_REGISTRATION_VERDICT_AGREES = 1,
    /** The images agree, but the residual has a structure that neither the parts nor the polynomials explain. */
    SKG_REGISTRATION_VERDICT_STRUCTURE = 2,
    /** The radiographs do not determine some direction as well as options.need_mm asks. */
    SKG_REGISTRATION_VERDICT_UNDETERMINED = 3,
    /** The body is not where it shows in the radiographs, or does not show in them. */
    SKG_REGISTRATION_VERDICT_FAILED = 4,
    /** The registration was cancelled: the best pose so far stands. */
    SKG_REGISTRATION_VERDICT_STOPPED = 5
};

/** Options of a registration. Prepare with skg_registration_options_init. */
typedef struct {
    /** Set by skg_registration_options_init. */
    int32_t size;
    /** Sum of enum skg_registration_free: SKG_REGISTRATION_FREE_POSE, the default, or one or both of the others. */
    int32_t free;
    /** enum skg_registration_loss; SKG_REGISTRATION_LOSS_LSQ by default */
    int32_t loss;
    /** 1: SKG_REGISTRATION_LOSS_GRADIENT_NCC ends the search, from where the other loss led. 0 by default. */
    int32_t polish;
    /** Number of further starts, 0 (default) to 10,000: they are ranked by the correlation of images of at most 64 x 64 pixels, and
     * the best three are followed. */
    int64_t restarts;
    /** Decides where they are; at least 0; 1 by default. */
    int64_t seed;
    /** How far from the start they are at most: shift, above 0 to 1000 mm; 20 by default. */
    double spread_mm;
    /** Turn, above 0 to pi; 15 degrees by default. */
    double spread_rad;
    /** Steps at each level of the pyramid at most, 1 to 1000; 30 by default. */
    int64_t steps;
    /** Pixels count that are at most this far from the shadow of the parts at the start, measured at the body; above 0 to 1e6 mm, 25 by
     * default. */
    double margin_mm;
    /** How well each direction has to be known, above 0; 1 mm by default. Angles count by what they move at the body's radius. */
    double need_mm;
    /** The start: a twist of the parts as skg_gradient has it, in addition to their poses in the scene; 0 by default. */
    double start[6];
    /** Steps are those of the search. Retained; NULL: nobody wants to know. */
    skg_progress *progress;
} skg_registration_options;

SKG_INIT(skg_registration_options)

/** Begins a registration.
 *
 *     context    has the device
 *     scene      retained; the poses of its parts stay as they are
 *     spectrum   retained
 *     plan       precision, strategy, repair, response and world are used; NULL: the defaults
 *     options    NULL: the defaults
 *     errors     SKG_ERR_ARGUMENT (an option) */
SKG_API skg_status skg_registration_create(skg_context *context, skg_scene *scene, skg_spectrum *spectrum,
                                           const skg_plan_options *plan,
                                           const skg_registration_options *options,
                                           skg_registration **registration);

/** Frees a registration. */
SKG_API void skg_registration_release(skg_registration **registration);

/** Adds a part to the body, whose parts move as one. Parts inside it stay where they are unless they are added as well.
 * If source or detector are free, the body says where the radiographs are compared, and all parts count.
 *
 *     errors   SKG_ERR_ARGUMENT if there is no such part, or it was added before */
SKG_API skg_status skg_registration_part_add(skg_registration *registration, int64_t part);

/** A radiograph. Prepare with skg_radiograph_init: intensities without a flat field. */
typedef struct {
    /** Set by skg_radiograph_init. */
    int32_t size;
    /** enum skg_quantity of the values: SKG_QUANTITY_TRANSMISSION, SKG_QUANTITY_ATTENUATION, or any other for intensities in any
     * unit. */
    int32_t quantity;
    /** Where it was taken; its numbers of columns and rows are those of the image. */
    const skg_view *view;
    /** [rows][columns] the values. */
    const double *values;
    /** [rows][columns] intensities without parts; NULL: flat_field. */
    const double *flat;
    /** Intensity without parts everywhere; 0: the largest one of the image. Polynomials and correlations take what is wrong with it. */
    double flat_field;
    /** [rows][columns] 0: the pixel does not count; NULL: all count. */
    const double *mask;
    /** For messages, such as the file's name; NULL: "radiograph 1". */
    const char *name;
} skg_radiograph;

SKG_INIT(skg_radiograph)

/** Adds a radiograph, the 64th at most. All is copied.
 *
 *     errors   SKG_ERR_ARGUMENT: values that are not finite (with row and column), an image that is the same everywhere, a flat field that
 *              is not above 0, a mask that hides everything; SKG_ERR_SCENE: a view that cannot be imaged */
SKG_API skg_status skg_registration_image_add(skg_registration *registration, const skg_radiograph *image);

/** Registers.
 *
 *     errors   SKG_ERR_ARGUMENT: there is no radiograph or no part, or a part lies outside of a view or behind its detector;
 *              SKG_ERR_CANCELLED: the best pose so far stands, and results can be asked for; others as of skg_plan_create and
 *              skg_plan_derivatives, such as SKG_ERR_UNSUPPORTED for meshes that are not closed */
SKG_API skg_status skg_registration_run(skg_registration *registration);

/** Result of a registration. The library fills it; prepare with skg_registration_result_init. */
typedef struct {
    /** Set by skg_registration_result_init. */
    int32_t size;
    /** enum skg_registration_verdict */
    int32_t verdict;
    /** The motion of the parts: a twist about the world's origin as skg_gradient has it, the start included. */
    double twist[6];
    /** [6] shift of the body's middle along x, y and z, mm, and rotation about x, y and z, rad: by how much noise alone displaces the result
     * (one standard deviation). It is no error: what the model lacks displaces it further. */
    double sigma[6];
    /** [6] the same, if what is left in the images is taken for noise that is independent in 16 x 16 cells of a radiograph, and correlated
     * within them as it is. */
    double sigma_structure[6];
    /** [6] 1: both are at most need_mm (angles: at the body's radius). */
    int32_t determined[6];
    /** Middle of the body at the start: the mean of its vertices. */
    double middle[3];
    /** Root mean square distance of its vertices from there. */
    double radius_mm;
    /** How far the middle was shifted. */
    double shift_mm;
    /** Angle by which the body was turned. */
    double turn_rad;
    /** Loss at the start, over the finest images. */
    double loss_start;
    /** Loss at the end, over the finest images. */
    double loss;
    /** Root mean square difference of the attenuations at the end, polynomials included. */
    double residual;
    /** The part of it that is noise: from differences of neighbours. */
    double noise;
    /** Pixels over which the residual is correlated. */
    double correlation_pixels;
    /** Share of the variance of the radiographs in their masks that model and polynomials explain, to 1. */
    double explained;
    /** Correlation of the parts' own contrast with what the radiographs show where it is, without what the polynomials take: 1 if
     * they are the same. */
    double agreement;
    /** Energy of the model, keV. */
    double energy_kev;
    /** Images that were rendered, each at the resolution of its level. */
    int64_t images;
    /** Derivatives of images along the free directions. */
    int64_t jacobians;
    /** Wall time of the run, s. */
    double seconds;
    /** Number of free directions, whose combinations skg_registration_direction_get returns. */
    int64_t directions;
    /** Number of the radiograph in which the mean square of the residual is largest, among cells of an eighth of a radiograph. */
    int64_t worst_image;
    /** Row of the middle of this cell. */
    int64_t worst_row;
    /** Column of the middle of this cell. */
    int64_t worst_column;
} skg_registration_result;

SKG_INIT(skg_registration_result)

/** Gets the result, after skg_registration_run. */
SKG_API skg_status skg_registration_result_get(const skg_registration *registration,
                                               skg_registration_result *result);

/** Gets the verdict as a sentence, valid as long as the registration. */
SKG_API skg_status skg_registration_verdict_get(const skg_registration *registration, const char **sentence);

/** An independent direction in which the result is uncertain. The library fills it; prepare with
 * skg_registration_direction_init. */
typedef struct {
    /** Set by skg_registration_direction_init. */
    int32_t size;
    /** 1: it is as well known as need_mm asks. */
    int32_t determined;
    /** Name of the direction, such as "shift along the beam of view 1"; valid as long as the registration. */
    const char *name;
    /** One standard deviation from noise alone, mm; of turns at the body's radius. */
    double sigma_mm;
    /** One standard deviation with the residual of the images taken for noise, likewise. */
    double sigma_structure_mm;
} skg_registration_direction;

SKG_INIT(skg_registration_direction)

/** Gets independent direction 0 <= index < directions, the least certain first. */
SKG_API skg_status skg_registration_direction_get(const skg_registration *registration, int64_t index,
                                                  skg_registration_direction *direction);

/** Gets the view of a radiograph as it was found: the given one, if neither source nor detector is free.
 *
 *     view   in and out: prepared with skg_view_init */
SKG_API skg_status skg_registration_view_get(const skg_registration *registration, int64_t image,
                                             skg_view *view);

/** Gets the motion of the body, whose twist skg_registration_result has.
 *
 *     motion   result: [16] affine matrix, row by row */
SKG_API skg_status skg_registration_motion_get(const skg_registration *registration, double *motion);

/** Gets the pose of a part as it was found.
 *
 *     pose   result: [16] */
SKG_API skg_status skg_registration_pose_get(const skg_registration *registration, int64_t part,
                                             double *pose);

/** Pictures that skg_registration_picture_get makes of a radiograph. */
enum skg_registration_picture {
    /** The radiograph, -ln of the transmission. */
    SKG_REGISTRATION_PICTURE_FIXED = 0,
    /** The model at the end, polynomials included where pixels count. */
    SKG_REGISTRATION_PICTURE_MODEL = 1,
    /** Model less radiograph at the start. 0 where pixels do not count. */
    SKG_REGISTRATION_PICTURE_BEFORE = 2,
    /** Model less radiograph at the end, likewise. */
    SKG_REGISTRATION_PICTURE_AFTER = 3,
    /** Attenuation of the parts alone at the start. */
    SKG_REGISTRATION_PICTURE_SHADOW_BEFORE = 4,
    /** Attenuation of the parts alone at the end. */
    SKG_REGISTRATION_PICTURE_SHADOW_AFTER = 5,
    /** Where the model lacks something: SKG_REGISTRATION_PICTURE_AFTER, averaged over the pixels that count among those at most an eightieth
     * of the radiograph's shorter side away, along rows and along columns; 0 where noise alone may be the reason (three standard
     * deviations). */
    SKG_REGISTRATION_PICTURE_STRUCTURE = 6
};

/** Gets a picture of a radiograph, after skg_registration_run.
 *
 *     which    enum skg_registration_picture
 *     values   result: [rows][columns], of the radiograph */
SKG_API skg_status skg_registration_picture_get(skg_registration *registration, int64_t image, int32_t which,
                                                double *values);

/** Number of steps of the search so far, those that were taken back included. */
SKG_API skg_status skg_registration_step_count(const skg_registration *registration, int64_t *count);

/** Gets step 0 <= index < count.
 *
 *     level   result: pixels of the radiograph along the side of a pixel of the level
 *     loss    result: after the step. Both may be NULL */
SKG_API skg_status skg_registration_step_get(const skg_registration *registration, int64_t index,
                                             int64_t *level, double *loss);

#ifdef __cplusplus
}
#endif
#endif
