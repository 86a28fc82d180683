/* Self-tests of a device: small scenes whose images are known, rendered when their kernels are first needed. Each device, driver
 * and version of the kernels is tested once; the verdict is cached in the user's folder. Private.
 *
 * The rooms below lib/selftest ask for self-tests, and lib/selftest renders them with these rooms. The way up is one constant,
 * skg_self_tests. */
#ifndef SKG_SELF_TESTS_H
#define SKG_SELF_TESTS_H

#include "core/context.h"
#include "core/digest.h"

/* In the order in which `skiagraph devices --test` lists them. */
typedef enum {
    SKG_SELF_TEST_CORE, /* what every plan needs: project, one raster, attenuate */
    SKG_SELF_TEST_COPIES,
    SKG_SELF_TEST_TILES,
    SKG_SELF_TEST_ATOMICS,
    SKG_SELF_TEST_DOUBLE,
    SKG_SELF_TEST_HALF,
    SKG_SELF_TEST_ENERGIES,
    SKG_SELF_TEST_SOURCE_PLANE,
    SKG_SELF_TEST_LEAKY,
    SKG_SELF_TEST_PRIORITY,
    SKG_SELF_TEST_NOISE,
    SKG_SELF_TEST_BLUR,
    SKG_SELF_TEST_PARALLEL, /* all strategies, with exact sums */
    SKG_SELF_TEST_LENGTHS,
    SKG_SELF_TEST_DETECTOR,  /* electronic noise, steps, flat field */
    SKG_SELF_TEST_SHADES,    /* bow-tie filter, grid, oblique scintillator, jaws */
    SKG_SELF_TEST_PLACE,     /* positions in memory of the device */
    SKG_SELF_TEST_PICTURE,   /* the 3D view */
    SKG_SELF_TEST_RAYS,      /* several rays of a pixel in one pass */
    SKG_SELF_TEST_HEEL,      /* heel effect */
    SKG_SELF_TEST_DEPTHS,    /* several blurs, added */
    SKG_SELF_TEST_APART,     /* noise with a blur of its own, added */
    SKG_SELF_TEST_PASSES,    /* passes of a frame, each by a worker */
    SKG_SELF_TEST_SIDE,      /* the same, several side by side */
    SKG_SELF_TEST_SCATTER,   /* scattered photons */
    SKG_SELF_TEST_GRADIENT,  /* derivatives of an image */
    SKG_SELF_TEST_VARIANCE,  /* of noise, behind a blur and a logarithm */
    SKG_SELF_TEST_DENSITIES, /* derivatives of an image by the densities of parts inside each other */
    SKG_SELF_TEST_VOLUME,    /* volumes of cells */
    SKG_SELF_TEST_PULSES,    /* a detector that counts */
    SKG_SELF_TEST_LINEAR,    /* volumes whose values are linear between their cells' centres */
    SKG_SELF_TEST_CELLS,     /* derivatives of an image by parts that displace cells of a volume */
    SKG_SELF_TESTS
} skg_self_test;

/* The kernels that are tested, such as "strategy tiles". Static storage. */
const char *skg_self_test_name(skg_self_test number);

/* The result of a self-test, as it is cached. */
typedef struct {
    int32_t good;     /* 1: every pixel is right */
    int32_t failed;   /* 1: the driver failed, or ended or blocked the process that tested it */
    double score;     /* SKG_SELF_TEST_CORE: images of 512 x 512 pixels per second; 0: not measured */
    char reason[256]; /* what is wrong, with the first pixel; "" if it is good */
} skg_verdict;

/* The hook: lib/selftest defines this constant. It is no variable that is set at run time, so that all contexts and threads have
 * it from the start, and so that a program that links the static library has the self-tests with the device. */
typedef struct {
    /* Renders and compares. The status is that of the calls, which fail if the device cannot run the self-test at all. */
    skg_status (*run)(skg_context *context, skg_self_test number, skg_verdict *verdict);
} skg_self_test_hook;
extern const skg_self_test_hook skg_self_tests;

/* Makes sure that the device has passed a self-test: in this context, or in an earlier process, or else now. Calls that a self-test
 * makes need none. SKG_ERR_DEVICE with a sentence that names the kernels, the device and its driver if it has failed. */
skg_status skg_self_test_need(skg_context *context, skg_self_test number);

/* Runs a self-test. Nothing is cached. */
skg_status skg_self_test_run(skg_context *context, skg_self_test number, skg_verdict *verdict);

/* Runs a self-test, whatever verdict is cached, and keeps the new one. */
skg_status skg_self_test_repeat(skg_context *context, skg_self_test number, skg_verdict *verdict);

/* --- verdicts in the user's folder (verdict.c) --- */

/* Reads the verdict of a test on a device with its driver, for the kernels that are built in. 0: none is cached. */
int skg_verdict_known(const char *store, const skg_digest *identity, const char *test, skg_verdict *verdict);

void skg_verdict_keep(const char *store, const skg_digest *identity, const char *test,
                      const skg_verdict *verdict);

#endif
