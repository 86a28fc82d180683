#include "common/device.h"

#include "common/environment.h"
#include "common/say.h"

int cli_open_context(const cli_arguments *arguments, skg_context **context, skg_device_info *device) {
    cli_prepare_environment();
    skg_status status = skg_context_create(cli_value(arguments, &cli_flag_device), context);
    if (status != SKG_OK) return cli_fail(status);
    skg_device_info_init(device);
    skg_context_device_get(*context, device);
    skg_context_log_set(*context, cli_log, NULL);
    cli_warn_of_cache(device);
    return CLI_DONE;
}
