/* A JSON file, its values, the lines where they stand, and settings that change it. Private. */
#ifndef SKG_JSON_JSON_FILE_H
#define SKG_JSON_JSON_FILE_H

#include "core/core.h"

#include <jansson.h>

typedef struct {
    const char *path; /* for messages */
    char *text;       /* the file's contents, for line numbers; ends with a 0 */
    json_t *root;     /* an object */
    json_t *set;      /* array of the values that settings put in; they have no line */
    json_t *remarks;  /* array of strings: warnings for the reader's log, each once */
    int32_t lenient;  /* 1: unknown keys and the like are remarks, not errors */
    int32_t lengths;  /* 1: only path lengths are wanted: a beam and materials may be absent or unknown */
} skg_json_file;

/* Reads and parses a file whose top level is an object. SKG_ERR_FILE, SKG_ERR_FORMAT with line and column.
 * path is not copied. Close also after a failure. */
skg_status skg_json_open(const char *path, skg_json_file *file);

/* Parses a text, which is copied, as skg_json_open does a file. path: for messages. */
skg_status skg_json_parse(const char *text, const char *path, skg_json_file *file);
void skg_json_close(skg_json_file *file);

/* A value and the path to it. Lives on the stack; `up` has to outlive it. */
typedef struct skg_json_node {
    const skg_json_file *file;
    const struct skg_json_node *up; /* NULL: the root */
    const char *key;                /* NULL: element `index` of an array */
    int64_t index;
    json_t *value; /* NULL: absent */
} skg_json_node;

skg_json_node skg_json_root(const skg_json_file *file);

/* The line of a node in the file's text, from 1; 0 where it has none. */
int64_t skg_json_line(const skg_json_node *node);

/* The column of a node in a file of one line, where the line says nothing, from 1; 0 in other files. */
int64_t skg_json_column(const skg_json_node *node);

/* Applies one setting "KEY=VALUE" with a dotted path; elements of arrays by number or by their Label. The
 * value is JSON, or a string where it does not parse. SKG_ERR_ARGUMENT. */
skg_status skg_json_set(skg_json_file *file, const char *setting);

#endif
