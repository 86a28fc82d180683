/* The JSON object of --json. */
#ifndef SKG_CLI_JSON_H
#define SKG_CLI_JSON_H

#include <jansson.h>

/* null if the number is not finite. */
json_t *cli_json_number(double number);

/* Bytes that are not UTF-8 become question marks. */
json_t *cli_json_text(const char *text);

json_t *cli_json_numbers(const double *numbers, int count);

/* Prints an object on standard output and releases it. Returns an exit status. */
int cli_json_print(json_t *object);

#endif
