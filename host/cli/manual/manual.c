/* Manual of a verb's command line: one table for the parser, `help`, the man pages and the completion of shells. */
#include "manual/manual.h"

#include <stdio.h>
#include <string.h>

int cli_flag_is_output(const cli_flag *flag) {
    return flag->names == CLI_NAMES_OUTPUT || strcmp(flag->name, "-o") == 0;
}

int cli_flag_has_value(const cli_flag *flag) {
    return flag->argument || flag->values;
}

void cli_flag_argument(const cli_flag *flag, char *text, size_t size) {
    int used = snprintf(text, size, "%s", flag->argument ? flag->argument : "");
    for (const cli_item *value = flag->argument ? NULL : flag->values; value && value->name; value++)
        used +=
            snprintf(text + used, size - (size_t)used, "%s%s", value == flag->values ? "" : "|", value->name);
}
