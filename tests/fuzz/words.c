/* Command lines: each line of the input is a word, the first one a verb. They are parsed, and every flag is
 * read in every way. Verbs that need no device and read no scene are run, unless they would write files. */
#include "cli/args.h"
#include "cli/plot.h"
#include "fuzz/fuzz.h"

#include <stdlib.h>
#include <string.h>

static const cli_verb *const verbs[] = {&cli_image,    &cli_lbuffer, &cli_plan,    &cli_cost,   &cli_mesh,
                                        &cli_material, &cli_beam,    &cli_devices, &cli_thorax, &cli_breathe};

static void read_flags(const cli_arguments *arguments) {
    static const char *const names[4] = {"auto", "copies", "tiles", "atomics"};
    for (int i = 0; arguments->verb->flags[i]; i++) {
        const cli_flag *flag = arguments->verb->flags[i];
        int32_t choice = 0;
        int64_t number = 7;
        double low = 0, high = 0;
        if (!cli_given(arguments, flag) || !flag->value) continue;
        if (!cli_value(arguments, flag) || !cli_nth_value(arguments, flag, 0)) abort();
        if (cli_choice(arguments, flag, names, 4, &choice) == CLI_DONE && (choice < 0 || choice > 3)) abort();
        if (cli_integer(arguments, flag, 0, 1000, &number) == CLI_DONE && (number < 0 || number > 1000))
            abort();
        if (cli_range(arguments, flag, &low, &high) == CLI_DONE && !(low < high)) abort();
    }
}

static void use(const cli_arguments *arguments) {
    read_flags(arguments);
    if (arguments->verb != &cli_material && arguments->verb != &cli_beam) return;
    if (cli_given(arguments, &cli_flag_plot)) return;
    const int exit_status = arguments->verb->run(arguments);
    if (exit_status < CLI_DONE || exit_status > CLI_OUTPUT) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    enum { MOST = 64, VERBS = sizeof verbs / sizeof *verbs };
    char *words[MOST], *text = fuzz_text(data, size), *at = text;
    const cli_verb *verb = NULL;
    int count = 0;
    while (count < MOST && at) { /* strtok would take no empty word */
        char *end = strchr(at, '\n');
        if (end) *end = '\0';
        words[count++] = at;
        at = end ? end + 1 : NULL;
    }
    for (int i = 0; i < VERBS; i++)
        if (strcmp(words[0], verbs[i]->name) == 0) verb = verbs[i];
    if (verb) {
        cli_arguments arguments;
        if (cli_parse(verb, count - 1, words + 1, &arguments) == CLI_DONE && !arguments.help) use(&arguments);
        cli_arguments_free(&arguments);
    }
    free(text);
    return 0;
}
