/* Names and units of quantities. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

START_TEST(every_quantity_has_a_unit) {
    static const char *const units[] = {[SKG_QUANTITY_ENERGY] = "keV per pixel",
                                        [SKG_QUANTITY_FLUENCE] = "keV/mm2",
                                        [SKG_QUANTITY_PHOTONS] = "photons per pixel",
                                        [SKG_QUANTITY_TRANSMISSION] = "I/I0",
                                        [SKG_QUANTITY_ATTENUATION] = "-ln(I/I0)"};
    const char *name = "", *unit = "";
    for (int32_t q = 0; q < 5; q++) {
        ck_skg(skg_quantity_get(q, NULL, &unit));
        ck_assert_str_eq(unit, units[q]);
    }
    ck_skg(skg_quantity_get(SKG_QUANTITY_FLUENCE, &name, NULL));
    ck_assert_str_eq(name, "fluence");
    ck_skg_fails(skg_quantity_get(5, &name, &unit), SKG_ERR_ARGUMENT, "no quantity 5");
    ck_assert(!name && !unit);
    ck_skg_fails(skg_quantity_get(-1, &name, &unit), SKG_ERR_ARGUMENT, "no quantity -1");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, every_quantity_has_a_unit);
}

SKG_SUITE_MAIN("quantity", add_tests)
