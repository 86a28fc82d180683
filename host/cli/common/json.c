#include "common/json.h"

#include "common/say.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

json_t *cli_json_number(double number) {
    return isfinite(number) ? json_real(number) : json_null();
}

json_t *cli_json_text(const char *text) {
    json_t *value = json_string(text);
    if (value) return value;
    size_t length = strlen(text);
    char *plain = malloc(length + 1);
    if (!plain) return json_null();
    for (size_t i = 0; i <= length; i++) plain[i] = (unsigned char)text[i] < 128 ? text[i] : '?';
    value = json_string(plain);
    free(plain);
    return value;
}

json_t *cli_json_numbers(const double *numbers, int count) {
    json_t *list = json_array();
    for (int i = 0; i < count; i++) json_array_append_new(list, cli_json_number(numbers[i]));
    return list;
}

int cli_json_print(json_t *object) {
    int failed = json_dumpf(object, stdout, JSON_INDENT(2)) != 0;
    putchar('\n');
    json_decref(object);
    /* main reports an error of standard output, such as a full disk. */
    return failed && !ferror(stdout) ? cli_error(CLI_DEVICE, "out of host memory") : CLI_DONE;
}
