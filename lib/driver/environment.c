/* Environment variables that drivers read, as the library reads them. */
#include "driver/driver.h"

#include <stdlib.h>
#include <string.h>

extern char **environ;

int skg_driver_has_cache(cl_platform_id platform) {
    const char *asked = getenv("POCL_KERNEL_CACHE");
    return skg_platform_is(platform, "Portable Computing Language") && !(asked && strcmp(asked, "0") == 0);
}

const char *skg_driver_threads_variable(const char *platform_name) {
    static const char *const variables[][2] = {{"Portable Computing Language", "POCL_MAX_PTHREAD_COUNT"},
                                               {"Intel", "CL_CONFIG_CPU_TBB_NUM_WORKERS"},
                                               {"rusticl", "LP_NUM_THREADS"}};
    const char *found = NULL;
    for (size_t n = 0; n < sizeof variables / sizeof *variables; n++)
        if (strstr(platform_name, variables[n][0])) found = variables[n][1];
    return found;
}

static int starts_with(const char *text, const char *start) {
    return strncmp(text, start, strlen(start)) == 0;
}

/* Variables that change what PoCL and Intel's runtime compile. Those that only say where and how much are left out.
 * The order of the environment is that of the process, so that another order compiles once more. */
void skg_driver_environment_add(skg_digester *digester) {
    static const char *const plain[] = {"POCL_CACHE_DIR=", "POCL_AFFINITY=", "POCL_MAX_PTHREAD_COUNT=",
                                        "POCL_DEBUG=",     "POCL_TRACING=",  "POCL_KERNEL_CACHE="};
    for (char **word = environ; word && *word; word++) {
        if (!starts_with(*word, "POCL_") && !starts_with(*word, "CL_CONFIG_")) continue;
        int is_plain = 0;
        for (size_t i = 0; i < sizeof plain / sizeof *plain; i++)
            if (starts_with(*word, plain[i])) is_plain = 1;
        if (!is_plain) skg_digest_add_text(digester, *word);
    }
}
