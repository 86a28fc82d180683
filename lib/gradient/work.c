/* The end of the work of a job of gradients or derivatives. */
#include "gradient/work.h"

void skg_gradient_work_release(skg_gradient_work **work) {
    if (!*work) return;
    skg_gradient_work *w = *work;
    if (w->ready) clReleaseEvent(w->ready);
    skg_free(&w->raw);
    skg_free(&w->image);
    skg_free(&w->adjoint);
    skg_free(&w->poses);
    skg_free(&w->densities);
    skg_free(&w->needs_lengths);
    skg_free(&w->planes);
    skg_free(&w->attenuations);
    skg_free(&w->nodes);
    for (int64_t d = 0; d < w->direction_count; d++) {
        skg_free(&w->directions[d].plane_changes);
        skg_free(&w->directions[d].node_changes);
    }
    skg_free(&w->directions);
    skg_free(&w->images);
    skg_free(work);
}
