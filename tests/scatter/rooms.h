/* Rooms with exact bodies, and the scatter that photons of our own find in them. The judge of scatter where parts do not fill their
 * box: thin lead, small castings on large tables, holes.
 *
 * Photons are followed from surface to surface of boxes, balls and rods; nothing is divided into cells. They share the cross sections,
 * form factors and scattering functions of materials with the library, and nothing else. */
#ifndef SKG_TESTS_SCATTER_ROOMS_H
#define SKG_TESTS_SCATTER_ROOMS_H

#include <stdint.h>

enum { ROOM_BODIES = 16, ROOM_BINS = 12, ROOM_SIDE = 4, ROOM_BLOCKS = ROOM_SIDE * ROOM_SIDE };

enum room_shape {
    ROOM_BOX = 0,  /* size: edges */
    ROOM_BALL = 1, /* size[0]: radius */
    ROOM_ROD = 2   /* size[0]: radius, size[1]: length, size[2]: the axis it lies along, 0 to 2 */
};

typedef struct {
    int shape;
    double at[3], size[3]; /* middle; mm */
    const char *material;  /* of skg_material_create_named */
    double density;        /* g/cm3; 0: the material's own */
    int inside;            /* 1 + the number of the body it lies in, which comes before it; 0: none */
} room_body;

/* The source is on the z axis, the detector across it; it is the field, too. */
typedef struct {
    const char *name, *world; /* world: material from source to detector; NULL: vacuum */
    double source, plane;     /* z, mm */
    double side[2];           /* of the detector, along x and y, mm */
    int bins;
    double kev[ROOM_BINS], photons[ROOM_BINS]; /* shares of the beam */
    int count;
    room_body bodies[ROOM_BODIES];
} room;

/* Energy per area of a block of the detector over that of the open beam on the axis. Blocks go along x first. */
typedef struct {
    double primary[ROOM_BLOCKS], scatter[ROOM_BLOCKS],
        sigma[ROOM_BLOCKS];    /* sigma: standard error of the scatter */
    double ratio, ratio_sigma; /* scatter over primary, of all */
    double histories;
} room_truth;

extern const room rooms[];
extern const int rooms_count;

/* A room that a seed decides: layers along the beam of all sizes. name: of at least 32 bytes; it has to live as long */
room room_draw(uint64_t seed, char *name);

/* How photons are followed. */
enum room_method {
    ROOM_EXPECTED =
        0, /* every interaction is counted with its expected share of a random place of the detector */
    ROOM_ANALOGUE = 1 /* photons are counted where they arrive */
};

room_truth room_follow(const room *r, int method, int64_t histories, uint64_t seed);

#endif
