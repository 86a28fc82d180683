/* Sets the environment variables that PoCL reads. The library never changes the environment; the command is a process
 * of its own and may. */
#ifndef SKG_CLI_ENVIRONMENT_H
#define SKG_CLI_ENVIRONMENT_H

#include <skiagraph/skiagraph.h>

/* Sets POCL_AFFINITY and POCL_CACHE_DIR where they help. Call it before the first OpenCL call. */
void cli_prepare_environment(void);

/* The reason why POCL_AFFINITY is set or not. */
const char *cli_affinity_reason(void);

/* Warns if the device's compiled kernels cannot be kept. */
void cli_warn_of_cache(const skg_device_info *device);

#endif
