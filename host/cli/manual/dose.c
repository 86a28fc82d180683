/* The manual of `dose`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag dose_at = {
    "--at", "X,Y,Z",
    "A place in mm, in the axes of the world, where air kerma is wanted; several flags give several places. Without it: "
    "where the middle ray of the field enters the first part.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag dose_histories = {
    "--histories", "N",
    "Photons that are followed through the parts; 200000 if it is not given. Four times as many halve the errors. 0: "
    "none, and doses of parts and backscatter factors are not known.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag dose_seed = {
    "--seed", "N", "Of these photons: another seed gives an independent result.", NULL, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Prints what one exposure, or all projections of a Scan together, give to people and things: air kerma free in air with the backscatter factor, the "
    "kerma-area product of the field, air kerma at the detector and its exposure index, the energy and the dose that "
    "stay in each part, and half-value layers of the beam. With noise it says signal and signal-to-noise ratio where the "
    "parts let least through.",
    "The scene has to say how many photons there are: mAs of a tube, or photons of a pixel. The field is that of the "
    "jaws (Collimation), or else the detector's; outside, kerma is 0. Doses and backscatter are from photons that are "
    "followed from surface to surface, whether or not the scene has the key Scatter; with this key the detector's figures "
    "have scatter. Each dose has its standard error. A part that no photon met has the error -.",
    "--json prints {kerma: [{at, air_kerma_uGy, backscatter}], kap_uGy_cm2, detector_air_kerma_uGy, exposure_index, parts: "
    "[{label, dose_uGy, sigma, energy_keV}], hvl1_mm_al, hvl2_mm_al}; sigma is in uGy, and what is not known is null. With "
    "noise there is darkest: {row, column, signal, snr}, too; of a scan projections, and neither exposure_index nor darkest.",
    NULL};

static const cli_flag *const flags[] = {&dose_at,          &dose_histories,    &dose_seed,
                                        &cli_flag_device,  &cli_flag_strategy, &cli_flag_set,
                                        &cli_flag_lenient, &cli_flag_json,     &cli_flag_verbose,
                                        &cli_flag_strict,  &cli_flag_quiet,    NULL};

static const cli_item examples[] = {
    {"skiagraph dose scene.json", "prints the dose of an exposure"},
    {"skiagraph dose scene.json --at 0,-800,0 --at 300,0,0 --json", "air kerma at two places, as JSON"},
    {NULL, NULL}};

const cli_manual cli_manual_dose = {.name = "dose",
                                    .operands = "SCENE",
                                    .summary = "what an exposure gives: kerma, dose of parts, exposure index",
                                    .text = text,
                                    .least = 1,
                                    .most = 1,
                                    .names = CLI_NAMES_SCENE,
                                    .flags = flags,
                                    .examples = examples,
                                    .has_device = 1};
