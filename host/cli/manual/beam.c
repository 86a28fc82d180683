/* The manual of `beam`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag beam_kvp = {
    "--kvp", "KV", "The tube voltage, 10 to 450 kV; validated from 20 to 300 kV (Mo, Rh: to 49 kV).", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag beam_filter = {
    "--filter", "MATERIAL:MM",
    "A filter of the beam with its thickness in mm, or in another unit that follows: Al:2.5, Cu:100um. May be repeated. Give every filter, the inherent one included: "
    "none is assumed.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag beam_angle = {
    "--angle", "DEGREES", "The angle between the anode's face and the central ray. The default is 12.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag beam_anode = {"--anode", "ELEMENT", "The anode's element. The default is W.", NULL,
                                    CLI_NAMES_NOTHING};

/* In the order of SKG_TUBE_MODEL_. */
static const cli_item models[] = {
    {"ebel", "Ebel 1999 (the default)"}, {"birch", "Birch and Marshall 1979"}, {NULL, NULL}};
static const cli_flag beam_model = {"--model", NULL, "The model of the tube.", models, CLI_NAMES_NOTHING};

static const cli_flag beam_bin = {"--bin", "KEV", "The width of an energy bin. The default is 1.", NULL,
                                  CLI_NAMES_NOTHING};
static const cli_flag beam_mas = {"--mas", "MAS", "The tube load in mAs. The default is 1.", NULL,
                                  CLI_NAMES_NOTHING};
static const cli_flag beam_distance = {"--distance", "MM",
                                       "The distance from the focal spot in mm. The default is 1000.", NULL,
                                       CLI_NAMES_NOTHING};
static const cli_flag beam_output = {
    "--output", "OUTPUT@DISTANCE",
    "The air kerma measured behind the filters, as 65uGy/mAs@100cm, which replaces the model's.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag beam_file = {
    "--file", "FILE",
    "Reads a spectrum instead of computing a tube's: two columns, energy and photons, or a GATE macro.", NULL,
    CLI_NAMES_FILE};

static const cli_item units[] = {
    {"eV", "electronvolt"}, {"keV", "1000 eV (the default)"}, {"MeV", "1000 keV"}, {NULL, NULL}};
static const cli_flag beam_unit = {"--unit", NULL, "The unit of the file's energies.", units,
                                   CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Computes the spectrum of a tube behind its filters by the model of Ebel 1999 or of Birch and Marshall 1979; "
    "output and lines are calibrated to SpekPy 2.5: tungsten from 20 to 300 kV (up to 150 kV half-value layers agree with measured ones, too), "
    "molybdenum and rhodium from 20 to 49 kV. Of tungsten from there to 400 kV spectra change as another computation says (xpecgen), and beyond nothing is verified; a warning says so. Prints the mean energy, the half-value layers of air kerma, the "
    "homogeneity and the output. Give --kvp, or --file for a spectrum that is known.",
    "Bins hold photons per mm2, for the load --mas at --distance.",
    "--json prints {mean_energy_keV, hvl1_mm_al, hvl2_mm_al, hvl1_mm_cu, hvl2_mm_cu, homogeneity, "
    "air_kerma_uGy_per_mAs_1m, photons_per_mm2_mAs_1m, bins: [[keV, photons]]}; a value that a file does not state is "
    "null.",
    NULL};

static const cli_flag *const flags[] = {&beam_kvp,      &beam_filter,     &beam_angle,     &beam_anode,
                                        &beam_model,    &beam_bin,        &beam_mas,       &beam_distance,
                                        &beam_output,   &beam_file,       &beam_unit,      &cli_flag_plot,
                                        &cli_flag_json, &cli_flag_strict, &cli_flag_quiet, NULL};

static const cli_item examples[] = {
    {"skiagraph beam --kvp 90 --filter Al:2.5 --filter Cu:0.1", "prints the quality of a filtered beam"},
    {"skiagraph beam --file spectrum.txt -o spectrum.svg", "plots a spectrum that was measured"},
    {NULL, NULL}};

const cli_manual cli_manual_beam = {.name = "beam",
                                    .operands = "",
                                    .summary = "the spectrum of a tube, or of a file, and its quality",
                                    .text = text,
                                    .flags = flags,
                                    .examples = examples};
