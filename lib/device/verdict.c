/* Verdicts of self-tests in the user's folder. */
#include "core/core.h"
#include "device/cache.h"
#include "device/programs.h"
#include "device/self_tests.h"

#include <string.h>

static skg_digest key_of(const skg_digest *identity, const char *test) {
    skg_digester digester;
    skg_digest_start(&digester);
    skg_digest_add(&digester, identity->bytes, sizeof identity->bytes);
    skg_digest_add_text(&digester, test);
    skg_digest_add_text(&digester, skg_kernel_sources_digest);
    return skg_digest_end(&digester);
}

int skg_verdict_known(const char *store, const skg_digest *identity, const char *test, skg_verdict *verdict) {
    void *data = NULL;
    int64_t bytes = 0;
    if (!store[0]) return 0;
    const skg_digest key = key_of(identity, test);
    if (!skg_store_read(store, &key, SKG_KEPT_VERDICT, &data, &bytes)) return 0;
    const int whole = bytes == (int64_t)sizeof *verdict;
    if (whole) {
        memcpy(verdict, data, sizeof *verdict);
        verdict->reason[sizeof verdict->reason - 1] = '\0';
    }
    skg_free(&data);
    return whole;
}

void skg_verdict_keep(const char *store, const skg_digest *identity, const char *test,
                      const skg_verdict *verdict) {
    if (!store[0]) return;
    const skg_digest key = key_of(identity, test);
    skg_store_write(store, &key, SKG_KEPT_VERDICT, verdict, (int64_t)sizeof *verdict);
}
