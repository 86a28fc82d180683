/* Drawn scenes of one to three parts, thin and thick, for the bound of the precision. Judged by the caster; nothing here calls
 * the library. */
#ifndef SKG_TESTS_DRAWN_H
#define SKG_TESTS_DRAWN_H

#include "support/shapes.h"

enum { DRAWN_PARTS = 3 };

typedef struct {
    int parts;
    solid solids[DRAWN_PARTS];
    double mu[DRAWN_PARTS]; /* 1/cm */
    skg_view view;
    char name[96];
} drawn_scene;

/* Another scene for each number. Free with drawn_scene_free. */
drawn_scene drawn_scene_make(uint64_t number);
void drawn_scene_free(drawn_scene *s);

/* The worst relative errors of an image. */
typedef struct {
    double whole; /* against the other image */
    /* of the interval of rays that are shifted by 4 last places of a coordinate relative to each part */
    double outside;
    int64_t pixel; /* of `outside` */
} drawn_error;

/* Compares transmissions in single precision with those in double, [rows][columns]; relative where more than 1e-6 arrives, else
 * in units of 1e-6. Where they differ most, the caster finds the interval; double precision lies in it. */
drawn_error drawn_scene_judge(const drawn_scene *s, const double *single, const double *twice);

#endif
