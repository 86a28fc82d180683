#include <skiagraph/version.h>

const char *skg_version(void) {
    return SKG_VERSION;
}
