/* Helpers of rows of effects: how one is reported, and refused. */
#include "plan/rules.h"

#include <stdarg.h>
#include <stdio.h>

void skg_effect_set(skg_effect_state *state, int on, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(state->reason, sizeof state->reason, format, arguments);
    va_end(arguments);
    state->on = on;
}

skg_status skg_effect_no_gradient(const char *call, const char *what, const char *mend) {
    return skg_fail(SKG_ERR_UNSUPPORTED, "%s: %s has no gradient; %s", call, what, mend);
}

skg_status skg_effect_no_view_gradient(const char *call, const char *what) {
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "%s: %s under source and detector has no gradient; take it of poses, vertices or densities "
        "alone, or leave the effect out",
        call, what);
}
