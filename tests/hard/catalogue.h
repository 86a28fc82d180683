/* The catalogue of hard cases: each a small scene, the reason why it is hard, and its bar. */
#ifndef SKG_TESTS_CATALOGUE_H
#define SKG_TESTS_CATALOGUE_H

#include "support/run.h"

/* How a case went. */
typedef struct {
    const char *name, *danger; /* what it is; what could go wrong */
    double worst[2], bar[2];   /* error in single and double, in the case's own unit; worst < 0: not judged */
    const char *unit;
    double slower; /* time of a frame over that of an ordinary scene of that size; 0: not measured */
    char fault[240];
} hard_outcome;

/* Notes what is wrong; the first fault is kept. */
void hard_fault(hard_outcome *o, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A solid under a view, judged by the caster in both precisions and by all strategies. */
typedef struct {
    const char *name, *danger;
    solid body;
    double pose[16];
    skg_view view;
    double wobble; /* as in hard_scene */
    double turned;
    int sliver;
    double size;       /* mm by which errors are divided; 0: the longest path */
    double double_bar; /* 0: 1e-11 */
} hard_solid;

/* The shapes that scenes.c lacks; SOLIDS of them. */
enum { HARD_SOLIDS = 16 };
void hard_solid_make(int which, hard_solid *s);

/* Images, open meshes, many parts, breathing, bounds, cuts, derivatives. */
typedef void (*hard_function)(hard_outcome *o);
extern const hard_function hard_images[], hard_meshes[], hard_bodies[], hard_bounds[], hard_cuts[],
    hard_gradients[]; /* end with NULL */

/* The ways whose bits have to be the same; the first one is the plan's choice. */
enum { HARD_WAYS = 4 };
extern const run_choice hard_ways[HARD_WAYS];

/* Bits of `image` against the first of its kind: a fault where they differ. */
void hard_same_bits(hard_outcome *o, int way, const double *image, int64_t count, uint64_t *first);

/* Every value finite, none below `least`. */
void hard_check_values(hard_outcome *o, const double *image, int64_t count, double least);

/* Sets o->slower: the fastest frame of the plan over that of an ordinary scene of that size, timed alternately. Its
 * size: as many pixels, triangles, and hits of pixels' paths with triangles, which are what work is made of;
 * in one part, spheres within each other, all of them between source and detector (ordinary.c). */
void hard_compare_time(hard_outcome *o, const skg_scene *scene, skg_plan *plan, const skg_view *view);

int hard_case_count(void);
void hard_case_run(int which, hard_outcome *o);

#endif
