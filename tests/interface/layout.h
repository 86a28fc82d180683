/* The list of the interface beside what the compiler makes of the headers. layout.cmake writes the tables. */
#ifndef LAYOUT_H
#define LAYOUT_H

#include <skiagraph/breathing.h>
#include <skiagraph/live.h>
#include <skiagraph/opencl.h>
#include <skiagraph/registration.h>
#include <skiagraph/scanning.h>
#include <skiagraph/skiagraph.h>

#include <stddef.h>

typedef struct {
    const char *name;
    size_t size, listed_size;
} listed_struct;

typedef struct {
    const char *of, *name;
    size_t offset, listed_offset, size, listed_size;
    size_t type_size; /* of the type that the list gives */
} listed_field;

typedef struct {
    const char *name;
    int value, listed_value;
} listed_value;

typedef struct {
    const char *name, *returns;
} listed_function;

/* Each ends with an entry without a name. */
extern const listed_struct listed_structs[];
extern const listed_field listed_fields[];
extern const listed_value listed_values[];
extern const listed_function listed_functions[];

void listed_types(void);

#endif
