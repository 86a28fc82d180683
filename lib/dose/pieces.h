/* Lines through the parts of a scene on the host: where they cross surfaces, and which part has which piece. Private. */
#ifndef SKG_DOSE_PIECES_H
#define SKG_DOSE_PIECES_H

#include "core/core.h"
#include "plan/recipe.h"

/* --- The triangles of all closed parts, in boxes within boxes. */

typedef struct {
    double low[3], high[3];
    int32_t first, count; /* count 0: its two halves are the nodes from `first` on; else its triangles */
} skg_forest_node;

typedef struct {
    int64_t count, node_count;
    double (*corners)[9]; /* [count] mm, world */
    int32_t *part;        /* [count] */
    int8_t *sign;         /* [count] 1; -1: the part's triangles face inward */
    skg_forest_node *nodes;
} skg_forest;

/* Free the tree also after a failure. */
skg_status skg_forest_make(const skg_scene *scene, skg_forest *tree);
void skg_forest_free(skg_forest *tree);

/* --- Pieces of a line through the parts */

typedef struct {
    double at; /* mm from the beginning */
    int32_t part;
    int32_t sign; /* 1: it enters the part, -1: it leaves it */
} skg_crossing;

/* A part that has a share of a piece; -1: the world. Shares are 1 but where parts overlap; of cells of a volume, times g/cm3. */
typedef struct {
    int32_t part;
    int32_t curve; /* of the cells of a volume (scene/volume.h); else 0 */
    double share;
} skg_presence;

typedef struct {
    double from, to;
    int64_t first, count; /* presences */
} skg_piece;

/* Which part has a place, as images have it: parts displace those that they lie inside, and of parts that compete the highest priority
 * counts. All zero, but for these: */
typedef struct {
    const skg_scene *scene;
    int32_t competing, clip, unite; /* competing: 1: priorities, clip or unite decide */
    int32_t cells;                  /* 1: there are volumes of cells */
    int32_t alone, reserved;        /* 0, or 1 + the number of the only part that is there */
} skg_rules;

/* The rules that a plan has. */
skg_rules skg_rules_of(const skg_recipe *recipe);

/* A line and what was found along it. All zero: no memory yet. One for each thread. */
typedef struct {
    int64_t crossing_count, crossing_room, piece_count, piece_room, presence_count, presence_room;
    skg_crossing *crossings;
    skg_piece *pieces;
    skg_presence *presences;
    int32_t *winding, *active; /* [parts] workspace; those that are not 0 are listed in `active` */
    int64_t active_count;
} skg_way;

/* Finds all crossings from `from` on along a direction, sorted. Signs cancel over every part, also where lines meet edges: each edge
 * belongs to one side (S. Woop, C. Benthin and I. Wald, Watertight ray/triangle intersection, Journal of Computer Graphics Techniques 2
 * (2013) 65-82, with the half-open rule of rasterisers). */
skg_status skg_way_cross(const skg_forest *tree, const double from[3], const double direction[3],
                         skg_way *way);

/* Finds the pieces of the line up to `reach` mm: skg_way_cross, and what the rules make of it. Pieces in which there is nothing but the
 * world have it as their presence. */
skg_status skg_way_find(const skg_forest *tree, const skg_rules *rules, const double from[3],
                        const double direction[3], double reach, skg_way *way);
void skg_way_free(skg_way *way);

/* Finds the pieces likewise, those in volumes of cells as long as the cells are the same. Values that are linear between cells count as
 * those of
 * the cells, which have the same mass. */
skg_status skg_way_find_cells(const skg_forest *tree, const skg_rules *rules, const double from[3],
                              const double direction[3], double reach, skg_way *way);

/* Adds a piece without presences, and one to the last piece. */
skg_status skg_way_add_piece(skg_way *way, double from, double to);
skg_status skg_way_add_presence(skg_way *way, const skg_presence *presence);

#endif
