/* The browser that live opens, through a file of the user alone that holds the address with its token. */
#define _GNU_SOURCE /* mkostemps */
#include "live/browser.h"

#include "common/child.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* mkostemps gives the file to its owner alone (0600). Returns whether it is written. */
static int write_file(const char *url, char *file) {
    static const char end[] = ".html";
    const char *folder = getenv("XDG_RUNTIME_DIR");
    if (!folder || access(folder, W_OK) != 0) folder = getenv("TMPDIR");
    snprintf(file, LIVE_BROWSER_PATH, "%s/skiagraph-live-XXXXXX%s", folder ? folder : "/tmp", end);
    const int descriptor = mkostemps(file, sizeof end - 1, O_CLOEXEC);
    FILE *stream = descriptor < 0 ? NULL : fdopen(descriptor, "w");
    if (!stream) {
        if (descriptor >= 0) close(descriptor);
        return 0;
    }
    fprintf(
        stream,
        "<!DOCTYPE html><meta charset=\"utf-8\"><meta name=\"referrer\" content=\"no-referrer\">"
        "<meta http-equiv=\"refresh\" content=\"0;url=%s\"><title>skiagraph live</title><a href=\"%s\">%s</a>\n",
        url, url, "skiagraph live");
    return fclose(stream) == 0;
}

void live_browser_open(const char *url, char *file) {
    const char *const words[] = {"xdg-open", file, NULL};
    pid_t process;
    *file = '\0';
    if ((!getenv("DISPLAY") && !getenv("WAYLAND_DISPLAY")) || !cli_has_program(words[0])) return;
    const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nothing < 0) return;
    if (write_file(url, file))
        (void)cli_process_start(words, nothing, -1, nothing, &process);
    else
        live_browser_end(file);
    close(nothing);
}

void live_browser_end(char *file) {
    if (*file) unlink(file);
    *file = '\0';
}
