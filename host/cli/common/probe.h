/* Drivers of OpenCL in child processes. A driver that is not known may end, crash or block the process that calls it, so the
 * command calls it in a child first. The child is this command again, and answers on its standard input, which is a socket; what
 * its driver prints is dropped but for the last line. */
#ifndef CLI_COMMON_PROBE_H
#define CLI_COMMON_PROBE_H

#include <skiagraph/skiagraph.h>
#include <sys/types.h>

/* First word of the child's command line. Not for users, and in no manual. */
#define CLI_PROBE_WORD "(probe)"

/* Kinds of messages from the child. */
enum { CLI_PROBE_FOUND = 1, CLI_PROBE_RESULT, CLI_PROBE_OPENED, CLI_PROBE_REFUSED };

typedef struct {
    int32_t kind;
    skg_status status;      /* CLI_PROBE_REFUSED: of the call that failed */
    skg_device_info device; /* CLI_PROBE_FOUND */
    skg_device_test result; /* CLI_PROBE_RESULT */
    char sentence[1024];    /* CLI_PROBE_REFUSED */
} cli_probe_answer;

enum { CLI_PROBE_LINE = 128 };

typedef struct {
    pid_t process; /* 0: none */
    int answers, output;
    char line[CLI_PROBE_LINE]; /* the last one that it printed */
    int line_ended;
    int status;      /* once it has ended: its exit status, or minus the number of a signal */
    char ended[256]; /* the same as a sentence */
} cli_probe;

/* Lists all devices in a child, then counts them in this process. Returns an exit status and prints the error.
 *
 * config   words of --device, or NULL. A driver that they name is opened, here and in the child */
int cli_probe_all(const char *config, int64_t *count);

/* Starts a child that tests device number `device` of that list, from test `first` on. It answers RESULT for each test. Returns 0 or a value of
 * errno. */
int cli_probe_test(const char *config, int64_t device, int64_t first, cli_probe *probe);

/* Waits for an answer, for 30 s at most. Returns 0 if there is none: then the child has ended or was killed, and `ended` says how. */
int cli_probe_next(cli_probe *probe, cli_probe_answer *answer);

/* Ends the child. */
void cli_probe_end(cli_probe *probe);

enum { CLI_REFUSED = 1200 };

/* Opens a device in a child and keeps what went wrong. config: as above; words: of the device, or NULL; refused: CLI_REFUSED characters, why it cannot be opened; "" if it can.
 * Returns the exit status. */
int cli_probe_device(const char *config, const char *words, char refused[CLI_REFUSED]);

/* Runs in the child. words: those after CLI_PROBE_WORD. Returns the exit status of the process. */
int cli_probe_child(int count, char **words);

#endif
