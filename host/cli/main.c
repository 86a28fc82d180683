/* The command skiagraph: finds the verb, parses what follows it, runs it. */
#include "args.h"
#include "interrupt.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static const cli_verb *const verbs[] = {
    &cli_image,    &cli_lbuffer, &cli_plan,    &cli_cost,   &cli_mesh,
    &cli_material, &cli_beam,    &cli_devices, &cli_thorax, &cli_breathe,
};
enum { VERBS = sizeof verbs / sizeof *verbs };

static void print_overview(FILE *stream) {
    fprintf(stream,
            "usage: skiagraph VERB ...\nX-ray images of triangle meshes on any OpenCL device.\n\nverbs:\n");
    for (int i = 0; i < VERBS; i++)
        fprintf(stream, "  %-8s %-14s %s\n", verbs[i]->name, verbs[i]->operands, verbs[i]->summary);
    fprintf(stream, "  %-8s %-14s %s\n", "help", "[VERB]", "this text, or that of a verb");
    fprintf(stream, "  %-8s %-14s %s\n", "version", "", "the version (also --version)");
    fprintf(stream, "\nexit status: 0 done, 1 a check failed, 2 usage, 3 bad input, 4 device or memory,\n"
                    "5 output could not be written\n");
}

static int find_verb(const char *name, const cli_verb **verb) {
    const char *names[VERBS + 2] = {"help", "version"};
    for (int i = 0; i < VERBS; i++) {
        names[i + 2] = verbs[i]->name;
        if (strcmp(name, verbs[i]->name) != 0) continue;
        *verb = verbs[i];
        return CLI_DONE;
    }
    return cli_unknown(name[0] == '-' ? "flag" : "verb", name, names, VERBS + 2, "help");
}

/* -o names what is written, whatever the verb. */
static void guard_outputs(const cli_arguments *arguments) {
    const char *path;
    for (int f = 0; arguments->verb->flags[f]; f++)
        for (int i = 0; strcmp(arguments->verb->flags[f]->name, "-o") == 0 &&
                        (path = cli_nth_value(arguments, arguments->verb->flags[f], i));
             i++)
            cli_guard_output(path);
}

static int run_verb(const cli_verb *verb, int count, char **words) {
    cli_arguments arguments;
    int exit_status = cli_parse(verb, count, words, &arguments);
    if (exit_status == CLI_DONE && arguments.help) {
        cli_print_help(verb);
    } else if (exit_status == CLI_DONE) {
        cli_catch_signals();
        guard_outputs(&arguments);
        cli_set_quiet(cli_given(&arguments, &cli_flag_quiet));
        exit_status = verb->run(&arguments);
    }
    cli_arguments_free(&arguments);
    return exit_status;
}

static int is_one_of(const char *word, const char *a, const char *b, const char *c) {
    return strcmp(word, a) == 0 || strcmp(word, b) == 0 || (c && strcmp(word, c) == 0);
}

static int run(int count, char **words) {
    const cli_verb *verb = NULL;
    if (count < 2) {
        print_overview(stderr);
        return CLI_USAGE;
    }
    if (is_one_of(words[1], "version", "--version", NULL)) {
        printf("skiagraph %s\n", skg_version());
        return CLI_DONE;
    }
    int help = is_one_of(words[1], "help", "--help", "-h");
    if (help && count == 2) {
        print_overview(stdout);
        return CLI_DONE;
    }
    int exit_status = find_verb(words[help ? 2 : 1], &verb);
    if (exit_status != CLI_DONE) return exit_status;
    if (!help) return run_verb(verb, count - 2, words + 2);
    cli_print_help(verb);
    return CLI_DONE;
}

int main(int count, char **words) {
    int exit_status = run(count, words);
    errno = 0;
    if ((fflush(stdout) != 0 || ferror(stdout)) && exit_status <= CLI_CHECK_FAILED)
        exit_status = cli_error(CLI_OUTPUT, "standard output: cannot be written%s%s", errno ? ": " : "",
                                errno ? strerror(errno) : "");
    return exit_status;
}
