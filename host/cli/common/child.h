/* Processes that this one starts, one at a time. */
#ifndef SKG_CLI_CHILD_H
#define SKG_CLI_CHILD_H

#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

/* A program that reads its standard input from this process. */
typedef struct {
    pid_t process;    /* 0: none */
    int input;        /* its standard input; what it prints on standard output is dropped */
    FILE *complaints; /* its standard error */
} cli_child;

/* Whether a folder of the environment variable PATH has this program. */
int cli_has_program(const char *name);

/* Starts words[0], searched on PATH, with the words up to NULL, as leader of a process group. A signal that ends this process also
 * ends the child. input, output, complaints: descriptors that become its standard streams; output may be -1: dropped.
 * Returns 0 or a value of errno. */
int cli_process_start(const char *const *words, int input, int output, int complaints, pid_t *process);

/* Waits for its end. Returns its exit status, or minus the number of the signal that ended it. */
int cli_process_end(pid_t process);

/* Starts words[0], searched on PATH, with the words up to NULL. A signal that ends this process also ends the child.
 * Returns 0 or a value of errno. */
int cli_child_start(const char *const *words, cli_child *child);

/* Returns 1; 0 if the child has closed its standard input or has ended. */
int cli_child_feed(const cli_child *child, const void *bytes, size_t count);

/* Closes the standard input and waits for the end. Returns the exit status of the child, or minus the number of the
 * signal that ended it.
 *
 * said   its standard error as one line, cut to `size` bytes; empty if it printed nothing */
int cli_child_end(cli_child *child, char *said, size_t size);

/* Kills the child if there is one. */
void cli_child_kill(cli_child *child);

#endif
