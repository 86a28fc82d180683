/* Functions that gathers on the device share, of faces (gather.c) and of pixels (spread.c). Private. */
#ifndef SKG_GRADIENT_GATHER_H
#define SKG_GRADIENT_GATHER_H

#include "gradient/gather_run.h"

/* Begins a gather: its program and arguments. */
skg_status skg_gather_begin(skg_gather_run *run);

/* Waits for the weights. most: [planes] result: the largest of each plane. */
skg_status skg_gather_find_max(const skg_gather_run *run, double *most);

/* Rounds numbers to the precision of the pass. reals: as many, filled from number `first` on */
void skg_gather_round(const skg_gather_run *run, int64_t first, int64_t count, const double *numbers,
                      void *reals);
skg_status skg_gather_upload_scales(const skg_gather_run *run, int64_t count, const double *scales);
skg_status skg_gather_reserve(const skg_gather_run *run, skg_buffer *buffer, int64_t bytes);

/* Makes sure of `end` sums, of which those from number `first` on are 0. */
skg_status skg_gather_clear(const skg_gather_run *run, int64_t first, int64_t end);

/* Adds to the weights of hits what priorities make of them; the hits of competing parts are listed still, by skg_hits_settle of this pass. */
skg_status skg_gather_slopes(const skg_gather_run *run);

/* On a processor: all but what priorities add. Memory that another gather uses, and this one does not, is passed as it is. */
skg_status skg_gather_batches(const skg_gather_run *run);

/* Adds what batches have not, by gradient.cl: all faces, or what priorities add. */
skg_status skg_gather_faces(const skg_gather_run *run);

#endif
