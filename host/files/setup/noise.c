/* The key Noise. */
#include "core/text.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <inttypes.h>

/* An energy with its unit; 0 where it is absent. */
static skg_status read_energy(const skg_json_object *noise, const char *name, double *kev) {
    skg_json_node node = skg_json_member(noise, name);
    const char *unit = NULL;
    int64_t count = 0;
    double per_unit = 0;
    *kev = 0;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_array(&node, "[2.5, \"keV\"]", &count));
    if (count != 2)
        return skg_json_fail(&node, SKG_ERR_FORMAT, "has %" PRId64 " elements; write [2.5, \"keV\"]", count);
    skg_json_node number = skg_json_element(&node, 0), unit_node = skg_json_element(&node, 1);
    SKG_TRY(skg_json_number(&number, kev));
    if (!(*kev >= 0))
        return skg_json_fail(&number, SKG_ERR_FORMAT, "is %g; give an energy of 0 or more", *kev);
    SKG_TRY(skg_json_text(&unit_node, &unit));
    skg_status status = skg_unit_of_energy(unit, &per_unit);
    SKG_TRY(skg_json_at(&unit_node, status));
    *kev *= per_unit;
    return SKG_OK;
}

/* Noise is true, false, or an object. */
skg_status skg_setup_read_noise(skg_setup_reader *reader, const skg_json_node *node) {
    skg_setup_noise *noise = &reader->setup->noise;
    skg_json_object object;
    noise->swank = 1;
    if (!node->value) return SKG_OK;
    if (json_is_boolean(node->value)) return skg_json_flag(node, &noise->quantum);
    SKG_TRY(skg_json_read_object(node, &skg_keys_noise, &object));
    skg_json_node quantum = skg_json_member(&object, "Quantum"), swank = skg_json_member(&object, "Swank"),
                  seed = skg_json_member(&object, "Seed");
    noise->quantum = 1;
    if (quantum.value) SKG_TRY(skg_json_flag(&quantum, &noise->quantum));
    if (swank.value) SKG_TRY(skg_json_number(&swank, &noise->swank));
    if (!(noise->swank > 0 && noise->swank <= 1))
        return skg_json_fail(&swank, SKG_ERR_FORMAT, "is %g; a Swank factor is above 0 and at most 1",
                             noise->swank);
    if (seed.value) SKG_TRY(skg_json_integer(&seed, INT32_MIN, INT32_MAX, &noise->seed));
    SKG_TRY(read_energy(&object, "Electronic", &noise->electronic_kev));
    return read_energy(&object, "Step", &noise->step_kev);
}
