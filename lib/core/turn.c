/* Turns on a context: the calls of its program, and a thread of the library that goes on with a job between them. */
#include "core/core.h"
#include "core/threads.h"

#include <unistd.h>

struct skg_turn {
    skg_refs refs;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t given;
    pthread_t owner;
    /* The process that made it: in a child after fork nothing is under way, and the lock may be held for ever. */
    int64_t process;
    int32_t depth; /* how often the owner has taken it; 0: nobody has */
    int32_t reserved;
};

skg_status skg_turn_create(skg_turn **turn) {
    SKG_TRY(skg_alloc(1, sizeof **turn, "context", turn));
    skg_refs_init(&(*turn)->refs);
    pthread_mutex_init(&(*turn)->lock, NULL);
    pthread_cond_init(&(*turn)->given, NULL);
    (*turn)->process = (int64_t)getpid();
    return SKG_OK;
}

skg_turn *skg_turn_retain(skg_turn *turn) {
    if (turn) skg_ref(&turn->refs);
    return turn;
}

void skg_turn_release(skg_turn **turn) {
    if (!*turn) return;
    skg_turn *last = *turn;
    *turn = NULL;
    if (!skg_unref(&last->refs)) return;
    pthread_cond_destroy(&last->given);
    pthread_mutex_destroy(&last->lock);
    skg_free(&last);
}

int skg_turn_is_here(const skg_turn *turn) {
    return turn && turn->process == (int64_t)getpid();
}

int skg_turn_take(skg_turn *turn, const int32_t *stop) {
    if (!skg_turn_is_here(turn)) return 1;
    const pthread_t self = pthread_self();
    pthread_mutex_lock(&turn->lock);
    while (turn->depth > 0 && !pthread_equal(turn->owner, self) && !(stop && *stop))
        pthread_cond_wait(&turn->given, &turn->lock);
    const int taken = !(stop && *stop);
    turn->owner = taken ? self : turn->owner;
    turn->depth += taken;
    pthread_mutex_unlock(&turn->lock);
    return taken;
}

void skg_turn_give(skg_turn *turn) {
    if (!skg_turn_is_here(turn)) return;
    pthread_mutex_lock(&turn->lock);
    SKG_ASSERT(turn->depth > 0 && pthread_equal(turn->owner, pthread_self()));
    if (--turn->depth == 0) pthread_cond_broadcast(&turn->given);
    pthread_mutex_unlock(&turn->lock);
}

void skg_turn_stop(skg_turn *turn, int32_t *stop) {
    pthread_mutex_lock(&turn->lock);
    *stop = 1;
    pthread_cond_broadcast(&turn->given);
    pthread_mutex_unlock(&turn->lock);
}
