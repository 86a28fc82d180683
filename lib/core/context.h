/* The inside of a context that every room may use: where warnings go. The OpenCL side is lib/device's.
 * Private. */
#ifndef SKG_CONTEXT_PRIVATE_H
#define SKG_CONTEXT_PRIVATE_H

#include "core/core.h"

#include <skiagraph/context.h>

/* One warning or note, formatted; dropped where context is NULL or has no log. */
void skg_log(skg_context *context, int32_t level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
