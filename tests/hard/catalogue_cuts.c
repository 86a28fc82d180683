/* Blocks that are cut by planes which nearly hold the rays of a column or row of pixels, against the whole block: a truth that needs no
 * ray caster. SKG_CUTS_SEED: other scenes than these; SKG_CUTS_SCENES: how many of each kind. */
#include "hard/catalogue.h"

#include "suite.h"
#include "support/random.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 65, MIDDLE = 32, PIECES = 4, HALF = 20, DEEP = 15, RIM = 3, SCENES = 6 };

/* A scene in units of pixels at the block, turned and shifted into the world. */
typedef struct {
    double pitch, source, away, tilt; /* mm, mm, mm, rad */
    int parallel, across;             /* across: the cuts hold rays of rows */
    int pieces;
    double cuts[PIECES + 1][2]; /* x at the near and far end */
    double turn[3][3], shift[3];
} cut_block;

static void draw_turn(uint64_t *seed, double turn[3][3]) {
    const double z = draw(seed, -1, 1), around = draw(seed, 0, 6.283), spin = draw(seed, 0, 6.283);
    const double flat = sqrt(1 - z * z), c = cos(spin), s = sin(spin), ca = cos(around), sa = sin(around);
    const double a[3] = {-sa, ca, 0}, b[3] = {-z * ca, -z * sa, flat}, d[3] = {flat * ca, flat * sa, z};
    for (int k = 0; k < 3; k++)
        turn[k][0] = c * a[k] + s * b[k], turn[k][1] = d[k], turn[k][2] = s * a[k] - c * b[k];
}

static const double tilts[] = {0, 1e-9, 1e-8, 1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 1e-4, 1e-3, 1e-2};

/* The cuts hold the rays of pixels, before they are tilted. */
static void draw_cuts(uint64_t *seed, cut_block *b) {
    int column = -HALF;
    b->pieces = 1;
    for (int k = 0; k < 2; k++) b->cuts[0][k] = -HALF;
    while (b->pieces < PIECES && (column += 1 + (int)draw_below(seed, 16)) < HALF - 4) {
        const double tilt = (draw_below(seed, 2) ? 1 : -1) * b->tilt;
        for (int k = 0; k < 2; k++) {
            const double y = k ? DEEP : -DEEP, grown = b->parallel ? 1 : 1 + y * b->pitch / b->source;
            b->cuts[b->pieces][k] = column * grown + tilt * y;
        }
        b->pieces++;
    }
    for (int k = 0; k < 2; k++) b->cuts[b->pieces][k] = HALF;
}

static cut_block draw_block(uint64_t *seed, double most_away, double least_source, double most_source) {
    cut_block b = {.pitch = pow(10, draw(seed, -4, 0)), .turn = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    double way[3], length = 0;
    b.source = fmax(least_source * pow(most_source / least_source, draw(seed, 0, 1)), 100 * DEEP * b.pitch);
    b.away = most_away > 0 ? fmin(pow(10, draw(seed, 2, log10(most_away))), 1e6 * b.pitch) : 0;
    b.tilt = tilts[draw_below(seed, sizeof tilts / sizeof *tilts)];
    b.parallel = draw_below(seed, 4) == 0;
    b.across = (int)draw_below(seed, 2);
    if (draw_below(seed, 3) > 0) draw_turn(seed, b.turn);
    for (int k = 0; k < 3; k++) way[k] = draw(seed, -1, 1), length += way[k] * way[k];
    for (int k = 0; k < 3; k++) b.shift[k] = b.away * way[k] / sqrt(length);
    draw_cuts(seed, &b);
    return b;
}

static void place(const cut_block *b, double x, double y, double z, double world[3]) {
    for (int k = 0; k < 3; k++)
        world[k] = b->turn[k][0] * x + b->turn[k][1] * y + b->turn[k][2] * z + b->shift[k];
}

static skg_view view_of(const cut_block *b) {
    const double far = b->source / 4, step = b->pitch * (b->parallel ? 1 : (b->source + far) / b->source);
    skg_view view;
    skg_view_init(&view);
    view.projection = b->parallel ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
    view.columns = view.rows = SIDE;
    place(b, 0, -b->source, 0, view.source);
    place(b, 0, far, 0, view.centre);
    for (int k = 0; k < 3; k++) {
        view.column_step[k] = step * b->turn[k][b->across ? 2 : 0];
        view.row_step[k] = step * b->turn[k][b->across ? 0 : 2];
    }
    return view;
}

/* Pieces from cut `first` to cut `end`, as one. Corners at one place have the same bits in all pieces. */
static void add_piece(const cut_block *b, skg_scene *scene, int first, int end) {
    char label[24];
    solid s = solid_box(2, 2, 2);
    for (int k = 0; k < 8; k++) {
        const int far = (k & 2) != 0;
        place(b, b->cuts[k & 1 ? end : first][far] * b->pitch, (far ? DEEP : -DEEP) * b->pitch,
              (k & 4 ? HALF : -HALF) * b->pitch, s.positions + 3 * k);
    }
    skg_mesh *mesh = run_mesh(&s);
    snprintf(label, sizeof label, "piece %d", first);
    run_part(scene, label, mesh, 0.2 / b->pitch, NULL, -1);
    skg_mesh_release(&mesh);
    solid_free(&s);
}

static skg_scene *scene_of(const cut_block *b, int whole) {
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    if (whole) add_piece(b, scene, 0, b->pieces);
    for (int n = 0; !whole && n < b->pieces; n++) add_piece(b, scene, n, n + 1);
    return scene;
}

static double *whole_of(const cut_block *b, const skg_view *view, double *greatest) {
    skg_scene *scene = scene_of(b, 1);
    skg_plan *plan = run_plan(
        scene, view, (run_choice){.precision = SKG_PRECISION_DOUBLE, .quantity = SKG_QUANTITY_ATTENUATION});
    double *image = run_image(plan, view);
    *greatest = 0;
    for (int p = 0; p < SIDE * SIDE; p++) *greatest = fmax(*greatest, image[p]);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    return image;
}

/* The largest difference but for the block's own rim. */
static double compare(const double *image, const double *truth) {
    double worst = 0;
    for (int row = 0; row < SIDE; row++)
        for (int column = 0; column < SIDE; column++) {
            const int p = row * SIDE + column, in = HALF - RIM;
            if (abs(row - MIDDLE) > in || abs(column - MIDDLE) > in) continue;
            const double error = fabs(image[p] - truth[p]);
            worst = error <= worst ? worst : error; /* NaN is the worst */
        }
    return worst;
}

static void judge(const cut_block *b, uint64_t seed, int32_t precision, hard_outcome *o) {
    const skg_view view = view_of(b);
    uint64_t first = 0;
    double greatest, *truth = whole_of(b, &view, &greatest);
    skg_scene *scene = scene_of(b, 0);
    for (int way = 0; way < HARD_WAYS; way++) {
        run_choice choice = hard_ways[way];
        double bound = 0;
        choice.precision = precision;
        choice.quantity = SKG_QUANTITY_ATTENUATION;
        skg_plan *plan = run_plan(scene, &view, choice);
        double *image = run_image(plan, &view);
        hard_same_bits(o, way, image, SIDE * SIDE, &first);
        const double error = compare(image, truth);
        ck_skg(skg_plan_precision_bound_get(plan, &bound));
        o->worst[precision] = fmax(o->worst[precision], error / greatest);
        if (!(error <= o->bar[precision] * greatest && error <= bound * fmin(greatest, 1)))
            hard_fault(
                o,
                "SKG_CUTS_SEED=%llu: %.2g of the greatest value, bound %.2g; pixel %.2g, source %.3g, away "
                "%.2g mm, tilt %.0e, precision %d",
                (unsigned long long)seed, error / greatest, bound, b->pitch, b->source, b->away, b->tilt,
                (int)precision);
        free(image);
        skg_plan_release(&plan);
    }
    skg_scene_release(&scene);
    free(truth);
}

static uint64_t number_of(const char *name, uint64_t otherwise) {
    const char *wanted = getenv(name);
    return wanted ? strtoull(wanted, NULL, 10) : otherwise;
}

/* Every scene has a seed of its own, which a fault names. */
static void run_cuts(double most_away, double least_source, double most_source, hard_outcome *o) {
    const uint64_t first = number_of("SKG_CUTS_SEED", 1), count = number_of("SKG_CUTS_SCENES", SCENES);
    o->danger = "two parts take the depth of one face from corners of their own";
    o->unit = "of the greatest value";
    o->bar[0] = 2e-5, o->bar[1] = 1e-6;
    if (!run_has_double()) return; /* the truth is a picture in double precision */
    o->worst[0] = o->worst[1] = 0;
    for (uint64_t number = first; number < first + count; number++) {
        uint64_t seed = 7919 * number;
        const cut_block b = draw_block(&seed, most_away, least_source, most_source);
        for (int32_t precision = 0; precision < 2; precision++) judge(&b, number, precision, o);
    }
}

static void at_home(hard_outcome *o) {
    o->name = "cuts tilted against the rays";
    run_cuts(0, 300, 1000, o);
}

static void far_from_origin(hard_outcome *o) {
    o->name = "cuts far from the origin";
    run_cuts(1e5, 300, 1000, o);
}

static void far_from_source(hard_outcome *o) {
    o->name = "cuts at any distance of the source";
    run_cuts(1e3, 0.3, 145e3, o);
}

const hard_function hard_cuts[] = {at_home, far_from_origin, far_from_source, NULL};
