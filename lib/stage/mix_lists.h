/* The lists by which an image's planes are mixed from accumulators (spectral/mix.h), on the device. Private. */
#ifndef SKG_MIX_LISTS_H
#define SKG_MIX_LISTS_H

#include "stage/staging.h"

/* All zero: nothing was sent so far. */
typedef struct {
    skg_buffer memory; /* [accumulators][planes] float or double */
    double *sent;      /* as the device has them; NULL: nothing was sent */
    int64_t count;     /* of the numbers sent */
} skg_mix_lists;

/* Enqueues the upload of `count` numbers if they differ from those on the device. */
skg_status skg_mix_lists_send(skg_mix_lists *lists, const double *numbers, int64_t count, int32_t is_double,
                              skg_staging *staging);
void skg_mix_lists_release(skg_mix_lists *lists);

#endif
