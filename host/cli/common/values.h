/* Reads the values of flags: files, a device, a filter, a unit. Functions that return int return an exit status
 * and print the error. */
#ifndef CLI_COMMON_VALUES_H
#define CLI_COMMON_VALUES_H

#include "common/args.h"

#include <skiagraph/skiagraph.h>
#include <stddef.h>

/* The least share of the flat field that is told from nothing: less counts as this much, as skg_scan_reader_attenuation_get has it. */
#define CLI_LEAST_TRANSMISSION 1e-6

/* Refuses an output that is an input, and one that exists in the folder of an input, or below it, and that this command
 * did not write: its files name it. Inputs are the operands and the files of flags. */
int cli_check_overwrite(const cli_arguments *arguments, const char *path);

/* Checks every file that flags name as an output. */
int cli_check_overwrites(const cli_arguments *arguments);

/* Refuses an output that is a file which the scene reads: a mesh, a volume, a table. */
int cli_check_file_kept(const skg_setup *setup, const char *output);

/* Checks every file that flags name as an output with cli_check_file_kept. */
int cli_check_files_kept(const cli_arguments *arguments, const skg_setup *setup);

/* Opens the device of --device. The caller releases the context, which is nevertheless held until the process ends. */
int cli_open_context(const cli_arguments *arguments, skg_context **context, skg_device_info *device);

/* The millimetres of "um", "mm", "cm" or "m"; 0 if the unit is none of these. */
double cli_millimetres(const char *unit);

/* Reads the value of --filter, "Cu:0.1", "Al:2mm" or "Al 2 mm" into the material's name and its thickness. */
int cli_read_filter(const char *text, char *name, size_t size, double *mm);

/* The millimetres of the unit that --unit names for the numbers in mesh files; 1 if it was not given. */
int cli_mesh_unit(const cli_arguments *arguments, double *unit_mm);

#endif
