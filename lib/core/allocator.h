/* Host memory from the allocator of the process. For memory.c alone. Private. */
#ifndef SKG_ALLOCATOR_H
#define SKG_ALLOCATOR_H

#include <stddef.h>

/* Zeroed memory for count items, both above 0; NULL: none. */
void *skg_block_make(size_t count, size_t size);

/* Grows or shrinks a block, which may be NULL; NULL: no memory, and the block stays. */
void *skg_block_resize(void *block, size_t bytes);

/* Frees a block, which may be NULL. */
void skg_block_drop(void *block);

#endif
