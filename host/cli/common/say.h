/* Sentences on standard error, and the exit status that goes with each. Control characters are written as \xNN. */
#ifndef SKG_CLI_SAY_H
#define SKG_CLI_SAY_H

#include <skiagraph/skiagraph.h>

enum { CLI_DONE = 0, CLI_CHECK_FAILED = 1, CLI_USAGE = 2, CLI_INPUT = 3, CLI_DEVICE = 4, CLI_OUTPUT = 5 };

/* A failure, as --json prints it. */
typedef struct {
    char message[4096]; /* empty: nothing failed; a longer one is cut */
    skg_status status;
} cli_failure;

/* The first failure that cli_error or cli_fail printed. */
const cli_failure *cli_first_failure(void);

/* Prints "skiagraph: sentence" and returns the exit status. */
int cli_error(int exit_status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints the last message of the library and returns the exit status that fits. */
int cli_fail(skg_status status);

/* The exit status for a failure of the library. */
int cli_exit_status(skg_status status);

/* Prints "skiagraph: warning: sentence", unless --quiet. */
void cli_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Whether the last warning was this one, but for a number at its beginning. */
int cli_was_warned(const char *sentence);

/* The number of warnings so far, printed or not. */
int cli_warning_count(void);

/* Prints "skiagraph: note: sentence", unless --quiet. */
void cli_note(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A skg_log_function that prints warnings and notes, unless --quiet. */
void cli_log(int32_t level, const char *sentence, void *user);

/* As printf, for texts with labels or names of files: control characters are written as \xNN. */
void cli_print(const char *format, ...) __attribute__((format(printf, 1, 2)));

void cli_set_quiet(int quiet);
int cli_is_quiet(void);

/* With --verbose, cli_tell prints "skiagraph: sentence" on standard error: what was loaded, chosen and compiled. */
void cli_set_verbose(int verbose);
void cli_tell(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Shows a line at the bottom of a terminal until the next sentence, the next line, or NULL, which erases it. May be
 * called by any thread. */
void cli_show_line(const char *line);

#endif
