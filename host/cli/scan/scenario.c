/* Writes the scene as a CTSimU scenario, and says what of it a scenario does not hold. */
#include "scan/steps.h"

#include "common/file.h"
#include "common/say.h"

#include <stdio.h>
#include <string.h>

enum { LIST_LENGTH = 1024 };

/* Effects that a scenario has, too, or that are ways of computing the same image. */
static const char *const held[] = {"several energies", "extended source", "spectral compression", "falloff",
                                   "world material",   "nesting",         "leaky meshes",         "repair",
                                   "source plane",     "overlap check"};

int scenario_is(const char *path) {
    return cli_has_extension(path, ".ctsimu.json");
}

static int is_held(const char *effect) {
    for (size_t i = 0; i < sizeof held / sizeof *held; i++)
        if (strcmp(effect, held[i]) == 0) return 1;
    return 0;
}

/* Names the effects of the plan that the scenario has not. */
static void note_losses(const cli_acquisition *a, const char *path) {
    char list[LIST_LENGTH] = "";
    size_t used = 0;
    int64_t count = 0;
    int falls = 0;
    skg_plan_effect_count(a->plan, &count);
    for (int64_t i = 0; i < count; i++) {
        skg_effect effect;
        skg_effect_init(&effect);
        if (skg_plan_effect_get(a->plan, i, &effect) != SKG_OK || !effect.on) continue;
        falls |= strcmp(effect.name, "falloff") == 0;
        if (is_held(effect.name) || used >= sizeof list) continue;
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", used > 0 ? ", " : "", effect.name);
    }
    if (a->is_grey && used < sizeof list)
        used += (size_t)snprintf(list + used, sizeof list - used, "%sgrey values", used > 0 ? ", " : "");
    if (a->motion && used < sizeof list)
        used += (size_t)snprintf(list + used, sizeof list - used, "%sbreathing", used > 0 ? ", " : "");
    if (used > 0)
        cli_warn("%s: the scenario does not have %s: its images differ from those of the scene", path, list);
    if (!falls && a->session.view.projection == SKG_PROJECTION_POINT)
        cli_warn(
            "%s: a scenario's beam falls off with distance and obliquity, and the scene's does not (Falloff): its images differ",
            path);
}

int scenario_write(const cli_arguments *arguments, const cli_acquisition *a) {
    const char *path;
    for (int i = 0; a->ranks.rank == 0 && (path = cli_nth_value(arguments, "--geometry", i)); i++) {
        if (!scenario_is(path)) continue;
        const skg_status status = skg_setup_save_scenario(a->session.setup, path);
        if (status == SKG_ERR_UNSUPPORTED) return cli_fail(status), CLI_OUTPUT;
        if (status != SKG_OK) return cli_fail(status);
        note_losses(a, path);
    }
    return CLI_DONE;
}
