/* Photons through the exact bodies of a room. */
#include "rooms.h"

#include "matter.h"
#include "support/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

enum { BATCHES = 64, SEGMENTS = 2 * ROOM_BODIES + 3, WORLD = ROOM_BODIES };

/* Below this weight one photon in four goes on, with four times the weight. */
static const double LOWEST_WEIGHT = 0.05;

/* A piece of a line in one body; body -1: vacuum. */
typedef struct {
    double from, to;
    int body;
} segment;

/* matter of the bodies and of the world; NULL: vacuum */
typedef struct {
    const room *room;
    matter *of[ROOM_BODIES + 1];
    double block[ROOM_BLOCKS]; /* keV of this batch */
    uint64_t seed;
} hall;

/* Where a line is in a range of a coordinate. */
static void clip(double at, double way, double low, double high, double *enter, double *leave) {
    const double a = (low - at) / way, b = (high - at) / way;
    if (way == 0) {
        if (at < low || at > high) *leave = -HUGE_VAL;
        return;
    }
    *enter = fmax(*enter, fmin(a, b)), *leave = fmin(*leave, fmax(a, b));
}

/* Where it is within a radius of the origin, in `count` of its coordinates. */
static void clip_round(const double *at, const double *way, int skip, double radius, double *enter,
                       double *leave) {
    double a = 0, b = 0, c = -radius * radius;
    for (int k = 0; k < 3; k++)
        if (k != skip) a += way[k] * way[k], b += at[k] * way[k], c += at[k] * at[k];
    const double root = b * b - a * c;
    if (root <= 0 || a == 0) {
        if (root <= 0 || c > 0) *leave = -HUGE_VAL;
        return;
    }
    *enter = fmax(*enter, (-b - sqrt(root)) / a), *leave = fmin(*leave, (-b + sqrt(root)) / a);
}

static int cross(const room_body *b, const double from[3], const double way[3], double *enter,
                 double *leave) {
    double at[3];
    for (int k = 0; k < 3; k++) at[k] = from[k] - b->at[k];
    const int axis = b->shape == ROOM_ROD ? (int)b->size[2] : -1;
    if (b->shape == ROOM_BOX)
        for (int k = 0; k < 3; k++) clip(at[k], way[k], -b->size[k] / 2, b->size[k] / 2, enter, leave);
    else
        clip_round(at, way, axis, b->size[0], enter, leave);
    if (axis >= 0) clip(at[axis], way[axis], -b->size[1] / 2, b->size[1] / 2, enter, leave);
    return *leave > *enter;
}

/* The pieces of a line up to `limit`, in order. Of bodies that hold a place the last one has it. */
static int walk(const hall *h, const double from[3], const double way[3], double limit,
                segment out[SEGMENTS]) {
    const room *r = h->room;
    double enter[ROOM_BODIES], leave[ROOM_BODIES], ends[SEGMENTS];
    int met[ROOM_BODIES], bodies = 0, count = 0, pieces = 0;
    double world[2] = {0, limit};
    if (h->of[WORLD]) clip(from[2], way[2], r->source, r->plane, &world[0], &world[1]);
    ends[count++] = 0, ends[count++] = h->of[WORLD] ? world[1] : limit;
    for (int b = 0; b < r->count; b++) {
        enter[bodies] = 0, leave[bodies] = limit;
        if (!cross(&r->bodies[b], from, way, &enter[bodies], &leave[bodies])) continue;
        ends[count++] = enter[bodies], ends[count++] = leave[bodies];
        met[bodies++] = b;
    }
    for (int i = 1; i < count; i++) /* few: by insertion */
        for (int k = i; k > 0 && ends[k - 1] > ends[k]; k--) {
            const double t = ends[k];
            ends[k] = ends[k - 1], ends[k - 1] = t;
        }
    for (int i = 1; i < count; i++) {
        if (!(ends[i] > ends[i - 1])) continue;
        const double middle = isinf(ends[i]) ? ends[i - 1] + 1 : (ends[i - 1] + ends[i]) / 2;
        int body = h->of[WORLD] && middle < world[1] ? WORLD : -1;
        for (int m = 0; m < bodies; m++)
            if (middle > enter[m] && middle < leave[m]) body = met[m];
        out[pieces++] = (segment){ends[i - 1], ends[i], body};
    }
    return pieces;
}

static const matter *matter_of(const hall *h, int body) {
    return body < 0 ? NULL : h->of[body];
}

static double depth_of(const hall *h, const segment *pieces, int count, double kev) {
    double depth = 0;
    for (int i = 0; i < count; i++) {
        const matter *m = matter_of(h, pieces[i].body);
        if (m) depth += (pieces[i].to - pieces[i].from) * matter_at_energy(m->total, m, kev);
    }
    return depth;
}

/* Where a depth is reached. Returns the body; -1: not at all. */
static int reach(const hall *h, const segment *pieces, int count, double kev, double depth, double *on) {
    for (int i = 0; i < count; i++) {
        const matter *m = matter_of(h, pieces[i].body);
        if (!m) continue;
        const double per_mm = matter_at_energy(m->total, m, kev), length = pieces[i].to - pieces[i].from;
        if (depth < length * per_mm) {
            *on = pieces[i].from + depth / per_mm;
            return pieces[i].body;
        }
        depth -= length * per_mm;
    }
    return -1;
}

/* The block of a place of the detector; -1: beside it. */
static int block_of(const room *r, double x, double y) {
    const double column = floor((x / r->side[0] + 0.5) * ROOM_SIDE),
                 row = floor((y / r->side[1] + 0.5) * ROOM_SIDE);
    if (column < 0 || column >= ROOM_SIDE || row < 0 || row >= ROOM_SIDE) return -1;
    return (int)row * ROOM_SIDE + (int)column;
}

/* A photon towards a random place of the detector. Returns its energy; *stands: for how many per mm2 at the foot of the perpendicular. */
static double emit(hall *h, double from[3], double way[3], double *stands) {
    const room *r = h->room;
    const double to[3] = {draw(&h->seed, -0.5, 0.5) * r->side[0], draw(&h->seed, -0.5, 0.5) * r->side[1],
                          r->plane};
    double at = draw(&h->seed, 0, 1), length = 0;
    int bin = 0;
    while (bin < r->bins - 1 && at >= r->photons[bin]) at -= r->photons[bin++];
    for (int k = 0; k < 3; k++) {
        from[k] = k == 2 ? r->source : 0, way[k] = to[k] - from[k];
        length += way[k] * way[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; k++) way[k] /= length;
    *stands = r->side[0] * r->side[1] * pow((r->plane - r->source) / length, 3);
    return r->kev[bin];
}

/* Scores the expected contribution of an interaction to a random place of the detector. */
static void expect(hall *h, const double at[3], const double way[3], const matter *m, double kev,
                   double weight) {
    const room *r = h->room;
    const double to[3] = {draw(&h->seed, -0.5, 0.5) * r->side[0], draw(&h->seed, -0.5, 0.5) * r->side[1],
                          r->plane};
    segment pieces[SEGMENTS];
    double line[3], length = 0, cosine = 0;
    for (int k = 0; k < 3; k++) line[k] = to[k] - at[k], length += line[k] * line[k];
    length = sqrt(length);
    if (!(line[2] > 0)) return;
    for (int k = 0; k < 3; k++) line[k] /= length, cosine += line[k] * way[k];
    cosine = fmin(fmax(cosine, -1), 1);
    const double per_area = weight * line[2] / (length * length) / (2 * PI) * r->side[0] * r->side[1];
    const double lower = kev * matter_ratio(kev, cosine);
    const int count = walk(h, at, line, length, pieces);
    double sum = matter_at_energy(m->rayleigh, m, kev) * matter_rayleigh(m, kev, cosine) * kev *
                 exp(-depth_of(h, pieces, count, kev));
    if (lower > MATTER_LOWEST_KEV)
        sum += matter_at_energy(m->compton, m, kev) * matter_compton(m, kev, cosine) * lower *
               exp(-depth_of(h, pieces, count, lower));
    h->block[block_of(r, to[0], to[1])] += per_area * sum;
}

/* An interaction: the photon's new energy and direction. Returns the share that is not absorbed. */
static double interact(hall *h, const matter *m, double *kev, double way[3]) {
    const double compton = matter_at_energy(m->compton, m, *kev),
                 rayleigh = matter_at_energy(m->rayleigh, m, *kev);
    const int is_compton = draw(&h->seed, 0, compton + rayleigh) < compton;
    const double cosine = matter_draw(m, *kev, is_compton, &h->seed);
    matter_turn(way, cosine, draw(&h->seed, 0, 2 * PI));
    if (is_compton) *kev *= matter_ratio(*kev, cosine);
    return compton + rayleigh;
}

/* The first interaction happens on the line; later ones may not. */
static void follow_expected(hall *h) {
    double from[3], way[3], weight, on;
    double kev = emit(h, from, way, &weight);
    segment pieces[SEGMENTS];
    for (int order = 0; kev > MATTER_LOWEST_KEV; order++) {
        const int count = walk(h, from, way, HUGE_VAL, pieces);
        const double met = order ? 1 : -expm1(-depth_of(h, pieces, count, kev));
        const int body = reach(h, pieces, count, kev, -log1p(-met * draw(&h->seed, 0, 1)), &on);
        if (body < 0) return;
        for (int k = 0; k < 3; k++) from[k] += on * way[k];
        weight *= met;
        expect(h, from, way, h->of[body], kev, weight);
        weight *= interact(h, h->of[body], &kev, way);
        if (weight < LOWEST_WEIGHT * h->room->side[0] * h->room->side[1]) {
            if (draw(&h->seed, 0, 1) > 0.25) return;
            weight *= 4;
        }
    }
}

static void follow_analogue(hall *h) {
    const room *r = h->room;
    double from[3], way[3], weight, on;
    double kev = emit(h, from, way, &weight);
    segment pieces[SEGMENTS];
    int order = 0;
    for (; kev > MATTER_LOWEST_KEV; order++) {
        const int count = walk(h, from, way, way[2] > 0 ? (r->plane - from[2]) / way[2] : HUGE_VAL, pieces);
        const int body = reach(h, pieces, count, kev, -log1p(-draw(&h->seed, 0, 1)), &on);
        if (body < 0) break;
        for (int k = 0; k < 3; k++) from[k] += on * way[k];
        const matter *m = h->of[body];
        if (draw(&h->seed, 0, 1) >
            matter_at_energy(m->compton, m, kev) + matter_at_energy(m->rayleigh, m, kev))
            return;
        interact(h, m, &kev, way);
    }
    if (order == 0 || !(way[2] > 0) || from[2] > r->plane) return;
    on = (r->plane - from[2]) / way[2];
    const int block = block_of(r, from[0] + on * way[0], from[1] + on * way[1]);
    if (block >= 0) h->block[block] += weight * kev;
}

/* The primary, exactly but for the number of rays. */
static void find_primary(hall *h, double kev_of_beam, room_truth *truth) {
    enum { RAYS = 256, PER_BLOCK = RAYS / ROOM_SIDE };
    const room *r = h->room;
    segment pieces[SEGMENTS];
    for (int i = 0; i < RAYS * RAYS; i++) {
        const double share[2] = {(i % RAYS + 0.5) / RAYS - 0.5, ((double)(i / RAYS) + 0.5) / RAYS - 0.5};
        double from[3] = {0, 0, r->source},
               way[3] = {share[0] * r->side[0], share[1] * r->side[1], r->plane - r->source};
        const double length = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
        for (int k = 0; k < 3; k++) way[k] /= length;
        const int count = walk(h, from, way, length, pieces);
        double kev = 0;
        for (int b = 0; b < r->bins; b++)
            kev += r->photons[b] * r->kev[b] * exp(-depth_of(h, pieces, count, r->kev[b]));
        truth->primary[block_of(r, share[0] * r->side[0], share[1] * r->side[1])] +=
            kev / kev_of_beam * pow((r->plane - r->source) / length, 3) / (PER_BLOCK * PER_BLOCK);
    }
}

static void open_hall(hall *h, const room *r, uint64_t seed) {
    double most = 0;
    *h = (hall){.room = r, .seed = seed};
    for (int b = 0; b < r->bins; b++) most = fmax(most, r->kev[b]);
    for (int b = 0; b <= WORLD; b++) {
        const char *material = b < r->count ? r->bodies[b].material : b == WORLD ? r->world : NULL;
        if (!material || strcmp(material, "Vacuum") == 0) continue;
        h->of[b] = malloc(sizeof *h->of[b]);
        if (!h->of[b]) abort();
        matter_make(material, b < r->count ? r->bodies[b].density : 0, most, h->of[b]);
    }
}

room_truth room_follow(const room *r, int method, int64_t histories, uint64_t seed) {
    room_truth truth = {.histories = (double)(histories / BATCHES * BATCHES)};
    double kev = 0, batches[BATCHES] = {0}, squares[ROOM_BLOCKS] = {0}, all = 0, primary = 0;
    hall h;
    open_hall(&h, r, seed);
    for (int b = 0; b < r->bins; b++) kev += r->photons[b] * r->kev[b];
    find_primary(&h, kev, &truth);
    const double unit = BATCHES / truth.histories / kev / (r->side[0] * r->side[1] / ROOM_BLOCKS);
    for (int b = 0; b < BATCHES; b++) {
        memset(h.block, 0, sizeof h.block);
        for (int64_t i = 0; i < histories / BATCHES; i++)
            method == ROOM_ANALOGUE ? follow_analogue(&h) : follow_expected(&h);
        for (int k = 0; k < ROOM_BLOCKS; k++) {
            const double value = unit * h.block[k];
            truth.scatter[k] += value / BATCHES, squares[k] += value * value / BATCHES;
            batches[b] += value / ROOM_BLOCKS;
        }
    }
    for (int k = 0; k < ROOM_BLOCKS; k++) {
        truth.sigma[k] = sqrt(fmax(squares[k] - truth.scatter[k] * truth.scatter[k], 0) / (BATCHES - 1));
        primary += truth.primary[k] / ROOM_BLOCKS, all += truth.scatter[k] / ROOM_BLOCKS;
    }
    double variance = 0;
    for (int b = 0; b < BATCHES; b++) variance += pow(batches[b] - all, 2) / BATCHES / (BATCHES - 1);
    truth.ratio = all / primary, truth.ratio_sigma = sqrt(variance) / primary;
    for (int b = 0; b <= WORLD; b++) free(h.of[b]);
    return truth;
}
