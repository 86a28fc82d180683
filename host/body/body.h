/* What a body is inside. Private. */
#ifndef SKG_BODY_H
#define SKG_BODY_H

#include "body/rigid.h"
#include "chainmail/chainmail.h"
#include "core/context.h"
#include "mesh/mesh.h"

#include <skiagraph/breathing.h>

/* How an organ moves. */
typedef enum {
    ROLE_STATIC,
    ROLE_RIGID, /* turns as it is told */
    ROLE_RIB,
    ROLE_STERNUM,
    ROLE_CARTILAGE,
    ROLE_DIAPHRAGM,
    ROLE_LINKED,  /* deformable, driven through links: lungs, liver, heart, skin */
    ROLE_CARRIED, /* every vertex goes with the nearest ones of a carrier */
    ROLE_SPANNED, /* between a carrier at one end and rest at the other */
    ROLE_NEEDLE
} skg_role;

/* A point that follows another organ: one on its triangle, or, fixed to a rigid organ, goes with it as a
 * whole. */
typedef struct {
    int32_t organ, corner[3]; /* corner: vertices of that organ */
    double weight[3];
    double part; /* of that displacement, 0 to 1 */
    int32_t fixed, reserved;
    double point[3]; /* of fixed ones, at rest */
} skg_link;

enum { CARRIERS = 12, BLOCK = 32 };

typedef struct {
    skg_mesh *mesh;
    char *label;
    int64_t inside;
    skg_tissue tissue;
    skg_role role;
    int kind, told; /* SKG_ORGAN_; a conflict was warned of */
    int64_t vertices, triangles;
    double *rest;     /* rows of x, y, z, mm */
    double bounds[6]; /* of them: low, high */
    int32_t *corner;
    double *block;    /* bounds of each BLOCK triangles in a row: low, high */
    int32_t *node_of; /* welded vertex: the first one there */
    double *moved;    /* displacements, rows of x, y, z, mm */
    int changed;      /* by the last pose */
    int number, side; /* of ribs and cartilage: 1 to 12; 1 left, -1 right */
    /* rigid */
    int turned, centred;     /* axis is the caller's, at weight 1; head is the caller's */
    double head[3], axis[3]; /* of a rib: rotation vector at full inspiration, rad */
    skg_rigid rigid;         /* now, of ribs, sternum and rigid organs */
    /* deformable: links[d] moves driver d; those of organ -1 stay (anchors) or are tendon (-2) */
    skg_chain *chain; /* of the vertices, and of the far ends of links that are not rigid */
    int64_t links;
    skg_link *link;
    double *anchor;        /* per driver: where it is at rest */
    skg_organ_link *given; /* the caller's, in the place of the label's rule */
    int64_t given_count;
    int stage;      /* is posed after those of lower ones */
    int corotates;  /* boxes turn with the drivers */
    double *target; /* per driver */
    double *state;  /* axis by axis, as the chain has it */
    double *memory; /* with hysteresis: the state that remembers */
    skg_chain_report report;
    /* carried: CARRIERS vertices of an organ and their weights, per vertex */
    int32_t carrier;
    int32_t *near;
    double *near_weight, *share; /* share: 0 to 1 per vertex */
    double tip[3], pivot[3];     /* of the needle: its end in the tissue, where it enters the skin */
    skg_link skin;               /* that place */
    double volume;               /* at rest, mm3 */
} skg_body_organ;

struct skg_body {
    skg_context *context;
    skg_body_options options;
    int64_t organs, room;
    skg_body_organ *organ;
    int tried, linked;  /* skg_body_link was called; succeeded */
    int large;          /* deformable organs have so many vertices that threads pay */
    double tendon[3];   /* mm, now */
    double withdrawn;   /* the needle, mm */
    int loop;           /* steps of the loop that are kept: 0 or LOOP_STEPS */
    int64_t loop_size;  /* doubles of one step */
    double *loop_state; /* every chain's state after each step */
};

enum { LOOP_STEPS = 24, LINK_STAYS = -1, LINK_TENDON = -2 };

/* roles.c */
skg_role skg_role_of(const char *label, int *number, int *side);
skg_tissue skg_tissue_of(const char *label);
int skg_label_begins(const char *label, const char *word);
int skg_label_stays(const char *label); /* a bone that does not move */

/* measure.c */
double skg_body_lung_ratio(const skg_body *body);   /* V0/V of the lungs; 1 where there is none */
double skg_body_needle_depth(const skg_body *body); /* of the mesh below the skin, mm; NaN: no needle */

/* near.c */
skg_status skg_near_prepare(skg_body_organ *organ);
/* The nearest point of an organ's triangles within reach of a point; the distance, or
 * HUGE_VAL. */
double skg_nearest(const skg_body_organ *organ, const double point[3], double reach, skg_link *link);

/* ribs.c */
skg_status skg_rib_prepare(const skg_body *body, skg_body_organ *rib);
double skg_rib_fraction(double weight); /* of the rotation at full inspiration */
void skg_rib_plane(const skg_body_organ *rib, const double *displacements, double *pump, double *bucket);

/* organ.c: what the caller says of an organ, copied and checked. */
skg_status skg_body_fill_organ(const skg_organ *given, skg_body_organ *organ);

/* axes.c: all but the solving of angles. Vectors have length 1. */
int skg_rib_bone_axis(const skg_body *body, const skg_body_organ *rib, double head[3], double along[3]);
void skg_inertia_axes(const skg_body_organ *organ, double axes[9], double end[3]);

/* tie.c: links that the caller gives. Which organs they go to, and the order that follows. */
skg_status skg_body_check_ties(skg_body *body);
void skg_link_fix(const skg_body *body, const double p[3], skg_link *link); /* where the other is rigid */
double skg_given_link(const skg_body *body, const skg_body_organ *organ, const double p[3], skg_link *link,
                      double *rigid);

/* conflict.c */
void skg_conflict_partners(const skg_body *body, const skg_body_organ *organ, const char *between[2]);
void skg_body_tell_conflicts(skg_body *body);

/* corotate.c */
int skg_corotates(const skg_body *body, const skg_body_organ *organ);
int skg_drivers_frame(const skg_body_organ *organ, skg_rigid *frame); /* 0: no driver moves */
void skg_frame_enter(const skg_rigid *frame, const double rest[3], const double u[3], double v[3]);
void skg_frame_leave(const skg_rigid *frame, const double rest[3], const double v[3], double u[3]);

/* link.c */
skg_status skg_body_find_links(skg_body *body);

/* struts.c: ties across a sheet, added to its edges; the caller frees *ends. */
skg_status skg_body_add_struts(const skg_body_organ *organ, int64_t *links, int32_t **ends);

/* pose.c */
void skg_link_follow(const skg_body *body, const skg_link *link, double displacement[3]);
void skg_carried_vertex(const skg_body *body, const skg_body_organ *organ, int64_t vertex,
                        double displacement[3]);

#endif
