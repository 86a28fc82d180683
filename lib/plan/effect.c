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
