/* The machine of a plan on the device: memory, kernels and stages that its frames share. Private.
 *
 * It is filled by lib/frame, which gives each stage the members that it needs. */
#ifndef SKG_MACHINE_H
#define SKG_MACHINE_H

#include "stage/attenuate.h"
#include "stage/hits.h"
#include "stage/leaks.h"
#include "stage/place.h"
#include "stage/readout.h"
#include "stage/tables.h"
#include "stage/volumes.h"

/* Memory that a room above keeps with a plan's device from call to call. All zero: nothing. */
typedef struct {
    void *memory;
    void (*release)(void *memory);
    int64_t (*bytes)(const void *memory); /* on the device */
} skg_attachment;

/* Host memory of frames that are drawn together, which is taken again when the device has read it: as many times can be enqueued ahead. */
typedef struct {
    skg_staging staging;
    cl_event read; /* NULL: nothing is enqueued that reads it */
} skg_together_slot;

typedef struct {
    skg_context *context;
    skg_geometry geometry;
    skg_placement placement;
    skg_attenuation images;  /* planes to images */
    skg_attenuation lengths; /* one plane to path lengths: the plane itself */
    skg_attenuator *attenuator;
    skg_layers layers;      /* and their blurs */
    skg_pulses *pulses;     /* in their place; NULL: the detector does not count */
    skg_detector *detector; /* NULL: what is attenuated and blurred is shown */
    skg_flat_field flat_field;
    skg_mix_lists mix_lists;
    skg_leaky_memory leaky;
    skg_hits_memory hits;
    skg_volumes volumes;
    skg_buffer image; /* on its way to the host */
    skg_buffer mean;  /* of the transmission, for the variance of its logarithm */
    /* int[3]: pixels with a negative exponent, or outside the verified range; infinite values */
    skg_buffer negative;
    skg_pass_memory pass;
    skg_together_slot together[SKG_TABLE_SLOTS];
    int64_t together_next; /* how often one was taken */
    skg_raster_cache rasters;
    skg_attachment attached;
} skg_machine;

void skg_machine_release(skg_machine *machine);

/* The next slot, empty, for so many frames. Waits until the device has read what it held. */
skg_status skg_machine_slot_take(skg_machine *machine, int64_t frames, skg_together_slot **slot);

/* Empties the slots that the device has read: what a plan keeps between jobs does not depend on how many frames they had. */
void skg_machine_slots_settle(skg_machine *machine);

/* Bytes on the device, but for small tables. */
int64_t skg_machine_bytes(const skg_machine *machine);

#endif
