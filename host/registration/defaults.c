/* The structs of a registration as their init functions leave them. */
#include "registration/types.h"

void skg_registration_options_init_sized(void *options, int32_t size) {
    const skg_registration_options defaults = {.free = SKG_REGISTRATION_FREE_POSE,
                                               .seed = 1,
                                               .spread_mm = 20,
                                               .spread_rad = 15 * SKG_PI / 180,
                                               .steps = 30,
                                               .margin_mm = 25,
                                               .need_mm = 1};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

void skg_radiograph_init_sized(void *image, int32_t size) {
    const skg_radiograph defaults = {.quantity = SKG_QUANTITY_ENERGY};
    skg_struct_init(image, size, &defaults, sizeof defaults);
}

void skg_registration_result_init_sized(void *result, int32_t size) {
    const skg_registration_result defaults = {0};
    skg_struct_init(result, size, &defaults, sizeof defaults);
}

void skg_registration_direction_init_sized(void *direction, int32_t size) {
    const skg_registration_direction defaults = {0};
    skg_struct_init(direction, size, &defaults, sizeof defaults);
}
