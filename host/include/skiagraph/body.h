/** @file
 * Bodies: organs whose meshes move with the breath. The method is that of Vidal and Villard, Comput. Med.
 * Imaging Graph. 49 (2016) 1-15, "the paper". Lengths are in mm, angles in radians.
 *
 * The rule by which an organ moves is found by its label, without regard to case:
 *
 * - "rib N left" (or right, or rib_l05): turns about an axis through its head, by the angles of Wilson et
 *   al., J. Appl. Physiol. 62 (1987) 1872 for ribs 3 to 7. The other ribs are extrapolated, which is an
 *   assumption.
 * - "sternum ...": rigid, fitted to the anterior ends of ribs 1 to 7.
 * - "cartilage N left": between its rib and the sternum or the next rib above; without a number, all of one
 *   side. Deformable, linked to ribs and sternum; the boxes of its links turn with them.
 * - "diaphragm": the tendon is rigid above a plane, the muscle below it deformable, the rim moves with the
 *   ribs.
 * - "lung ...", "liver", "heart", "skin", "muscle": deformable, linked to the diaphragm, the ribs or both.
 * - "gallbladder": with the liver. "common bile duct": its upper end with the liver.
 * - "stomach", "spleen", "kidney ...", "perirenal fat ...": with the tendon, kidneys and their fat 0.65 of it.
 * - "bowel": its upper end with the tendon; the lower one stays. "pulmonary vessels ...": with the tendon, in
 *   full at the base of the lung and not at all at the apex.
 * - "trachea", "bronchus ...", "pulmonary artery ...": with the lungs; the upper end of the trachea stays.
 * - "ascending aorta", "vena cava ...", "pulmonary trunk": the lower end with the heart; the upper one stays.
 * - "needle": rigid, pivots where it enters the skin, its tip moves with the liver.
 * - "spine", "vertebra ...", "disc ...", "spinal canal", "clavicle ...", "scapula ...", "aorta ...",
 *   "brachiocephalic ...", "oesophagus": stay.
 *
 * Any other organ moves with the one that it lies inside, if that is deformable and neither the skin nor the
 * muscle, or if that is rigid, as marrow in a rib. Otherwise it stays, and a warning says so. x must point to the patient's left, y to the back, z to the head.
 *
 * A body is used by one thread at a time.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_BODY_H
#define SKIAGRAPH_BODY_H

#include <skiagraph/breath.h>
#include <skiagraph/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Organs that move together. */
typedef struct skg_body skg_body;

/** How the axes of the ribs are found. All of them go through the rib's head. */
enum skg_rib_axes {
    /** Horizontal; the pump and bucket angles change as Wilson measured. */
    SKG_RIB_AXES_LITERATURE = 0,
    /** From the head (where rib k is nearest to the bodies of vertebrae T_k and T_k-1) to the tubercle (where
     * it is nearest to the transverse process of T_k, "vertebra t05"), turned by Wilson's two angles
     * combined. If T_k is not in the body: an axis in the plane of the rib's two longest principal axes of
     * inertia, through the posterior end of the longest, such that Wilson's angles result. */
    SKG_RIB_AXES_BONES = 1
};

/** How ribs and diaphragm together move diaphragm, lungs, liver, muscle and skin. */
enum skg_coupling {
    /** As anatomy does: the ribs carry the diaphragm's rim, the muscle shortens evenly from the rim to the
     * tendon, the chest wall between ribs follows both, and the liver keeps its volume. Hysteresis or
     * relaxation above 0 selects SKG_COUPLING_PAPER instead, and so do the caller's links for the organ that
     * has them. */
    SKG_COUPLING_ANATOMICAL = 0,
    /** As Vidal and Villard (2016): ribs and tendon drive Chain Mail, each vertex by the nearest of them. */
    SKG_COUPLING_PAPER = 1
};

/** Options of a body. Prepare with skg_body_options_init. */
typedef struct {
    /** Set by skg_body_options_init. */
    int32_t size;
    /** Passes of elastic relaxation, 0 to 20; 0 by default. */
    int32_t relaxation;
    /** Displacement of the tendon at diaphragmatic weight 1, mm; 0, 0, -15 by default. */
    double tendon_mm[3];
    /** The tendon is where a x + b y + c z + d > 0; all 0, the default: the upper third of the diaphragm. */
    double tendon_plane[4];
    /** Weight of the ribs at which the meshes were made; 0, the default, is end-expiration. At both reference
     * weights every vertex is where its file has it. */
    double reference_thoracic;
    /** Weight of the diaphragm at which the meshes were made; 0 by default. */
    double reference_diaphragmatic;
    /** 0 (default): a pose depends on the weights at that phase only. 1: the paper's hysteresis. */
    double hysteresis;
    /** enum skg_rib_axes */
    int32_t rib_axes;
    /** enum skg_coupling */
    int32_t coupling;
    /** How near to ribs 6 to 12 the diaphragm's rim goes with them, mm, up to 1000; 0, the default, is 16. */
    double diaphragm_ribs_mm;
    /** How near to the tendon the liver goes with it, mm, up to 1000; 0, the default, is 9. */
    double diaphragm_liver_mm;
    /** With SKG_COUPLING_ANATOMICAL, at diaphragmatic weight 1: by how much farther down the top of the left dome goes than
     * the middle of the tendon, mm, -57 to 57; 0 by default. */
    double dome_left_mm;
    /** By how much farther down the top of the right dome goes, likewise. */
    double dome_right_mm;
    /** By how much farther down the back goes than the middle, and the front less, mm, -57 to 57; 0 by default. */
    double dome_back_mm;
    /** Length of the diaphragm's muscle from the rim to the tendon, as a part of the greatest distance from the rim, 0.1 to
     * 1; 0.8 by default. Without effect where tendon_plane is given. */
    double muscle_length;
    /** Angle by which the plane of rib 5 turns from relaxed expiration to full inspiration, rad, 0 to 1; the others' are
     * in proportion. By default what Wilson measured, 0.255. */
    double rib_angle_rad;
    /** By how much more than in Wilson's table the angles fall from each rib to the next, rad, -0.1 to 0.1; 0 by
     * default. */
    double rib_fall_rad;
    /** With SKG_COUPLING_ANATOMICAL: the part of the dome's motion with which the liver goes, 0 to 2; 1 by default. */
    double liver_follows;
    /** With SKG_COUPLING_ANATOMICAL: by which part of the tendon's motion the liver's lower end goes less than its top, 0
     * to 1; 0.25 by default. */
    double liver_held;
} skg_body_options;

SKG_INIT(skg_body_options)

/** How an organ moves. */
enum skg_organ_kind {
    /** By the rule of its label. */
    SKG_ORGAN_BY_LABEL = 0,
    /** Not at all. */
    SKG_ORGAN_STATIC = 1,
    /** The organ turns as a whole with the ribs. */
    SKG_ORGAN_RIGID = 2,
    /** The organ is linked to others and deforms. */
    SKG_ORGAN_DEFORMABLE = 3
};

/** Ties a deformable organ to another one. Its vertices within rigid_mm of that organ at rest move with it;
 * those within distance_mm are linked to it by the organ's own tissue. The other organ is not moved by this.
 * Prepare with skg_organ_link_init. */
typedef struct {
    /** Set by skg_organ_link_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Label of the other organ, or the word with which the labels of several begin, such as "rib". */
    const char *to;
    /** Above 0 to 1000 mm. */
    double distance_mm;
    /** 0 to distance_mm. */
    double rigid_mm;
} skg_organ_link;

SKG_INIT(skg_organ_link)

/** An organ. Prepare with skg_organ_init: moves by its label, inside nothing. */
typedef struct {
    /** Set by skg_organ_init. */
    int32_t size;
    /** enum skg_organ_kind */
    int32_t kind;
    /** Number of the organ that it lies inside, which was added before it; -1: none. */
    int64_t inside;
    /** Retained. The body writes its positions. */
    skg_mesh *mesh;
    /** Copied. */
    const char *label;
    /** How far the organ's tissue may be squeezed, as a fraction of each link's rest offset, axis by axis
     * (the bounding region of Li and Brodlie, Comput. Graph. Forum 22(4) (2003) 717-727): 0 to 1. If
     * alpha_min, alpha_max and beta are 0, the label decides; 1, 1, 0 is rigid; the paper's muscle is 0.7,
     * 1.1, 0.1. */
    double alpha_min;
    /** How far it may be stretched, as such a fraction, at least 1. */
    double alpha_max;
    /** How far it may be sheared, as such a fraction, at least 0. 0 stiffens sheets that lie along an
     * axis. */
    double beta;
    /** Rotation of a rigid organ: it turns by the exponential of one vector times the thoracic weight. The
     * vector is turn_rad plus the rotations by gamma_rad and lambda_rad. Each at most pi. If all are 0, the
     * label decides, which it can for ribs and sternum only. */
    double turn_rad[3];
    /** The paper's angle about the axis from back to front, which raises the side; with the same sign on both
     * sides of the body. */
    double gamma_rad;
    /** The paper's angle about the axis from left to right, which raises the front. */
    double lambda_rad;
    /** Fixed point of the rotation, mm. NaN, the default: the rib's head; for other organs the posterior end
     * of the longest principal axis of inertia. */
    double centre_mm[3];
    /** [link_count] of a deformable organ; copied. Each vertex takes the nearest organ. NULL: by label. */
    const skg_organ_link *links;
    /** Number of links. */
    int64_t link_count;
} skg_organ;

SKG_INIT(skg_organ)

/** Makes an empty body.
 *
 *     context   receives warnings; may be NULL
 *     options   NULL: the defaults
 *     body      result; the caller releases it
 *     errors    SKG_ERR_BREATHING if an option is out of range */
SKG_API skg_status skg_body_create(skg_context *context, const skg_body_options *options, skg_body **body);

/** Frees a body and releases its meshes, which stay as they are posed. */
SKG_API void skg_body_release(skg_body **body);

/** Adds an organ to a body.
 *
 *     id       result: its number, counted from 0; may be NULL
 *     errors   SKG_ERR_BREATHING with the organ, and which of its fields is out of range or does not fit its
 *              kind */
SKG_API skg_status skg_body_add(skg_body *body, const skg_organ *organ, int64_t *id);

/** Finds links, axes and regions in the meshes as they lie. Call it once, after the last organ. Errors:
 * SKG_ERR_BREATHING if no organ moves, or a link goes to no organ, to one that cannot be followed, or in a
 * circle. */
SKG_API skg_status skg_body_link(skg_body *body);

/** For hysteresis above 0: goes round the breath until it repeats itself and keeps the loop, from which
 * skg_body_pose then starts at any phase. */
SKG_API skg_status skg_body_breathe(skg_body *body, const skg_breath *breath);

/** Poses all organs: writes the positions of the meshes that move. The same state gives the same bits,
 * whatever was posed before; with hysteresis, after the same skg_body_breathe. Warns the first time that the
 * organs which drive another one contradict each other by more than 1 mm. */
SKG_API skg_status skg_body_pose(skg_body *body, const skg_breath_state *state);

/** Sets how far the needle is drawn back along its axis from where its file has it, mm; below 0: farther in.
 * Used from the next pose on. */
SKG_API skg_status skg_body_needle_set(skg_body *body, double withdrawn_mm);

/** Measurements of a pose. The library fills it; prepare with skg_body_measure_init. */
typedef struct {
    /** Set by skg_body_measure_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Volume of the lungs, ml. */
    double lung_ml;
    /** By how much that exceeds the volume in the reference pose, ml. */
    double tidal_ml;
    /** Density of the lungs over that of the reference pose, with constant mass: V0 / V. */
    double lung_density_ratio;
    /** Descent of the top of the left and of the right half of the diaphragm, mm. */
    double diaphragm_mm[2];
    /** Mean displacement of the liver, mm. */
    double liver_mm[3];
    /** Greatest contradiction between the organs that drive another one, mm; it is met halfway. */
    double conflict_mm;
    /** Volume of the liver over that of the reference pose. */
    double liver_volume_ratio;
    /** Number of links that are violated by more than 1e-9 mm; 0. */
    int64_t broken_links;
    /** Number of triangles of all organs whose normal turned by more than 90 degrees. */
    int64_t flipped_triangles;
    /** Labels of the organ with the greatest contradiction and of the two that drive it, valid as long as the
     * body; NULL: none. */
    const char *conflict[3];
} skg_body_measure;

SKG_INIT(skg_body_measure)

/** Measures the last pose. */
SKG_API skg_status skg_body_measure_get(const skg_body *body, skg_body_measure *measure);

/** The Hounsfield number of lung whose density is density_ratio times that at `hounsfield`: HU + 1000 is
 * proportional to the density. */
SKG_API double skg_lung_hounsfield(double hounsfield, double density_ratio);

#ifdef __cplusplus
}
#endif
#endif
