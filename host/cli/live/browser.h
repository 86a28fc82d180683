/* Opens the page in the user's browser. */
#ifndef CLI_LIVE_BROWSER_H
#define CLI_LIVE_BROWSER_H

enum { LIVE_BROWSER_PATH = 512 };

/* Opens an address in a browser, if there is a desktop. Every user of the machine can read the words of a process, and the address
 * holds the token: the browser is given a file that only this user can read, which leads on to it.
 *
 * file   [LIVE_BROWSER_PATH] result: the file, for live_browser_end; empty: none */
void live_browser_open(const char *url, char *file);

/* Removes the file. */
void live_browser_end(char *file);

#endif
