/* Adversarial bodies: corners on the rays of pixels give or take some ulps, faces nearly along the rays, slivers. */
#include "hard/bodies.h"

#include "support/random.h"

#include <math.h>

const char *const hard_names[HARD_KINDS] = {"sphere", "blob", "torus", "shell",  "octahedra", "slabs",
                                            "sliver", "fine", "flat",  "plates", "foils"};

/* Every body fits a sphere of this radius around the origin, in mm. */
static const double extent = 80;

skg_view hard_view(int64_t size, uint64_t number) {
    skg_view view;
    skg_view_init(&view);
    view.projection = number % 2 ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
    view.columns = view.rows = size;
    view.source[2] = -1000;
    view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = 2.5 * extent / (double)size;
    return view;
}

/* Moves a vertex across the beam onto the ray of the nearest pixel, give or take `ulps` units in the last place of a
 * float, as the library stores it. */
static void pull_onto_ray(double *p, const skg_view *view, int ulps, uint64_t *seed) {
    const double depth = (p[2] - view->source[2]) / (view->centre[2] - view->source[2]);
    const double scale = view->projection == SKG_PROJECTION_POINT ? depth : 1;
    for (int k = 0; k < 2; k++) {
        const double step = (k == 0 ? view->column_step[0] : view->row_step[1]) * scale;
        const double middle = 0.5 * (double)(view->columns - 1);
        float x = (float)((round(p[k] / step + middle) - middle) * step);
        for (int64_t u = draw_below(seed, 2 * ulps + 1) - ulps; u != 0; u += u < 0 ? 1 : -1)
            x = nextafterf(x, u < 0 ? -INFINITY : INFINITY);
        p[k] = (double)x;
    }
}

/* A turn about a random axis through the origin, by Rodrigues' formula. */
static void turn(solid *s, uint64_t *seed) {
    const double z = draw(seed, -1, 1), around = draw(seed, 0, 6.28), across = sqrt(1 - z * z);
    const double a[3] = {across * cos(around), across * sin(around), z}, angle = draw(seed, 0, 6.28);
    const double c = cos(angle), sine = sin(angle), d = 1 - c;
    const double m[12] = {
        c + a[0] * a[0] * d,           a[0] * a[1] * d - a[2] * sine, a[0] * a[2] * d + a[1] * sine, 0,
        a[1] * a[0] * d + a[2] * sine, c + a[1] * a[1] * d,           a[1] * a[2] * d - a[0] * sine, 0,
        a[2] * a[0] * d - a[1] * sine, a[2] * a[1] * d + a[0] * sine, c + a[2] * a[2] * d,           0};
    solid_move(s, m);
}

/* Plates whose faces lean from the ray by a small angle, each turned about the beam. */
static solid slabs(uint64_t *seed) {
    enum { SLABS = 12 };
    solid all = {0};
    for (int n = 0; n < SLABS; n++) {
        solid one = solid_box(draw(seed, 20, 50), draw(seed, 0.01, 8), draw(seed, 10, 50));
        const double lean = pow(10, draw(seed, -7, 0)), round = draw(seed, 0, 6.28);
        const double c = cos(lean), sine = sin(lean), cr = cos(round), sr = sin(round);
        const double m[12] = {cr, -sr * c, sr * sine,  draw(seed, -25, 25),
                              sr, cr * c,  -cr * sine, draw(seed, -25, 25),
                              0,  sine,    c,          draw(seed, -10, 10)};
        solid_move(&one, m);
        if (n == 0) {
            all = one;
        } else {
            solid_add(&all, &one);
            solid_free(&one);
        }
    }
    return all;
}

/* Shells anywhere in the picture, of triangles of 0.1 to 1 pixel. */
static solid fine_shells(const skg_view *view, uint64_t *seed) {
    enum { SHELLS = 4 };
    solid all = {0};
    for (int n = 0; n < SHELLS; n++) {
        const double pixels = pow(10, draw(seed, -0.3, 1.1)); /* radius: half a pixel to twelve */
        const double side = draw(seed, 0.1, 1);
        int around = (int)(2 * 3.14 * pixels / side);
        around = around < 12 ? 12 : around > 240 ? 240 : around;
        const double radius = pixels * 1000 / 1200 * view->column_step[0];
        solid one = solid_shell(radius, draw(seed, 0.2, 0.99) * radius, around, around / 2);
        turn(&one, seed);
        solid_shift(&one, draw(seed, -50, 50), draw(seed, -50, 50), draw(seed, -30, 30));
        if (n == 0) {
            all = one;
        } else {
            solid_add(&all, &one);
            solid_free(&one);
        }
    }
    return all;
}

/* The generator of a plate's numbers; the thickness is drawn first. */
static uint64_t plate_seed(uint64_t number) {
    return number * 7919 + 11;
}

static double draw_thickness(uint64_t *seed) {
    return pow(10, draw(seed, -3, log10(3)));
}

double hard_thickness(uint64_t number) {
    uint64_t seed = plate_seed(number);
    return draw_thickness(&seed);
}

/* Half of them lean from the rays by any small angle, the others by any angle; each is turned about the beam. */
static solid plate(uint64_t number) {
    uint64_t seed = plate_seed(number);
    const double thickness = draw_thickness(&seed);
    const double x = pow(10, draw(&seed, 0, log10(500))), y = pow(10, draw(&seed, 0, log10(500)));
    solid s = solid_box(x, y, thickness);
    const double lean = draw_below(&seed, 2) ? pow(10, draw(&seed, -6, 0.19)) : draw(&seed, 0, 1.57);
    const double c = cos(1.5707963267948966 - lean), sine = sin(1.5707963267948966 - lean);
    const double around = draw(&seed, 0, 6.28), within = draw(&seed, 0, 6.28);
    const double spin[12] = {cos(within), -sin(within), 0, 0, sin(within), cos(within), 0, 0, 0, 0, 1, 0};
    const double tilt[12] = {1, 0, 0, 0, 0, c, -sine, 0, 0, sine, c, 0};
    const double roll[12] = {cos(around), -sin(around),
                             0,           draw(&seed, -9, 9),
                             sin(around), cos(around),
                             0,           draw(&seed, -9, 9),
                             0,           0,
                             1,           draw(&seed, -50, 50)};
    solid_move(&s, spin);
    solid_move(&s, tilt);
    solid_move(&s, roll);
    return s;
}

void hard_view_fit(const solid *s, skg_view *view) {
    double most = 0;
    for (int64_t n = 0; n < s->vertices; n++)
        most = fmax(most, fmax(fabs(s->positions[3 * n]), fabs(s->positions[3 * n + 1])));
    view->column_step[0] = view->row_step[1] = 2.7 * most / (double)view->columns;
}

static solid raw_body(int kind, const skg_view *view, uint64_t *seed) {
    /* Triangles of 3 to 20 pixels: smaller ones fold up when their corners go to the same rays. */
    const int around = (int)((double)view->columns * draw(seed, 0.06, 0.18)), down = around / 2;
    solid s;
    switch (kind) {
    case HARD_SPHERE:
        return solid_sphere(extent, around, down);
    case HARD_BLOB:
        return solid_blob(0.8 * extent, around, down, draw_bits(seed));
    case HARD_TORUS:
        return solid_torus(0.7 * extent, 0.3 * extent, around, down);
    case HARD_SHELL:
        return solid_shell(extent, draw(seed, 0.6, 0.9) * extent, around, down);
    case HARD_OCTAHEDRA:
        return solid_octahedra(2000, view, (int)draw_below(seed, 3), 1 + (int)draw_below(seed, 2),
                               draw_bits(seed));
    case HARD_SLABS:
        return slabs(seed);
    case HARD_FINE:
        return fine_shells(view, seed);
    default: {
        s = solid_sphere(extent, around, down);
        const double flat = pow(10, draw(seed, -6, -0.5)), m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, flat, 0};
        solid_move(&s, m);
        return s;
    }
    }
}

solid hard_body(int kind, const skg_view *view, uint64_t number) {
    if (kind == HARD_PLATES) return plate(number);
    uint64_t seed = number * HARD_TURNS + (uint64_t)kind + 1;
    solid s = raw_body(kind, view, &seed);
    if (kind == HARD_SLABS || kind == HARD_OCTAHEDRA) return s;
    if (kind != HARD_FINE) turn(&s, &seed);
    const int ulps = (int)draw_below(&seed, 3);
    for (int64_t n = 0; n < s.vertices && kind != HARD_SLIVER; n++)
        pull_onto_ray(s.positions + 3 * n, view, ulps, &seed);
    return s;
}
