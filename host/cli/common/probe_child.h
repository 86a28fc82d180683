/* What a child does that calls drivers (probe.h). */
#ifndef SKG_CLI_PROBE_CHILD_H
#define SKG_CLI_PROBE_CHILD_H

/* words: behind CLI_PROBE_WORD. Returns the exit status of the process. */
int cli_probe_child(int count, char **words);

#endif
