/* Platforms whose devices may be asked more than their name. */
#include "device/choice.h"
#include "device/self_tests.h"

#include <skiagraph/version.h>

enum { LONGEST = 256 };

/* Name of the test whose verdict is cached under the identity of a platform. */
static const char test[] = "platform";

/* The digest of its names and versions and of the version of this library. Its devices are not asked. */
static skg_digest identity_of(cl_platform_id platform) {
    static const cl_platform_info parts[] = {CL_PLATFORM_NAME, CL_PLATFORM_VENDOR, CL_PLATFORM_VERSION};
    skg_digester digester;
    skg_digest_start(&digester);
    skg_digest_add_text(&digester, SKG_VERSION);
    for (size_t n = 0; n < sizeof parts / sizeof *parts; n++) {
        char text[LONGEST] = "";
        if (clGetPlatformInfo(platform, parts[n], sizeof text, text, NULL) != CL_SUCCESS) text[0] = '\0';
        text[LONGEST - 1] = '\0';
        skg_digest_add_text(&digester, text);
    }
    return skg_digest_end(&digester);
}

int skg_platform_is_trusted(const char *store, cl_platform_id platform) {
    skg_verdict verdict;
    if (skg_platform_is_known(platform)) return 1;
    const skg_digest identity = identity_of(platform);
    return skg_verdict_known(store, &identity, test, &verdict) && verdict.good;
}

void skg_platform_trust(const char *store, cl_platform_id platform) {
    const skg_digest identity = identity_of(platform);
    const skg_verdict verdict = {.good = 1};
    skg_verdict_keep(store, &identity, test, &verdict);
}
