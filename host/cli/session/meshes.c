/* Meshes instead of a scene file: the scene that the flags describe. */
#include "session/meshes.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"
#include "common/values.h"

#include <skiagraph/skiagraph.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* mm of aluminium in front of a tube if no --filter is given: what IEC 60601-1-3 asks of tubes from 70 kV on. */
static const double DEFAULT_FILTER_MM = 2.5;

static const char *const extensions[] = {".stl", ".ply", ".obj", ".off", ".gltf", ".glb",
                                         ".3ds", ".fbx", ".dae", ".3mf", ".amf",  ".x3d"};

/* Flags that describe meshes, and have no meaning for a scene file. */
static const char *const flags[] = {"--kvp", "--kev", "--filter", "--from", "--unit"};
enum { FLAGS = sizeof flags / sizeof *flags };

int cli_has_meshes(const cli_arguments *arguments) {
    return cli_given(arguments, "--material");
}

int cli_check_operands(const cli_arguments *arguments) {
    const char *first = arguments->operands[0];
    if (cli_has_meshes(arguments)) {
        for (int i = 0; i < arguments->operand_count; i++)
            if (cli_has_extension(arguments->operands[i], ".json"))
                return cli_error(
                    CLI_USAGE,
                    "--material is for meshes, but %s is a scene, whose samples have materials of "
                    "their own",
                    arguments->operands[i]);
        return CLI_DONE;
    }
    for (size_t e = 0; e < sizeof extensions / sizeof *extensions; e++)
        if (cli_has_extension(first, extensions[e]))
            return cli_error(CLI_USAGE,
                             "%s is a mesh, not a scene; add --material NAME and --kvp KV or --kev E, as in "
                             "--material Al --kvp 120",
                             first);
    const int takes_meshes = cli_find_flag(arguments->manual, "--material") != NULL;
    for (int f = 0; f < FLAGS; f++)
        if (takes_meshes && cli_given(arguments, flags[f]))
            return cli_error(CLI_USAGE,
                             "%s describes meshes and goes with --material; a scene file has a key for it",
                             flags[f]);
    if (arguments->operand_count > 1)
        return cli_error(CLI_USAGE, "%s: \"%s\" is one word too many; see `skiagraph help %s`",
                         arguments->manual->name, arguments->operands[1], arguments->manual->name);
    return CLI_DONE;
}

static int read_filters(const cli_arguments *arguments, json_t *list) {
    const char *text;
    char name[256];
    double mm = 0;
    for (int i = 0; (text = cli_nth_value(arguments, "--filter", i)); i++) {
        int exit_status = cli_read_filter(text, name, sizeof name, &mm);
        if (exit_status != CLI_DONE) return exit_status;
        json_array_append_new(list, json_pack("[o,f,s]", cli_json_text(name), mm, "mm"));
    }
    if (json_array_size(list) > 0) return CLI_DONE;
    json_array_append_new(list, json_pack("[s,f,s]", "Al", DEFAULT_FILTER_MM, "mm"));
    cli_note("the beam is filtered by %g mm of aluminium; --filter changes that", DEFAULT_FILTER_MM);
    return CLI_DONE;
}

static int read_beam(const cli_arguments *arguments, json_t *source) {
    double kvp = (double)NAN, kev = (double)NAN;
    int exit_status = cli_number(arguments, "--kvp", 10, 450, &kvp);
    if (exit_status == CLI_DONE) exit_status = cli_number(arguments, "--kev", 1, 20000, &kev);
    if (exit_status != CLI_DONE) return exit_status;
    if (isnan(kvp) == isnan(kev)) {
        const int is_lengths = arguments->manual == &cli_manual_lbuffer;
        if (!isnan(kvp) || !is_lengths)
            return cli_error(CLI_USAGE,
                             "%s: give the beam as either --kvp KV (a tube) or --kev E (one energy)",
                             arguments->manual->name);
        kev = 60; /* path lengths do not depend on it */
    }
    if (!isnan(kev)) {
        if (cli_given(arguments, "--filter"))
            return cli_error(CLI_USAGE, "--filter belongs to a tube; give --kvp instead of --kev");
        json_object_set_new(source, "Beam",
                            json_pack("[{s:f,s:s,s:i}]", "Energy", kev, "Unit", "keV", "PhotonCount", 1000));
        return CLI_DONE;
    }
    json_t *filters = json_array();
    exit_status = read_filters(arguments, filters);
    json_object_set_new(source, "Beam", json_pack("{s:f,s:o}", "kVp", kvp, "Filter", filters));
    return exit_status;
}

static int read_side(const cli_arguments *arguments, json_t *source) {
    const char *value = cli_value(arguments, "--from"), *at = value;
    if (!value) value = "front";
    if (!strchr(value, ',')) {
        json_object_set_new(source, "From", cli_json_text(value));
        double direction[3];
        int32_t from_detector;
        if (skg_side_get(value, direction, &from_detector) == SKG_OK) return CLI_DONE;
        return cli_error(CLI_USAGE, "--from %s, or a direction X,Y,Z such as 1,-1,0.5", skg_last_error());
    } else {
        double x[3];
        int k = 0;
        for (char *end = NULL; k < 3; k++, at = end + 1) {
            x[k] = strtod(at, &end);
            if (end == at || !isfinite(x[k]) || *end != (k < 2 ? ',' : '\0')) break;
        }
        json_object_set_new(source, "From", cli_json_numbers(x, k));
        if (k == 3 && (x[0] != 0 || x[1] != 0 || x[2] != 0)) return CLI_DONE;
    }
    return cli_error(CLI_USAGE, "--from %s is no direction X,Y,Z such as 1,-1,0.5", value);
}

/* The name of a mesh's file without folder and extension; "name 2" for the second of this name. */
static json_t *label_of(const cli_arguments *arguments, int operand) {
    char label[256];
    int same = 1;
    size_t length = 0;
    const char *name = NULL;
    for (int i = operand; i >= 0; i--) {
        const char *slash = strrchr(arguments->operands[i], '/');
        const char *its = slash ? slash + 1 : arguments->operands[i], *dot = strrchr(its, '.');
        const size_t its_length = dot && dot > its ? (size_t)(dot - its) : strlen(its);
        if (!name) name = its, length = its_length;
        same += i < operand && its_length == length && memcmp(name, its, length) == 0;
    }
    if (same > 1)
        snprintf(label, sizeof label, "%.*s %d", (int)(length < 200 ? length : 200), name, same);
    else
        snprintf(label, sizeof label, "%.*s", (int)(length < 200 ? length : 200), name);
    return cli_json_text(label);
}

/* One material for all meshes, or one for each. */
static int read_samples(const cli_arguments *arguments, json_t *samples) {
    int32_t unit = -1;
    int materials = 0;
    while (cli_nth_value(arguments, "--material", materials)) materials++;
    if (materials != 1 && materials != arguments->operand_count)
        return cli_error(CLI_USAGE,
                         "%d meshes have %d materials; give --material once, or once for each mesh in order",
                         arguments->operand_count, materials);
    int exit_status = cli_choice(arguments, "--unit", &unit);
    for (int i = 0; i < arguments->operand_count && exit_status == CLI_DONE; i++) {
        const char *name = cli_nth_value(arguments, "--material", materials == 1 ? 0 : i);
        skg_material *material = NULL;
        skg_status status = skg_material_create_named(name, &material);
        skg_material_release(&material);
        if (status != SKG_OK) return cli_fail(status);
        json_t *sample =
            json_pack("{s:o,s:o,s:o,s:n}", "Label", label_of(arguments, i), "Path",
                      cli_json_text(arguments->operands[i]), "Material", cli_json_text(name), "Parent");
        if (unit >= 0)
            json_object_set_new(sample, "Unit", cli_json_text(cli_flag_mesh_unit.values[unit].name));
        json_array_append_new(samples, sample);
    }
    return exit_status;
}

int cli_scene_of_meshes(const cli_arguments *arguments, char **text) {
    json_t *source = json_pack("{s:s}", "Shape", "PointSource"), *samples = json_array();
    json_t *scene = json_pack("{s:O,s:O,s:f}", "Source", source, "Samples", samples, "Tolerance", 1e-4);
    *text = NULL;
    int exit_status = scene ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
    if (exit_status == CLI_DONE) exit_status = read_side(arguments, source);
    if (exit_status == CLI_DONE) exit_status = read_samples(arguments, samples);
    if (exit_status == CLI_DONE) exit_status = read_beam(arguments, source);
    if (exit_status == CLI_DONE && !(*text = json_dumps(scene, 0)))
        exit_status = cli_error(CLI_DEVICE, "out of host memory");
    json_decref(scene);
    json_decref(source);
    json_decref(samples);
    return exit_status;
}
