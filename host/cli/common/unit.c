/* The unit of meshes that the command line names. */
#include "common/values.h"

#include "common/say.h"

int cli_mesh_unit(const cli_arguments *arguments, double *unit_mm) {
    static const double units_mm[] = {1e-6, 1e-3, 1,    10,   100,
                                      1000, 25.4, 25.4, 304.8}; /* by the values of --unit */
    int32_t chosen = -1;
    const int exit_status = cli_choice(arguments, "--unit", &chosen);
    *unit_mm = chosen < 0 ? 0 : units_mm[chosen];
    return exit_status;
}
