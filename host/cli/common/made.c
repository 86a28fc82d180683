/* Removes the files and folders of an output that the command could not finish, if they were not there before. */
#include "common/made.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char **made;
static size_t made_count, made_room;

void cli_made(const char *path) {
    struct stat there;
    if (lstat(path, &there) == 0) return;
    if (made_count == made_room) {
        const size_t room = 2 * made_room + 16;
        char **more = realloc(made, room * sizeof *made);
        if (!more) return;
        made = more, made_room = room;
    }
    made[made_count] = strdup(path);
    if (made[made_count]) made_count++;
}

void cli_unmake(void) {
    while (made_count > 0) {
        char *path = made[--made_count];
        if (unlink(path) != 0) (void)rmdir(path);
        free(path);
    }
    cli_made_forget();
}

void cli_made_forget(void) {
    while (made_count > 0) free(made[--made_count]);
    free(made);
    made = NULL, made_room = 0;
}
