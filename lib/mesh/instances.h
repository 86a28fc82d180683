/* How often the parts of a file that place each other are placed, counted before the file is opened. Private. */
#ifndef SKG_MESH_INSTANCES_H
#define SKG_MESH_INSTANCES_H

#include "core/core.h"

#include <stdint.h>

/* The most times that a file may place its parts, together. */
enum { SKG_INSTANCES_MAX = 100000 };

/* A file may take this many times its own bytes of memory, and in any case 1 GiB. */
#define SKG_MESH_BYTES_TIMES 64
#define SKG_MESH_BYTES_LEAST ((int64_t)1 << 30)

double skg_mesh_bytes_max(int64_t size);

/* Fails with SKG_ERR_FORMAT if reading a file of `size` bytes would take more than that. */
skg_status skg_mesh_check_bytes(const char *path, int64_t size, double bytes);

/* Fails likewise if it places its parts more than SKG_INSTANCES_MAX times. its: how many the part of this name places */
skg_status skg_mesh_check_times(const char *path, double times, const char *kind, const char *name,
                                double its);

/* A part: an object, a node, a geometry. */
typedef struct {
    char name[40];       /* for messages */
    double own, bytes;   /* instances of its own (0 or 1), and its bytes each time that it is placed */
    int64_t first;       /* reference; -1: none */
    double times, takes; /* with all that it places */
    int32_t height;      /* levels below it */
    int8_t state, placed;
} skg_instance;

typedef struct {
    uint64_t key;
    int64_t node;
} skg_instance_name;

typedef struct {
    uint64_t key, other; /* the names that are looked for, one after the other; 0: none */
    int64_t to;          /* -1: by its name */
    int64_t next;        /* of the same part; -1: none */
} skg_instance_reference;

/* All zero: empty. */
typedef struct {
    skg_instance *nodes;
    skg_instance_name *names;
    skg_instance_reference *references;
    int64_t count, capacity, name_count, name_capacity, reference_count, reference_capacity;
    const char *path; /* of the file */
    const char *kind; /* what its parts are called: "object" */
    int64_t size;     /* bytes of the file */
    int32_t deepest;  /* levels that may lie in each other */
    /* 1: the file places each part that no other part places; 0: what part 0 places, and only that is looked at */
    int32_t all;
} skg_instances;

void skg_instances_free(skg_instances *all);

/* Adds a part, and gives its number. The first one is the whole file. */
skg_status skg_instances_add(skg_instances *all, const char *name, double own, int64_t *node);

/* The key of a name among the names of one kind. Different names may share a key: both are then taken for named. */
uint64_t skg_instances_key(uint64_t kind, const char *name);

/* Names a part. */
skg_status skg_instances_name(skg_instances *all, int64_t node, uint64_t key);

/* Says that a part places another one once: the one of this number, or each one of this name, or else of the other. */
skg_status skg_instances_place(skg_instances *all, int64_t from, int64_t to);
skg_status skg_instances_place_named(skg_instances *all, int64_t from, uint64_t key, uint64_t other);

/* Fails with SKG_ERR_FORMAT if a part contains itself, if they lie too deep in each other, or if they are placed more than
 * SKG_INSTANCES_MAX times, or take more memory than skg_mesh_check_bytes allows. Call once. */
skg_status skg_instances_check(skg_instances *all);

#endif
