/* Breathing: tissues, waveforms, the generated thorax, bodies that move.
 *
 * The method is that of Vidal and Villard, Comput. Med. Imaging Graph. 49 (2016) 1-15, "the paper": meshes
 * move on the host, and the picture is made of where they are. Lengths in mm, angles in radians, time in s,
 * frequencies in Hz. Calls are stateless unless a body is named: any time or phase may be asked in any order.
 */
#ifndef SKIAGRAPH_BREATHING_H
#define SKIAGRAPH_BREATHING_H

#include <skiagraph/context.h>
#include <skiagraph/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How far a link of soft tissue may be squeezed (alpha_min, 0 to 1), stretched (alpha_max, >= 1) and sheared
 * (beta, >= 0), as fractions of its rest offset, axis by axis: the bounding region of Li and Brodlie,
 * Comput. Graph. Forum 22(4) (2003) 717-727. 1, 1, 0 is rigid. The paper's muscle: 0.7, 1.1, 0.1. A beta of
 * 0 stiffens sheets that lie along an axis. */
typedef struct {
    double alpha_min, alpha_max, beta;
} skg_tissue;

/* Waveforms over the phase p of 4D-CT, 0 <= p < 1 from end-inspiration. All give the amplitude f from 0
 * (end-expiration) to 1 (end-inspiration), and f(0) is their largest. */
enum {
    SKG_WAVEFORM_SINE = 0,  /* (1 + cos 2 pi p)/2: the paper's Eq. 1, its sine begun at p = 3/4 */
    SKG_WAVEFORM_LUJAN = 1, /* cos^2n(pi p), n = exponent: dwells at expiration (Lujan et al., Med. Phys. 26
                             (1999) 715) */
    SKG_WAVEFORM_ASYMMETRIC = 2, /* half cosines; expiration lasts expiration_ratio times inspiration */
    SKG_WAVEFORM_SAMPLED = 3     /* samples evenly over the cycle, joined by a monotone cubic */
};

/* A span of time in which the breath is held: it stays where it was at `from` and goes on from there. */
typedef struct {
    double from, to; /* s, from <= to */
} skg_breath_hold;

/* One way to breathe. Prepare with skg_breath_init: sine, 4 s, both channels, no lag. */
typedef struct {
    int32_t size;
    int32_t waveform;        /* SKG_BREATH_ */
    int32_t exponent;        /* n of LUJAN, 1 to 8; 2 */
    int32_t reserved;        /* 0 */
    double period_s;         /* of one breath, 0.2 to 60 s; 4 */
    double start_phase;      /* at time 0, 0 to 1; 0 */
    double expiration_ratio; /* of ASYMMETRIC, 0.2 to 5; 1.5 */
    double thoracic;         /* weight of the ribs, 0 to 4: 0 for diaphragmatic breathing; 1 quiet */
    double diaphragmatic;    /* weight of the diaphragm, 0 to 4: 0 for thoracic breathing; 1 quiet */
    double thoracic_lag;     /* how much later the ribs are, in cycles, -0.5 to 0.5; 0 */
    const double *samples;   /* of SAMPLED: f from 0 to 1, end-inspiration first and largest; not copied */
    int64_t sample_count;    /* >= 3 */
    const skg_breath_hold *holds; /* in order of time, not overlapping; not copied; may be NULL */
    int64_t hold_count;
} skg_breath;

SKG_API void skg_breath_init(skg_breath *breath);

/* Sets a breath to a named pattern: "quiet" (asymmetric 1:1.5, 4 s), "diaphragmatic", "thoracic", "shallow"
 * (weights 0.3, 3 s), "deep" (weights 2.5, 6 s), "hyperventilation" (weights 2, 1.5 s). SKG_ERR_BREATHING
 * with the nearest name otherwise. */
SKG_API skg_status skg_breath_pattern(const char *name, skg_breath *breath);

/* SKG_ERR_BREATHING names the field that is out of range. */
SKG_API skg_status skg_breath_check(const skg_breath *breath);

/* Where a breath is. Prepare with skg_breath_state_init (end-expiration). */
typedef struct {
    int32_t size;
    int32_t reserved;     /* 0 */
    double phase;         /* 0 to below 1, from end-inspiration */
    double amplitude;     /* f of the waveform at that phase, 0 to 1 */
    double thoracic;      /* weight times lagged amplitude: what the ribs get */
    double diaphragmatic; /* weight times amplitude: what the diaphragm gets */
} skg_breath_state;

SKG_API void skg_breath_state_init(skg_breath_state *state);

/* The state at a time (s, any finite) or at a phase (any finite; counted modulo 1). Stateless. */
SKG_API skg_status skg_breath_state_at_time(const skg_breath *breath, double time_s, skg_breath_state *state);
SKG_API skg_status skg_breath_state_at_phase(const skg_breath *breath, double phase, skg_breath_state *state);

/* A thorax at end-expiration, generated. x to the patient's left, y to the back, z up; the origin is the top
 * of the right half of the diaphragm. Sizes from the literature and from aggregates of real bones. Every mesh
 * is closed and outward; two meshes are disjoint or one lies in the other (below 42,000 triangles facets may
 * cut into a neighbour by up to 3 mm), but for the needle, which passes through. Labels are English: "rib 5
 * left", "liver", "lung right", "skin". */
typedef struct skg_thorax skg_thorax;

/* Prepare with skg_thorax_options_init. */
typedef struct {
    int32_t size;
    int32_t reserved;  /* 0 */
    int64_t triangles; /* in all, about: 10,000 to 20,000,000; 42,000 (the paper's scene has 41,710) */
} skg_thorax_options;

SKG_API void skg_thorax_options_init(skg_thorax_options *options);

/* SKG_ERR_ARGUMENT for a number of triangles out of range. The caller releases the thorax. */
SKG_API skg_status skg_thorax_create(const skg_thorax_options *options, skg_thorax **thorax);
SKG_API void skg_thorax_release(skg_thorax **thorax);

/* One part. The library fills it; strings and mesh are valid as long as the thorax. */
typedef struct {
    int32_t size;
    int32_t reserved;     /* 0 */
    int64_t inside;       /* number of the part that it lies in, -1: none */
    skg_mesh *mesh;       /* not retained for the caller */
    const char *label;    /* unique */
    const char *material; /* as skg_material_create_named takes it ("Liver", "Needle steel"); NULL of bones */
    double hounsfield;    /* HU at about 120 kV: what it is of where material is NULL */
    double density_g_cm3; /* 0: that of the material's tables */
} skg_thorax_part;

SKG_API void skg_thorax_part_init(skg_thorax_part *part);
SKG_API skg_status skg_thorax_part_count(const skg_thorax *thorax, int64_t *parts);
SKG_API skg_status skg_thorax_part_get(const skg_thorax *thorax, int64_t number, skg_thorax_part *part);

/* Writes one PLY file per part and a scene file, thorax.json, into a folder that exists: a tube of 80 kV 1 m
 * in front of a detector behind the patient's back, head up, the patient's right on the viewer's left, and
 * the breathing and events of a percutaneous cholangiography (docs/scene-files.md). SKG_ERR_OUTPUT. */
SKG_API skg_status skg_thorax_save(const skg_thorax *thorax, const char *folder);

/* A body: organs that move with the breath. Each has a rule, found by its label (without regard to case):
 * - "rib N left" (or right; or rib_l05): turns about an axis through its head, by the angles of Wilson et
 * al., J. Appl. Physiol. 62 (1987) 1872 for ribs 3 to 7; the others are extrapolated (an assumption);
 * - "sternum ...": rigid, fitted to the anterior ends of ribs 1 to 7;
 * - "cartilage N left": between its rib and the sternum or the next rib above; without a number, all of one
 * side: deformable, linked to ribs and sternum, its boxes turning with them;
 * - "diaphragm": tendon rigid above a plane, muscle below it deformable, rim with the ribs;
 * - "lung ...", "liver", "heart", "skin": deformable, linked to the diaphragm, the ribs or both;
 * - "gallbladder": with the liver; "common bile duct": its upper end with the liver;
 * - "stomach", "spleen", "kidney ...": with the tendon, kidneys 0.65 of it;
 * - "trachea", "bronchus ...": with the lungs, the trachea's upper end stays;
 * - "needle": rigid, pivots where it enters the skin, tip with the liver;
 * - "spine", "vertebra ...", "clavicle ...", "scapula ...": stay.
 * Any other part moves with the one that it lies inside, if that is deformable and not the skin; else it
 * stays, and a warning says so. Links are found once, at rest. x has to point to the patient's left, y to
 * the back, z to the head. */
typedef struct skg_body skg_body;

/* Axes of the ribs. All go through the rib's head.
 * LITERATURE: horizontal; pump and bucket angle change as Wilson measured. BONES: from the head, where the
 * rib is nearest to the bodies of vertebrae T_k and T_k-1, to the tubercle, where it is nearest to the
 * transverse process of T_k ("vertebra t05"), and Wilson's angles make one; where T_k is not in the body, an
 * axis in the plane of the rib's two longest principal axes of inertia, about the posterior end of the
 * longest, turned so that Wilson's angles come out. */
enum { SKG_RIB_AXES_LITERATURE = 0, SKG_RIB_AXES_BONES = 1 };

/* Prepare with skg_body_options_init. */
typedef struct {
    int32_t size;
    int32_t relaxation;        /* passes of elastic relaxation, 0 to 20; 0 */
    double tendon_mm[3];       /* displacement of the tendon at diaphragmatic weight 1; 0, 0, -15 */
    double tendon_plane[4];    /* a x + b y + c z + d > 0: tendon; all 0 (default): the upper third */
    double reference_thoracic; /* weights at which the meshes were made: there every vertex is the file's; */
    double reference_diaphragmatic; /* 0, 0: end-expiration */
    double hysteresis; /* 0 to 1; 0: the state depends on the phase's weights only; 1: the paper's */
    int32_t rib_axes;  /* SKG_RIB_AXES_ */
    int32_t reserved;  /* 0 */
} skg_body_options;

SKG_API void skg_body_options_init(skg_body_options *options);

/* How an organ moves: by its label's rule; not at all; rigid, turning with the ribs; deformable. */
enum { SKG_ORGAN_BY_LABEL = 0, SKG_ORGAN_STATIC = 1, SKG_ORGAN_RIGID = 2, SKG_ORGAN_DEFORMABLE = 3 };

/* Ties a deformable organ to another: vertices within rigid_mm of it at rest go with it; those beyond, within
 * distance_mm, hang on it by a link of the organ's own tissue. The other organ is not moved by it. */
typedef struct {
    const char *to;     /* an organ's label, or the word that labels begin with: "rib" */
    double distance_mm; /* above 0 to 1000 */
    double rigid_mm;    /* 0 to distance_mm */
} skg_organ_link;

/* One organ. Prepare with skg_organ_init. */
typedef struct {
    int32_t size;
    int32_t kind;      /* SKG_ORGAN_ */
    int64_t inside;    /* number of the organ that it lies in, added before it; -1: none */
    skg_mesh *mesh;    /* retained; the body writes its positions */
    const char *label; /* copied */
    skg_tissue tissue; /* all 0: by label */
    /* Of a rigid one: the rotation at thoracic weight 1 is the exponential of one vector, and goes with the
     * weight. The vector is turn_rad plus the paper's two angles: gamma about the axis from back to front
     * (raises the side), lambda about the axis from left to right (raises the front), both counted alike on
     * either side of the body. All 0 are for ribs and sternum only: by label. */
    double turn_rad[3], gamma_rad, lambda_rad; /* each angle at most pi */
    double
        centre_mm[3]; /* NaN (default): the rib's head; else the posterior end of the longest axis of inertia
                       */
    const skg_organ_link *links; /* of a deformable one, the nearest organ counts; none: by label; copied */
    int64_t link_count;
} skg_organ;

SKG_API void skg_organ_init(skg_organ *organ);

/* An empty body. context: for warnings; may be NULL. options NULL: the defaults. SKG_ERR_BREATHING for an
 * option out of range. The caller releases the body. */
SKG_API skg_status skg_body_create(skg_context *context, const skg_body_options *options, skg_body **body);
SKG_API void skg_body_release(skg_body **body);

/* Adds an organ; *id: its number from 0 (NULL: not wanted). SKG_ERR_BREATHING names the organ and what of it
 * is out of range or does not fit its kind. */
SKG_API skg_status skg_body_add(skg_body *body, const skg_organ *organ, int64_t *id);

/* Finds links, axes and regions in the meshes as they lie; to be called once, after the last organ.
 * SKG_ERR_BREATHING: no organ that moves; a link to no organ, to one that cannot be followed, or in a
 * circle. */
SKG_API skg_status skg_body_link(skg_body *body);

/* With hysteresis only: goes round the breath until it repeats itself and keeps the loop, from which
 * skg_body_pose then starts at any phase. */
SKG_API skg_status skg_body_breathe(skg_body *body, const skg_breath *breath);

/* Poses all organs, and warns the first time that an organ's drivers contradict each other by more than 1 mm:
 * writes the meshes that move. The same state gives the same bits, whatever came before (with hysteresis:
 * after the same skg_body_breathe). state: as skg_breath_state_at_time gives it. */
SKG_API skg_status skg_body_pose(skg_body *body, const skg_breath_state *state);

/* From the next pose on, the needle is drawn back along its axis by so many mm from where its file has it
 * (negative: farther in). */
SKG_API skg_status skg_body_needle_set(skg_body *body, double withdrawn_mm);

/* What a pose is like. Filled by the library; prepare with skg_body_measure_init. */
typedef struct {
    int32_t size;
    int32_t reserved;          /* 0 */
    double lung_ml, tidal_ml;  /* volume of the lungs; its excess over the reference pose */
    double lung_density_ratio; /* V0/V: density against the reference, mass kept */
    double diaphragm_mm[2];    /* descent of the top of each half: left, right */
    double liver_mm[3];        /* mean displacement */
    double conflict_mm;        /* largest contradiction between drivers of one organ; they meet halfway */
    double liver_volume_ratio; /* V/V0 */
    int64_t broken_links;      /* by more than 1e-9 mm; 0 */
    int64_t flipped_triangles; /* whose normal turned by more than 90 degrees, over all organs */
    const char *conflict[3];   /* that organ, and the two that pull at it; NULL: none. As long as the body */
} skg_body_measure;

SKG_API void skg_body_measure_init(skg_body_measure *measure);
SKG_API skg_status skg_body_measure_get(const skg_body *body, skg_body_measure *measure);

/* HU at a density of ratio times that at hounsfield: (HU + 1000) goes with the density. */
SKG_API double skg_lung_hounsfield(double hounsfield, double density_ratio);

#ifdef __cplusplus
}
#endif
#endif
