/* Blocks of one size that are handed out again and again, and freed with their pool: a pointer to one that was given back may be stale,
 * but the memory behind it is never another's. */
#include "core/core.h"
#include "core/threads.h"

#include <stddef.h>
#include <string.h>

typedef struct block {
    struct block *next;  /* of the spare ones */
    max_align_t bytes[]; /* the user's */
} block;

struct skg_pool {
    skg_refs refs;
    pthread_mutex_t lock; /* of what follows */
    block *spare;
    size_t size; /* of every piece */
};

skg_status skg_pool_create(skg_pool **pool) {
    SKG_TRY(skg_alloc(1, sizeof **pool, "context", pool));
    skg_refs_init(&(*pool)->refs);
    pthread_mutex_init(&(*pool)->lock, NULL);
    return SKG_OK;
}

skg_pool *skg_pool_retain(skg_pool *pool) {
    skg_ref(&pool->refs);
    return pool;
}

void skg_pool_release(skg_pool **pool) {
    skg_pool *last = *pool;
    *pool = NULL;
    if (!last || !skg_unref(&last->refs)) return;
    while (last->spare) {
        block *freed = last->spare;
        last->spare = freed->next;
        skg_free(&freed);
    }
    pthread_mutex_destroy(&last->lock);
    skg_free(&last);
}

skg_status skg_pool_take(skg_pool *pool, size_t size, const char *what, void *pointer_address) {
    pthread_mutex_lock(&pool->lock);
    block *taken = pool->spare;
    SKG_ASSERT(pool->size == 0 || pool->size == size); /* any spare piece has to do */
    pool->size = size;
    if (taken) pool->spare = taken->next;
    pthread_mutex_unlock(&pool->lock);
    if (!taken) SKG_TRY(skg_alloc(1, offsetof(block, bytes) + size, what, &taken));
    void *bytes = taken->bytes;
    memcpy(pointer_address, &bytes, sizeof bytes);
    return SKG_OK;
}

void skg_pool_give(skg_pool *pool, void *bytes) {
    block *given = (block *)((char *)bytes - offsetof(block, bytes));
    pthread_mutex_lock(&pool->lock);
    given->next = pool->spare;
    pool->spare = given;
    pthread_mutex_unlock(&pool->lock);
}
