/* Moving the drivers: one search per axis and direction, largest remaining displacement first. */
#include "chainmail/chainmail.h"

#include "scene/vector.h"

#include <inttypes.h>
#include <string.h>

enum { ABSENT = -1, SETTLED = -2 };

/* Below this, drivers that contradict each other are rounding: paths of 1e3 links over 1e3 mm round to 1e-10.
 */
static const double rounding_mm = 1e-9;

static void sift_up(skg_chain_front *f, int64_t hole, skg_chain_waiting entry) {
    while (hole > 0) {
        int64_t parent = (hole - 1) / 4;
        if (f->heap[parent].gain >= entry.gain) break;
        f->heap[hole] = f->heap[parent], f->place[f->heap[hole].node] = (int32_t)hole;
        hole = parent;
    }
    f->heap[hole] = entry, f->place[entry.node] = (int32_t)hole;
}

static int32_t pop(skg_chain_front *f) {
    int32_t top = f->heap[0].node;
    skg_chain_waiting last = f->heap[--f->waiting];
    f->place[top] = SETTLED;
    if (f->waiting == 0) return top;
    int64_t hole = 0;
    for (;;) {
        int64_t child = 4 * hole + 1, end = child + 4 < f->waiting ? child + 4 : f->waiting, best = -1;
        double most = last.gain;
        for (int64_t c = child; c < end; c++)
            if (f->heap[c].gain > most) best = c, most = f->heap[c].gain;
        if (best < 0) break;
        f->heap[hole] = f->heap[best], f->place[f->heap[hole].node] = (int32_t)hole;
        hole = best;
    }
    f->heap[hole] = last, f->place[last.node] = (int32_t)hole;
    return top;
}

static void lift(skg_chain_front *f, int32_t node, double gain) {
    f->gain[node] = gain;
    int64_t hole = f->place[node];
    if (hole == ABSENT) f->seen[f->found++] = node, hole = f->waiting++;
    sift_up(f, hole, (skg_chain_waiting){gain, node});
}

/* Node may gain this much. Where the search has not been, its gain is what it has without; where it is
 * settled no later offer is larger, as slacks are not negative. */
static inline void offer(skg_chain_front *f, int32_t node, double gain) {
    if (gain > f->gain[node]) lift(f, node, gain);
}

/* Every gain to what a node has without. */
static void forget(const skg_chain *chain, skg_chain_front *f, double without) {
    for (int64_t i = 0; i < f->found; i++) f->place[f->seen[i]] = ABSENT, f->gain[f->seen[i]] = without;
    for (int64_t i = 0; f->without != without && i < chain->nodes; i++) f->gain[i] = without;
    f->without = without;
    f->found = f->waiting = 0;
    f->conflict = 0, f->at = -1;
}

/* How much of a node's gain the next one feels: u_j follows once the link is taut. */
static inline double link_slack(const skg_chain_edge *edge, int direction, double here, double there) {
    double left = direction > 0 ? edge->fall + (there - here) : edge->rise - (there - here);
    return left > 0 ? left : 0; /* rounding only: the state keeps its links */
}

/* Gains over the state u (one axis) of every node that has to move in this direction. */
static void spread(const skg_chain *chain, int axis, int direction, const double *u, skg_chain_front *f) {
    forget(chain, f, 0);
    const skg_chain_edge *edges = chain->edge[axis];
    for (int64_t s = 0; s < chain->drivers; s++) {
        int32_t node = chain->driver[s];
        offer(f, node, direction * (chain->target[axis][s] - u[node]));
    }
    while (f->waiting > 0) {
        int32_t i = pop(f);
        double gain = f->gain[i], here = u[i];
        int32_t s = chain->driver_of[i];
        if (s >= 0) {
            double overrun = gain - direction * (chain->target[axis][s] - here);
            if (overrun > f->conflict) f->conflict = overrun, f->at = s;
        }
        for (int64_t e = chain->first[i]; e < chain->first[i + 1]; e++) {
            int32_t j = edges[e].node;
            offer(f, j, gain - link_slack(edges + e, direction, here, u[j]));
        }
    }
}

void skg_chain_bounds(const skg_chain *chain, int axis, int direction, const double *sources,
                      skg_chain_front *f) {
    forget(chain, f, -HUGE_VAL);
    const skg_chain_edge *edges = chain->edge[axis];
    for (int64_t s = 0; !sources && s < chain->drivers; s++)
        offer(f, chain->driver[s], direction * chain->target[axis][s]);
    for (int64_t i = 0; sources && i < chain->nodes; i++) offer(f, (int32_t)i, direction * sources[i]);
    while (f->waiting > 0) {
        int32_t i = pop(f);
        for (int64_t e = chain->first[i]; e < chain->first[i + 1]; e++)
            offer(f, edges[e].node, f->gain[i] - (direction > 0 ? edges[e].fall : edges[e].rise));
    }
}

/* Where a link lies between a node that rises and one that falls, neither may have been overrun, and yet the
 * link cannot hold: the bounds cross on it. */
static double crossing(const skg_chain *chain, int axis, const double *u, const skg_chain_front *up,
                       const skg_chain_front *down) {
    double most = 0;
    for (int64_t n = 0; n < up->found && down->found > 0; n++) {
        int32_t i = up->seen[n];
        for (int64_t e = chain->first[i]; e < chain->first[i + 1]; e++) {
            const skg_chain_edge *edge = chain->edge[axis] + e;
            int32_t j = edge->node;
            if (down->place[j] != SETTLED) continue;
            most = fmax(most, up->gain[i] + down->gain[j] - link_slack(edge, 1, u[i], u[j]));
        }
    }
    return most;
}

/* Targets halfway between the bounds keep every link and miss the drivers by half the conflict at most. */
static double meet_halfway(skg_chain *chain, int axis, int64_t *worst) {
    skg_chain_front *up = chain->front + 2 * axis, *down = up + 1;
    skg_chain_bounds(chain, axis, 1, NULL, up);
    skg_chain_bounds(chain, axis, -1, NULL, down);
    double conflict = 0;
    for (int64_t s = 0; s < chain->drivers; s++) {
        double lower = up->gain[chain->driver[s]], upper = -down->gain[chain->driver[s]];
        if (lower - upper > conflict) conflict = lower - upper, *worst = s;
        if (lower > upper) chain->target[axis][s] = 0.5 * (lower + upper);
    }
    return conflict;
}

static void apply(const skg_chain *chain, int axis, double *u) {
    const skg_chain_front *up = chain->front + 2 * axis, *down = up + 1;
    for (int64_t n = 0; n < up->found; n++) u[up->seen[n]] += up->gain[up->seen[n]];
    for (int64_t n = 0; n < down->found; n++) u[down->seen[n]] -= down->gain[down->seen[n]];
    for (int64_t s = 0; s < chain->drivers; s++) u[chain->driver[s]] = chain->target[axis][s];
}

static void spread_axis(skg_chain *chain, int axis, const double *u) {
    spread(chain, axis, 1, u, chain->front + 2 * axis);
    spread(chain, axis, -1, u, chain->front + 2 * axis + 1);
}

/* Solves the conflict of one axis, if any. */
static void settle_conflict(skg_chain *chain, int axis, const double *u, skg_chain_report *report) {
    skg_chain_front *up = chain->front + 2 * axis, *down = up + 1;
    double conflict = fmax(fmax(up->conflict, down->conflict), crossing(chain, axis, u, up, down));
    if (conflict <= rounding_mm) return;
    int64_t worst = -1;
    conflict = meet_halfway(chain, axis, &worst);
    spread_axis(chain, axis, u);
    if (conflict > report->conflict_mm) {
        report->conflict_mm = conflict;
        report->axis = axis;
        report->driver = worst;
    }
}

/* Below so many nodes, starting threads costs more than they save. */
static const int64_t threads_from = 10000;

static void solve(skg_chain *chain, double *u, skg_chain_report *report) {
#pragma omp parallel for schedule(dynamic, 1) if (chain->nodes >= threads_from)
    for (int task = 0; task < 6; task++)
        spread(chain, task / 2, task % 2 ? -1 : 1, u + task / 2 * chain->nodes, chain->front + task);
    *report = (skg_chain_report){.axis = -1, .driver = -1};
    for (int axis = 0; axis < 3; axis++) {
        settle_conflict(chain, axis, u + axis * chain->nodes, report);
        apply(chain, axis, u + axis * chain->nodes);
        for (int d = 0; d < 2; d++) report->settled[2 * axis + d] = chain->front[2 * axis + d].found;
    }
}

skg_status skg_chain_move(skg_chain *chain, const double *targets, double *u, skg_chain_report *report) {
    for (int64_t s = 0; s < chain->drivers; s++)
        if (!skg_all_finite(targets + 3 * s, 3))
            return skg_fail(SKG_ERR_BREATHING,
                            "%s: driver %" PRId64 " (node %" PRId32 ") goes to (%g, %g, %g) mm: not finite",
                            chain->name, s, chain->driver[s], targets[3 * s], targets[3 * s + 1],
                            targets[3 * s + 2]);
    for (int64_t s = 0; s < chain->drivers; s++)
        for (int k = 0; k < 3; k++) chain->target[k][s] = targets[3 * s + k];
    skg_chain_report ours;
    solve(chain, u, &ours);
    if (report) *report = ours;
    return SKG_OK;
}

/* One axis: to the neighbours' mean, then to the middle of the nearest states above and below that keep
 * every link. */
static void relax_axis(skg_chain *chain, int axis, double fraction, double *u, double *mean) {
    skg_chain_front *up = chain->front + 2 * axis, *down = up + 1;
    for (int64_t i = 0; i < chain->nodes; i++) {
        int64_t degree = chain->first[i + 1] - chain->first[i];
        double sum = 0;
        for (int64_t e = chain->first[i]; e < chain->first[i + 1]; e++) sum += u[chain->edge[axis][e].node];
        int moves = degree > 0 && chain->driver_of[i] < 0;
        mean[i] = moves ? (1 - fraction) * u[i] + fraction * (sum / (double)degree) : u[i];
    }
    skg_chain_bounds(chain, axis, 1, mean, up);
    skg_chain_bounds(chain, axis, -1, mean, down);
    for (int64_t i = 0; i < chain->nodes; i++) u[i] = 0.5 * (up->gain[i] - down->gain[i]);
}

skg_status skg_chain_relax(skg_chain *chain, int32_t passes, double fraction, double *u) {
    if (!(fraction >= 0 && fraction <= 1) || passes < 0)
        return skg_fail(SKG_ERR_BREATHING, "%s: %" PRId32 " relaxation passes of %g: at least 0, of 0 to 1",
                        chain->name, passes, fraction);
    double *mean;
    SKG_TRY(skg_alloc(3 * chain->nodes, sizeof(double), chain->name, &mean));
    for (int32_t pass = 0; pass < passes; pass++) {
#pragma omp parallel for schedule(dynamic, 1) if (chain->nodes >= threads_from)
        for (int axis = 0; axis < 3; axis++)
            relax_axis(chain, axis, fraction, u + axis * chain->nodes, mean + axis * chain->nodes);
        skg_chain_report report;
        solve(chain, u, &report);
    }
    skg_free(&mean);
    return SKG_OK;
}
