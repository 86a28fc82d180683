#include "common/progress.h"

#include "common/say.h"

#include <inttypes.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

double cli_now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

void cli_progress(const char *things, int64_t done, int64_t total, double start_ms) {
    enum { WIDTH = 78 };
    static double shown_ms;
    double now = cli_now_ms(), seconds = 1e-3 * (now - start_ms);
    if (cli_is_quiet() || seconds < 1 || !isatty(STDERR_FILENO)) return;
    if (done == total) {
        fprintf(stderr, "\r%*s\r", WIDTH, "");
    } else if (now - shown_ms > 200) {
        char line[WIDTH + 1];
        double rate = (double)done / seconds;
        snprintf(line, sizeof line, "%" PRId64 " of %" PRId64 " %s, %.3g per second, %.0f s left", done,
                 total, things, rate, (double)(total - done) / rate);
        fprintf(stderr, "\r%-*s", WIDTH, line);
        shown_ms = now;
    }
}
