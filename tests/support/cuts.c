/* Blocks that are cut into pieces, and shells nested within each other with faces in common: together they have to give the picture of the whole, however rounding decides on rays that lie in the plane of a cut. */
#include "support/cuts.h"

#include "support/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FACES = 32, CORNERS = 32 };

/* A convex polygon, and a convex body. Corners at one place have the same bits in all faces. */
typedef struct {
    int count;
    double at[CORNERS][3];
} polygon;

typedef struct {
    int count;
    polygon face[FACES]; /* counter-clockwise from outside */
} convex;

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *c) {
    for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static int same(const double *a, const double *b) {
    return memcmp(a, b, 3 * sizeof *a) == 0;
}

/* --- cutting */

typedef struct {
    double normal[3], point[3];
} plane;

static double side_of(const plane *p, const double *at) {
    const double from[3] = {at[0] - p->point[0], at[1] - p->point[1], at[2] - p->point[2]};
    return dot(p->normal, from);
}

/* Where a plane meets an edge: the same bits whichever end comes first. */
static void meet(const plane *p, const double *a, const double *b, double *at) {
    int order = 0;
    for (int k = 0; k < 3 && order == 0; k++) order = (a[k] > b[k]) - (a[k] < b[k]);
    const double *low = order < 0 ? a : b, *high = order < 0 ? b : a;
    const double sl = side_of(p, low), sh = side_of(p, high), part = sl / (sl - sh);
    for (int k = 0; k < 3; k++) at[k] = low[k] + part * (high[k] - low[k]);
}

/* The face that a cut makes: its corners, given in any order, go around `out`. */
static void order_around(polygon *f, const double *out) {
    double middle[3] = {0}, axes[2][3], angle[CORNERS];
    for (int c = 0; c < f->count; c++)
        for (int k = 0; k < 3; k++) middle[k] += f->at[c][k] / f->count;
    for (int k = 0; k < 3; k++) axes[0][k] = f->at[0][k] - middle[k];
    cross(out, axes[0], axes[1]);
    for (int c = 0; c < f->count; c++) {
        const double from[3] = {f->at[c][0] - middle[0], f->at[c][1] - middle[1], f->at[c][2] - middle[2]};
        angle[c] = atan2(dot(from, axes[1]) / sqrt(dot(axes[1], axes[1])),
                         dot(from, axes[0]) / sqrt(dot(axes[0], axes[0])));
    }
    for (int c = 1; c < f->count; c++)
        for (int d = c; d > 0 && angle[d - 1] > angle[d]; d--) {
            double corner[3];
            const double other = angle[d];
            memcpy(corner, f->at[d], sizeof corner);
            memcpy(f->at[d], f->at[d - 1], sizeof corner);
            memcpy(f->at[d - 1], corner, sizeof corner);
            angle[d] = angle[d - 1], angle[d - 1] = other;
        }
}

/* Cuts a body at the plane and keeps the side before it (way 1) or behind it (-1). 0: too many faces. */
static int keep(const convex *from, const plane *p, double way, convex *to) {
    polygon cap = {0};
    to->count = 0;
    for (int f = 0; f < from->count; f++) {
        const polygon *given = &from->face[f];
        polygon left = {0};
        for (int c = 0; c < given->count; c++) {
            const double *a = given->at[c], *b = given->at[(c + 1) % given->count];
            const int here = way * side_of(p, a) > 0, there = way * side_of(p, b) > 0;
            if (left.count + 2 > CORNERS) return 0;
            if (here) memcpy(left.at[left.count++], a, sizeof *left.at);
            if (here == there) continue;
            meet(p, a, b, left.at[left.count]);
            int known = 0;
            for (int k = 0; k < cap.count; k++) known |= same(cap.at[k], left.at[left.count]);
            if (cap.count == CORNERS) return 0;
            if (!known) memcpy(cap.at[cap.count++], left.at[left.count], sizeof *cap.at);
            left.count++;
        }
        if (to->count == FACES) return 0;
        if (left.count >= 3) to->face[to->count++] = left;
    }
    if (cap.count < 3 || to->count == FACES) return 0;
    const double out[3] = {-way * p->normal[0], -way * p->normal[1], -way * p->normal[2]};
    order_around(&cap, out);
    to->face[to->count++] = cap;
    return 1;
}

/* Whether the plane leaves some of the body on either side, and passes no corner. */
static int divides(const convex *c, const plane *p) {
    double low = 0, high = 0, nearest = HUGE_VAL;
    for (int f = 0; f < c->count; f++)
        for (int k = 0; k < c->face[f].count; k++) {
            const double s = side_of(p, c->face[f].at[k]);
            low = fmin(low, s), high = fmax(high, s), nearest = fmin(nearest, fabs(s));
        }
    return low < -0.1 && high > 0.1 && nearest > 1e-7;
}

/* --- solids */

static void add_triangle(solid *s, const polygon *f, int a, int b, int c) {
    const int corners[3] = {a, b, c};
    for (int k = 0; k < 3; k++) {
        const double *at = f->at[corners[k] % f->count];
        int64_t v = 0;
        while (v < s->vertices && !same(s->positions + 3 * v, at)) v++;
        if (v == s->vertices) memcpy(s->positions + 3 * s->vertices++, at, 3 * sizeof *at);
        s->corners[3 * s->triangles + k] = (int32_t)v;
    }
    s->triangles++;
}

/* Faces become fans from any of their corners. */
static solid solid_of(const convex *c, uint64_t *seed) {
    int corners = 0;
    for (int f = 0; f < c->count; f++) corners += c->face[f].count;
    solid s = {0, 0, calloc((size_t)(3 * corners), sizeof(double)),
               calloc((size_t)(3 * corners), sizeof(int32_t))};
    for (int f = 0; f < c->count; f++) {
        const polygon *face = &c->face[f];
        const int first = (int)draw_below(seed, face->count);
        for (int k = 1; k + 1 < face->count; k++) add_triangle(&s, face, first, first + k, first + k + 1);
    }
    return s;
}

static convex box(const double *half) {
    static const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    convex c = {.count = 6};
    for (int q = 0; q < 6; q++) {
        c.face[q].count = 4;
        for (int k = 0; k < 4; k++)
            for (int axis = 0; axis < 3; axis++)
                c.face[q].at[k][axis] = quads[q][k] >> axis & 1 ? half[axis] : -half[axis];
    }
    return c;
}

/* --- places: rows by columns, then a shift */

static void turn(double *m, uint64_t *seed, double shift) {
    const double z = draw(seed, -1, 1), around = draw(seed, 0, 6.28), across = sqrt(1 - z * z);
    const double a[3] = {across * cos(around), across * sin(around), z}, angle = draw(seed, 0, 6.28);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            const double turned = r == c ? 0 : (c - r + 3) % 3 == 1 ? -a[3 - r - c] : a[3 - r - c];
            m[4 * r + c] = (r == c) * cos(angle) + a[r] * a[c] * (1 - cos(angle)) + turned * sin(angle);
        }
        m[4 * r + 3] = draw(seed, -shift, shift);
    }
}

static void move(const double *m, const double *at, double shifted, double *to) {
    double moved[3];
    for (int r = 0; r < 3; r++) moved[r] = dot(m + 4 * r, at) + shifted * m[4 * r + 3];
    memcpy(to, moved, sizeof moved);
}

/* Positions become those of the part before its pose. */
static void unpose(solid *s, const double *m) {
    for (int64_t v = 0; v < s->vertices; v++) {
        double from[3], at[3];
        for (int k = 0; k < 3; k++) from[k] = s->positions[3 * v + k] - m[4 * k + 3];
        for (int k = 0; k < 3; k++) at[k] = m[k] * from[0] + m[4 + k] * from[1] + m[8 + k] * from[2];
        memcpy(s->positions + 3 * v, at, sizeof at);
    }
}

/* --- scenes */

/* A plane along the rays, in the picture through `pixel` in the direction `way`. */
static plane plane_through(const skg_view *view, const double *pixel, const double *way) {
    plane p;
    double along[3], ray[3];
    for (int k = 0; k < 3; k++) {
        along[k] = way[0] * view->column_step[k] + way[1] * view->row_step[k];
        p.point[k] = view->centre[k] + (pixel[0] - 0.5 * (double)(view->columns - 1)) * view->column_step[k] +
                     (pixel[1] - 0.5 * (double)(view->rows - 1)) * view->row_step[k];
        ray[k] = (view->projection == SKG_PROJECTION_POINT ? p.point[k] : view->centre[k]) - view->source[k];
    }
    cross(along, ray, p.normal);
    const double length = sqrt(dot(p.normal, p.normal));
    for (int k = 0; k < 3; k++) p.normal[k] /= length;
    return p;
}

/* A plane of a scene: through any pixel, or any place, in a direction that meets many pixels or in any. */
static plane draw_plane(const cut_scene *s, uint64_t *seed) {
    static const double ways[][2] = {{1, 0},  {0, 1}, {1, 0}, {0, 1}, {1, 1},  {1, -1}, {3, 4},  {4, 3},
                                     {-3, 4}, {1, 2}, {2, 1}, {7, 1}, {-1, 7}, {20, 1}, {1, 20}, {-40, 1}};
    const int64_t known = draw_below(seed, 20), count = sizeof ways / sizeof *ways;
    const double angle = draw(seed, 0, 3.14), any[2] = {cos(angle), sin(angle)};
    double pixel[2];
    for (int k = 0; k < 2; k++) {
        pixel[k] = draw(seed, 0.2, 0.8) * (double)(s->view.columns - 1);
        if (s->place == CUTS_THROUGH_CENTRES) pixel[k] = round(pixel[k]);
    }
    return plane_through(&s->view, pixel, known < count ? ways[known] : any);
}

static int cut_pieces(cut_scene *s, convex *piece, int most, uint64_t *seed) {
    int count = 1;
    for (int tries = 0; tries < 4 * most && count < most; tries++) {
        const plane p = draw_plane(s, seed);
        const int all = s->structure == CUTS_THROUGH_ALL, before = count;
        const int first = all ? 0 : (int)draw_below(seed, count), end = all ? before : first + 1;
        for (int n = first; n < end && count < most; n++) {
            if (!divides(&piece[n], &p)) continue;
            const convex whole = piece[n];
            if (!keep(&whole, &p, 1, &piece[n]) || !keep(&whole, &p, -1, &piece[count]))
                piece[n] = whole;
            else
                count++;
        }
        s->cuts += count > before;
    }
    return count;
}

/* Shells: each is what a few planes leave of the one before, which keeps its other faces. */
static int nest(cut_scene *s, convex *shell, int most, uint64_t *seed) {
    int count = 1;
    for (int tries = 0; tries < 40 && count < most; tries++) {
        const plane p = draw_plane(s, seed);
        shell[count] = shell[count - 1];
        if (!divides(&shell[count], &p)) continue;
        if (keep(&shell[count - 1], &p, draw_below(seed, 2) ? 1 : -1, &shell[count])) count++, s->cuts++;
    }
    return count;
}

/* Moves the whole world, and gives the parts their poses: none, one for all, or one each. */
static void place(cut_scene *s, uint64_t *seed) {
    double world[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, common[16];
    const int64_t poses = draw_below(seed, 3);
    if (draw_below(seed, 2)) turn(world, seed, 300);
    memcpy(common, world, sizeof common);
    turn(common, seed, 100);
    for (int k = 0; k < s->bodies; k++) solid_move(&s->body[k], world);
    for (int64_t n = 0; n < s->parts; n++) {
        solid_move(&s->part[n], world);
        memcpy(s->pose[n], common, sizeof common);
        if (poses == 2) turn(s->pose[n], seed, 100);
        for (int k = 0; k < 16 && poses == 0; k++) s->pose[n][k] = k % 5 == 0;
        unpose(&s->part[n], s->pose[n]);
    }
    move(world, s->view.source, 1, s->view.source);
    move(world, s->view.centre, 1, s->view.centre);
    move(world, s->view.column_step, 0, s->view.column_step);
    move(world, s->view.row_step, 0, s->view.row_step);
}

static void fill(cut_scene *s, const convex *piece, const convex *whole, uint64_t *seed) {
    const int nested = s->structure == CUTS_NESTED, two = s->structure == CUTS_TWO_MATERIALS;
    double mu = 0;
    s->least = 1, s->most = two ? 1.1 : 1;
    for (int64_t n = 0; n < s->parts; n++) {
        s->part[n] = solid_of(&piece[n], seed);
        s->inside[n] = nested ? n - 1 : -1;
        s->mu[n] = nested ? draw(seed, 0.2, 2) : two && draw_below(seed, 2) ? 1.1 : 1;
        if (!nested) continue;
        s->body[s->bodies] = solid_copy(&s->part[n]);
        s->weight[s->bodies++] = 0.1 * (s->mu[n] - mu); /* per mm */
        mu = s->mu[n];
    }
    if (nested) return;
    s->body[0] = solid_of(whole, seed);
    s->weight[0] = 0.1;
    s->bodies = 1;
}

cut_scene *cut_make(uint64_t number, int64_t size, int most) {
    uint64_t seed = 1000003 * number + 7;
    cut_scene *s = calloc(1, sizeof *s);
    convex *piece = calloc(CUTS_PIECES, sizeof *piece);
    skg_view_init(&s->view);
    s->view.projection = number % 2 ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
    s->place = (int)(number / 2 % CUTS_PLACES);
    s->structure = (int)(number / 2 / CUTS_PLACES % CUTS_STRUCTURES);
    s->view.columns = s->view.rows = size;
    s->view.source[2] = -1000;
    s->view.centre[2] = 200;
    s->magnified = number / 16 % 2 ? 10 : 1;
    s->view.column_step[0] = s->view.row_step[1] = 160 / s->magnified / (double)size;
    const double half[3] = {draw(&seed, 20, 60), draw(&seed, 20, 60), draw(&seed, 2, 60)};
    const convex whole = box(half);
    const double pieces = exp(draw(&seed, log(2), log((double)most + 1)));
    piece[0] = whole;
    s->parts = s->structure == CUTS_NESTED
                   ? nest(s, piece, 2 + (int)draw_below(&seed, CUTS_BODIES - 1), &seed)
                   : cut_pieces(s, piece, (int)pieces, &seed);
    fill(s, piece, &whole, &seed);
    place(s, &seed);
    free(piece);
    return s;
}

void cut_free(cut_scene *s) {
    for (int64_t n = 0; s && n < s->parts; n++) solid_free(&s->part[n]);
    for (int k = 0; s && k < s->bodies; k++) solid_free(&s->body[k]);
    free(s);
}

static skg_status add_part(skg_context *context, const cut_scene *s, int64_t n, skg_scene *scene) {
    skg_part part;
    char label[32];
    const solid *of = &s->part[n];
    snprintf(label, sizeof label, "piece %d", (int)n);
    skg_part_init(&part);
    skg_status status = skg_mesh_create(context, label,
                                        &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                           .vertices = of->vertices,
                                                           .positions = of->positions,
                                                           .triangles = of->triangles,
                                                           .corners = of->corners,
                                                           .unit_mm = 1},
                                        &part.mesh);
    if (status == SKG_OK) status = skg_material_create_mu(label, s->mu[n], &part.material);
    part.label = label;
    part.inside = s->inside[n];
    memcpy(part.pose, s->pose[n], sizeof part.pose);
    if (status == SKG_OK) status = skg_scene_part_add(scene, &part, NULL);
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    return status;
}

skg_status cut_scene_create(skg_context *context, const cut_scene *s, skg_scene **scene) {
    skg_status status = skg_scene_create(context, scene);
    for (int64_t n = 0; n < s->parts && status == SKG_OK; n++) status = add_part(context, s, n, *scene);
    if (status != SKG_OK) skg_scene_release(scene);
    return status;
}

/* --- the truth */

static double exponent(const cut_scene *s, caster **casters, double column, double row) {
    double sum = 0;
    for (int k = 0; k < s->bodies; k++)
        sum +=
            s->weight[k] * (double)caster_length(casters[k], &s->view, (long double)column, (long double)row);
    return sum;
}

/* How far a value is from those of the rays around a pixel: in directions between those of any cuts that meet there. */
static double off(const cut_scene *s, caster **casters, double column, double row, double shift,
                  double value) {
    enum { RAYS = 40 };
    double low = exponent(s, casters, column, row), high = low;
    for (int k = 0; k < RAYS; k++) {
        /* Angles beside the rows and columns are for cuts that are nearly rows or columns. */
        const double angle = k < 32 ? k * 0.19635 : 1.5708 * (k % 4) + (k < 36 ? 0.004 : -0.004);
        const double sum = exponent(s, casters, column + shift * cos(angle), row + shift * sin(angle));
        low = fmin(low, sum), high = fmax(high, sum);
        if (isnan(sum)) return HUGE_VAL;
    }
    return fmax(0, fmax(s->least * low - value, value - s->most * high));
}

cut_verdict cut_judge(const cut_scene *s, const double *image, double shift, double bar) {
    const int64_t pixels = s->view.columns * s->view.rows;
    caster *casters[CUTS_BODIES];
    cut_verdict v = {.first = -1};
    double *exact = calloc((size_t)pixels, sizeof *exact), largest = 0;
    for (int k = 0; k < s->bodies; k++) casters[k] = caster_create(&s->body[k], NULL);
    for (int64_t p = 0; p < pixels; p++) {
        exact[p] = exponent(s, casters, (double)(p % s->view.columns), (double)(p / s->view.columns));
        largest = fmax(largest, s->most * exact[p]);
        v.met += exact[p] != 0;
    }
    for (int64_t p = 0; p < pixels; p++) {
        const double value = image[p], column = (double)(p % s->view.columns),
                     row = (double)(p / s->view.columns);
        if (value >= s->least * exact[p] - bar * largest && value <= s->most * exact[p] + bar * largest)
            continue;
        const double error = off(s, casters, column, row, shift, value) / largest;
        v.worst = fmax(v.worst, error);
        if (error <= bar) continue;
        if (v.wrong++ == 0) v.first = p;
    }
    for (int k = 0; k < s->bodies; k++) caster_free(casters[k]);
    free(exact);
    return v;
}
