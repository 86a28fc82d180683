/* State of a body, and the roles that labels give to organs. Private. */
#ifndef SKG_BODY_TYPES_H
#define SKG_BODY_TYPES_H

#include "body/rigid.h"
#include "chainmail/chainmail.h"
#include "core/context.h"
#include "distance/nearest.h"
#include "mesh/mesh.h"

#include <skiagraph/breathing.h>

/* How an organ moves. */
typedef enum {
    ROLE_STATIC,
    ROLE_RIGID, /* turns as the caller says */
    ROLE_RIB,
    ROLE_STERNUM,
    ROLE_CARTILAGE, /* between a rib and the sternum or another rib */
    ROLE_DIAPHRAGM,
    ROLE_LINKED,   /* deformable, driven through links: lungs, liver, heart, skin, muscle */
    ROLE_CARRIED,  /* every vertex moves with the nearest ones of a carrier */
    ROLE_SPANNED,  /* one end moves with a carrier, the other stays */
    ROLE_ENCLOSED, /* moves with the rigid organ that it lies in */
    ROLE_NEEDLE
} skg_role;

/* The role of a label. number: of ribs and cartilages, 1 to 12; else 0. side: 1 left, -1 right, 0 neither. */
skg_role skg_role_of(const char *label, int *number, int *side);

/* The tissue of a deformable organ with this label. */
skg_tissue skg_tissue_of(const char *label);

/* The tissue of a deformable organ that follows ribs and dome together. */
skg_tissue skg_coupled_tissue_of(const char *label);

/* Whether a label begins with a word, without regard to case, and no letter follows. */
int skg_label_begins(const char *label, const char *word);

/* Whether this is a bone that does not move, or what lies at the spine and does not. */
int skg_label_stays(const char *label);

/* Whether this is the wall of the body, in which everything lies: skin or muscle. */
int skg_label_is_wall(const char *label);

/* Values of skg_link.organ that are no organ: the point stays at rest, or moves with the diaphragm's tendon. */
enum { LINK_STAYS = -1, LINK_TENDON = -2 };

/* A point that follows another organ: a point of one of its triangles or, where fixed, a point that moves with a
 * rigid organ as a whole. */
typedef struct {
    int32_t organ, corner[3]; /* corner: vertices of that organ */
    double weight[3];
    double fraction; /* of that displacement, 0 to 1 */
    int32_t fixed, reserved;
    double point[3]; /* at rest, where fixed */
} skg_link;

/* CARRIERS: vertices that together carry a vertex of another organ. LOOP_STEPS: states of a breath that are stored for
 * hysteresis. BONES: bones that together move a point of the chest wall. All are choices. */
enum { CARRIERS = 12, LOOP_STEPS = 24, BONES = 4 };

/* A thin facet. corner[0] lies opposite its longest edge. If that corner has to move away from the edge, each corner
 * takes the part `by` of the way: the two others backwards. */
typedef struct {
    int32_t corner[3], reserved;
    double by[3], normal[3]; /* at rest, twice the area long */
} skg_thin;

/* The point of the diaphragm nearest to a vertex, and how far away it is in mm. */
typedef struct {
    double away, weight[3];
    int32_t corner[3], reserved;
} skg_base;

/* --- Members that organs of single kinds need beside the common part. A struct each and no union: an organ may be of two kinds, as the
 * vessels of the liver, which are carried and follow ribs and dome. */

/* Rigid organs: how they turn. */
typedef struct {
    int given;      /* 1: axis is the caller's, at weight 1 */
    int centred;    /* 1: head is the caller's */
    double head[3]; /* the point about which the organ turns */
    double axis[3]; /* rotation vector, rad: at weight 1 where given, else at full inspiration */
} skg_turning;

/* Deformable organs. links[d] moves driver d. */
typedef struct {
    skg_chain *chain; /* of the vertices, and of the far ends of links that are not rigid */
    int64_t links;
    skg_link *link;
    double *anchor;        /* per driver: its place at rest */
    skg_organ_link *given; /* links of the caller, instead of the label's rule */
    int64_t given_count;
    int stage;      /* posed after organs of lower stages */
    int corotates;  /* 1: boxes turn with the drivers */
    int unfolds;    /* 1: facets that would fold are opened after its links were kept */
    double *target; /* per driver: displacement */
    double *state;  /* displacements of the chain's nodes, axis by axis */
    double *memory; /* the same with hysteresis: the state before, as moved on */
    skg_chain_report report;
} skg_soft;

/* Organs that follow ribs and dome together (shares.h). */
typedef struct {
    double *share;   /* per vertex: of the tendon's displacement */
    double shear[3]; /* of the liver: growth of the share across the tendon's motion, per mm */
    double squeeze;  /* and its fall along it, per mm */
    double *beyond;  /* per vertex of what the liver carries: displacement beyond its carriers', as course */
    double *course;  /* per vertex: displacement with the tendon at weight 1, mm */
    int32_t *bone;   /* per vertex: BONES bones; NULL: none */
    double *bone_weight; /* their weights */
    /* Distances and weights from which share, course and bone_weight are found, as the meshes lie: options that change find only these
     * three again. Of the diaphragm, way is the distance of each vertex from the rim, mm, or its share where the plane is given. */
    double *way;
    double farthest;   /* the greatest of them */
    skg_base *base;    /* per vertex of what lies over the diaphragm */
    double *bone_base; /* per vertex: weights of its bones, whose sum is 1 */
    double *bone_away; /* per vertex: distance of the nearest bone, mm */
    int64_t thins;
    skg_thin *thin; /* facets that fold easily (shares.h) */
} skg_coupling;

/* Carried organs. Of a cartilage, near holds the two organs that it lies between. */
typedef struct {
    int32_t by;       /* the carrier */
    int32_t *near;    /* per vertex: CARRIERS vertices of the carrier */
    double *weight;   /* their weights */
    double *fraction; /* per vertex: of the carrier's motion, 0 to 1; of a cartilage: of the second organ's */
} skg_carried;

/* The needle: its end in the tissue, and where it enters the skin. */
typedef struct {
    double tip[3], pivot[3];
    skg_link skin; /* that place */
} skg_needle;

typedef struct {
    skg_mesh *mesh;
    char *label;
    int64_t inside;
    skg_tissue tissue;
    int tissue_by_label; /* 1: the caller gave none */
    skg_role role;
    int kind;   /* SKG_ORGAN_ of the caller */
    int warned; /* of a conflict */
    int64_t vertices, triangles;
    double *rest;     /* rows of x, y, z, mm */
    double bounds[6]; /* of rest: low, high */
    double volume;    /* at rest, mm3 */
    int32_t *corner;
    skg_tree tree;    /* of the triangles at rest */
    int32_t *node_of; /* per vertex: the first vertex at the same place */
    double *moved;    /* displacements, rows of x, y, z, mm */
    int changed;      /* 1: the mesh is not at rest */
    int number, side; /* as skg_role_of gives them */
    int coupled;      /* 1: it follows ribs and dome together */
    skg_rigid rigid;  /* of what moves as a whole: its motion as posed */
    skg_turning turn;
    skg_soft soft;
    skg_coupling coupling;
    skg_carried carried;
    skg_needle needle;
} skg_body_organ;

struct skg_body {
    skg_context *context;
    skg_body_options options;
    int64_t organs, capacity;
    skg_body_organ *organ;
    int tried, linked;           /* 1: skg_body_link was called; it succeeded */
    int plane_given;             /* 1: the options have a plane of the tendon */
    int large;                   /* 1: deformable organs have so many vertices that threads pay */
    int32_t diaphragm, reserved; /* its number, if it is coupled; otherwise -1 */
    double tendon[3];            /* displacement as posed, mm */
    double descended;            /* the same over that at weight 1 */
    double withdrawn;            /* by how much the needle is drawn back, mm */
    /* per organ, of bones: displacement of p is row k times p plus the fourth number, 12 numbers */
    double *bone_motion;
    int bones_move;     /* 1: one of them is not at rest */
    int loop;           /* states stored for hysteresis: 0 or LOOP_STEPS */
    int64_t loop_size;  /* doubles of one of them */
    double *loop_state; /* every chain's memory after each step */
};

#endif
