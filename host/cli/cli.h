/* What every verb of the command shares. A new verb is one file that defines a cli_verb, and one line in
 * main.c's table. */
#ifndef SKG_CLI_H
#define SKG_CLI_H

#include <skiagraph/skiagraph.h>

#include <jansson.h>

/* Exit statuses. */
enum { CLI_DONE = 0, CLI_CHECK_FAILED = 1, CLI_USAGE = 2, CLI_INPUT = 3, CLI_DEVICE = 4, CLI_OUTPUT = 5 };

/* A flag: "--name" or "-n". value: what follows it, as the help calls it; NULL: nothing does. */
typedef struct {
    const char *name, *value, *help;
} cli_flag;

/* Flags that several verbs take. */
extern const cli_flag cli_flag_device, cli_flag_precision, cli_flag_tolerance, cli_flag_strategy,
    cli_flag_set, cli_flag_quiet, cli_flag_json, cli_flag_output, cli_flag_repeat, cli_flag_range;

struct cli_arguments;

typedef struct {
    const char *name, *operands, *summary; /* as the help shows them */
    const char *text;                      /* the help's paragraphs */
    int least, most;                       /* operands; most < 0: as many as given */
    const cli_flag *const *flags;          /* ends with NULL */
    int (*run)(const struct cli_arguments *arguments);
} cli_verb;

extern const cli_verb cli_beam, cli_cost, cli_devices, cli_image, cli_lbuffer, cli_material, cli_mesh,
    cli_plan;
extern const cli_verb cli_thorax, cli_breathe;

/* A parsed command line; texts are the program's arguments themselves. */
typedef struct cli_arguments {
    const cli_verb *verb;
    const char **operands;
    int operand_count, help;
    struct cli_given {
        const cli_flag *flag;
        const char *value;
    } * given;
    int given_count;
} cli_arguments;

/* --- say.c: one sentence on standard error ------------------------------------------------------------- */

/* "skiagraph: sentence"; returns the exit status. */
int cli_error(int exit_status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The library's last sentence, with the exit status that fits. */
int cli_fail(skg_status status);

/* The exit status for a failure of the library. */
int cli_exit_status(skg_status status);

/* "skiagraph: warning: sentence", unless --quiet. */
void cli_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Receives the library's warnings and notes. */
void cli_log(int32_t level, const char *sentence, void *user);

/* On a terminal, from the first second on: "12 of 200 frames, 3.4 per second, 55 s left". start_ms: of
 * cli_now_ms. The line goes away when done == total. */
void cli_progress(const char *things, int64_t done, int64_t total, double start_ms);

/* Milliseconds of a clock that only goes forward. */
double cli_now_ms(void);

void cli_set_quiet(int quiet);
int cli_is_quiet(void);

/* --- json.c: one object on standard output ------------------------------------------------------------- */

/* null where the number is not finite; text that is not UTF-8 gets question marks. */
json_t *cli_json_number(double number);
json_t *cli_json_text(const char *text);
json_t *cli_json_numbers(const double *numbers, int count);

/* Prints and releases an object. */
int cli_json_print(json_t *object);

/* --- environment.c -------------------------------------------------------------------------------------- */

/* Sets up what PoCL reads from the environment; to be called before the first call that meets OpenCL. */
void cli_prepare_environment(void);

/* Why POCL_AFFINITY is set or not. */
const char *cli_affinity_reason(void);

/* Warns when the device's kernels cannot be kept. */
void cli_warn_of_cache(const skg_device_info *device);

#endif
