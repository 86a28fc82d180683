/* What the label of an organ says of it. Private. */
#ifndef SKG_ROLES_H
#define SKG_ROLES_H

#include "chainmail/chainmail.h"

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

/* The same of an organ that follows ribs and dome together. */
skg_tissue skg_coupled_tissue_of(const char *label);

/* Whether a label begins with a word, without regard to case, and no letter follows. */
int skg_label_begins(const char *label, const char *word);

/* Whether this is a bone that does not move, or what lies at the spine and does not. */
int skg_label_stays(const char *label);

/* Whether this is the wall of the body, in which everything lies: skin or muscle. */
int skg_label_is_wall(const char *label);

#endif
