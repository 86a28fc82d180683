/* The command line: flags by table, values by kind. */
#include "common/args.h"

#include "common/say.h"
#include "core/text.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAMES_MAX = 64 };

int cli_unknown(const char *what, const char *name, const char *const *known, int count, const char *help) {
    const char *near = skg_nearest_name(name, known, count);
    if (near)
        return cli_error(CLI_USAGE, "unknown %s %s; did you mean %s? `skiagraph %s` lists all", what, name,
                         near, help);
    return cli_error(CLI_USAGE, "unknown %s %s; `skiagraph %s` lists all", what, name, help);
}

/* Flags that no verb has, or not this one, and where what they ask for is said. */
static const struct {
    const char *flag, *advice;
} elsewhere[] = {
    {"--projections",
     "the key Scan of the scene says it: --set Scan.NumberOfProjections=90, for the verb scan"},
    {"--angles", "the key Scan of the scene says it: --set Scan.NumberOfProjections=90, for the verb scan"},
    {"--noise", "the scene says it: --set Noise=true"},
    {"--threads", "they belong to the device: --device \"device=cpu threads=4\""},
    {"--seconds", "only breathe and view make films; cost has --within SECONDS"},
    {"--size", "the scene says it: --set Detector.NumberOfPixels=[640,480]"},
    {"--kv", "give --kvp, with meshes instead of a scene; a scene says it: --set Source.Beam.kVp=120"},
};

/* The advice on a flag; NULL: there is none. */
static const char *advice_on(const char *name) {
    for (size_t i = 0; i < sizeof elsewhere / sizeof *elsewhere; i++)
        if (strcmp(elsewhere[i].flag, name) == 0) return elsewhere[i].advice;
    return NULL;
}

static int unknown_flag(const cli_manual *manual, const char *name) {
    const char *advice = advice_on(name);
    if (advice) return cli_error(CLI_USAGE, "%s has no flag %s: %s", manual->name, name, advice);
    const char *names[NAMES_MAX];
    char help[64];
    int count = 0;
    while (manual->flags[count] && count < NAMES_MAX - 1) {
        names[count] = manual->flags[count]->name;
        count++;
    }
    names[count++] = cli_flag_help.name;
    snprintf(help, sizeof help, "help %s", manual->name);
    return cli_unknown("flag", name, names, count, help);
}

const cli_flag *cli_find_flag(const cli_manual *manual, const char *word) {
    size_t length = strcspn(word, "=");
    for (int i = 0; manual->flags[i]; i++)
        if (strlen(manual->flags[i]->name) == length && strncmp(manual->flags[i]->name, word, length) == 0)
            return manual->flags[i];
    return NULL;
}

static int parse_flag(const cli_manual *manual, int count, char **words, int *at, cli_arguments *arguments) {
    char *word = words[*at];
    if (strcmp(word, cli_flag_help.name) == 0 || strcmp(word, "-h") == 0) {
        arguments->help = 1;
        return CLI_DONE;
    }
    const cli_flag *flag = cli_find_flag(manual, word);
    const char *equals = strchr(word, '='), *value = equals ? equals + 1 : NULL;
    if (!flag) {
        if (equals) word[equals - word] = '\0'; /* the message shows the name alone */
        return unknown_flag(manual, word);
    }
    if (!cli_flag_has_value(flag) && value) return cli_error(CLI_USAGE, "%s takes no value", flag->name);
    if (cli_flag_has_value(flag) && !value) {
        char text[128];
        cli_flag_argument(flag, text, sizeof text);
        if (*at + 1 >= count)
            return cli_error(CLI_USAGE, "%s needs a value: %s %s", flag->name, flag->name, text);
        value = words[++*at];
    }
    arguments->given[arguments->given_count].flag = flag;
    arguments->given[arguments->given_count++].value = value;
    return CLI_DONE;
}

static int check_operands(const cli_arguments *arguments) {
    const cli_manual *manual = arguments->manual;
    if (arguments->operand_count < manual->least)
        return cli_error(CLI_USAGE, "%s: %s is missing; see `skiagraph help %s`", manual->name,
                         manual->operands, manual->name);
    if (manual->most >= 0 && arguments->operand_count > manual->most)
        return cli_error(CLI_USAGE, "%s: \"%s\" is one word too many; see `skiagraph help %s`", manual->name,
                         arguments->operands[manual->most], manual->name);
    return CLI_DONE;
}

int cli_parse(const cli_manual *manual, int count, char **words, cli_arguments *arguments) {
    *arguments = (cli_arguments){.manual = manual};
    arguments->operands = calloc((size_t)count + 1, sizeof *arguments->operands);
    arguments->given = calloc((size_t)count + 1, sizeof *arguments->given);
    if (!arguments->operands || !arguments->given) return cli_error(CLI_DEVICE, "out of host memory");
    int only_operands = 0;
    for (int at = 0; at < count; at++) {
        if (!only_operands && strcmp(words[at], "--") == 0) {
            only_operands = 1;
        } else if (!only_operands && words[at][0] == '-' && words[at][1] != '\0') {
            int exit_status = parse_flag(manual, count, words, &at, arguments);
            if (exit_status != CLI_DONE) return exit_status;
        } else {
            arguments->operands[arguments->operand_count++] = words[at];
        }
    }
    return arguments->help ? CLI_DONE : check_operands(arguments);
}

void cli_arguments_free(cli_arguments *arguments) {
    free(arguments->operands);
    free(arguments->given);
    *arguments = (cli_arguments){0};
}

const char *cli_nth_value(const cli_arguments *arguments, const char *flag, int index) {
    for (int i = 0; i < arguments->given_count; i++)
        if (strcmp(arguments->given[i].flag->name, flag) == 0 && index-- == 0)
            return arguments->given[i].value;
    return NULL;
}

const char *cli_value(const cli_arguments *arguments, const char *flag) {
    for (int i = arguments->given_count - 1; i >= 0; i--)
        if (strcmp(arguments->given[i].flag->name, flag) == 0) return arguments->given[i].value;
    return NULL;
}

int cli_given(const cli_arguments *arguments, const char *flag) {
    for (int i = 0; i < arguments->given_count; i++)
        if (strcmp(arguments->given[i].flag->name, flag) == 0) return 1;
    return 0;
}

int cli_choice(const cli_arguments *arguments, const char *flag, int32_t *choice) {
    const char *value = cli_value(arguments, flag), *names[NAMES_MAX];
    char known[256] = "";
    int count = 0;
    if (!value) return CLI_DONE;
    const cli_item *const values = cli_find_flag(arguments->manual, flag)->values;
    for (; values[count].name && count < NAMES_MAX; count++) {
        const size_t used = strlen(known);
        names[count] = values[count].name;
        snprintf(known + used, sizeof known - used, "%s%s", count == 0 ? "" : ", ", names[count]);
        if (!skg_same_name(value, names[count])) continue;
        *choice = count;
        return CLI_DONE;
    }
    const char *near = skg_nearest_name(value, names, count);
    return cli_error(CLI_USAGE, "%s %s is not known%s%s; known: %s", flag, value,
                     near ? "; did you mean " : "", near ? near : "", known);
}

int cli_integer(const cli_arguments *arguments, const char *flag, int64_t least, int64_t most,
                int64_t *number) {
    const char *value = cli_value(arguments, flag);
    if (!value) return CLI_DONE;
    char *end = NULL;
    errno = 0;
    long long found = strtoll(value, &end, 10);
    if (end == value || *end || errno || found < least || found > most)
        return cli_error(CLI_USAGE, "%s %s is not a whole number from %" PRId64 " to %" PRId64, flag, value,
                         least, most);
    *number = found;
    return CLI_DONE;
}

int cli_number(const cli_arguments *arguments, const char *flag, double least, double most, double *number) {
    const char *value = cli_value(arguments, flag);
    if (!value) return CLI_DONE;
    char *end = NULL;
    double found = strtod(value, &end);
    if (end == value || *end || !(found >= least && found <= most))
        return cli_error(CLI_USAGE, "%s %s is not a number from %g to %g", flag, value, least, most);
    *number = found;
    return CLI_DONE;
}

int cli_phase(const char *given, const char *value, double *phase) {
    char *end = NULL;
    *phase = strtod(value, &end);
    if (end != value && !*end && *phase >= 0 && *phase < 1) return CLI_DONE;
    return cli_error(CLI_USAGE, "%s %s: a phase is a number from 0 to below 1", given, value);
}

int cli_range(const cli_arguments *arguments, const char *flag, double *low, double *high) {
    const char *value = cli_value(arguments, flag);
    if (!value) return CLI_DONE;
    char *colon = NULL, *end = NULL;
    double a = strtod(value, &colon);
    double b = *colon == ':' ? strtod(colon + 1, &end) : 0;
    if (colon == value || *colon != ':' || end == colon + 1 || *end || !isfinite(a) || !isfinite(b) || a >= b)
        return cli_error(CLI_USAGE, "%s %s is not two numbers LOW:HIGH, the lower number first", flag, value);
    *low = a;
    *high = b;
    return CLI_DONE;
}
