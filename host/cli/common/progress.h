/* Time, and the line that shows how far a long computation is. */
#ifndef SKG_CLI_PROGRESS_H
#define SKG_CLI_PROGRESS_H

#include <skiagraph/progress.h>
#include <stdint.h>

/* Milliseconds of a clock that never goes back. */
double cli_now_ms(void);

/* Begins a computation. If standard error is a terminal, a line there shows it from a second after the first computation of
 * the command on, renewed by a thread of its own: "frames: 12 of 200, 3.4 per second, 55 s left"; without a total, "planning, 5 s".
 * There is one at a time: one that begins ends the one before.
 *
 * what    what is done or counted; a text that lives as long as the computation
 * total   how many things there are; 0: not known */
void cli_progress_begin(const char *what, int64_t total);

/* The progress of the process, for the options of long work: one work at a time. A signal cancels it where cli_stop_gently says
 * so. NULL without memory. */
skg_progress *cli_progress(void);

/* Begins a computation that is given cli_progress(), whose numbers the line shows. */
void cli_progress_follow(const char *what);

/* `done` things are done by now. */
void cli_progress_step(int64_t done);

/* How much longer the computation will take, in ms from now, for one whose things take different times. The line then shows
 * from the first moment on "measuring: 12 of 44, 31 s left". Begins a computation if there is none. */
void cli_progress_forecast(const char *what, int64_t done, int64_t total, double left_ms);

/* Ends the computation and erases the line. Does nothing if there is none. */
void cli_progress_end(void);

#endif
