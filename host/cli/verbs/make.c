/* The verb make. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LISTED_MAX = 64 };

/* Numbers separated by commas; `numbers` holds the defaults, whose count *count is, and stays if the flag was not given. */
static int read_list(const cli_arguments *arguments, const char *flag, int64_t most, double *numbers,
                     int64_t *count) {
    const char *given = cli_value(arguments, flag);
    if (!given) return CLI_DONE;
    const char *rest = given;
    for (*count = 0; *count < most; rest++) {
        char *end = NULL;
        numbers[(*count)++] = strtod(rest, &end);
        if (end == rest || (*end && *end != ',')) break;
        rest = end;
        if (!*rest) return CLI_DONE;
    }
    return cli_error(CLI_USAGE, "make: %s %s: give 1 to %" PRId64 " numbers, separated by commas", flag,
                     given, most);
}

/* Edges of a box; one number makes a cube. */
static int read_box(const cli_arguments *arguments, double box[3]) {
    int64_t count = 3;
    const int exit_status = read_list(arguments, "--box", 3, box, &count);
    if (exit_status != CLI_DONE) return exit_status;
    if (count == 2)
        return cli_error(CLI_USAGE, "make: --box %s: give X,Y,Z or one edge", cli_value(arguments, "--box"));
    if (count == 1) box[1] = box[2] = box[0];
    return CLI_DONE;
}

static int number(const cli_arguments *arguments, const char *flag, double *value) {
    return cli_number(arguments, flag, 0, 1e9, value);
}

static int whole(const cli_arguments *arguments, const char *flag, int64_t *value) {
    return cli_integer(arguments, flag, 0, INT32_MAX, value);
}

static int make_foam(const cli_arguments *a, skg_mesh **mesh) {
    skg_foam foam;
    skg_foam_init(&foam);
    int exit_status = read_box(a, foam.box);
    if (exit_status == CLI_DONE) exit_status = number(a, "--radius", &foam.radius_mm);
    if (exit_status == CLI_DONE) exit_status = number(a, "--fraction", &foam.fraction);
    if (exit_status == CLI_DONE) exit_status = number(a, "--spread", &foam.spread);
    if (exit_status == CLI_DONE) exit_status = number(a, "--gap", &foam.gap_mm);
    if (exit_status == CLI_DONE) exit_status = whole(a, "--count", &foam.count);
    if (exit_status == CLI_DONE) exit_status = whole(a, "--seed", &foam.seed);
    if (exit_status == CLI_DONE) exit_status = whole(a, "--segments", &foam.segments);
    if (exit_status != CLI_DONE) return exit_status;
    const skg_status status = skg_mesh_create_foam(&foam, mesh);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int make_fibres(const cli_arguments *a, skg_mesh **mesh) {
    skg_fibres fibres;
    skg_fibres_init(&fibres);
    int exit_status = read_box(a, fibres.box);
    if (exit_status == CLI_DONE) exit_status = number(a, "--radius", &fibres.radius_mm);
    if (exit_status == CLI_DONE) exit_status = number(a, "--gap", &fibres.gap_mm);
    if (exit_status == CLI_DONE) exit_status = number(a, "--tilt", &fibres.tilt_deg);
    if (exit_status == CLI_DONE) exit_status = whole(a, "--count", &fibres.count);
    if (exit_status == CLI_DONE) exit_status = whole(a, "--seed", &fibres.seed);
    if (exit_status == CLI_DONE) exit_status = whole(a, "--segments", &fibres.segments);
    if (exit_status != CLI_DONE) return exit_status;
    const skg_status status = skg_mesh_create_fibres(&fibres, mesh);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int make_gyroid(const cli_arguments *a, skg_mesh **mesh) {
    double box[3] = {20, 20, 20}, period = 10, level = 0.3;
    int64_t cells = 0;
    int exit_status = read_box(a, box);
    if (exit_status == CLI_DONE) exit_status = number(a, "--period", &period);
    if (exit_status == CLI_DONE) exit_status = number(a, "--level", &level);
    if (exit_status == CLI_DONE) exit_status = whole(a, "--cells", &cells);
    if (exit_status != CLI_DONE) return exit_status;
    const skg_status status = skg_mesh_create_gyroid(box, period, level, cells, mesh);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int make_lines(const cli_arguments *a, skg_mesh **mesh) {
    double per_mm[LISTED_MAX] = {0.5, 1, 2}, length = 20, thickness = 1;
    int64_t groups = 3, bars = 4;
    int exit_status = read_list(a, "--per-mm", LISTED_MAX, per_mm, &groups);
    if (exit_status == CLI_DONE) exit_status = whole(a, "--bars", &bars);
    if (exit_status == CLI_DONE) exit_status = number(a, "--length", &length);
    if (exit_status == CLI_DONE) exit_status = number(a, "--thickness", &thickness);
    if (exit_status != CLI_DONE) return exit_status;
    const skg_status status = skg_mesh_create_line_pairs(groups, per_mm, bars, length, thickness, mesh);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int make_star(const cli_arguments *a, skg_mesh **mesh) {
    double radius = 20, inner = 1, thickness = 1;
    int64_t spokes = 36;
    int exit_status = number(a, "--radius", &radius);
    if (exit_status == CLI_DONE) exit_status = number(a, "--inner", &inner);
    if (exit_status == CLI_DONE) exit_status = number(a, "--thickness", &thickness);
    if (exit_status == CLI_DONE) exit_status = whole(a, "--spokes", &spokes);
    if (exit_status != CLI_DONE) return exit_status;
    const skg_status status = skg_mesh_create_star(radius, inner, spokes, thickness, mesh);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int make_steps(const cli_arguments *a, skg_mesh **mesh) {
    double heights[LISTED_MAX] = {5, 10, 15, 20, 25}, length = 50, width = 20;
    int64_t steps = 5;
    int exit_status = read_list(a, "--heights", LISTED_MAX, heights, &steps);
    if (exit_status == CLI_DONE) exit_status = number(a, "--length", &length);
    if (exit_status == CLI_DONE) exit_status = number(a, "--width", &width);
    if (exit_status != CLI_DONE) return exit_status;
    const skg_status status = skg_mesh_create_steps(length, width, steps, heights, mesh);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int print(const cli_arguments *arguments, const skg_mesh *mesh, const char *path) {
    skg_mesh_health health;
    skg_mesh_health_init(&health);
    const skg_status status = skg_mesh_health_get(mesh, &health);
    if (status != SKG_OK) return cli_fail(status);
    if (cli_given(arguments, "--json")) {
        json_t *object = json_object();
        json_object_set_new(object, "kind", json_string(arguments->operands[0]));
        json_object_set_new(object, "triangles", json_integer(health.triangles));
        json_object_set_new(object, "vertices", json_integer(health.vertices));
        json_object_set_new(object, "components", json_integer(health.components));
        json_object_set_new(object, "volume_mm3", cli_json_number(health.volume));
        json_object_set_new(object, "bounds", cli_json_numbers(health.bounds, 6));
        json_object_set_new(object, "file", cli_json_text(path));
        return cli_json_print(object);
    }
    if (!cli_is_quiet())
        printf("%" PRId64 " triangles, %" PRId64 " component%s, volume %.6g mm3; wrote %s\n",
               health.triangles, health.components, health.components == 1 ? "" : "s", health.volume, path);
    return CLI_DONE;
}

int cli_make(const cli_arguments *arguments) {
    static const char *const names[] = {"foam", "fibres", "gyroid", "lines", "star", "steps"};
    static int (*const makers[])(const cli_arguments *, skg_mesh **) = {make_foam,  make_fibres, make_gyroid,
                                                                        make_lines, make_star,   make_steps};
    enum { KINDS = sizeof names / sizeof *names };
    const char *kind = arguments->operands[0], *path = cli_value(arguments, "-o");
    skg_mesh *mesh = NULL;
    int k = 0;
    while (k < KINDS && strcmp(kind, names[k]) != 0) k++;
    if (k == KINDS) return cli_unknown("kind of body", kind, names, KINDS, "help make");
    if (!path) return cli_error(CLI_USAGE, "make: no mesh is named; add -o FILE.ply");
    if (!cli_has_extension(path, ".stl") && !cli_has_extension(path, ".ply"))
        return cli_error(CLI_USAGE, "%s: a mesh is written as .ply or .stl", path);
    int exit_status = makers[k](arguments, &mesh);
    if (exit_status == CLI_DONE) {
        const skg_status status = skg_mesh_save(mesh, path);
        exit_status = status == SKG_OK ? print(arguments, mesh, path) : cli_fail(status);
    }
    skg_mesh_release(&mesh);
    return exit_status;
}
