/* How far a long computation is, as its caller is told. */
#include "core/log.h"

#include "core/core.h"

#include <inttypes.h>

struct skg_progress {
    skg_refs refs;
    skg_progress_function function;
    void *user;
    _Atomic int64_t done, total;
    atomic_int cancelled;
};

skg_status skg_progress_create(skg_progress_function function, void *user, skg_progress **progress) {
    SKG_NEEDS(progress);
    *progress = NULL;
    SKG_TRY(skg_alloc(1, sizeof **progress, "progress", progress));
    skg_refs_init(&(*progress)->refs);
    (*progress)->function = function;
    (*progress)->user = user;
    return SKG_OK;
}

skg_status skg_progress_retain(skg_progress *progress) {
    SKG_NEEDS(progress);
    skg_ref(&progress->refs);
    return SKG_OK;
}

void skg_progress_release(skg_progress **progress) {
    if (!progress || !*progress) return;
    if (skg_unref(&(*progress)->refs)) skg_free(progress);
    *progress = NULL;
}

skg_status skg_progress_get(const skg_progress *progress, int64_t *done, int64_t *total) {
    SKG_NEEDS(progress);
    if (done) *done = atomic_load(&progress->done);
    if (total) *total = atomic_load(&progress->total);
    return SKG_OK;
}

skg_status skg_progress_cancel(skg_progress *progress) {
    SKG_NEEDS(progress);
    atomic_store(&progress->cancelled, 1);
    return SKG_OK;
}

skg_progress *skg_progress_keep(skg_progress *progress) {
    if (progress) skg_ref(&progress->refs);
    return progress;
}

skg_status skg_progress_step(skg_progress *progress, int64_t done, int64_t total) {
    if (!progress) return SKG_OK;
    atomic_store(&progress->done, done);
    atomic_store(&progress->total, total);
    if (progress->function && !atomic_load(&progress->cancelled) &&
        progress->function(done, total, progress->user) != 0)
        atomic_store(&progress->cancelled, 1);
    if (!atomic_load(&progress->cancelled)) return SKG_OK;
    return skg_fail(SKG_ERR_CANCELLED, "cancelled after %" PRId64 " of %" PRId64, done, total);
}
