/* The relationships of a package (ECMA-376, part 2), of which 3MF is one. Private. */
#ifndef SKG_MESH_RELATIONS_H
#define SKG_MESH_RELATIONS_H

/* The part in which they stand. */
#define SKG_RELATIONS_PART "_rels/.rels"

enum { SKG_RELATION_MAX = 256 };

/* Prepare with {text}, which ends in a zero. */
typedef struct {
    const char *at; /* where it goes on */
    int is_begun;   /* 1: within the element Relationships */
} skg_relations;

/* Gets the name of the next part that holds a 3MF model. Returns 1; 0 at the end of the document; -1 where the text is none. Less
 * is understood than XML allows: no entities and no other elements. */
int skg_relations_next_model(skg_relations *relations, char target[SKG_RELATION_MAX]);

#endif
