/* Reads filters and lengths of the command line. */
#include "common/values.h"

#include "common/say.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double cli_millimetres(const char *unit) {
    static const struct {
        const char *name;
        double mm;
    } units[] = {{"um", 1e-3}, {"mm", 1}, {"cm", 10}, {"m", 1000}};
    for (size_t u = 0; u < sizeof units / sizeof *units; u++)
        if (strcmp(unit, units[u].name) == 0) return units[u].mm;
    return 0;
}

/* Where the thickness of a filter begins: behind the last ':', because a material's name may contain one; in
 * "Al 2mm" and "Al 2 mm" at the last blank before a digit. NULL: nowhere. */
static const char *find_thickness(const char *text) {
    const char *found = strrchr(text, ':');
    for (const char *at = found ? NULL : text; at && (at = strchr(at, ' ')); at++)
        if (strspn(at + 1, "0123456789.") > 0) found = at;
    return found;
}

int cli_read_filter(const char *text, char *name, size_t size, double *mm) {
    char *end = NULL;
    const char *gap = find_thickness(text);
    const size_t length = gap ? (size_t)(gap - text) : 0;
    *mm = gap ? strtod(gap + 1, &end) : -1;
    if (gap && end != gap + 1 && *end) *mm *= cli_millimetres(end + strspn(end, " "));
    if (length == 0 || length >= size || end == gap + 1 || !(*mm >= 0 && *mm < HUGE_VAL) ||
        (*end && cli_millimetres(end + strspn(end, " ")) == 0))
        return cli_error(CLI_USAGE, "--filter %s is not MATERIAL:MM, such as Cu:0.1, or with a unit Al:2mm",
                         text);
    memcpy(name, text, length);
    name[length] = '\0';
    return CLI_DONE;
}
