/* pages FOLDER VERSION: writes the man pages and the completion of shells into an existing folder. Runs at
 * build time. */
#include "pages/pages.h"

#include "manual/manual.h"

#include <errno.h>
#include <string.h>

static FILE *open_file(const char *folder, const char *name, const char *end) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s%s", folder, name, end);
    FILE *stream = fopen(path, "w");
    if (!stream) fprintf(stderr, "pages: %s: cannot be written: %s\n", path, strerror(errno));
    return stream;
}

/* Returns 1 after a failure. */
static int close_file(FILE *stream) {
    const int failed = ferror(stream);
    if (fclose(stream) == 0 && !failed) return 0;
    fprintf(stderr, "pages: a file could not be written: %s\n", strerror(errno));
    return 1;
}

static int write_verb(const cli_manual *manual, const char *folder, const char *version) {
    char name[64];
    snprintf(name, sizeof name, "skiagraph-%s", manual->name);
    FILE *stream = open_file(folder, name, ".1");
    if (!stream) return 1;
    pages_man_verb(manual, version, stream);
    return close_file(stream);
}

static int write_command(const char *folder, const char *version) {
    FILE *stream = open_file(folder, "skiagraph", ".1");
    if (!stream) return 1;
    pages_man_command(version, stream);
    return close_file(stream);
}

static int write_completion(const char *folder, const char *name, void (*write)(FILE *)) {
    FILE *stream = open_file(folder, name, "");
    if (!stream) return 1;
    write(stream);
    return close_file(stream);
}

int main(int count, char **words) {
    if (count != 3) {
        fputs("usage: pages FOLDER VERSION\n", stderr);
        return 2;
    }
    int failed = write_command(words[1], words[2]);
    for (const cli_manual *const *manual = cli_manuals; *manual; manual++)
        failed |= write_verb(*manual, words[1], words[2]);
    failed |= write_completion(words[1], "skiagraph", pages_bash);
    failed |= write_completion(words[1], "_skiagraph", pages_zsh);
    return failed;
}
