/* Adversarial bodies: corners on the rays of pixels give or take some ulps, faces nearly along the rays, slivers. */
#ifndef BENCH_HARD_BODIES_H
#define BENCH_HARD_BODIES_H

#include "support/shapes.h"

enum {
    HARD_SPHERE,
    HARD_BLOB,
    HARD_TORUS,
    HARD_SHELL,
    HARD_OCTAHEDRA,
    HARD_SLABS,
    HARD_SLIVER,
    HARD_FINE,  /* shells of triangles smaller than a pixel, corners on the rays: they fold up and vanish */
    HARD_FLAT,  /* ellipsoids, flattened by up to a million, corners on the rays */
    HARD_TURNS, /* the kinds above take turns */
    HARD_PLATES = HARD_TURNS, /* 1 um to 3 mm thick, sides of 1 to 500 mm, at any tilt */
    HARD_FOILS,               /* those of them that are thinner than 10 um, which are counted apart */
    HARD_KINDS
};

extern const char *const hard_names[HARD_KINDS];

/* size x size pixels, point source or parallel beam by turns of `number`. */
skg_view hard_view(int64_t size, uint64_t number);

/* Scales the view so that the body fills much of it. */
void hard_view_fit(const solid *s, skg_view *view);

/* The thickness in mm of plate `number`. */
double hard_thickness(uint64_t number);

/* The body `number` of this kind before that view; another one for each number. */
solid hard_body(int kind, const skg_view *view, uint64_t number);

#endif
