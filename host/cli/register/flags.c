/* The options of a registration from flags. */
#include "register/work.h"

#include "common/progress.h"
#include "common/say.h"

#include <math.h>
#include <stdio.h>

static const double degree = 3.14159265358979323846 / 180;

/* Six numbers with commas between them. */
static int read_start(const cli_arguments *arguments, double *start) {
    const char *value = cli_value(arguments, "--start");
    char rest = 0;
    if (!value) return CLI_DONE;
    if (sscanf(value, "%lf,%lf,%lf,%lf,%lf,%lf%c", start, start + 1, start + 2, start + 3, start + 4,
               start + 5, &rest) == 6)
        return CLI_DONE;
    return cli_error(CLI_USAGE, "--start %s: give six numbers, TX,TY,TZ,RX,RY,RZ in mm and radians", value);
}

static int read_spread(const cli_arguments *arguments, skg_registration_options *options) {
    double mm = 0, degrees = 0;
    if (!cli_given(arguments, "--spread")) return CLI_DONE;
    char rest = 0;
    const char *value = cli_value(arguments, "--spread");
    if (sscanf(value, "%lf:%lf%c", &mm, &degrees, &rest) != 2 ||
        !(mm > 0 && mm <= 1000 && degrees > 0 && degrees <= 180))
        return cli_error(CLI_USAGE, "--spread %s: give MM:DEGREES, such as 20:15, up to 1000:180", value);
    options->spread_mm = mm, options->spread_rad = degrees * degree;
    return CLI_DONE;
}

int register_read_options(register_work *work) {
    static const int32_t frees[] = {SKG_REGISTRATION_FREE_POSE, SKG_REGISTRATION_FREE_SOURCE,
                                    SKG_REGISTRATION_FREE_DETECTOR,
                                    SKG_REGISTRATION_FREE_SOURCE | SKG_REGISTRATION_FREE_DETECTOR};
    const cli_arguments *a = work->arguments;
    skg_registration_options *o = &work->options;
    int32_t chosen = 0;
    skg_registration_options_init(o);
    o->progress = cli_progress();
    o->polish = cli_given(a, "--polish");
    int exit_status = cli_choice(a, "--free", &chosen);
    o->free = frees[chosen];
    if (exit_status == CLI_DONE) exit_status = cli_choice(a, "--loss", &o->loss);
    if (exit_status == CLI_DONE) exit_status = read_start(a, o->start);
    if (exit_status == CLI_DONE) exit_status = read_spread(a, o);
    if (exit_status == CLI_DONE) exit_status = cli_integer(a, "--restarts", 0, 10000, &o->restarts);
    if (exit_status == CLI_DONE) exit_status = cli_integer(a, "--seed", 0, INT64_MAX, &o->seed);
    if (exit_status == CLI_DONE) exit_status = cli_number(a, "--margin", 1e-3, 1e6, &o->margin_mm);
    if (exit_status == CLI_DONE) exit_status = cli_number(a, "--need", 1e-6, 1e6, &o->need_mm);
    return exit_status;
}
