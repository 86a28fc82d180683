/* Rounds of histories: how many follow, and when to stop. */
#include "scatter/tracing.h"

#include "core/log.h"

#include <inttypes.h>
#include <math.h>

/* A round may have so many times the histories of the last one, after the first: by then the error is known, but for the number of
 * cosines, by which chance makes it too large. */
static const double GROWTH_MAX = 4, GROWTH_FIRST = 16;
enum { FIRST_END = 4096 };

/* The error falls with this root of the histories or faster: more slowly than noise alone, because more cosines are kept then. A
 * round that ends near what was asked for would end by luck, with too small an error stated. */
static const double ROOT = 2.5;

/* From here on what the last two rounds have reached says whether the lattice has points enough for what was asked for. Sharp edges of
 * a thick body near the detector take so many cosines that the error falls with the third root of the histories. */
enum { TREND_FROM = 1 << 17 };

static int is_out_of_reach(const skg_rounds *r, double error) {
    if (r->end < TREND_FROM || !(r->last_end > 0 && r->end > r->last_end)) return 0;
    const double power = log(r->last_error / error) / log((double)r->end / (double)r->last_end);
    return !(power > 0) ||
           (double)r->end * pow(error / r->tolerance, 1 / power) > (double)SKG_SCATTER_HISTORIES;
}

skg_rounds skg_rounds_begin(const skg_scatter *asked, int64_t first, double tolerance) {
    const int64_t batches = SKG_SCATTER_BATCHES;
    return (skg_rounds){.is_fixed = asked->histories > 0,
                        .tolerance = tolerance,
                        .end = asked->histories ? (asked->histories + batches - 1) / batches : first};
}

int skg_rounds_next(skg_rounds *r, double error) {
    if (r->is_fixed || error <= r->tolerance) return 0;
    r->gave_up = r->end >= SKG_SCATTER_HISTORIES || is_out_of_reach(r, error);
    if (r->gave_up) return 0;
    const double most = r->end < FIRST_END ? GROWTH_FIRST : GROWTH_MAX,
                 more = fmin(pow(error / r->tolerance, ROOT), most);
    r->last_end = r->end, r->last_error = error;
    r->end *= 2; /* powers of two, of which the lattice is best */
    for (double factor = 2; factor < more && r->end < SKG_SCATTER_HISTORIES; factor *= 2) r->end *= 2;
    return 1;
}

void skg_rounds_warn(const skg_context *context, const skg_rounds *r, const skg_scatter *asked,
                     double error) {
    if (!r->gave_up) return;
    skg_log(
        context, SKG_LOG_WARNING,
        "scatter: %.3g %% of its mean were asked for, and its standard error is %.3g %% after %" PRId64
        " histories; it falls so slowly, because of sharp edges, that %.2g would not do. Ask for less, or for a number "
        "of histories",
        100 * asked->tolerance, 100 * error, r->end * SKG_SCATTER_BATCHES,
        (double)SKG_SCATTER_HISTORIES * SKG_SCATTER_BATCHES);
}
