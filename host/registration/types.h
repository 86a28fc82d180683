/* State of a registration, and the functions that its files share. Private.
 *
 * The body is the parts that move. A scene of the body holds them and the parts that they lie inside, since their attenuation counts less
 * what they displace; the rest of the scene adds a constant, at one energy. */
#ifndef SKG_REGISTRATION_PRIVATE_H
#define SKG_REGISTRATION_PRIVATE_H

#include "core/core.h"
#include "core/maths.h"

#include <skiagraph/registration.h>

/* Attenuations that have a gain each: the body less what it displaces; of what does not move, that what the body lies inside, with
 * volumes of cells; and light, soft and dense materials. */
typedef enum { REG_BODY_OWN, REG_HOLDING, REG_LIGHT, REG_SOFT, REG_DENSE, REG_SHARES } reg_share;

enum {
    REG_BASIS = 15,                     /* polynomials of order 4 over the image */
    REG_COARSE_BASIS = 6,               /* those of order 2 */
    REG_ADDED = REG_BASIS + REG_SHARES, /* what adds to attenuation: polynomials, and shares */
    REG_NUISANCES =
        REG_ADDED + REG_BASIS, /* of a radiograph: those of attenuation, then those of transmission */
    REG_POSE = 6,              /* free directions of a pose */
    REG_LOCAL = 9,             /* most free directions that a radiograph sees */
    REG_GRAM = REG_LOCAL + REG_NUISANCES + 2, /* most rows of a Gram matrix */
    REG_LEVELS = 12,
    REG_IMAGES = 64, /* most radiographs */
    REG_LONGEST = REG_IMAGES * REG_LOCAL,
    REG_NAME = 96
};

/* Added to transmissions before the logarithm: pixels behind metal, or without photons, end here instead of at infinity, and lose their
 * weight gradually. An assumption: a tenth of a thousandth of the open beam is less than any detector's scatter. */
#define REG_FLOOR 1e-4

/* Losses that differ by less than this share are called the same where the model lacks something. An assumption. */
#define REG_SAME 0.01

typedef struct {
    char name[REG_NAME];
    skg_view view;        /* as given */
    double *transmission; /* [rows][columns] */
    double *given;        /* [rows][columns] 1: the caller lets it count */
    double *mask;         /* [rows][columns] 1: it counts, and is near the shadow */
    double *rest; /* [rows][columns] attenuation of what does not move, and is not in the scene of the body */
    /* [rows][columns] each; REG_BODY_OWN: what an image of the body has without it */
    double *shares[REG_SHARES];
    double *shadow; /* [rows][columns] attenuation of the parts alone at the start */
    double *before; /* [rows][columns] model less radiograph at the start */
} reg_image;

/* A radiograph at a level of the pyramid. */
typedef struct {
    int64_t rows, columns;
    double *fixed; /* -ln(transmission + floor) */
    double *rest;
    double *shares[REG_SHARES]; /* as of reg_image */
    int32_t gains;              /* 1: shares at rest have gains: where a pose is free */
    double *mask;               /* 1: counts */
    int64_t terms;              /* polynomials of each kind: the first ones of REG_BASIS */
    skg_plan *plan;
} reg_shrunk;

typedef struct {
    int64_t factor;
    reg_shrunk *images; /* [image_count] */
} reg_level;

/* Where the search is. */
typedef struct {
    double motion[16]; /* of the body */
    skg_view *views;   /* [image_count] */
    double *nuisances; /* [image_count][REG_NUISANCES] */
    int32_t body_gain; /* 1: the body's contrast has a gain */
} reg_state;

/* Normal equations of a state: the sum of squares is cost + 2 g s + s A s for a step s. Nuisances are eliminated; what is needed to find
 * them for a step is kept. */
typedef struct {
    double cost, reduction; /* reduction: what the nuisances alone take of the cost */
    double *matrix;         /* [count][count] */
    double *gradient;       /* [count] */
    /* [image_count][REG_LOCAL + 1][REG_NUISANCES] inverse of their matrix times coupling and gradient */
    double *coupling;
} reg_equations;

/* Scenes that are rendered: all parts; the body with what it lies inside; only the latter; the parts alone; all but them. */
typedef enum { REG_ALL, REG_BODY, REG_AROUND, REG_SHADOW, REG_REST } reg_kind;

typedef struct {
    skg_scene *scene;
    int64_t count;  /* of parts that move in it */
    int64_t *parts; /* [count] their numbers in it */
} reg_scene;

typedef struct {
    int64_t level;
    double loss;
} reg_step;

struct skg_registration {
    skg_context *context;
    skg_scene *scene;
    skg_spectrum *spectrum, *model; /* model: of one energy */
    skg_plan_options plan;
    skg_registration_options options;
    int64_t part_count, image_count, level_count;
    int64_t *parts;
    reg_image *images;
    reg_scene body;   /* scene of REG_BODY, or of REG_ALL where attenuations do not add */
    int32_t additive; /* 1: they do */
    int64_t rays;     /* along a side of a pixel of a radiograph */
    double middle[3], radius, axis[3];
    reg_level levels[REG_LEVELS]; /* the coarsest first */
    reg_state state;
    reg_step *path;
    int64_t path_count;
    int32_t loss;  /* that is minimized now */
    int32_t ended; /* 1: results can be asked for */
    skg_registration_result result;
    int32_t minimized;      /* the loss that was minimized last */
    double least[REG_POSE]; /* the least certain direction of a pose */
    double apart;           /* of two places that agree almost equally, mm; 0: none is known */
    char verdict[512];
    skg_registration_direction *directions;
    char (*names)[REG_NAME];
};

/* Free directions in all, and of a radiograph; the number of its first one. */
int64_t reg_count(const skg_registration *r);
int64_t reg_local_count(const skg_registration *r);
int64_t reg_first(const skg_registration *r, int64_t image);

/* --- Motions: twist.c */

/* The motion of a twist about the world's origin, and back. */
void reg_motion_of(const double *twist, double *motion);
void reg_twist_of(const double *motion, double *twist);

/* Moves a state by a step: mm, and turns in mm at the body's radius or the detector's. */
void reg_state_move(const skg_registration *r, const double *step, reg_state *state);

/* The direction of free direction k of a radiograph. poses: [parts of the body's scene][6], zeroed by the caller. */
void reg_direction(const skg_registration *r, const reg_state *state, int64_t image, int64_t k,
                   skg_direction *direction, double *poses, double *source, double *detector);

skg_status reg_state_create(const skg_registration *r, reg_state *state);
void reg_state_copy(const skg_registration *r, const reg_state *from, reg_state *to);
void reg_state_free(reg_state *state);

/* --- Scenes: scenes.c */
skg_status reg_scene_make(const skg_registration *r, reg_kind kind, reg_scene *made);
void reg_scene_free(reg_scene *made);

/* Middle, radius and long axis of the body; whether attenuations add. */
skg_status reg_body_measure(skg_registration *r);

/* --- The pyramid: shrink.c, pyramid.c */

/* The view whose pixels are means of factor x factor pixels. */
skg_view reg_view_shrunk(const skg_view *view, int64_t factor);

/* Means of factor x factor values of an image. */
void reg_shrink(const skg_view *view, int64_t factor, const double *from, double *to);

/* The mask near a shadow: pixels at most `distance` pixels from one where it is above 0. */
skg_status reg_mask_near(int64_t rows, int64_t columns, const double *shadow, double distance, double *mask);

skg_status reg_levels_create(skg_registration *r);
void reg_levels_free(skg_registration *r);

/* --- Rendering: render.c */

/* A plan of attenuations. */
skg_status reg_plan_create(const skg_registration *r, skg_scene *scene, skg_spectrum *spectrum,
                           const skg_view *view, int64_t supersampling, skg_plan **plan);

/* One image of a scene that is not kept, at full resolution or shrunk. motion: NULL: at the start. spectrum: NULL: the model's. */
skg_status reg_render_once(skg_registration *r, const reg_scene *scene, skg_spectrum *spectrum,
                           const skg_view *view, int64_t supersampling, const double *motion, double *image);

/* Attenuation of the body in every radiograph at a level: images[i]: [rows][columns]. */
skg_status reg_render(skg_registration *r, const reg_level *level, const reg_state *state, float **images);

/* Renders the images of many poses in one radiograph: [count][rows][columns]. */
skg_status reg_render_poses(skg_registration *r, const reg_shrunk *shrunk, const skg_view *view,
                            int64_t count, const double *motions, float *images);

/* The derivatives of a radiograph's image by its free directions: [local][rows][columns]. */
skg_status reg_differentiate(skg_registration *r, const reg_level *level, const reg_state *state,
                             int64_t image, double *derivatives);

/* Solves a symmetric positive definite system in place: 0 if it is none: solve.c. */
int reg_solve(int64_t count, double *matrix, int64_t right, double *vectors);

/* --- Equations: equations.c */
void reg_basis(int64_t rows, int64_t columns, int64_t row, int64_t column, double *basis);
skg_status reg_equations_create(const skg_registration *r, reg_equations *equations);
void reg_equations_free(reg_equations *equations);

/* The loss of rendered images. */
double reg_loss(const skg_registration *r, const reg_level *level, const reg_state *state,
                float *const *images);

/* Adds a radiograph's part to equations that begin as zeros. damping: of nuisances, relative. */
void reg_equations_add(const skg_registration *r, const reg_level *level, const reg_state *state,
                       int64_t image, const float *body, const double *derivatives, double damping,
                       reg_equations *equations);

/* Adds what the nuisances do for a step. */
void reg_nuisances_move(const skg_registration *r, const reg_equations *equations, const double *step,
                        reg_state *state);

/* Finds the nuisances of a state whose images are given. */
skg_status reg_nuisances_find(const skg_registration *r, const reg_level *level, reg_state *state,
                              float *const *images);

/* -ln of the transmission that the model has, polynomials included: [rows][columns]. */
void reg_model(const skg_registration *r, const reg_level *level, const reg_state *state, int64_t image,
               const float *body, double *model);

/* Adds to `meat`, [count][count], the products of the slopes of the sum of squares, summed over cells of a radiograph: what is left in
 * different cells is taken to be independent (K.-Y. Liang and S. L. Zeger, Biometrika 73 (1986) 13-22). The equations are those of
 * the same state. */
void reg_scores(const skg_registration *r, const reg_level *level, const reg_state *state, int64_t image,
                const float *body, const double *derivatives, const reg_equations *equations, double *meat);

/* Adds sums over a radiograph of what is left of two columns when polynomials and shares at rest have taken theirs: the body's contrast
 * with its gain, and model less radiograph. sums: contrast^2, contrast times difference, difference^2. */
void reg_contrast(const reg_level *level, const reg_state *state, int64_t image, const float *body,
                  const double *contrast, double sums[3]);

/* --- The search: search.c, starts.c */

/* Images of every radiograph at a level. */
skg_status reg_images_create(const skg_registration *r, const reg_level *level, float ***images);
void reg_images_free(const skg_registration *r, float ***images);

/* Minimizes at a level from a state; *loss: at the end. */
skg_status reg_search(skg_registration *r, const reg_level *level, reg_state *state, double *loss);

/* Minimizes likewise, and once more with a gain of the body's contrast where the radiographs ask for it: gain.c. */
skg_status reg_gain_search(skg_registration *r, const reg_level *level, reg_state *state, double *loss);

/* Replaces the state by the best of several starts, searched at all levels but the last. */
skg_status reg_starts_try(skg_registration *r);

skg_status reg_progress(skg_registration *r);

/* --- Before the search: images.c, prepare.c */
void reg_image_free(reg_image *image);
skg_status reg_prepare(skg_registration *r);

/* The shares of a radiograph, once the energy of the model is known: shares.c. */
skg_status reg_shares_find(skg_registration *r, reg_image *image);

/* --- Verdict on the result: judge.c, words.c */

/* Residual of a radiograph, and its correlation. */
typedef struct {
    double squares, noise; /* sums over pixels, and over differences of 2 x 2 pixels */
    int64_t pixels, blocks;
    double lag[33]; /* sums of products of pixels so far apart */
    int64_t lags[33];
    double fixed, fixed_squares;
    int64_t worst_image, worst_row, worst_column; /* middle of the worst cell */
    double worst;
} reg_rest;

skg_status reg_judge(skg_registration *r);

/* After reg_judge: looks for other places that agree as well, and judges again: probe.c. */
skg_status reg_probe(skg_registration *r);
void reg_say_verdict(skg_registration *r, const reg_rest *rest);
void reg_name_direction(const skg_registration *r, const double *vector, char *name, size_t size);

#endif
