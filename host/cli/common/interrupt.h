/* What a signal leaves behind: nothing unfinished. */
#ifndef SKG_CLI_INTERRUPT_H
#define SKG_CLI_INTERRUPT_H

/* SIGINT, SIGTERM and SIGHUP, unless they were ignored before, remove what this process has not finished of
 * guarded outputs (NAME.part-PID), and then end it as they would have. Call once, in the thread that writes.
 */
void cli_catch_signals(void);

/* Guards the folder that `path` is in, and `path` where it is a folder itself. */
void cli_guard_output(const char *path);

#endif
