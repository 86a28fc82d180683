/* Blocks that are cut into pieces, and shells nested within each other with faces in common: together they have to give the
 * picture of the whole, however rounding decides on rays that lie in the plane of a cut. */
#ifndef SKG_TESTS_CUTS_H
#define SKG_TESTS_CUTS_H

#include "support/caster.h"

#include <skiagraph/skiagraph.h>

enum { CUTS_PIECES = 512, CUTS_BODIES = 8 };

/* Where the planes of the cuts are, all of them along rays: through centres of pixels, or anywhere. */
enum { CUTS_THROUGH_CENTRES, CUTS_ANYWHERE, CUTS_PLACES };

enum {
    CUTS_PIECE_BY_PIECE, /* each piece is cut by a plane of its own: corners of one stand amid edges of another */
    CUTS_THROUGH_ALL,   /* each plane cuts all pieces */
    CUTS_TWO_MATERIALS, /* piece by piece; values lie between those of the two */
    CUTS_NESTED,        /* shells, each inside the one before, with faces flush with it */
    CUTS_STRUCTURES
};

typedef struct {
    int structure, place, cuts; /* cuts: planes that have cut something */
    int64_t parts;
    solid part[CUTS_PIECES];
    double pose[CUTS_PIECES][16], mu[CUTS_PIECES];
    int64_t inside[CUTS_PIECES]; /* the parent's number; -1: none */
    skg_view view;
    /* 1: the block lies within the picture; more: the picture shows this share of its sides */
    double magnified;
    int bodies; /* the truth: exponents are the sum of weight[k] times the length in body[k], mm */
    solid body[CUTS_BODIES];
    double weight[CUTS_BODIES];
    double least, most; /* factors on that sum: the range of two materials */
} cut_scene;

/* The scene of this number; another one for each. size: pixels along a side of its picture; most: pieces. Free with
 * cut_free. */
cut_scene *cut_make(uint64_t number, int64_t size, int most);
void cut_free(cut_scene *s);

/* Makes a scene of the parts of the cut scene, to be released. */
skg_status cut_scene_create(skg_context *context, const cut_scene *s, skg_scene **scene);

/* Pixels of an image of exponents that are wrong: further than `bar` of the largest exponent from those of rays shifted by up
 * to `shift` pixels. met: those whose ray meets the block. first: the first wrong one, if there is one. */
typedef struct {
    int64_t met, wrong, first;
    double worst; /* in units of the largest exponent */
} cut_verdict;

cut_verdict cut_judge(const cut_scene *s, const double *image, double shift, double bar);

#endif
