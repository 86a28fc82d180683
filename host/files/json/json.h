/* Reading JSON with errors that name the place: file, line where the text has it, and path
 * ("Samples[3].Material"). Private.
 *
 * Keys are compared without regard to case, spaces, hyphens and underscores: scene files in use have both
 * "NumberOfPixels" and "Number of pixels". */
#ifndef SKG_JSON_H
#define SKG_JSON_H

#include "json/json_file.h"

/* Fails with the sentence after "FILE: line N: PATH: ". SKG_ERR_ARGUMENT becomes SKG_ERR_FORMAT: the file is wrong,
 * not the caller of its reader. */
skg_status skg_json_fail(const skg_json_node *node, skg_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The status of a call that used a value of the file. On a failure the last error gets the value's place, as above. */
skg_status skg_json_at(const skg_json_node *node, skg_status status);

/* Keeps a warning about a value: its place, then the sentence. The same warning is kept once. */
skg_status skg_json_remark(const skg_json_node *node, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* A fault that leniency forgives: a failure as of skg_json_fail, or, where the file is read leniently, a remark and SKG_OK. */
skg_status skg_json_fault(const skg_json_node *node, skg_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Writes "Samples[3].Material (line 12)", for warnings; truncated where it does not fit. */
void skg_json_place(const skg_json_node *node, char *place, size_t size);

/* Keys that an object may have. */
enum {
    SKG_KEY_READ = 0,
    SKG_KEY_IGNORED = 1 /* concerns the display only, or is a comment */
};
typedef struct {
    const char *name;
    const char *as; /* the key of which this is another spelling; NULL: none */
    int32_t kind;
    const char *form; /* of the value, in the words of setup/keys.h */
    const char *says; /* what it means; NULL: nothing */
} skg_json_key;

/* The keys of one kind of object. */
typedef struct {
    const char *name;
    const skg_json_key *keys;
    int64_t count;
} skg_json_table;

/* Keys that any object may have besides its own: comments and colours, which are ignored. */
extern const skg_json_table skg_json_asides;

typedef struct {
    const skg_json_node *node;
    const skg_json_table *table;
} skg_json_object;

/* The node has to be an object with these keys only, each once. An unknown key is a fault with the nearest known name.
 * Every object may have a comment and a colour, which are ignored. */
skg_status skg_json_read_object(const skg_json_node *node, const skg_json_table *table,
                                skg_json_object *object);

/* The member with this name, or another spelling of it; its value is NULL where there is none. */
skg_json_node skg_json_member(const skg_json_object *object, const char *name);

/* Gets a member that is required: SKG_ERR_FORMAT where there is none. */
skg_status skg_json_need(const skg_json_object *object, const char *name, const char *example,
                         skg_json_node *member);

int skg_json_same_key(const char *a, const char *b);

/* Element of an array; its value is NULL beyond the end. */
skg_json_node skg_json_element(const skg_json_node *array, int64_t index);

/* Number of elements; the node has to be an array. */
skg_status skg_json_array(const skg_json_node *node, const char *example, int64_t *count);

skg_status skg_json_number(const skg_json_node *node, double *number);
skg_status skg_json_integer(const skg_json_node *node, int64_t lowest, int64_t highest, int64_t *integer);
skg_status skg_json_flag(const skg_json_node *node, int32_t *flag);
skg_status skg_json_text(const skg_json_node *node, const char **text);

/* The index of a string among names[0..count), compared as keys are. what: "shape of a source", for the message. */
skg_status skg_json_choice(const skg_json_node *node, const char *what, const char *const *names,
                           int64_t count, int64_t *choice);

/* Exactly `count` numbers in an array. example: for the message. */
skg_status skg_json_numbers(const skg_json_node *node, const char *example, int64_t count, double *numbers);

/* Exactly `count` lengths and a unit in an array, converted to mm: [1, 2, 3, "cm"]. */
skg_status skg_json_lengths(const skg_json_node *node, const char *example, int64_t count, double *mm);

/* The mm of a unit of length, from its name. */
skg_status skg_json_unit_of_length(const skg_json_node *node, double *mm);

/* A direction of three numbers, not all zero, scaled to length 1. */
skg_status skg_json_direction(const skg_json_node *node, double *direction);

#endif
