/* A signal leaves no unfinished output behind. */
#ifndef SKG_CLI_INTERRUPT_H
#define SKG_CLI_INTERRUPT_H

#include <sys/types.h>

/* SIGINT, SIGTERM, SIGHUP, SIGUSR1 and SIGXCPU, unless they were ignored before, remove the unfinished files (NAME.part-PID-TAG) of
 * guarded outputs and then end the process. Call it once, in the thread that writes. */
void cli_catch_signals(void);

/* Guards the folder that holds `path`, and `path` itself if it is a folder, and removes what commands that were killed have left
 * unfinished there. */
void cli_guard_output(const char *path);

/* The handler kills this child process before it removes files, so that the child makes none. 0: there is no child. */
void cli_guard_child(pid_t child);

/* From now on the first signal only asks the computation to stop: it cancels cli_progress(), and cli_stop_asked reports it. The
 * second one ends the process as described above. */
void cli_stop_gently(void);

/* Whether a signal asked the computation to stop. */
int cli_stop_asked(void);

/* Ends the process by the signal that asked the computation to stop, so that its parent learns of it. */
void cli_end_by_signal(void);

/* Sets the text that the handler prints after "skiagraph: interrupted; ": the files that are kept. Until the first call: "no output was
 * written". */
void cli_keep(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A signal that ends the process gives the unfinished file its name, since what is in it is whole so far; NULL: no longer. */
void cli_keep_file(const char *temporary, const char *path);

#endif
