/* The verbs. Each returns an exit status and prints its errors. */
#ifndef CLI_VERBS_VERBS_H
#define CLI_VERBS_VERBS_H

#include "common/args.h"

int cli_beam(const cli_arguments *arguments);
int cli_devices(const cli_arguments *arguments);
int cli_distance(const cli_arguments *arguments);
int cli_dose(const cli_arguments *arguments);
int cli_image(const cli_arguments *arguments);
int cli_lbuffer(const cli_arguments *arguments);
int cli_material(const cli_arguments *arguments);
int cli_mesh(const cli_arguments *arguments);
int cli_parts(const cli_arguments *arguments);
int cli_schema(const cli_arguments *arguments);

/* Prints the keys of scene files, for `help keys`. */
int cli_print_keys(void);
int cli_plan(const cli_arguments *arguments);
int cli_thorax(const cli_arguments *arguments);
int cli_make(const cli_arguments *arguments);
int cli_breathe(const cli_arguments *arguments);
int cli_cost(const cli_arguments *arguments);
int cli_fit(const cli_arguments *arguments);
int cli_register(const cli_arguments *arguments);
int cli_scan(const cli_arguments *arguments);
int cli_reconstruct(const cli_arguments *arguments);
int cli_view(const cli_arguments *arguments);
int cli_live(const cli_arguments *arguments);

/* `devices --test`: tests every device with all kernels and prints a table, or with json an object. config: the value of --device, or NULL; a driver that it names is tested,
 * too. Returns an exit status. */
int cli_device_tests(const char *config, int json);

/* `devices --warm`: renders every scene of the flag once. Returns an exit status, of the first scene that failed. */
int cli_warm(const cli_arguments *arguments);

#endif
