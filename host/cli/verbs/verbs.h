/* The verbs of this room. Each returns an exit status and prints its errors. */
#ifndef SKG_CLI_VERBS_H
#define SKG_CLI_VERBS_H

#include "common/args.h"

int cli_beam(const cli_arguments *arguments);
int cli_devices(const cli_arguments *arguments);
int cli_distance(const cli_arguments *arguments);
int cli_image(const cli_arguments *arguments);
int cli_lbuffer(const cli_arguments *arguments);
int cli_material(const cli_arguments *arguments);
int cli_mesh(const cli_arguments *arguments);
int cli_plan(const cli_arguments *arguments);
int cli_thorax(const cli_arguments *arguments);
int cli_make(const cli_arguments *arguments);

#endif
