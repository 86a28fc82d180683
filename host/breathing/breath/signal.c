/* A recorded signal: amplitudes over time. */
#include "breath/signal.h"

#include "core/core.h"
#include "core/files.h"

#include <inttypes.h>
#include <math.h>

/* A breath reaches its end-inspiration where the signal has been above `high` and falls below `low`: smaller turns are noise,
 * or the heart's. Choices. */
static const double high = 0.6, low = 0.4;

skg_status skg_signal_check(const skg_breath *b) {
    if (!b->signal || b->signal_count < 2)
        return skg_fail(SKG_ERR_BREATHING, "breath: a signal needs at least 2 points; there are %" PRId64,
                        b->signal ? b->signal_count : 0);
    for (int64_t i = 0; i < b->signal_count; i++) {
        const double *point = b->signal + 2 * i;
        if (!(isfinite(point[0]) && point[1] >= 0 && point[1] <= 1))
            return skg_fail(SKG_ERR_BREATHING,
                            "breath: point %" PRId64
                            " of the signal is (%g s, %g); times are finite, amplitudes 0 to 1",
                            i, point[0], point[1]);
        if (i > 0 && !(point[0] > point[-2]))
            return skg_fail(SKG_ERR_BREATHING,
                            "breath: point %" PRId64
                            " of the signal is at %g s, the one before at %g s; times rise",
                            i, point[0], point[-2]);
    }
    return SKG_OK;
}

double skg_signal_amplitude(const skg_breath *b, double time) {
    const double *p = b->signal;
    int64_t before = 0, behind = b->signal_count - 1;
    if (time <= p[0]) return p[1];
    if (time >= p[2 * behind]) return p[2 * behind + 1];
    while (behind - before > 1) {
        const int64_t middle = before + (behind - before) / 2;
        *(p[2 * middle] <= time ? &before : &behind) = middle;
    }
    const double t = (time - p[2 * before]) / (p[2 * behind] - p[2 * before]);
    return (1 - t) * p[2 * before + 1] + t * p[2 * behind + 1];
}

/* The last end-inspiration up to a time and the first one after it; infinite: there is none. */
static void find_breath(const skg_breath *b, double time, double *last, double *next) {
    int64_t highest = -1; /* of the breath that is above */
    *last = -HUGE_VAL, *next = HUGE_VAL;
    for (int64_t i = 0; i <= b->signal_count; i++) {
        const double *p = b->signal + 2 * i;
        const int ends = i == b->signal_count || p[1] < low;
        if (!ends && (highest >= 0 ? p[1] > b->signal[2 * highest + 1] : p[1] >= high)) highest = i;
        if (!ends || highest < 0) continue;
        const double peak = b->signal[2 * highest];
        highest = -1;
        if (peak <= time) *last = peak;
        if (peak > time) {
            *next = peak;
            return;
        }
    }
}

double skg_signal_phase(const skg_breath *b, double time) {
    double last, next;
    find_breath(b, time, &last, &next);
    if (isfinite(last) && isfinite(next)) return (time - last) / (next - last);
    if (isfinite(last)) return (time - last) / b->period_s;
    return isfinite(next) ? (time - next) / b->period_s : b->start_phase + time / b->period_s;
}

static skg_status scale(const char *path, int64_t count, const double *times, const double *values,
                        double *points) {
    double least = HUGE_VAL, greatest = -HUGE_VAL;
    for (int64_t i = 0; i < count; i++) {
        if (!isfinite(times[i]) || !isfinite(values[i]))
            return skg_fail(SKG_ERR_FORMAT, "%s: row %" PRId64 ": a number is too large", path, i + 1);
        if (i > 0 && !(times[i] > times[i - 1]))
            return skg_fail(SKG_ERR_FORMAT,
                            "%s: row %" PRId64 " is at %g s, the one before at %g s; sort the rows by time",
                            path, i + 1, times[i], times[i - 1]);
        least = fmin(least, values[i]), greatest = fmax(greatest, values[i]);
    }
    if (!(greatest > least))
        return skg_fail(SKG_ERR_FORMAT, "%s: the amplitude is %g everywhere; a breath rises and falls", path,
                        least);
    for (int64_t i = 0; i < count; i++) {
        points[2 * i] = times[i] - times[0];
        points[2 * i + 1] = (values[i] - least) / (greatest - least);
    }
    return SKG_OK;
}

skg_status skg_signal_load(const char *path, double **points, int64_t *count) {
    double *times = NULL, *values = NULL;
    *points = NULL;
    SKG_TRY(skg_read_columns(path, NULL, count, &times, &values));
    skg_status status = *count >= 2
                            ? SKG_OK
                            : skg_fail(SKG_ERR_FORMAT,
                                       "%s: has one row; a signal has a row of time and amplitude for "
                                       "each moment, at least two",
                                       path);
    if (status == SKG_OK) status = skg_alloc(2 * *count, sizeof **points, path, points);
    if (status == SKG_OK) status = scale(path, *count, times, values, *points);
    if (status != SKG_OK) skg_free(points);
    skg_free(&times);
    skg_free(&values);
    return status;
}
