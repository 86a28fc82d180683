/* Reading JSON with errors that name the place: file, line where the text has it, and path
 * ("Samples[3].Material"). Private.
 *
 * Keys are compared without regard to case, spaces, hyphens and underscores: scene files in use have both
 * "NumberOfPixels" and "Number of pixels". */
#ifndef SKG_JSON_H
#define SKG_JSON_H

#include "core/core.h"

#include <jansson.h>

/* One file. */
typedef struct {
    const char *path;
    char *text;   /* the file's contents, for line numbers; NULL terminated */
    json_t *root; /* an object */
    json_t *set;  /* array of the values that settings put in: they have no line */
} skg_json_file;

/* Reads and parses a file whose top level is an object. SKG_ERR_FILE, SKG_ERR_FORMAT with line and column.
 * path is not copied. Close also after a failure. */
skg_status skg_json_open(const char *path, skg_json_file *file);
void skg_json_close(skg_json_file *file);

/* Applies one setting "KEY=VALUE" with a dotted path; elements of arrays by number or by their Label. The
 * value is JSON, or a string where it does not parse. SKG_ERR_ARGUMENT. */
skg_status skg_json_set(skg_json_file *file, const char *setting);

/* A value and the way to it. Lives on the stack; `up` has to outlive it. */
typedef struct skg_json_node {
    const skg_json_file *file;
    const struct skg_json_node *up; /* NULL: the root */
    const char *key;                /* NULL: element `index` of an array */
    int64_t index;
    json_t *value; /* NULL: absent */
} skg_json_node;

skg_json_node skg_json_root(const skg_json_file *file);

/* Fails with the sentence after "FILE: line N: PATH: ". A call that found a value of the file unusable as an
 * argument (SKG_ERR_ARGUMENT) makes it SKG_ERR_FORMAT. */
skg_status skg_json_fail(const skg_json_node *node, skg_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* "Samples[3].Material (line 12)", for warnings. Cut where it does not fit. */
void skg_json_place(const skg_json_node *node, char *place, size_t size);

/* The line of a node in the file's text, from 1; 0 where it has none. */
int64_t skg_json_line(const skg_json_node *node);

/* Keys that an object may have. */
enum {
    SKG_KEY_READ = 0,
    SKG_KEY_IGNORED = 1, /* concerns the display only */
    SKG_KEY_NOT_YET = 2  /* of the schema, not simulated: refused unless its value is null or false */
};
typedef struct {
    const char *name;
    const char *as; /* another spelling of this key; NULL: itself. For SKG_KEY_NOT_YET: what it would do */
    int32_t kind;
} skg_json_key;

typedef struct {
    const skg_json_node *node;
    const skg_json_key *keys;
    int64_t count;
} skg_json_object;

/* The node has to be an object with these keys only, each once. Unknown keys: SKG_ERR_FORMAT with the nearest
 * known name; not yet: SKG_ERR_UNSUPPORTED. */
skg_status skg_json_read_object(const skg_json_node *node, const skg_json_key *keys, int64_t count,
                                skg_json_object *object);

/* The member with this name or another spelling of it; value NULL where there is none. */
skg_json_node skg_json_member(const skg_json_object *object, const char *name);

/* The same, which has to be there: SKG_ERR_FORMAT. */
skg_status skg_json_need(const skg_json_object *object, const char *name, const char *example,
                         skg_json_node *member);

int skg_json_same_key(const char *a, const char *b);

/* Element of an array; value NULL beyond its end. */
skg_json_node skg_json_element(const skg_json_node *array, int64_t index);

/* Number of elements; the node has to be an array. */
skg_status skg_json_array(const skg_json_node *node, const char *example, int64_t *count);

skg_status skg_json_number(const skg_json_node *node, double *number);
skg_status skg_json_integer(const skg_json_node *node, int64_t lowest, int64_t highest, int64_t *integer);
skg_status skg_json_flag(const skg_json_node *node, int32_t *flag);
skg_status skg_json_text(const skg_json_node *node, const char **text);

/* One of names[0..count), compared as keys are; its index. what: "shape of a source". */
skg_status skg_json_choice(const skg_json_node *node, const char *what, const char *const *names,
                           int64_t count, int64_t *choice);

/* Exactly `count` numbers in an array. example: shown where it is not. */
skg_status skg_json_numbers(const skg_json_node *node, const char *example, int64_t count, double *numbers);

/* Exactly `count` lengths and a unit in an array, converted to mm: [1, 2, 3, "cm"]. */
skg_status skg_json_lengths(const skg_json_node *node, const char *example, int64_t count, double *mm);

/* A string that names a unit of length: mm in it. */
skg_status skg_json_unit_of_length(const skg_json_node *node, double *mm);

/* A direction of three numbers, not all zero, scaled to length 1. */
skg_status skg_json_direction(const skg_json_node *node, double *direction);

#endif
