/* The object in cells. Private. */
#ifndef SKG_VOXELS_H
#define SKG_VOXELS_H

#include "geometry/overlaps.h"
#include "plan/recipe.h"
#include "scatter/interactions.h"

/* --- All functions of each material at the points of the tables, one below the other. */

/* The functions in their order: the first three have a row for each energy, the others for each momentum transfer. */
enum {
    SKG_SCATTER_TOTAL,
    SKG_SCATTER_COMPTON,
    SKG_SCATTER_RAYLEIGH,
    SKG_SCATTER_INCOHERENT,
    SKG_SCATTER_COHERENT,
    SKG_SCATTER_FUNCTIONS
};

/* The first row of a function; that of SKG_SCATTER_FUNCTIONS is the number of rows. */
int64_t skg_scatter_first_row(const skg_scatter_physics *grid, int function);

/* columns: [count][rows] 1/mm, freed by the caller. Only the points of grid are read. */
skg_status skg_scatter_columns(int64_t count, skg_material *const *materials, const skg_scatter_physics *grid,
                               double **columns);

/* --- The object as cells, each with the mixture of materials in it. *
 * Parallel columns through all parts, along z: each hit adds what its part's material is more than its parent's to the cells
 * behind it, and its share to its own cell (cumulative path lengths). Along the columns this is exact, across them sampled by
 * SKG_CELL_COLUMNS x SKG_CELL_COLUMNS columns a cell. Amounts are whole multiples of a small unit, so that a cell of void holds
 * exactly nothing. */

enum { SKG_CELLS_DEFAULT = 64, SKG_CELLS_MAX = 128, SKG_CELL_COLUMNS = 2 };

/* Whole multiples of a unit, of which sums of 2^22 hits fit in 63 bits: of the coefficients, and how many times each volume of cells is
 * there. */
#define SKG_CELL_UNIT 0x1p40
enum { SKG_CELL_TIMES = SKG_SCATTER_RANK, SKG_CELL_AMOUNTS = SKG_CELL_TIMES + SKG_SCATTER_VOLUMES_MAX };
typedef int64_t skg_cell_amount[SKG_CELL_AMOUNTS];

typedef struct {
    int64_t count[3];       /* cells along x, y, z; along x and y as many */
    double low[3], size[3]; /* mm, of the box of all parts */
    skg_mixture *mixtures;  /* [z][y][x] coefficients of skg_scatter_physics per mm */
    skg_cell_amount *known; /* [z][y][x] what is at one place of each, beyond the base: SKG_KNOWN */
    int64_t volume_count;   /* volumes of cells */
    int64_t (*within)[SKG_SCATTER_RANK]; /* [volume][z][y][x] what each holds there, on average; NULL: none */
    double mean[SKG_SCATTER_RANK];       /* over the cells */
    /* As photons read them (walk.clh), by skg_cells_trace: */
    skg_mixture *media; /* [media_count] mixtures per mm, and what faces of each part add */
    uint32_t *tree;     /* [tree_count] words of the cells; bricks of finer cells; lists of faces */
    float (*faces)[16];
    int64_t media_count, tree_count, face_count;
    uint32_t rough; /* the first medium of rough cells, of which each has one, [z][y][x]; 0: there are none */
    /* cells that hold the mixture of media which differ little, and those whose faces are met */
    int64_t smeared, traced;
} skg_cells;

/* The place of a cell where its medium is known, in shares of its sides: a column that was walked, at an odd height, so that faces
 * rarely contain it. */
#define SKG_KNOWN ((const double[3]){0.3660254037844386, 0.20710678118654755, 0.5772156649015329})

/* A volume of cells among the parts. What it holds differs from place to place, and is no part's amount: it is added where amounts say that
 * the volume is there. A volume in another is the box of its own and displaces that. */
typedef struct {
    const skg_volume *volume;
    int64_t first_curve; /* among those of all volumes */
    double to_cells[16]; /* from mm of the world */
    int32_t *times;      /* [parts] 1: its box; -1: a part inside it, which displaces it */
    double (*coefficients)[SKG_SCATTER_RANK]; /* [curves] of an amount of 1, per mm */
    double (*lines)[SKG_SCATTER_RANK];        /* likewise of the beam's lines */
} skg_cell_volume;

/* Closed parts. */
typedef struct {
    int64_t count;
    const skg_solid *solids;
    const int32_t *sign; /* 1; -1: the solid's hits have the other sign */
    const double *base;  /* [SKG_SCATTER_RANK] of what is around all solids, per mm; NULL: void */
    const double (*coefficients)[SKG_SCATTER_RANK]; /* of each solid less those of its parent, per mm */
    /* of each, which decides where solids with the same parent overlap; NULL: amounts add */
    const int32_t *priority;
    int32_t clip;  /* 1, with priority: a solid counts only inside its parent */
    int32_t unite; /* 1: a solid counts once where its winding number is above 0 */
    int64_t volume_count;
    const skg_cell_volume *volumes; /* [volume_count] */
} skg_cell_parts;

static inline int64_t skg_cells_count(const skg_cells *cells) {
    return cells->count[0] * cells->count[1] * cells->count[2];
}

/* The most curves that a volume among the parts has. */
int64_t skg_cell_curves(const skg_cell_parts *parts);

/* The coefficients of each part in these units; the caller frees them. */
skg_status skg_cells_amounts(const skg_cell_parts *parts, skg_cell_amount **amounts);

/* From a depth on there is `factor` times `more`. */
typedef void skg_cell_change(void *user, double depth, const int64_t *more, int64_t factor);

/* Gives all changes along a column, which cancel in the end; by depth where priorities decide. work: [2][parts] */
void skg_cells_walk(const skg_cell_parts *parts, const skg_cell_amount *amounts, skg_columns *grid,
                    int64_t column, int64_t *work, skg_cell_change *change, void *user);

/* Fills cells->within: the mean content of each volume in each cell, over the points of the cell that lie inside the volume. */
skg_status skg_cells_within(const skg_cell_parts *parts, skg_cells *cells);

/* Adds the integral of what a volume holds from one place of the world to another, as shares of the way: coefficients, or lines. amounts:
 * workspace of the curves of the volume */
void skg_volume_between(const skg_cell_volume *volume, int lines, const double from[3], const double to[3],
                        double *amounts, double sums[SKG_SCATTER_RANK]);

/* Makes the cells of parts. voxel_mm: about; 0: SKG_CELLS_DEFAULT cells along each side. Without any triangle there are no cells. */
skg_status skg_cells_make(const skg_cell_parts *parts, double voxel_mm, skg_cells *cells);

/* Makes of cells what photons read. Where media meet whose difference, over a side of the cell, is an optical depth above `limit`, the
 * cell gets the faces of the parts; else, and where parts compete, its mixture stands for it. mu: 1/mm per coefficient. */
skg_status skg_cells_trace(const skg_cell_parts *parts, const double mu[SKG_SCATTER_RANK], double limit,
                           skg_cells *cells);

/* Prepares cells for a sequence of limits, as skg_cells_trace does for one: data that a cell needs at any limit are made once, and stay in
 * the cells. The arguments must stay until the end; from then on the cells are independent of them. Without cells there is no planting. */
typedef struct skg_planting skg_planting;
skg_status skg_planting_begin(const skg_cell_parts *parts, const double mu[SKG_SCATTER_RANK],
                              skg_cells *cells, skg_planting **planting);
skg_status skg_planting_to(skg_planting *planting, double limit);

/* Number of cells with faces that would hold a mixture at this limit, without those in which parts compete. */
int64_t skg_planting_smears(const skg_planting *planting, double limit);
void skg_planting_end(skg_planting **planting);

/* The sum of the coefficients times mm from one place to another, in mm from the lowest corner, as photons read the cells. */
void skg_cells_along(const skg_cells *cells, const double from[3], const double to[3],
                     double mm[SKG_SCATTER_RANK]);
/* Sum along SKG_ROUGH_STEPS steps through the rough cells, as a photon first estimates it. */
void skg_cells_roughly(const skg_cells *cells, const double from[3], const double to[3],
                       double mm[SKG_SCATTER_RANK]);
void skg_cells_free(skg_cells *cells);

/* A beam as few lines, as many as there are coefficients at most, so that parts are walked as with these. */
typedef struct {
    int64_t count;
    double kev[SKG_SCATTER_RANK], weight[SKG_SCATTER_RANK]; /* weight: share of the beam's energy */
    double world[SKG_SCATTER_RANK];                         /* 1/mm at each line */
    const double (*parts)[SKG_SCATTER_RANK]; /* of each part less that of its parent, 1/mm at each line */
} skg_beam_lines;

/* Groups of neighbouring energies with about the same share each. */
void skg_beam_lines_find(const skg_spectrum *spectrum, skg_beam_lines *lines);

/* mu: [count] 1/mm of materials at the lines */
void skg_beam_lines_attenuated(const skg_beam_lines *lines, int64_t count, skg_material *const *materials,
                               double (*mu)[SKG_SCATTER_RANK]);

/* How far cells, read as photons read them, are from the surfaces, by what scatters straight on once, t exp(-t) at an optical depth of t: the
 * sum of the absolute differences over blocks of the detector, over the sum. With mixtures in cells on purpose, 28 rooms were off by .35 to
 * 1.8 of this in the scatter itself (docs/scatter.md), so that it is stated as the share of the mean that the scatter may be off by for
 * what stands for the object. All 0 if a part reaches behind the source. */
typedef struct {
    double cells; /* if the coefficients stand for the materials on both ways */
    double all;   /* with the materials themselves through the surfaces */
    double rough; /* what rough cells are off by on single rays, root mean square over that of the cells */
} skg_judged;

/* The ways through the surfaces are walked once, at the begin; what is given has to stay until the end. */
typedef struct skg_judging skg_judging;
skg_status skg_judging_begin(const skg_cell_parts *parts, const skg_scatter_physics *physics,
                             const skg_beam_lines *lines, const skg_view *view, const skg_cells *cells,
                             skg_judging **judging);
skg_status skg_judging_of(skg_judging *judging, skg_judged *judged);
void skg_judging_end(skg_judging **judging);

/* --- The scattering object: the parts in the beam, as cells */

/* A frame's scene. */
typedef struct {
    const skg_recipe *recipe;
    const skg_view *view;
    const double *const *poses; /* [parts] each NULL for the scene's; NULL: all the scene's */
    const double *density;      /* [parts] over that of the material; NULL: 1 */
    const double *fill;         /* [parts] share of the part that is there; NULL: 1 */
    uint64_t seed;              /* added to that of the options */
    skg_progress *progress;     /* NULL: none */
} skg_scatter_work;

/* The pose of a part. */
const double *skg_scatter_pose(const skg_scatter_work *work, int64_t part);

typedef struct {
    skg_scatter_physics physics;    /* of the materials of parts and world */
    skg_emitters emitters;          /* likewise */
    double world[SKG_SCATTER_RANK]; /* coefficients of the world; 0: vacuum */
    skg_cells cells;
    skg_judged judged;
    /* judged.cells if no other cells hold mixtures than those where parts compete, and of a volume */
    double settled_error;
} skg_scatter_object;

/* The share of a tolerance that the object may use up. */
#define SKG_SCATTER_MOST 0.5

/* Makes both. Free the object also after a failure. */
skg_status skg_scatter_object_make(const skg_scatter_work *work, skg_scatter_object *object);
void skg_scatter_object_free(skg_scatter_object *object);

#endif
