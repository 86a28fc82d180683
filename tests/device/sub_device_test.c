/* Parts of a device: made once in a process, because PoCL's threads look at them after the context was released. */
#include "device/device.h"
#include "suite.h"

#include <skiagraph/context.h>

static int made, fails;

cl_int __real_clCreateSubDevices(cl_device_id device, const cl_device_partition_property *how, cl_uint most,
                                 cl_device_id *parts, cl_uint *count);
cl_int __wrap_clCreateSubDevices(cl_device_id device, const cl_device_partition_property *how, cl_uint most,
                                 cl_device_id *parts, cl_uint *count);

cl_int __wrap_clCreateSubDevices(cl_device_id device, const cl_device_partition_property *how, cl_uint most,
                                 cl_device_id *parts, cl_uint *count) {
    if (fails) return CL_DEVICE_PARTITION_FAILED;
    made++;
    return __real_clCreateSubDevices(device, how, most, parts, count);
}

/* 0: the device has one compute unit, which nothing is a part of. */
static int has_parts(void) {
    skg_device_info info;
    skg_device_info_init(&info);
    ck_skg(skg_device_find("device=0:0", &info));
    return info.compute_units > 1;
}

START_TEST(a_part_is_made_once) {
    skg_context *contexts[2] = {NULL, NULL};
    if (!has_parts()) return;
    fails = 1;
    ck_skg_fails(skg_context_create("device=0:0 threads=1", &contexts[0]), SKG_ERR_UNSUPPORTED,
                 "cannot be limited to threads=1: CL_DEVICE_PARTITION_FAILED");
    fails = 0;
    ck_skg(skg_context_create("device=0:0 threads=1", &contexts[0]));
    const cl_device_id first = contexts[0]->device->id;
    ck_skg(skg_context_create("device=0:0 threads=1", &contexts[1])); /* beside it */
    ck_assert_ptr_eq(contexts[1]->device->id, first);
    for (int n = 0; n < 2; n++) skg_context_release(&contexts[n]);
    for (int n = 0; n < 10; n++) { /* and after it */
        cl_uint units = 0;
        ck_skg(skg_context_create("device=0:0 threads=1", &contexts[0]));
        ck_assert_ptr_eq(contexts[0]->device->id, first);
        ck_assert_int_eq(clGetDeviceInfo(first, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof units, &units, NULL),
                         CL_SUCCESS);
        ck_assert_int_eq(units, 1);
        skg_context_release(&contexts[0]);
    }
    ck_assert_int_eq(made, 1);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, a_part_is_made_once);
}

SKG_SUITE_MAIN("sub_device", add_tests)
