/* Manual of a verb's command line: one table for the parser, `help`, the man pages and the completion of shells. A paragraph is one string
 * without line breaks; the functions that print it break the lines. */
#ifndef CLI_MANUAL_MANUAL_H
#define CLI_MANUAL_MANUAL_H

#include <stddef.h>
#include <stdio.h>

/* Kinds of names that a value or an operand has, for completion. CLI_NAMES_OUTPUT: a file that is written, by another flag than -o;
 * CLI_NAMES_KEY: a key of a scene file, with its =. */
enum {
    CLI_NAMES_NOTHING,
    CLI_NAMES_FILE,
    CLI_NAMES_FOLDER,
    CLI_NAMES_SCENE,
    CLI_NAMES_OUTPUT,
    CLI_NAMES_KEY
};

/* A name or a number and what it means. Lists end with a row whose name is NULL. */
typedef struct {
    const char *name, *meaning;
} cli_item;

typedef struct {
    const char *name;       /* "--name" or "-o" */
    const char *argument;   /* what the help calls the value; NULL: its values, or without them, no value */
    const char *meaning;    /* one paragraph */
    const cli_item *values; /* the only values, which the parser numbers from 0; NULL: any */
    int names;              /* CLI_NAMES_... */
} cli_flag;

typedef struct {
    const char *name;
    const char *operands;         /* as the usage line shows them */
    const char *required;         /* flags that the usage line shows outside of [FLAGS]; NULL: none */
    const char *summary;          /* begins in lower case, no full stop */
    const char *const *text;      /* paragraphs, ends with NULL */
    int least, most;              /* number of operands; most < 0: no limit */
    int names;                    /* CLI_NAMES_... of the operands */
    const cli_flag *const *flags; /* ends with NULL */
    const cli_item *files;        /* what it writes; NULL: nothing but standard output */
    const cli_item *examples;     /* command line and what it does */
    const char *check;            /* the check that exit status 1 stands for; NULL: none */
    int has_device;               /* it opens an OpenCL device */
    int checks_outputs;           /* it refuses outputs that are not its own itself */
} cli_manual;

/* Whether the value of a flag is a file that is written. */
int cli_flag_is_output(const cli_flag *flag);

/* Whether a value follows the flag, and what the help calls it: "FILE", "single|double|half". */
int cli_flag_has_value(const cli_flag *flag);
void cli_flag_argument(const cli_flag *flag, char *text, size_t size);

extern const cli_manual cli_manual_beam, cli_manual_breathe, cli_manual_cost, cli_manual_devices,
    cli_manual_distance, cli_manual_dose, cli_manual_fit, cli_manual_image, cli_manual_lbuffer,
    cli_manual_live, cli_manual_material, cli_manual_make, cli_manual_mesh, cli_manual_plan,
    cli_manual_reconstruct, cli_manual_parts, cli_manual_register, cli_manual_scan, cli_manual_schema,
    cli_manual_thorax, cli_manual_view;

extern const cli_flag cli_flag_help; /* of every verb */

/* Flags that several verbs take. Those of one verb are static in its manual, and elsewhere have their names. */
extern const cli_flag cli_flag_device, cli_flag_precision, cli_flag_tolerance, cli_flag_strategy,
    cli_flag_set, cli_flag_lenient, cli_flag_strict, cli_flag_quiet, cli_flag_verbose, cli_flag_json,
    cli_flag_output, cli_flag_plot, cli_flag_repeat, cli_flag_range, cli_flag_mesh_unit,
    cli_flag_image_quantity, cli_flag_breathe_fps, cli_flag_register_quantity, cli_flag_register_flat;

/* Flags of verbs that take meshes instead of a scene. */
extern const cli_flag cli_flag_meshes_material, cli_flag_meshes_kvp, cli_flag_meshes_kev,
    cli_flag_meshes_filter, cli_flag_meshes_from;
extern const char cli_text_meshes[]; /* a paragraph on them */

/* Every verb, and what is known of the command as a whole. */

/* Every verb, in the order of `skiagraph help`; ends with NULL. */
extern const cli_manual *const cli_manuals[];

extern const char cli_summary[];           /* of the command, one sentence */
extern const char *const cli_text[];       /* of the command, paragraphs; ends with NULL */
extern const cli_item cli_other_verbs[];   /* help and version, which are no rows of cli_manuals */
extern const cli_item cli_exit_statuses[]; /* of every verb */
extern const cli_item cli_environment[];   /* variables that the command or its platform reads */

/* The help texts on a terminal. */

void cli_help_overview(FILE *stream);
void cli_help_verb(const cli_manual *manual, FILE *stream);

#endif
