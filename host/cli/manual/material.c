/* The manual of `material`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag material_energy = {
    "--energy", "KEV[:KEV[:STEP]]",
    "One energy in keV, or a range with a step, which is 1 keV unless given. The default is ten energies from 10 to "
    "150 keV.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag material_density = {"--density", "G_CM3", "The density, g/cm3, instead of the table's.",
                                          NULL, CLI_NAMES_NOTHING};
static const cli_flag material_list = {
    "--list", NULL, "Prints the names and densities of the tables instead.", NULL, CLI_NAMES_NOTHING};

static const cli_item interpolations[] = {
    {"bilinear", "straight lines"}, {"bilogarithmic", "straight lines between logarithms"}, {NULL, NULL}};
static const cli_flag material_naive = {
    "--naive", NULL,
    "For HU:... also prints mu interpolated between water, soft tissue and bone by Hounsfield number (Eq. 13 of "
    "Vidal and Villard 2016), to show its error.",
    interpolations, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Prints at each energy the mass attenuation coefficient mu/rho (cm2/g), coherent scattering included, in total "
    "and by process; the linear attenuation coefficient mu (1/cm); and the Hounsfield number. The cross sections "
    "are NIST XCOM's, from 1 keV to 20 MeV; they are warranted from 5 keV.",
    "NAME is an element (Fe), a formula by atoms (H2O), a formula by mass (weight:Ti90Al6V4), a Hounsfield number "
    "(HU:52, tissue after Schneider 2000), a linear attenuation coefficient in 1/cm (mu:0.2), or a name of the "
    "tables (\"soft tissue icru44\"; see --list).",
    "-o plots mu/rho and its processes against energy, both on logarithmic axes.",
    "--json prints {name, density_g_cm3, note, rows: [{energy_keV, mu_rho_cm2_g, mu_per_cm, hu, ...}]}; a value "
    "that is not known is null.",
    NULL};

static const cli_flag *const flags[] = {&material_energy, &material_density, &cli_flag_plot,
                                        &material_naive,  &material_list,    &cli_flag_json,
                                        &cli_flag_strict, &cli_flag_quiet,   NULL};

static const cli_item examples[] = {
    {"skiagraph material H2O --energy 60", "prints the coefficients of water at 60 keV"},
    {"skiagraph material I --energy 10:100 -o iodine.svg", "plots iodine with its K edge"},
    {"skiagraph material --list", "lists the tabled materials"},
    {NULL, NULL}};

const cli_manual cli_manual_material = {.name = "material",
                                        .operands = "NAME",
                                        .summary = "attenuation coefficients of a material",
                                        .text = text,
                                        .most = 1,
                                        .flags = flags,
                                        .examples = examples};
