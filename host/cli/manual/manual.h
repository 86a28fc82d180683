/* What is known of a verb's command line: one table for the parser, `help`, the man pages and the completion
 * of shells. A paragraph is one string without line breaks; who prints it breaks the lines. */
#ifndef CLI_MANUAL_MANUAL_H
#define CLI_MANUAL_MANUAL_H

#include <stddef.h>
#include <stdio.h>

/* What a value or an operand names, for completion. CLI_NAMES_OUTPUT: a file that is written, by another flag than -o;
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

/* Flags that several verbs take. */
extern const cli_flag cli_flag_device, cli_flag_precision, cli_flag_tolerance, cli_flag_strategy,
    cli_flag_set, cli_flag_lenient, cli_flag_quiet, cli_flag_verbose, cli_flag_json, cli_flag_output,
    cli_flag_plot, cli_flag_repeat, cli_flag_range;

/* Flags of verbs that take meshes instead of a scene. */
extern const cli_flag cli_flag_meshes_material, cli_flag_meshes_kvp, cli_flag_meshes_kev,
    cli_flag_meshes_filter, cli_flag_meshes_from;
extern const char cli_text_meshes[]; /* a paragraph on them */

/* Flags of one verb. */
extern const cli_flag cli_flag_image_quantity, cli_flag_image_display, cli_flag_image_bands,
    cli_flag_image_only, cli_flag_image_without, cli_flag_image_band_weight, cli_flag_image_scatter,
    cli_flag_image_scatter_image, cli_flag_image_scatter_sigma, cli_flag_image_mean, cli_flag_image_variance;
extern const cli_flag cli_flag_parts_output;
extern const cli_flag cli_flag_dose_at, cli_flag_dose_histories, cli_flag_dose_seed;
extern const cli_flag cli_flag_lbuffer_part, cli_flag_lbuffer_surface;
extern const cli_flag cli_flag_cost_output, cli_flag_cost_quick, cli_flag_cost_within, cli_flag_cost_frames,
    cli_flag_cost_sensitivity;
extern const cli_flag cli_flag_devices_test, cli_flag_devices_warm;
extern const cli_flag cli_flag_mesh_unit, cli_flag_mesh_fix, cli_flag_mesh_output, cli_flag_mesh_groups,
    cli_flag_mesh_group, cli_flag_mesh_split, cli_flag_mesh_scene;
extern const cli_flag cli_flag_distance_map, cli_flag_distance_output, cli_flag_distance_high,
    cli_flag_distance_sampling, cli_flag_distance_spacing;
extern const cli_flag cli_flag_fit_target, cli_flag_fit_phase, cli_flag_fit_output, cli_flag_fit_parameters,
    cli_flag_fit_bounds, cli_flag_fit_evaluations, cli_flag_fit_seed, cli_flag_fit_method,
    cli_flag_fit_checkpoint;
extern const cli_flag cli_flag_register_image, cli_flag_register_part, cli_flag_register_output,
    cli_flag_register_report, cli_flag_register_free, cli_flag_register_loss, cli_flag_register_polish,
    cli_flag_register_start, cli_flag_register_mask, cli_flag_register_quantity, cli_flag_register_flat,
    cli_flag_register_restarts, cli_flag_register_seed, cli_flag_register_spread, cli_flag_register_margin,
    cli_flag_register_need;
extern const cli_flag cli_flag_material_energy, cli_flag_material_density, cli_flag_material_list,
    cli_flag_material_naive;
extern const cli_flag cli_flag_beam_kvp, cli_flag_beam_filter, cli_flag_beam_angle, cli_flag_beam_anode,
    cli_flag_beam_model, cli_flag_beam_bin, cli_flag_beam_mas, cli_flag_beam_distance, cli_flag_beam_output,
    cli_flag_beam_file, cli_flag_beam_unit;
extern const cli_flag cli_flag_make_output, cli_flag_make_box, cli_flag_make_radius, cli_flag_make_fraction,
    cli_flag_make_count, cli_flag_make_spread, cli_flag_make_gap, cli_flag_make_tilt, cli_flag_make_seed,
    cli_flag_make_segments, cli_flag_make_period, cli_flag_make_level, cli_flag_make_cells,
    cli_flag_make_per_mm, cli_flag_make_bars, cli_flag_make_length, cli_flag_make_width,
    cli_flag_make_thickness, cli_flag_make_heights, cli_flag_make_inner, cli_flag_make_spokes;
extern const cli_flag cli_flag_thorax_output, cli_flag_thorax_triangles, cli_flag_thorax_simple;
extern const cli_flag cli_flag_breathe_output, cli_flag_breathe_seconds, cli_flag_breathe_fps,
    cli_flag_breathe_phase, cli_flag_breathe_at, cli_flag_breathe_outline, cli_flag_breathe_meshes;
extern const cli_flag cli_flag_view_output, cli_flag_view_from, cli_flag_view_size,
    cli_flag_view_orthographic, cli_flag_view_phase, cli_flag_view_at, cli_flag_view_seconds,
    cli_flag_view_sensitivity, cli_flag_view_zoom;
extern const cli_flag cli_flag_live_port, cli_flag_live_no_open, cli_flag_live_bind, cli_flag_live_idle,
    cli_flag_live_fixed;
extern const cli_flag cli_flag_schema_output, cli_flag_schema_paths;
extern const cli_flag cli_flag_reconstruct_output, cli_flag_reconstruct_size, cli_flag_reconstruct_voxel,
    cli_flag_reconstruct_filter, cli_flag_reconstruct_truncation, cli_flag_reconstruct_geometry;
extern const cli_flag cli_flag_scan_output, cli_flag_scan_from, cli_flag_scan_to, cli_flag_scan_only,
    cli_flag_scan_overwrite, cli_flag_scan_breathing, cli_flag_scan_subframes, cli_flag_scan_geometry,
    cli_flag_scan_flats, cli_flag_scan_darks, cli_flag_scan_shard, cli_flag_scan_join, cli_flag_scan_mixed,
    cli_flag_scan_grey16, cli_flag_scan_packed, cli_flag_scan_packed_grey16, cli_flag_scan_phases,
    cli_flag_scan_dicom, cli_flag_scan_verify, cli_flag_strict;

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
