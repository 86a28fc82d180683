#include "args.h"

#include "core/names.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NAMES = 64 };

const cli_flag cli_flag_device = {"--device", "NAME",
                                  "cpu, gpu, PLATFORM:DEVICE, or part of a device's name; \"cpu threads=4\"\n"
                                  "limits the threads. Default: SKG_DEVICE, then the best there is"};
const cli_flag cli_flag_precision = {"--precision", "single|double|half",
                                     "of path lengths and image; default: the scene's, else single"};
const cli_flag cli_flag_tolerance = {"--tolerance", "ERROR",
                                     "relative error allowed to the spectrum, 0 to below 1; default: the\n"
                                     "scene's"};
const cli_flag cli_flag_strategy = {"--strategy", "auto|copies|tiles|atomics",
                                    "how hits are summed; every one gives the same bits"};
const cli_flag cli_flag_set = {"--set", "KEY=VALUE",
                               "changes the scene file before it is read: Detector.NumberOfPixels=[64,64],\n"
                               "Samples.liver.Type=inner; may be repeated"};
const cli_flag cli_flag_quiet = {"--quiet", NULL, "nothing but errors"};
const cli_flag cli_flag_json = {"--json", NULL, "one JSON object on standard output"};
const cli_flag cli_flag_output = {"-o", "FILE", "where to write; .png, .tif or .mha; may be repeated"};
const cli_flag cli_flag_repeat = {"--repeat", "N",
                                  "times N more frames: minimum and median, and for each stage"};
const cli_flag cli_flag_range = {"--range", "LOW:HIGH",
                                 "shown from black to white in a .png; default: the picture's own"};

int cli_unknown(const char *what, const char *name, const char *const *known, int count, const char *help) {
    const char *near = skg_nearest_name(name, known, count);
    if (near)
        return cli_error(CLI_USAGE, "unknown %s %s; did you mean %s? `skiagraph %s` lists all", what, name,
                         near, help);
    return cli_error(CLI_USAGE, "unknown %s %s; `skiagraph %s` lists all", what, name, help);
}

static int unknown_flag(const cli_verb *verb, const char *name) {
    const char *names[MOST_NAMES];
    char help[64];
    int count = 0;
    while (verb->flags[count] && count < MOST_NAMES - 1) {
        names[count] = verb->flags[count]->name;
        count++;
    }
    names[count++] = "--help";
    snprintf(help, sizeof help, "help %s", verb->name);
    return cli_unknown("flag", name, names, count, help);
}

/* The flag that a word names, up to its '=' if it has one. */
static const cli_flag *find_flag(const cli_verb *verb, const char *word) {
    size_t length = strcspn(word, "=");
    for (int i = 0; verb->flags[i]; i++)
        if (strlen(verb->flags[i]->name) == length && strncmp(verb->flags[i]->name, word, length) == 0)
            return verb->flags[i];
    return NULL;
}

static int parse_flag(const cli_verb *verb, int count, char **words, int *at, cli_arguments *arguments) {
    char *word = words[*at];
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        arguments->help = 1;
        return CLI_DONE;
    }
    const cli_flag *flag = find_flag(verb, word);
    const char *equals = strchr(word, '='), *value = equals ? equals + 1 : NULL;
    if (!flag) {
        if (equals) word[equals - word] = '\0'; /* the name alone */
        return unknown_flag(verb, word);
    }
    if (!flag->value && value) return cli_error(CLI_USAGE, "%s takes no value", flag->name);
    if (flag->value && !value) {
        if (*at + 1 >= count)
            return cli_error(CLI_USAGE, "%s needs a value: %s %s", flag->name, flag->name, flag->value);
        value = words[++*at];
    }
    arguments->given[arguments->given_count].flag = flag;
    arguments->given[arguments->given_count++].value = value;
    return CLI_DONE;
}

static int check_operands(const cli_arguments *arguments) {
    const cli_verb *verb = arguments->verb;
    if (arguments->operand_count < verb->least)
        return cli_error(CLI_USAGE, "%s: what is missing is %s; `skiagraph help %s` says more", verb->name,
                         verb->operands, verb->name);
    if (verb->most >= 0 && arguments->operand_count > verb->most)
        return cli_error(CLI_USAGE, "%s: \"%s\" is one word too many; `skiagraph help %s` says more",
                         verb->name, arguments->operands[verb->most], verb->name);
    return CLI_DONE;
}

int cli_parse(const cli_verb *verb, int count, char **words, cli_arguments *arguments) {
    *arguments = (cli_arguments){.verb = verb};
    arguments->operands = calloc((size_t)count + 1, sizeof *arguments->operands);
    arguments->given = calloc((size_t)count + 1, sizeof *arguments->given);
    if (!arguments->operands || !arguments->given) return cli_error(CLI_DEVICE, "out of host memory");
    int only_operands = 0;
    for (int at = 0; at < count; at++) {
        if (!only_operands && strcmp(words[at], "--") == 0) {
            only_operands = 1;
        } else if (!only_operands && words[at][0] == '-' && words[at][1] != '\0') {
            int exit_status = parse_flag(verb, count, words, &at, arguments);
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

const char *cli_nth_value(const cli_arguments *arguments, const cli_flag *flag, int index) {
    for (int i = 0; i < arguments->given_count; i++)
        if (arguments->given[i].flag == flag && index-- == 0) return arguments->given[i].value;
    return NULL;
}

const char *cli_value(const cli_arguments *arguments, const cli_flag *flag) {
    for (int i = arguments->given_count - 1; i >= 0; i--)
        if (arguments->given[i].flag == flag) return arguments->given[i].value;
    return NULL;
}

int cli_given(const cli_arguments *arguments, const cli_flag *flag) {
    for (int i = 0; i < arguments->given_count; i++)
        if (arguments->given[i].flag == flag) return 1;
    return 0;
}

int cli_choice(const cli_arguments *arguments, const cli_flag *flag, const char *const *names, int count,
               int32_t *place) {
    const char *value = cli_value(arguments, flag);
    if (!value) return CLI_DONE;
    for (int i = 0; i < count; i++)
        if (skg_same_name(value, names[i])) {
            *place = i;
            return CLI_DONE;
        }
    char known[256] = "";
    for (int i = 0; i < count; i++) {
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", i == 0 ? "" : ", ", names[i]);
    }
    const char *near = skg_nearest_name(value, names, count);
    return cli_error(CLI_USAGE, "%s %s is not known%s%s; known: %s", flag->name, value,
                     near ? "; did you mean " : "", near ? near : "", known);
}

int cli_integer(const cli_arguments *arguments, const cli_flag *flag, int64_t least, int64_t most,
                int64_t *place) {
    const char *value = cli_value(arguments, flag);
    if (!value) return CLI_DONE;
    char *end = NULL;
    errno = 0;
    long long number = strtoll(value, &end, 10);
    if (end == value || *end || errno || number < least || number > most)
        return cli_error(CLI_USAGE, "%s %s is not a whole number from %" PRId64 " to %" PRId64, flag->name,
                         value, least, most);
    *place = number;
    return CLI_DONE;
}

int cli_number(const cli_arguments *arguments, const cli_flag *flag, double least, double most,
               double *place) {
    const char *value = cli_value(arguments, flag);
    if (!value) return CLI_DONE;
    char *end = NULL;
    double number = strtod(value, &end);
    if (end == value || *end || !(number >= least && number <= most))
        return cli_error(CLI_USAGE, "%s %s is not a number from %g to %g", flag->name, value, least, most);
    *place = number;
    return CLI_DONE;
}

int cli_range(const cli_arguments *arguments, const cli_flag *flag, double *low, double *high) {
    const char *value = cli_value(arguments, flag);
    if (!value) return CLI_DONE;
    char *colon = NULL, *end = NULL;
    double a = strtod(value, &colon);
    double b = *colon == ':' ? strtod(colon + 1, &end) : 0;
    if (colon == value || *colon != ':' || end == colon + 1 || *end || !isfinite(a) || !isfinite(b) || a >= b)
        return cli_error(CLI_USAGE, "%s %s is not two numbers LOW:HIGH, the lower one first", flag->name,
                         value);
    *low = a;
    *high = b;
    return CLI_DONE;
}

static void print_flag(const char *name, const char *value, const char *help) {
    char head[64];
    snprintf(head, sizeof head, "%s%s%s", name, value ? " " : "", value ? value : "");
    if (strlen(head) > 18)
        printf("  %s\n  %-18s ", head, "");
    else
        printf("  %-18s ", head);
    for (; *help; help++) {
        putchar(*help);
        if (*help == '\n') printf("  %-18s ", "");
    }
    putchar('\n');
}

void cli_print_help(const cli_verb *verb) {
    printf("usage: skiagraph %s %s%s[FLAGS]\n%s\n\n%s\n\nflags:\n", verb->name, verb->operands,
           *verb->operands ? " " : "", verb->summary, verb->text);
    for (int i = 0; verb->flags[i]; i++)
        print_flag(verb->flags[i]->name, verb->flags[i]->value, verb->flags[i]->help);
    print_flag("--help", NULL, "this text");
}
