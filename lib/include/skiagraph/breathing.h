/* Breathing: tissues, waveforms, the generated thorax.
 *
 * The method is that of Vidal and Villard, Comput. Med. Imaging Graph. 49 (2016) 1-15, "the paper": meshes
 * move on the host, and the picture is made of where they are. Lengths in mm, angles in radians, time in s,
 * frequencies in Hz. Calls are stateless unless a body is named: any time or phase may be asked in any order.
 */
#ifndef SKIAGRAPH_BREATHING_H
#define SKIAGRAPH_BREATHING_H

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
    SKG_BREATH_SINE = 0,  /* (1 + cos 2 pi p)/2: the paper's Eq. 1, its sine begun at p = 3/4 */
    SKG_BREATH_LUJAN = 1, /* cos^2n(pi p), n = exponent: dwells at expiration (Lujan et al., Med. Phys. 26
                             (1999) 715) */
    SKG_BREATH_ASYMMETRIC = 2, /* half cosines; expiration lasts expiration_ratio times inspiration */
    SKG_BREATH_SAMPLED = 3     /* samples evenly over the cycle, joined by a monotone cubic */
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
SKG_API skg_status skg_breath_at_time(const skg_breath *breath, double time_s, skg_breath_state *state);
SKG_API skg_status skg_breath_at_phase(const skg_breath *breath, double phase, skg_breath_state *state);

/* A thorax at end-expiration, generated. x to the patient's left, y to the back, z up; the origin is the top
 * of the right half of the diaphragm. Sizes from the literature and from aggregates of real bones. Every mesh
 * is closed and outward; two meshes are disjoint or one lies in the other, but for faces that cut into a
 * neighbour by less than 0.5 mm (by 3 mm below 42,000 triangles), and for the needle, which passes through.
 * Labels are English: "rib 5 left", "liver", "lung right", "skin". */
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
    const char *material; /* chemical symbol where it is no tissue ("Fe" of the needle), or NULL */
    double hounsfield;    /* HU at about 120 kV, where material is NULL */
    double density_g_cm3; /* where material is given; else 0 */
} skg_thorax_part;

SKG_API void skg_thorax_part_init(skg_thorax_part *part);
SKG_API skg_status skg_thorax_size(const skg_thorax *thorax, int64_t *parts);
SKG_API skg_status skg_thorax_get_part(const skg_thorax *thorax, int64_t number, skg_thorax_part *part);

/* Writes one PLY file per part and a scene file, thorax.json, into a folder that exists: a point source 1 m
 * in front of a detector behind the patient's back, head up, the patient's right on the viewer's left.
 * SKG_ERR_OUTPUT. */
SKG_API skg_status skg_thorax_save(const skg_thorax *thorax, const char *folder);

#ifdef __cplusplus
}
#endif
#endif
