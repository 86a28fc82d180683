/* Rasters in use are never replaced. */
#include "stage/raster_private.h"
#include "suite.h"

#include <skiagraph/plan.h>

#include <string.h>

static skg_context *context;
static skg_raster_cache cache;

static void open_cache(void) {
    ck_skg(skg_context_create(NULL, &context));
    cache = (skg_raster_cache){.context = context};
}

static void close_cache(void) {
    skg_raster_cache_release(&cache);
    skg_context_release(&context);
}

/* Rasters that differ in the number of their planes. */
static skg_raster_options options_of(int64_t planes) {
    return (skg_raster_options){.kernels = {.bits = 32},
                                .strategy = SKG_STRATEGY_COPIES,
                                .columns = 8,
                                .rows = 8,
                                .planes = planes,
                                .triangles = 12};
}

static skg_status pin(int64_t planes, skg_raster_pin *to) {
    const skg_raster_options options = options_of(planes);
    return skg_raster_cache_pin(&cache, &options, to);
}

START_TEST(pinned_rasters_stay) {
    skg_raster_pin held = {0}, other = {0};
    ck_skg(pin(1, &held));
    for (int64_t planes = 2; planes < 3 * SKG_RASTER_CACHE_CAPACITY; planes++) {
        ck_skg(pin(planes, &other));
        ck_assert_int_eq(skg_raster_plane_count(other.raster), planes);
        ck_assert_int_eq(skg_raster_plane_count(held.raster), 1);
    }
    const skg_raster *first = held.raster;
    skg_raster_pin_release(&other);
    ck_skg(pin(1, &other)); /* found again, not made */
    ck_assert_ptr_eq(other.raster, first);
    skg_raster_pin_release(&held);
    skg_raster_pin_release(&held); /* one that holds nothing */
    for (int64_t planes = 100; planes < 100 + SKG_RASTER_CACHE_CAPACITY; planes++) ck_skg(pin(planes, &held));
    ck_assert_int_eq(skg_raster_plane_count(other.raster), 1); /* the second pin kept it */
    skg_raster_pin_release(&held);
    skg_raster_pin_release(&other);
}
END_TEST

START_TEST(full_of_pins) {
    skg_raster_pin pins[SKG_RASTER_CACHE_CAPACITY] = {{0}}, copy = {0}, more = {0};
    for (int k = 0; k < SKG_RASTER_CACHE_CAPACITY; k++) ck_skg(pin(k + 1, &pins[k]));
    ck_skg_fails(pin(99, &more), SKG_ERR_INTERNAL, "in use");
    ck_assert_ptr_null(more.raster);
    ck_skg(pin(3, &more)); /* is there already */
    skg_raster_pin_copy(&pins[5], &copy);
    skg_raster_pin_release(&pins[5]);
    ck_skg_fails(pin(99, &more), SKG_ERR_INTERNAL, "in use");
    ck_assert_int_eq(skg_raster_plane_count(more.raster), 3);
    skg_raster_pin_release(&copy);
    ck_skg(pin(99, &more));
    ck_assert_int_eq(skg_raster_plane_count(more.raster), 99);
    skg_raster_pin_release(&more);
    for (int k = 0; k < SKG_RASTER_CACHE_CAPACITY; k++) skg_raster_pin_release(&pins[k]);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_cache, close_cache);
    tcase_add_test(tests, pinned_rasters_stay);
    tcase_add_test(tests, full_of_pins);
}

SKG_SUITE_MAIN("raster_cache", add_tests)
