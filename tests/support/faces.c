/* Scenes whose source, start plane or detector lies on, at or inside a face, an edge or a corner of a part, with another part in the beam and one around everything. */
#include "support/faces.h"

#include "support/caster.h"
#include "support/random.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Where the source, or the detector, lies. */
enum { AT_END, AT_FACE, AT_EDGE, AT_CORNER, DETECTOR_AT_END, PLACES };
static const char *const places[PLACES] = {"the part ends at the source", "on a face", "on an edge",
                                           "on a corner", "the part begins at the detector"};

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void draw_axes(uint64_t *seed, double axes[3][3]) {
    const double z = draw(seed, -1, 1), around = draw(seed, 0, 6.283), turn = draw(seed, 0, 6.283);
    const double across = sqrt(1 - z * z), c = cos(turn), s = sin(turn);
    const double d[3] = {across * cos(around), across * sin(around), z};
    const double a[3] = {-sin(around), cos(around), 0}, b[3] = {-z * cos(around), -z * sin(around), across};
    for (int k = 0; k < 3; k++)
        axes[0][k] = c * a[k] + s * b[k], axes[1][k] = c * b[k] - s * a[k], axes[2][k] = d[k];
}

static solid draw_part(uint64_t *seed, double size) {
    double axes[3][3];
    solid s;
    switch (draw_below(seed, 4)) {
    case 0:
        s = solid_sphere(size / 2, 12, 6);
        break;
    case 1:
        s = solid_torus(0.35 * size, 0.15 * size, 12, 6);
        break;
    default: /* a plate, a rod or a cube */
        s = solid_box(size * pow(10, draw(seed, -3, 0)), size * pow(10, draw(seed, -1, 0)), size);
    }
    draw_axes(seed, axes);
    const int turned = draw_below(seed, 3) > 0;
    const double at[3] = {draw(seed, -100, 100), draw(seed, -100, 100), draw(seed, -100, 100)};
    const double m[12] = {turned ? axes[0][0] : 1, turned ? axes[0][1] : 0, turned ? axes[0][2] : 0, at[0],
                          turned ? axes[1][0] : 0, turned ? axes[1][1] : 1, turned ? axes[1][2] : 0, at[1],
                          turned ? axes[2][0] : 0, turned ? axes[2][1] : 0, turned ? axes[2][2] : 1, at[2]};
    solid_move(&s, m);
    if (draw_below(seed, 2)) solid_round(&s);
    return s;
}

/* A place on a random triangle, and its normal. */
static void draw_place(uint64_t *seed, const solid *s, int where, double place[3], double normal[3]) {
    const int32_t *corner = s->corners + 3 * draw_below(seed, s->triangles);
    const double *p[3], first = draw(seed, 0, 1), second = draw(seed, 0, 1 - first);
    for (int k = 0; k < 3; k++) p[k] = s->positions + 3 * (int64_t)corner[k];
    const double u = where == AT_CORNER ? 0 : first, v = where == AT_FACE ? second : 0;
    double ab[3], ac[3], size = 0;
    for (int k = 0; k < 3; k++) {
        ab[k] = p[1][k] - p[0][k], ac[k] = p[2][k] - p[0][k];
        place[k] = p[0][k] + u * ab[k] + v * ac[k];
    }
    for (int k = 0; k < 3; k++) {
        normal[k] = ab[(k + 1) % 3] * ac[(k + 2) % 3] - ab[(k + 2) % 3] * ac[(k + 1) % 3];
        size += normal[k] * normal[k];
    }
    for (int k = 0; k < 3; k++) normal[k] = size > 0 ? normal[k] / sqrt(size) : k == 0;
}

/* The corner that lies farthest along a direction. */
static const double *end_of(const solid *s, const double *along) {
    const double *end = s->positions;
    for (int64_t v = 1; v < s->vertices; v++)
        if (dot(s->positions + 3 * v, along) > dot(end, along)) end = s->positions + 3 * v;
    return end;
}

/* Axes whose third one is `along`, or its reverse: faces then lie across the beam. */
static void axes_about(uint64_t *seed, const double *along, double axes[3][3]) {
    const double way = draw_below(seed, 2) ? 1 : -1;
    int least = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(along[k]) < fabs(along[least])) least = k;
    double size = 0;
    for (int k = 0; k < 3; k++) {
        axes[2][k] = way * along[k];
        axes[0][k] = (k == least) - along[least] * along[k];
        size += axes[0][k] * axes[0][k];
    }
    for (int k = 0; k < 3; k++) axes[0][k] /= sqrt(size);
    for (int k = 0; k < 3; k++)
        axes[1][k] =
            axes[2][(k + 1) % 3] * axes[0][(k + 2) % 3] - axes[2][(k + 2) % 3] * axes[0][(k + 1) % 3];
}

face_scene face_scene_make(uint64_t number) {
    uint64_t seed = 7919 * number + 1;
    face_scene s = {
        .mu = {pow(10, draw(&seed, -4, 1.5)), pow(10, draw(&seed, -2, 0)), pow(10, draw(&seed, -5, -2))}};
    const double size = pow(10, draw(&seed, 0, 2.2)), distance = draw(&seed, 200, 1500);
    const int where = (int)draw_below(&seed, PLACES), parallel = draw_below(&seed, 4) == 0;
    const double off =
        draw_below(&seed, 5) == 0 ? 0 : (draw_below(&seed, 2) ? 1 : -1) * pow(10, draw(&seed, -12, -2));
    double place[3], normal[3], axes[3][3], sphere[3];
    s.parts[0] = draw_part(&seed, size);
    draw_place(&seed, &s.parts[0], where, place, normal);
    if (draw_below(&seed, 2))
        axes_about(&seed, normal, axes);
    else
        draw_axes(&seed, axes);
    const double back[3] = {-axes[2][0], -axes[2][1], -axes[2][2]};
    if (where == AT_END) memcpy(place, end_of(&s.parts[0], axes[2]), sizeof place);
    if (where == DETECTOR_AT_END) memcpy(place, end_of(&s.parts[0], back), sizeof place);
    const double *way = where == AT_END || where == DETECTOR_AT_END ? axes[2] : normal;
    skg_view *view = &s.view;
    skg_view_init(view);
    view->projection = parallel ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
    view->columns = view->rows = 32;
    const double pitch = distance * pow(10, draw(&seed, -2, 0.2)) / 32;
    /* Paths of a parallel beam to an oblique detector start at different t. */
    const double lean = draw_below(&seed, 2) ? draw(&seed, -1, 1) : 0;
    for (int k = 0; k < 3; k++) {
        const double at = place[k] + off * way[k];
        view->source[k] = where == DETECTOR_AT_END ? at - distance * axes[2][k] : at;
        view->centre[k] = where == DETECTOR_AT_END ? at : at + distance * axes[2][k];
        view->column_step[k] = pitch * (axes[0][k] + lean * axes[2][k]);
        view->row_step[k] = pitch * axes[1][k];
        sphere[k] = 0.5 * (view->source[k] + view->centre[k]) + pitch * axes[0][k];
    }
    s.parts[1] = solid_sphere(4 * pitch, 12, 6);
    solid_shift(&s.parts[1], sphere[0], sphere[1], sphere[2]);
    s.parts[2] = solid_box(1e4, 1.1e4, 1.2e4);
    s.mu[2] *= (double)draw_below(&seed, 2); /* or nothing */
    snprintf(s.name, sizeof s.name, "scene %llu: %s, off by %.1e mm, part of %.3g mm, %s",
             (unsigned long long)number, places[where], off, size, parallel ? "parallel" : "point");
    return s;
}

void face_scene_free(face_scene *s) {
    for (int p = 0; p < FACE_PARTS; p++) solid_free(&s->parts[p]);
}

/* The diagonal of a box around a solid. */
static double size_of(const solid *s) {
    double square = 0;
    for (int k = 0; k < 3; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int64_t v = 0; v < s->vertices; v++)
            low = fmin(low, s->positions[3 * v + k]), high = fmax(high, s->positions[3 * v + k]);
        square += (high - low) * (high - low);
    }
    return sqrt(square);
}

/* The lengths that a part may have at a pixel. */
static void range_of(caster *c, const skg_view *view, int64_t column, int64_t row, double moved, double shift,
                     double *low, double *high) {
    double least, most;
    caster_range(c, view, column, row, shift, low, high);
    for (int k = 0; k < 6; k++) {
        skg_view other = *view;
        other.source[k % 3] += k < 3 ? moved : -moved;
        caster_range(c, &other, column, row, 0, &least, &most);
        *low = fmin(*low, least);
        *high = fmax(*high, most);
    }
}

double face_scene_judge(const face_scene *s, const double *image, int is_double, int64_t rays,
                        uint64_t seed) {
    const skg_view *view = &s->view;
    const int64_t pixels = view->rows * view->columns;
    const double epsilon = is_double ? DBL_EPSILON : (double)FLT_EPSILON;
    const double share = is_double ? 1e-11 : 3e-5, flat = 2e-6 * epsilon / (double)FLT_EPSILON;
    double bar = 0, most = 0, worst = 0;
    caster *casters[FACE_PARTS];
    for (int p = 0; p < FACE_PARTS; p++) {
        const double size = size_of(&s->parts[p]);
        bar += 0.1 * s->mu[p] * fmax(share, flat) * size;
        most += 0.1 * s->mu[p] * size;
        casters[p] = caster_create(&s->parts[p], NULL);
    }
    bar += 4 * epsilon * most; /* exponents and images are rounded, too */
    for (int64_t n = 0; n < pixels; n++)
        if (!(image[n] >= -bar && image[n] <= most + bar)) worst = HUGE_VAL;
    for (int64_t n = 0; n < rays; n++) {
        const int64_t middle = view->columns / 2 - 3; /* and six pixels on */
        const int64_t column = n % 2 ? middle + draw_below(&seed, 6) : draw_below(&seed, view->columns);
        const int64_t row = n % 2 ? middle + draw_below(&seed, 6) : draw_below(&seed, view->rows);
        const int64_t pixel = row * view->columns + column;
        double least = 0, largest = 0, low, high;
        for (int p = 0; p < FACE_PARTS; p++) {
            /* Eight roundings of the part's size and of the way to its origin; of world coordinates in double. */
            const double moved = 8 * epsilon * 2 * size_of(&s->parts[p]) + 8 * DBL_EPSILON * 2000;
            range_of(casters[p], view, column, row, moved, 4 * epsilon * (double)view->columns, &low, &high);
            least += 0.1 * s->mu[p] * low;
            largest += 0.1 * s->mu[p] * high;
        }
        worst = fmax(worst, fmax(least - image[pixel], image[pixel] - largest) / bar);
        if (isnan(least)) worst = HUGE_VAL;
    }
    for (int p = 0; p < FACE_PARTS; p++) caster_free(casters[p]);
    return worst;
}
