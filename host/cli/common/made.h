/* Removes an output that the command could not finish. */
#ifndef SKG_CLI_MADE_H
#define SKG_CLI_MADE_H

/* Of an output of several files, or of a folder: a path that is about to be made. If the command cannot finish the output, cli_unmake
 * removes those that were not there before. A folder is remembered before what is in it (cli_make_folder does so). */
void cli_made(const char *path);

/* Removes what was remembered, the last first; folders only if they are empty. */
void cli_unmake(void);

/* Forgets it: it stays. */
void cli_made_forget(void);

#endif
