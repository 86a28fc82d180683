/* The version of the library. */
#include <skiagraph/version.h>

int32_t skg_version_number(void) {
    return SKG_VERSION_NUMBER;
}

const char *skg_version(void) {
    return SKG_VERSION;
}
