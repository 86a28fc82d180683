/* Solids and views at which coverage by rounded arithmetic goes wrong, with the truth about each. */
#ifndef SKG_TESTS_SCENES_H
#define SKG_TESTS_SCENES_H

#include "support/run.h"

enum {
    HARD_OCTAHEDRA,          /* 3000; corners within 3 ulp of the rays of pixels */
    HARD_OCTAHEDRA_EDGES,    /* the same, and edges and faces along rays but for those ulps */
    HARD_OCTAHEDRA_PARALLEL, /* corners on the rays exactly, but for float rounding */
    HARD_CUBE_ON_CENTRES,    /* parallel: corners and edges on pixel centres, sides along the rays */
    HARD_CUBES_ON_CENTRES,   /* point: front corners and edges on centres, cubes side by side sharing faces'
                                places */
    HARD_SLIVERS,            /* flattened 50 times */
    HARD_SLIVERS_OBLIQUE,    /* by a pose, edge-on to many rays */
    HARD_SOURCE_INSIDE,
    HARD_CUT_BY_DETECTOR,
    HARD_SOURCE_AND_DETECTOR, /* a long box through both */
    HARD_LONG,                /* through both, and 20 m beyond */
    HARD_MOSTLY_BEHIND,       /* a twentieth of it is before the detector, the rest far behind */
    HARD_MOSTLY_BEHIND_PARALLEL,
    HARD_WIDE,   /* a slab whose bounding sphere holds the source, but it does not */
    HARD_DUST,   /* triangles much smaller than a pixel */
    HARD_SPECK,  /* 40,000 triangles within three pixels */
    HARD_LAYERS, /* one mesh of 20 equal shells at the same place */
    HARD_GIANT,  /* its corners are far outside the detector */
    HARD_SCENES
};

typedef struct {
    const char *name;
    solid body;
    double pose[16];
    skg_view view;
    double wobble; /* pixels by which a ray may be off: the length jumps where a face lies in its plane, and
                      is steep at needles; 0: none */
    int sliver;    /* 1: the bars of slivers hold */
    double turned; /* fraction of pixels at which rounding may turn an edge along the ray inside out: the
                      length is then off by that edge's own, either way */
} hard_scene;

hard_scene hard_make(int which);
void hard_free(hard_scene *h);

#endif
