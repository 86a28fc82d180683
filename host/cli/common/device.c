/* Opens the device that a verb computes on. */
#include "common/values.h"

#include "common/environment.h"
#include "common/probe.h"
#include "common/progress.h"
#include "common/say.h"

#include <stdlib.h>

/* Holds the context until the process ends, because PoCL takes 70 ms to free its compiler. If the user has said whether PoCL
 * keeps kernels, it may have files to remove when the context is released. */
static void keep_to_the_end(skg_context *context) {
    static skg_context *kept;
    if (!kept && !getenv("POCL_KERNEL_CACHE") && skg_context_retain(context) == SKG_OK) kept = context;
}

int cli_open_context(const cli_arguments *arguments, skg_context **context, skg_device_info *device) {
    const char *config = cli_value(arguments, "--device");
    int32_t untested = 0;
    int exit_status = CLI_DONE;
    char refused[CLI_REFUSED];
    cli_prepare_environment();
    cli_progress_begin("starting and testing the device", 0);
    skg_status status = skg_device_untested(config, &untested);
    if (status == SKG_OK && untested) exit_status = cli_probe_device(config, config, refused);
    if (status == SKG_OK && exit_status == CLI_DONE) status = skg_context_create(config, context);
    cli_progress_end();
    if (exit_status != CLI_DONE) return cli_error(exit_status, "%s", refused);
    if (status != SKG_OK) return cli_fail(status);
    skg_device_info_init(device);
    skg_context_device_get(*context, device);
    skg_context_log_set(*context, cli_log, NULL);
    keep_to_the_end(*context);
    cli_warn_of_cache(device);
    return CLI_DONE;
}
