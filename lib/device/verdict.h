/* What was found out about a device, kept in the user's folder. Private. */
#ifndef SKG_VERDICT_H
#define SKG_VERDICT_H

#include "core/digest.h"

/* The name of the test of what every plan needs. The choice of a device reads its verdict. */
#define SKG_TEST_OF_ALL "core"

typedef struct {
    int32_t good;     /* 1: it computes rightly */
    int32_t failed;   /* 1: the driver failed, or ended or blocked the process that tested it */
    double score;     /* of the test "core": images per second; 0: not measured */
    char reason[256]; /* what is wrong */
} skg_verdict;

/* Reads the verdict of a test on a device with its driver, for the kernels that are built in. 0: none is kept. */
int skg_verdict_known(const char *store, const skg_digest *identity, const char *test, skg_verdict *verdict);

void skg_verdict_keep(const char *store, const skg_digest *identity, const char *test,
                      const skg_verdict *verdict);

#endif
