/* The command skiagraph: finds the verb, parses what follows it, runs it. */
#include "common/args.h"
#include "common/encode.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/made.h"
#include "common/probe.h"
#include "common/say.h"
#include "common/values.h"
#include "manual/manual.h"
#include "verb_table.h"
#include "verbs/verbs.h"
#include "version.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

enum { VERBS_MAX = 32 };

static int find_verb(const char *name, const cli_verb **verb) {
    const char *names[VERBS_MAX];
    int count = 0;
    for (const cli_verb *known = cli_verbs; known->manual && count < VERBS_MAX; known++) {
        names[count++] = known->manual->name;
        if (strcmp(name, known->manual->name) != 0) continue;
        *verb = known;
        return CLI_DONE;
    }
    for (const cli_item *other = cli_other_verbs; other->name && count < VERBS_MAX; other++)
        names[count++] = other->name;
    return cli_unknown(name[0] == '-' ? "flag" : "verb", name, names, count, "help");
}

static void guard_outputs(const cli_arguments *arguments) {
    for (int i = 0; i < arguments->given_count; i++)
        if (cli_flag_is_output(arguments->given[i].flag)) cli_guard_output(arguments->given[i].value);
}

static int run_verb(const cli_verb *verb, int count, char **words) {
    cli_arguments arguments;
    int exit_status = cli_parse(verb->manual, count, words, &arguments);
    if (exit_status == CLI_DONE && arguments.help) {
        cli_help_verb(verb->manual, stdout);
    } else if (exit_status == CLI_DONE) {
        cli_catch_signals();
        guard_outputs(&arguments);
        cli_set_quiet(cli_given(&arguments, "--quiet"));
        cli_set_verbose(cli_given(&arguments, "--verbose"));
        exit_status = cli_check_overwrites(&arguments);
        if (exit_status == CLI_DONE) exit_status = verb->run(&arguments);
        if (exit_status == CLI_DONE && cli_given(&arguments, "--strict") && cli_warning_count() > 0)
            exit_status = cli_error(CLI_CHECK_FAILED, "%d warning%s, which --strict makes an error",
                                    cli_warning_count(), cli_warning_count() == 1 ? "" : "s");
    }
    if (exit_status == CLI_OUTPUT)
        cli_unmake();
    else
        cli_made_forget();
    cli_arguments_free(&arguments);
    return exit_status;
}

static int is_one_of(const char *word, const char *a, const char *b, const char *c) {
    return strcmp(word, a) == 0 || strcmp(word, b) == 0 || (c && strcmp(word, c) == 0);
}

static int wants_json(int count, char **words) {
    for (int w = 1; w < count && strcmp(words[w], "--") != 0; w++)
        if (strcmp(words[w], cli_flag_json.name) == 0) return 1;
    return 0;
}

static int run(int count, char **words) {
    const cli_verb *verb = NULL;
    if (count < 2) {
        cli_help_overview(stderr);
        return CLI_USAGE;
    }
    if (strcmp(words[1], CLI_PROBE_WORD) == 0) return cli_probe_child(count - 2, words + 2);
    if (is_one_of(words[1], "version", "--version", NULL))
        return cli_version(count > 2 && wants_json(count, words));
    int help = is_one_of(words[1], "help", "--help", "-h");
    if (help && count == 2) {
        cli_help_overview(stdout);
        return CLI_DONE;
    }
    if (help && strcmp(words[2], "keys") == 0) return cli_print_keys();
    int exit_status = find_verb(words[help ? 2 : 1], &verb);
    if (exit_status != CLI_DONE) return exit_status;
    if (!help) return run_verb(verb, count - 2, words + 2);
    cli_help_verb(verb->manual, stdout);
    return CLI_DONE;
}

int main(int count, char **words) {
    int exit_status = run(count, words);
    if (exit_status != CLI_DONE && wants_json(count, words))
        cli_json_print_failure(count > 2 && words[2][0] != '-' ? words[2] : NULL);
    errno = 0;
    if ((fflush(stdout) != 0 || ferror(stdout)) && exit_status <= CLI_CHECK_FAILED)
        exit_status = cli_error(CLI_OUTPUT, "standard output: cannot be written%s%s", errno ? ": " : "",
                                errno ? strerror(errno) : "");
    return exit_status;
}
