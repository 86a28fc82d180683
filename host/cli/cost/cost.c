/* The verb cost, from its words to its outputs. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/made.h"
#include "common/progress.h"
#include "common/say.h"
#include "common/values.h"
#include "cost/dials.h"
#include "cost/findings.h"
#include "cost/measuring.h"
#include "cost/output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The path of the table beside a page: "cost.csv" for "cost.html". The caller frees it; NULL if memory is
 * exhausted. */
static char *table_beside(const char *path) {
    const size_t stem = strlen(path) - strlen(".html");
    char *beside = malloc(stem + sizeof ".csv");
    if (beside) sprintf(beside, "%.*s.csv", (int)stem, path);
    return beside;
}

/* Checks before the long computation that every -o can be written. */
static int check_outputs(const cli_arguments *arguments) {
    const char *path;
    for (int i = 0; (path = cli_nth_value(arguments, "-o", i)); i++) {
        if (!cli_has_extension(path, ".html") && !cli_has_extension(path, ".csv"))
            return cli_error(CLI_USAGE, "-o %s: its extension is neither .html nor .csv", path);
        if (cli_has_extension(path, ".html")) {
            char *beside = table_beside(path);
            const int exit_status =
                beside ? cli_check_overwrite(arguments, beside) : cli_error(CLI_DEVICE, "out of host memory");
            free(beside);
            if (exit_status != CLI_DONE) return exit_status;
        }
        const char *slash = strrchr(path, '/');
        char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
        if (!folder) return cli_error(CLI_DEVICE, "out of host memory");
        int can = access(folder, W_OK | X_OK) == 0;
        free(folder);
        if (!can) return cli_error(CLI_OUTPUT, "%s: cannot be written: %s", path, strerror(errno));
    }
    return CLI_DONE;
}

static int write_csv(const cost_study *study, const char *path) {
    char *text = cost_csv(study);
    if (!text) return cli_error(CLI_DEVICE, "out of host memory");
    cli_made(path);
    int exit_status = cli_write_file(path, text, strlen(text));
    free(text);
    return exit_status;
}

static int write_output(const cost_study *study, const char *path) {
    if (cli_has_extension(path, ".csv")) return write_csv(study, path);
    int exit_status = cost_write_page(study, path);
    char *beside = table_beside(path);
    int its = beside ? write_csv(study, beside) : cli_error(CLI_DEVICE, "out of host memory");
    free(beside);
    return exit_status == CLI_DONE ? its : exit_status;
}

static int write_outputs(const cost_study *study) {
    const char *path;
    int failure = CLI_DONE;
    for (int i = 0; (path = cli_nth_value(study->arguments, "-o", i)); i++) {
        int its = write_output(study, path);
        if (failure == CLI_DONE) failure = its;
    }
    return failure;
}

static int report(const cost_study *study) {
    const char *path;
    if (cli_given(study->arguments, "--json")) return cli_json_print(cost_json(study));
    if (cli_is_quiet()) return CLI_DONE;
    cost_print(study);
    for (int i = 0; (path = cli_nth_value(study->arguments, "-o", i)); i++)
        printf(cli_has_extension(path, ".csv") ? "wrote %s\n" : "wrote %s, and its table as .csv\n", path);
    return CLI_DONE;
}

static int read_flags(cost_study *study) {
    const cli_arguments *arguments = study->arguments;
    double within = 60;
    study->quick = cli_given(arguments, "--quick");
    study->sensitive = cli_given(arguments, "--sensitivity");
    study->frames = 1;
    int exit_status = cli_number(arguments, "--within", 1, 86400, &within);
    if (exit_status == CLI_DONE) exit_status = cli_integer(arguments, "--frames", 1, 4096, &study->frames);
    study->begun_ms = cli_now_ms();
    study->within_ms = 1e3 * within;
    return exit_status;
}

/* Each shot's command line. */
static int find_commands(cost_study *study) {
    for (int i = 0; i < study->measured.shot_count; i++) {
        study->measured.shots[i].command = cost_command(study, &study->measured.shots[i].setting);
        if (!study->measured.shots[i].command) return cli_error(CLI_DEVICE, "out of host memory");
    }
    return CLI_DONE;
}

static int measure(cost_study *study) {
    int exit_status = cost_measure_scatter(study);
    if (exit_status == CLI_DONE) exit_status = cost_measure_between(study);
    if (exit_status == CLI_DONE) exit_status = cost_sweep(study);
    if (exit_status == CLI_DONE) exit_status = cost_advise(study);
    if (exit_status == CLI_DONE) exit_status = find_commands(study);
    if (exit_status != CLI_DONE) return exit_status;
    cost_find_frontier(study);
    cost_find_unrest(study);
    exit_status = cost_find_sources(study);
    cost_find_trust(study);
    cost_summarise(study);
    study->stopped = cli_stop_asked();
    study->ended_ms = cli_now_ms();
    return exit_status;
}

int cli_cost(const cli_arguments *arguments) {
    if (strcmp(arguments->operands[0], "-") == 0)
        return cli_error(CLI_USAGE, "cost reads its scene several times; give a file instead of -");
    cost_study *study = calloc(1, sizeof *study);
    if (!study) return cli_error(CLI_DEVICE, "out of host memory");
    study->arguments = arguments;
    int exit_status = read_flags(study);
    if (exit_status == CLI_DONE) exit_status = check_outputs(arguments);
    if (exit_status == CLI_DONE) {
        cli_stop_gently();
        cli_progress_forecast("opening the scene", 0, 0, study->within_ms);
        exit_status = cost_open(study);
        if (exit_status == CLI_DONE) exit_status = cost_measure_sensitivity(study);
        study->begun_ms =
            cli_now_ms(); /* opening takes the time that every image takes once; sensitivities take their own */
        if (exit_status == CLI_DONE) exit_status = measure(study);
        cli_progress_end();
        if (exit_status == CLI_DONE) exit_status = write_outputs(study);
        if (exit_status == CLI_DONE) exit_status = report(study);
        cost_close(study);
    }
    free(study);
    return exit_status;
}
