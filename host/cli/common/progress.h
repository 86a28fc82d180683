/* Time, and the line that shows how far a long computation has come. */
#ifndef SKG_CLI_PROGRESS_H
#define SKG_CLI_PROGRESS_H

#include <stdint.h>

/* Milliseconds of a clock that never goes back. */
double cli_now_ms(void);

/* On a terminal, from the first second on: "12 of 200 frames, 3.4 per second, 55 s left". start_ms:
 * cli_now_ms at the beginning. The line is erased when done == total. */
void cli_progress(const char *things, int64_t done, int64_t total, double start_ms);

#endif
