/* Moving the drivers: one search per axis and direction, largest remaining displacement first. */
#include "chainmail/chainmail.h"

#include "core/maths.h"

#include <inttypes.h>
#include <string.h>

/* Contradictions of drivers below this are rounding: paths of 1000 links over 1000 mm round to 1e-10 mm. */
static const double rounding_mm = 1e-9;

/* Pushes u in one direction as the drivers ask: to max(u, L) upwards, to min(u, U) downwards. Returns the number of
 * nodes that moved. */
static int64_t push(const skg_chain *chain, int axis, int direction, double *u, skg_chain_front *f) {
    const double *target = chain->target[axis];
    skg_chain_forget(f);
    for (int64_t s = 0; s < chain->drivers; s++) {
        double gain = direction * (target[s] - u[chain->driver[s]]);
        if (gain > 0) skg_chain_start(f, chain->driver[s], gain);
    }
    skg_chain_spread(chain, axis, direction, u, f);
    for (int64_t n = 0; n < f->found; n++) u[f->seen[n]] += direction * f->gain[f->seen[n]];
    return f->found;
}

/* Puts drivers that differ from their targets by rounding only onto them. */
static void round_drivers(const skg_chain *chain, int axis, double *u) {
    for (int64_t s = 0; s < chain->drivers; s++) {
        double *at = u + chain->driver[s], target = chain->target[axis][s];
        if (fabs(*at - target) <= rounding_mm) *at = target;
    }
}

/* Where L > U, u is U after both pushes. A search with what the drivers still lack leads to L; half of its gains
 * leads halfway. */
static void meet_halfway(skg_chain *chain, int axis, double *u, skg_chain_report *report) {
    skg_chain_front *f = chain->front + axis;
    double *target = chain->target[axis];
    skg_chain_forget(f);
    for (int64_t s = 0; s < chain->drivers; s++) {
        double lacks = target[s] - u[chain->driver[s]];
        if (lacks > 0) skg_chain_start(f, chain->driver[s], lacks);
    }
    if (f->found == 0) return;
    skg_chain_spread(chain, axis, 1, u, f);
    for (int64_t n = 0; n < f->found; n++) u[f->seen[n]] += 0.5 * f->gain[f->seen[n]];
    for (int64_t s = 0; s < chain->drivers; s++) {
        double conflict = f->gain[chain->driver[s]];
        target[s] = u[chain->driver[s]];
        if (conflict <= report->conflict_mm) continue;
        report->conflict_mm = conflict, report->axis = axis, report->driver = s;
    }
}

/* With fewer nodes, starting threads costs more than they save. */
static const int64_t threads_from = 10000;

static void solve_axis(skg_chain *chain, int axis, double *u, skg_chain_report *report) {
    skg_chain_front *f = chain->front + axis;
    *report = (skg_chain_report){.axis = -1, .driver = -1};
    report->settled[2 * axis] = push(chain, axis, 1, u, f);
    round_drivers(chain, axis, u);
    report->settled[2 * axis + 1] = push(chain, axis, -1, u, f);
    round_drivers(chain, axis, u);
    meet_halfway(chain, axis, u, report);
}

static void solve(skg_chain *chain, double *u, skg_chain_report *report) {
    skg_chain_report each[3];
#pragma omp parallel for schedule(dynamic, 1) if (chain->nodes >= threads_from)
    for (int axis = 0; axis < 3; axis++) solve_axis(chain, axis, u + axis * chain->nodes, each + axis);
    *report = each[0];
    for (int axis = 1; axis < 3; axis++) {
        for (int d = 0; d < 2; d++) report->settled[2 * axis + d] = each[axis].settled[2 * axis + d];
        if (each[axis].conflict_mm <= report->conflict_mm) continue;
        report->conflict_mm = each[axis].conflict_mm;
        report->axis = axis, report->driver = each[axis].driver;
    }
}

skg_status skg_chain_move(skg_chain *chain, const double *targets, double *u, skg_chain_report *report) {
    for (int64_t s = 0; s < chain->drivers; s++)
        if (!skg_all_finite(targets + 3 * s, 3))
            return skg_fail(
                SKG_ERR_BREATHING,
                "%s: the target (%g, %g, %g) mm of driver %" PRId64 " (node %" PRId32 ") is not finite",
                chain->name, targets[3 * s], targets[3 * s + 1], targets[3 * s + 2], s, chain->driver[s]);
    for (int64_t s = 0; s < chain->drivers; s++)
        for (int k = 0; k < 3; k++) chain->target[k][s] = targets[3 * s + k];
    skg_chain_report ours;
    solve(chain, u, &ours);
    if (report) *report = ours;
    return SKG_OK;
}

/* How far each node goes from a state towards a wish when links are kept: to the middle of the nearest states above
 * and below the wish that keep them. Leaves these gains in wish. above: scratch, a number for each node. */
static void keep_links(skg_chain *chain, int axis, const double *u, double *wish, double *above) {
    skg_chain_front *f = chain->front + axis;
    for (int direction = 1; direction >= -1; direction -= 2) {
        skg_chain_forget(f);
        for (int64_t i = 0; i < chain->nodes; i++) skg_chain_start(f, (int32_t)i, direction * wish[i]);
        skg_chain_spread(chain, axis, direction, u, f);
        if (direction > 0) memcpy(above, f->gain, (size_t)chain->nodes * sizeof *above);
    }
    for (int64_t i = 0; i < chain->nodes; i++) wish[i] = 0.5 * (above[i] - f->gain[i]);
}

/* One axis of a pass: towards the neighbours' mean. scratch: two numbers for each node. */
static void relax_axis(skg_chain *chain, int axis, double fraction, double *u, double *scratch) {
    double *wish = scratch;
    for (int64_t i = 0; i < chain->nodes; i++) {
        int64_t degree = chain->first[i + 1] - chain->first[i];
        double sum = 0;
        for (int64_t e = chain->first[i]; e < chain->first[i + 1]; e++) sum += u[chain->node[e]];
        int moves = degree > 0 && chain->driver_of[i] < 0;
        wish[i] = moves ? fraction * (sum / (double)degree - u[i]) : 0;
    }
    keep_links(chain, axis, u, wish, scratch + chain->nodes);
    for (int64_t i = 0; i < chain->nodes; i++) u[i] += wish[i];
}

skg_status skg_chain_relax(skg_chain *chain, int32_t passes, double fraction, double *u) {
    if (!(fraction >= 0 && fraction <= 1) || passes < 0)
        return skg_fail(SKG_ERR_BREATHING,
                        "%s: %" PRId32
                        " relaxation passes by a fraction of %g; at least 0 passes, a fraction of 0 to 1",
                        chain->name, passes, fraction);
    double *scratch;
    SKG_TRY(skg_alloc(6 * chain->nodes, sizeof(double), chain->name, &scratch));
    for (int32_t pass = 0; pass < passes; pass++) {
#pragma omp parallel for schedule(dynamic, 1) if (chain->nodes >= threads_from)
        for (int axis = 0; axis < 3; axis++)
            relax_axis(chain, axis, fraction, u + axis * chain->nodes, scratch + 2 * axis * chain->nodes);
        skg_chain_report report;
        solve(chain, u, &report);
    }
    skg_free(&scratch);
    return SKG_OK;
}

/* Whether a state keeps every link along each axis. rows: displacements of the nodes, x, y, z. */
static void keeps(const skg_chain *chain, const double *rows, int kept[3]) {
    const double *rise[3] = {chain->rise[0], chain->rise[1], chain->rise[2]};
    double over[3] = {0, 0, 0};
    for (int64_t i = 0; i < chain->nodes; i++) {
        const double x = rows[3 * i], y = rows[3 * i + 1], z = rows[3 * i + 2];
        for (int64_t e = chain->first[i]; e < chain->first[i + 1]; e++) {
            const double *other = rows + 3 * (int64_t)chain->node[e];
            const double dx = other[0] - x - rise[0][e], dy = other[1] - y - rise[1][e],
                         dz = other[2] - z - rise[2][e];
            over[0] = dx > over[0] ? dx : over[0];
            over[1] = dy > over[1] ? dy : over[1];
            over[2] = dz > over[2] ? dz : over[2];
        }
    }
    for (int axis = 0; axis < 3; axis++) kept[axis] = over[axis] <= rounding_mm;
}

/* scratch: three numbers for each node. */
static void settle_axis(skg_chain *chain, int axis, double *rows, double *scratch, skg_chain_report *report) {
    const int64_t n = chain->nodes;
    double *rest = scratch, *above = scratch + n, *u = scratch + 2 * n;
    memset(rest, 0, (size_t)n * sizeof *rest);
    for (int64_t i = 0; i < n; i++) u[i] = rows[3 * i + axis];
    keep_links(chain, axis, rest, u, above);
    for (int64_t i = 0; i < n; i++) {
        const double conflict = 2 * fabs(u[i] - rows[3 * i + axis]);
        if (conflict > report->conflict_mm) report->conflict_mm = conflict, report->axis = axis;
        rows[3 * i + axis] = u[i];
    }
}

skg_status skg_chain_settle(skg_chain *chain, double *rows, skg_chain_report *report) {
    double *scratch = NULL;
    int kept[3];
    *report = (skg_chain_report){.axis = -1, .driver = -1};
    keeps(chain, rows, kept);
    if (kept[0] && kept[1] && kept[2]) return SKG_OK;
    SKG_TRY(skg_alloc(3 * chain->nodes, sizeof *scratch, chain->name, &scratch));
    for (int axis = 0; axis < 3; axis++)
        if (!kept[axis]) settle_axis(chain, axis, rows, scratch, report);
    skg_free(&scratch);
    return SKG_OK;
}
