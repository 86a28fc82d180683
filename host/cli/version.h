/* Prints `skiagraph version`. */
#ifndef CLI_VERSION_H
#define CLI_VERSION_H

/* The version; by what the command was built, with which libraries, and what is missing without others. json: 1: as an object.
 * Returns an exit status. */
int cli_version(int json);

#endif
