/* Copies of what a plan's options point to. Private. */
#ifndef SKG_COPIES_H
#define SKG_COPIES_H

#include "core/core.h"

#include <skiagraph/material.h>

/* All zero: none. */
typedef struct {
    int64_t count;
    struct skg_copy *copies;
} skg_copies;

/* Zeroed memory that is freed with the copies. what: for the message. */
skg_status skg_copies_alloc(skg_copies *copies, int64_t count, size_t size, const char *what,
                            void *pointer_address);

/* Copies a caller's struct over the defaults of its init function. name: of its type. */
skg_status skg_copies_struct(skg_copies *copies, const void *given, const char *name, size_t size,
                             void (*init_sized)(void *, int32_t), void *pointer_address);

/* Replaces the caller's array by a copy. */
skg_status skg_copies_array(skg_copies *copies, int64_t count, const char *what, const double **values);

/* Retains a material until the copies are released; NULL: nothing. */
skg_status skg_copies_material(skg_copies *copies, skg_material *material);

void skg_copies_release(skg_copies *copies);

#endif
