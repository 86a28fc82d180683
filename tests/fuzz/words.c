/* Command lines: each line of the input is a word, the first one a verb. They are parsed, and every flag is
 * read in every way. Verbs that need no device and read no scene are run, unless they would write files. */
#include "common/say.h"
#include "fuzz/fuzz.h"
#include "verb_table.h"

#include <stdlib.h>
#include <string.h>

static void read_flags(const cli_arguments *arguments) {
    for (int i = 0; arguments->manual->flags[i]; i++) {
        const cli_flag *flag = arguments->manual->flags[i];
        int32_t choice = 0;
        int64_t number = 7;
        double low = 0, high = 0;
        if (!cli_given(arguments, flag->name) || !cli_flag_has_value(flag)) continue;
        if (!cli_value(arguments, flag->name) || !cli_nth_value(arguments, flag->name, 0)) abort();
        if (flag->values && cli_choice(arguments, flag->name, &choice) == CLI_DONE &&
            (choice < 0 || !flag->values[choice].name))
            abort();
        if (cli_integer(arguments, flag->name, 0, 1000, &number) == CLI_DONE && (number < 0 || number > 1000))
            abort();
        if (cli_range(arguments, flag->name, &low, &high) == CLI_DONE && !(low < high)) abort();
    }
}

static void use(const cli_verb *verb, const cli_arguments *arguments) {
    read_flags(arguments);
    if (verb->manual != &cli_manual_material && verb->manual != &cli_manual_beam) return;
    if (cli_given(arguments, "-o")) return;
    const int exit_status = verb->run(arguments);
    if (exit_status < CLI_DONE || exit_status > CLI_OUTPUT) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    enum { LIMIT = 64 };
    char *words[LIMIT], *text = fuzz_text(data, size), *at = text;
    const cli_verb *verb = NULL;
    int count = 0;
    while (count < LIMIT && at) { /* strtok would take no empty word */
        char *end = strchr(at, '\n');
        if (end) *end = '\0';
        words[count++] = at;
        at = end ? end + 1 : NULL;
    }
    for (const cli_verb *known = cli_verbs; known->manual; known++)
        if (strcmp(words[0], known->manual->name) == 0) verb = known;
    if (verb) {
        cli_arguments arguments;
        if (cli_parse(verb->manual, count - 1, words + 1, &arguments) == CLI_DONE && !arguments.help)
            use(verb, &arguments);
        cli_arguments_free(&arguments);
    }
    free(text);
    return 0;
}
