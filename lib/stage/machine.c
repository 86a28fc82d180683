/* The machine of a plan on the device: released, and counted in bytes. */
#include "stage/machine.h"

/* Empties a slot that the device reads no more, or never will. */
static skg_status empty(skg_together_slot *slot) {
    const cl_int code = slot->read ? clWaitForEvents(1, &slot->read) : CL_SUCCESS;
    if (slot->read) clReleaseEvent(slot->read);
    slot->read = NULL;
    skg_staging_release(&slot->staging);
    SKG_CL_TRY(code);
    return SKG_OK;
}

skg_status skg_machine_slot_take(skg_machine *machine, int64_t frames, skg_together_slot **slot) {
    const skg_geometry *geometry = &machine->geometry;
    const int64_t bytes = frames * geometry->parts * (int64_t)skg_geometry_entry_size(geometry);
    *slot = &machine->together[machine->together_next++ % skg_table_slots(bytes)];
    (*slot)->staging.context = machine->context;
    return empty(*slot);
}

void skg_machine_slots_settle(skg_machine *machine) {
    for (int i = 0; i < SKG_TABLE_SLOTS && i < machine->together_next; i++) {
        skg_together_slot *slot = &machine->together[i];
        cl_int stage = CL_COMPLETE;
        if (slot->read && clGetEventInfo(slot->read, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof stage, &stage,
                                         NULL) != CL_SUCCESS)
            continue;
        if (slot->staging.first && stage <= CL_COMPLETE) (void)empty(slot);
    }
}

void skg_machine_release(skg_machine *machine) {
    for (int i = 0; i < SKG_TABLE_SLOTS; i++) (void)empty(&machine->together[i]);
    skg_raster_cache_release(&machine->rasters);
    skg_geometry_release(&machine->geometry);
    skg_placement_release(&machine->placement);
    skg_attenuation_release(&machine->images);
    skg_attenuation_release(&machine->lengths);
    skg_attenuator_release(&machine->attenuator);
    skg_layers_release(&machine->layers);
    skg_pulses_release(&machine->pulses);
    skg_detector_release(&machine->detector);
    skg_buffer_release(&machine->flat_field.image);
    skg_mix_lists_release(&machine->mix_lists);
    skg_leaky_memory_release(&machine->leaky);
    skg_hits_memory_release(&machine->hits);
    skg_volumes_release(&machine->volumes);
    if (machine->attached.memory) machine->attached.release(machine->attached.memory);
    skg_buffer_release(&machine->image);
    skg_buffer_release(&machine->mean);
    skg_buffer_release(&machine->negative);
    skg_pass_memory_release(&machine->pass);
}

int64_t skg_machine_bytes(const skg_machine *machine) {
    int64_t bytes = skg_geometry_bytes(&machine->geometry) + machine->image.bytes + machine->mean.bytes +
                    machine->negative.bytes + skg_leaky_memory_bytes(&machine->leaky) +
                    machine->flat_field.image.bytes + skg_hits_memory_bytes(&machine->hits) +
                    skg_placement_bytes(&machine->placement) + skg_attenuation_bytes(&machine->images) +
                    skg_attenuation_bytes(&machine->lengths) + skg_raster_cache_bytes(&machine->rasters) +
                    skg_layers_bytes(&machine->layers) + skg_volumes_bytes(&machine->volumes);
    if (machine->attached.memory) bytes += machine->attached.bytes(machine->attached.memory);
    if (machine->pulses) bytes += skg_pulses_bytes(machine->pulses);
    if (machine->detector) bytes += skg_detector_bytes(machine->detector);
    return bytes;
}
