/* Spheres whose triangles may be changed, and their path lengths and attenuations. */
#ifndef SKG_SOUP_H
#define SKG_SOUP_H

#include "suite.h"

#include <skiagraph/skiagraph.h>

enum { SIDE = 200, LIMIT = 4000 };

extern skg_context *context;
extern skg_material *water;
extern skg_spectrum *beam;
extern skg_view view;

/* A sphere whose triangles may be changed. */
typedef struct {
    int64_t vertices, triangles;
    double positions[3 * LIMIT];
    int32_t corners[3 * LIMIT];
} soup;

typedef struct {
    double mm[SIDE][SIDE];
    skg_plan_report report;
} picture;

/* Options of a picture besides its mesh. */
typedef struct {
    int32_t repair, strategy, precision, images;
    double z[2]; /* of the two parts */
} wish;

void open_context(void);
void close_context(void);
void fill_sphere(soup *s);
skg_mesh *mesh_of(const soup *s);

/* The triangle whose middle is nearest a place. */
int64_t triangle_at(const soup *s, double x, double y, double z);
void remove_triangle(soup *s, int64_t t);
void flip_triangle(soup *s, int64_t t);

/* Lengths of the one part, or the attenuation of two. */
void take(const soup *a, const soup *b, const wish *w, picture *result);
double worst(const picture *a, const picture *b);
int64_t count_different(const picture *a, const picture *b);

#endif
