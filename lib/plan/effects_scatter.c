/* The effect of scattered photons. */
#include "beam/spectrum.h"
#include "core/maths.h"
#include "material/material.h"
#include "material/scattering.h"
#include "material/shells.h"
#include "plan/decisions.h"
#include "plan/rules.h"
#include "spectral/model.h"

#include <inttypes.h>
#include <math.h>

/* Share of the beam that the world may scatter: 2 % in a metre of air, of which a seventh arrives on 40 cm of detector behind it. */
static const double WORLD_SCATTERS = 0.2;

enum { PLACES_MAX = 256 };
#define HISTORIES_MAX ((int64_t)1 << 30)

void skg_scatter_init_sized(void *scatter, int32_t size) {
    const skg_scatter defaults = {.tolerance = 0.01};
    skg_struct_init(scatter, size, &defaults, sizeof defaults);
}

static skg_status check_numbers(const skg_scatter *s) {
    if (!(s->tolerance >= 0 && s->tolerance < 1))
        return skg_fail(SKG_ERR_ARGUMENT, "scatter: a tolerance of %g; a share of its mean from 0 to below 1",
                        s->tolerance);
    if (s->histories < 0 || s->histories > HISTORIES_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "scatter: %" PRId64 " histories; 0 to %" PRId64, s->histories,
                        HISTORIES_MAX);
    if (s->tolerance == 0 && s->histories == 0)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "scatter: neither a tolerance nor histories are given; give one of them");
    if (!(s->voxel_mm >= 0 && isfinite(s->voxel_mm)))
        return skg_fail(SKG_ERR_ARGUMENT, "scatter: cells of %g mm; above 0, or 0 for 64 along each side",
                        s->voxel_mm);
    if (s->fluorescence < SKG_FLUORESCENCE_AUTO || s->fluorescence > SKG_FLUORESCENCE_OFF)
        return skg_fail(SKG_ERR_ARGUMENT, "scatter: there is no fluorescence %d", (int)s->fluorescence);
    if (s->columns < 0 || s->columns > PLACES_MAX || s->rows < 0 || s->rows > PLACES_MAX)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "scatter: %" PRId64 " x %" PRId64 " places of the detector; 0 to %d along each side",
                        s->columns, s->rows, PLACES_MAX);
    return SKG_OK;
}

static skg_status copy_scatter(skg_recipe *recipe) {
    const skg_scatter **scatter = &recipe->options.scatter;
    if (!*scatter) return SKG_OK;
    SKG_TRY(skg_copies_struct(&recipe->copies, *scatter, "skg_scatter", sizeof **scatter,
                              skg_scatter_init_sized, scatter));
    return check_numbers(*scatter);
}

static int refuses_half(const skg_recipe *recipe) {
    return recipe->options.scatter != NULL;
}

skg_material *skg_scatter_world(const skg_recipe *recipe) {
    return recipe->options.world_scatter_off ? NULL : recipe->options.world;
}

/* The world scatters in the box around source, parts and detector, and what comes back into it is left out: it has to be little. */
static skg_status check_world(const skg_recipe *recipe) {
    const skg_spectrum *spectrum = recipe->spectrum;
    const char *name = "";
    double way[3], signals = 0, met = 0;
    skg_material *world = skg_scatter_world(recipe);
    if (!world) return SKG_OK;
    SKG_TRY(skg_material_name_get(world, &name));
    if (recipe->view.projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "scatter: a parallel beam from infinity never comes through a World of %s; give the place where "
            "it begins, or leave out the World",
            name);
    skg_add_scaled(recipe->view.centre, -1, recipe->view.source, way);
    for (int64_t i = 0; i < spectrum->count; i++) {
        skg_coefficients c;
        double per_cm = 0, signal = 0;
        if (!(spectrum->photons[i] > 0)) continue;
        skg_coefficients_init(&c);
        SKG_TRY(skg_material_attenuation_get(world, spectrum->energy_kev[i], &per_cm));
        SKG_TRY(skg_material_coefficients_get(world, spectrum->energy_kev[i], &c));
        SKG_TRY(skg_signal_get(&recipe->options, spectrum->energy_kev[i], &signal));
        signal *= spectrum->photons[i];
        signals += signal;
        met += signal * -expm1(-per_cm * (c.compton + c.rayleigh) / c.total / 10 * skg_length(way));
    }
    if (!(met > WORLD_SCATTERS * signals)) return SKG_OK;
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "scatter: a World of %s scatters %.3g %% of the beam between source and detector, which is followed in "
        "the box around source, parts and detector alone, and may do so up to %g %%; make it a part that holds the "
        "others, or set WorldScatter to false (skg_plan_options.world_scatter_off)",
        name, 100 * met / signals, 100 * WORLD_SCATTERS);
}

skg_status skg_scatter_check(const skg_recipe *recipe) {
    const skg_scene *scene = recipe->scene;
    if (!recipe->options.scatter) return SKG_OK;
    for (int64_t i = 0; i < scene->count; i++) {
        const skg_status status = skg_scattering_check(scene->parts[i].material);
        if (status != SKG_OK)
            return skg_fail(status, "scatter: %s: %s", scene->parts[i].label, skg_last_error());
        if (!scene->parts[i].mesh->closed)
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "scatter: %s: its mesh is not closed, so what lies inside is not known; close it, or leave out "
                "the scatter",
                scene->parts[i].label);
    }
    if (skg_scatter_world(recipe) && skg_scattering_check(skg_scatter_world(recipe)) != SKG_OK)
        return skg_fail(SKG_ERR_MATERIAL, "scatter: World: %s", skg_last_error());
    return check_world(recipe);
}

static void find_scatter(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_scatter *s = f->recipe->options.scatter;
    if (!s)
        skg_effect_set(state, 0, "not asked for: directly transmitted photons only");
    else if (s->histories)
        skg_effect_set(state, 1, "asked for: %" PRId64 " histories, once for each scene and view",
                       s->histories);
    else
        skg_effect_set(state, 1, "asked for: to %g %% of its mean, once for each scene and view",
                       100 * s->tolerance);
}

static skg_status refuse_scatter(const char *call, const skg_recipe *recipe, int by_view) {
    (void)by_view;
    return recipe->options.scatter ? skg_effect_no_gradient(call, "scatter", "make the plan without it")
                                   : SKG_OK;
}

static void leave_out_scatter(skg_plan_options *options) {
    options->scatter = NULL;
}

const skg_effect_row skg_effect_scatter = {
    .name = "scatter",
    .key = "Scatter",
    .self_test = SKG_SELF_TEST_SCATTER,
    .copy = copy_scatter,
    .refuses_half = refuses_half,
    .refuses_gradient = refuse_scatter,
    .leave_out = leave_out_scatter,
    .predicted = 1,
    .find = find_scatter,
};

/* --- fluorescence of the parts */

static int32_t fluorescence_of(const skg_recipe *recipe) {
    return recipe->options.scatter ? recipe->options.scatter->fluorescence : SKG_FLUORESCENCE_AUTO;
}

static double highest_of(const skg_spectrum *spectrum) {
    double high = 0;
    for (int64_t i = 0; i < spectrum->count; i++)
        if (spectrum->photons[i] > 0) high = fmax(high, spectrum->energy_kev[i]);
    return high;
}

/* The heaviest element of the parts whose K or L edge is in the beam; 0: none. */
static int32_t find_emitter(const skg_recipe *recipe, skg_shell *shell) {
    const int32_t lightest = fluorescence_of(recipe) == SKG_FLUORESCENCE_ON ? 1 : SKG_FLUORESCENCE_LIGHTEST;
    const double high = highest_of(recipe->spectrum);
    int32_t found = 0;
    for (int64_t p = 0; p < recipe->scene->count; p++) {
        const skg_material *material = recipe->scene->parts[p].material;
        for (int64_t i = 0; material->kind == SKG_MATTER_COMPOSITION && i < material->count; i++)
            for (int32_t kind = 0; kind < SKG_SHELLS; kind++) {
                const int32_t z = material->parts[i].z;
                skg_shell own;
                if (z < lightest || z <= found || !skg_shell_find(z, kind, &own) || !(own.edge_kev[0] < high))
                    continue;
                found = z;
                *shell = own;
            }
    }
    return found;
}

static void find_fluorescence(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_recipe *recipe = f->recipe;
    skg_shell shell;
    const int32_t z = find_emitter(recipe, &shell);
    if (!z)
        skg_effect_set(state, 0, "no part has an element from Z = %d on with an edge in the beam",
                       SKG_FLUORESCENCE_LIGHTEST);
    else if (!recipe->options.scatter)
        skg_effect_set(state, 0, "comes with scatter, which is not asked for; %s emits %c lines",
                       skg_elements[z].symbol, shell.kind == SKG_SHELL_K ? 'K' : 'L');
    else if (fluorescence_of(recipe) == SKG_FLUORESCENCE_OFF)
        skg_effect_set(state, 0, "switched off; %s would emit %c lines", skg_elements[z].symbol,
                       shell.kind == SKG_SHELL_K ? 'K' : 'L');
    else
        skg_effect_set(state, 1, "%s emits %c lines after photo absorption from %.3g keV on",
                       skg_elements[z].symbol, shell.kind == SKG_SHELL_K ? 'K' : 'L', shell.edge_kev[0]);
}

const skg_effect_row skg_effect_fluorescence = {
    .name = "fluorescence",
    .key = "Fluorescence",
    .self_test = SKG_SELF_TEST_SCATTER,
    .refuses_gradient = refuse_scatter,
    .find = find_fluorescence,
};

/* --- annihilation after pair production */

static void find_annihilation(const skg_effect_facts *f, skg_effect_state *state) {
    const double high = highest_of(f->recipe->spectrum);
    if (!(high > SKG_PAIR_THRESHOLD_KEV))
        skg_effect_set(state, 0, "no photon has the %.4g keV of a pair", SKG_PAIR_THRESHOLD_KEV);
    else if (!f->recipe->options.scatter)
        skg_effect_set(state, 0,
                       "comes with scatter, which is not asked for; photons up to %.5g keV make pairs", high);
    else
        skg_effect_set(
            state, 1,
            "two photons of 511 keV for each pair that photons up to %.5g keV make; bremsstrahlung of the "
            "electrons is left out",
            high);
}

const skg_effect_row skg_effect_annihilation = {
    .name = "annihilation",
    .self_test = SKG_SELF_TEST_SCATTER,
    .refuses_gradient = refuse_scatter,
    .find = find_annihilation,
};

/* --- the order of molecules in Rayleigh scattering */

static void find_molecules(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_scene *scene = f->recipe->scene;
    int64_t bound = 0;
    for (int64_t i = 0; i < scene->count; i++) bound += scene->parts[i].material->momentum_count > 0;
    if (bound == 0)
        skg_effect_set(state, 0,
                       "no part has form factors of its molecules: atoms scatter as if they were free");
    else if (!f->recipe->options.scatter)
        skg_effect_set(state, 0, "comes with scatter, which is not asked for");
    else
        skg_effect_set(state, 1, "%" PRId64 " of %" PRId64 " parts have form factors of their molecules",
                       bound, scene->count);
}

const skg_effect_row skg_effect_molecules = {
    .name = "molecules",
    .key = "FormFactor",
    .self_test = SKG_SELF_TEST_SCATTER,
    .refuses_gradient = refuse_scatter,
    .find = find_molecules,
};
