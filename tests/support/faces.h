/* Scenes whose source, start plane or detector lies on, at or inside a face, an edge or a corner of a part, with another
 * part in the beam and one around everything. Judged by the caster; nothing here calls the library. */
#ifndef SKG_TESTS_FACES_H
#define SKG_TESTS_FACES_H

#include "support/shapes.h"

enum { FACE_PARTS = 3 };

typedef struct {
    solid parts
        [FACE_PARTS]; /* the one at the source or the detector, a sphere in the beam, and perhaps a box around all */
    double mu[FACE_PARTS]; /* 1/cm */
    skg_view view;
    char name[96]; /* what lies where, for messages */
} face_scene;

/* Another scene for each number. Free with face_scene_free. */
face_scene face_scene_make(uint64_t number);
void face_scene_free(face_scene *s);

/* The worst distance of an attenuation (-ln I/I0, [rows][columns]) from what the caster finds, in units of the bar, at `rays`
 * random pixels, half of them near the middle; every pixel has to be finite and no larger than the longest paths allow, else HUGE_VAL.
 *
 * The truth of a pixel is the interval over rays that are shifted by 4 last places of a coordinate, and over sources that are
 * displaced by the roundings of the part's size: a ray in a face runs inside or outside of it by these. The bar is that of
 * docs/numerics.md for each part: 3e-5 of the longest path or 2e-6 of the extent (single), 1e-11 and 4e-15 (double). */
double face_scene_judge(const face_scene *s, const double *image, int is_double, int64_t rays, uint64_t seed);

#endif
