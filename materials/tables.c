/* The program that turns the tables of this folder into one C file, whose types are in rows.h. */
#include "tables.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

void table_open(table *t, const char *folder, const char *name) {
    char path[4096];
    *t = (table){.folder = folder, .name = name};
    snprintf(path, sizeof path, "%s/%s", folder, name);
    t->file = fopen(path, "r");
    if (!t->file) table_stop(t, "cannot be read");
}

int table_next(table *t) {
    while (fgets(t->text, sizeof t->text, t->file)) {
        t->line++;
        size_t length = strcspn(t->text, "\n");
        if (t->text[length] != '\n') table_stop(t, "the line is too long or not ended");
        t->text[length] = '\0';
        if (length > 0 && t->text[0] != '#') return 1;
    }
    fclose(t->file);
    t->file = NULL;
    return 0;
}

void table_stop(const table *t, const char *why) {
    fprintf(stderr, "%s/%s:%d: %s\n", t->folder, t->name, t->line, why);
    exit(EXIT_FAILURE);
}

void table_fields(table *t, int count, char **fields) {
    char *rest = t->text;
    for (int k = 0; k < count; k++) {
        if (!rest) table_stop(t, "too few fields");
        char *end = strchr(rest, '|');
        while (isspace((unsigned char)*rest)) rest++;
        fields[k] = rest;
        char *last = end ? end : rest + strlen(rest);
        rest = end ? end + 1 : NULL;
        while (last > fields[k] && isspace((unsigned char)last[-1])) last--;
        *last = '\0';
    }
    if (rest) table_stop(t, "too many fields");
}
