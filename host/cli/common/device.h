/* The device of --device. */
#ifndef SKG_CLI_DEVICE_H
#define SKG_CLI_DEVICE_H

#include "common/args.h"

#include <skiagraph/skiagraph.h>

/* Opens the device. The caller releases the context, which is nevertheless held until the process ends. Returns an exit
 * status and prints the error. */
int cli_open_context(const cli_arguments *arguments, skg_context **context, skg_device_info *device);

#endif
