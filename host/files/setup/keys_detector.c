/* Keys of Detector: its place, what it makes of a photon, blur, grid, grey values. */
#include "setup/keys.h"

#define BLUR_KEYS                                                                                            \
    SKG_KEY("LSF", "text | numbers | rows",                                                                  \
            "line spread function: an odd number of samples, one pixel apart; two lists: rows, columns"),    \
        SKG_KEY("PSF", "rows", "point spread function, as rows of samples"),                                 \
        SKG_KEY("MTF", "rows 2", "modulation transfer function: line pairs per mm, and values")

static const skg_json_key detector[] = {
    SKG_KEY("Position", "lengths 3", "[x, y, z, unit] of its centre"),
    SKG_KEY("UpVector", "direction", "direction in which the row number grows; row 0 is on top of a picture"),
    SKG_KEY("RightVector", "direction",
            "direction in which the column number grows; UpVector x (source - detector) by default"),
    SKG_KEY("NumberOfPixels", "pair integer 1..32768", "[columns, rows]"),
    SKG_KEY("Size", "lengths 2", "[width, height, unit] of the detector"),
    SKG_KEY("Spacing", "lengths 2", "[width, height, unit] of a pixel"),
    SKG_KEY("Oversampling", "integer 1..16", "n x n rays for each pixel; 1 by default"),
    SKG_KEY("EnergyResponse", "object EnergyResponse", "mean recorded energy by photon energy"),
    SKG_KEY("Scintillator", "object Scintillator", "a layer that photons interact in"),
    SKG_KEY("Counting", "object Counting", "a sensor that counts photons by thresholds"),
    BLUR_KEYS,
    SKG_KEY("GreyValues", "object GreyValues", "what scan writes instead of energies"),
    SKG_KEY("Grid", "object Grid", "an anti-scatter grid on the detector"),
    SKG_KEY("DQE", "rows 2", "with Noise: detective quantum efficiency by line pairs per mm"),
    SKG_KEY("ColumnStep", "lengths 3", "[x, y, z, unit] from one column to the next"),
    SKG_KEY("RowStep", "lengths 3", "[x, y, z, unit] from one row to the next"),
    SKG_KEY("Curved", "object Curved", "columns at equal angles on a cylinder; flat by default"),
    SKG_KEY("Binning", "pair integer 1..16", "[columns, rows] of sensor pixels that are summed into one"),
    SKG_KEY("BinningNoise", "words each, once",
            "electronic noise of every sensor pixel, the default, or of every bin"),
};
SKG_TABLE(skg_keys_detector, "Detector", detector);

static const skg_json_key curved[] = {
    SKG_KEY("Radius", "length", "of the cylinder, whose axis lies towards the source"),
    SKG_KEY("Axis", "words columns", "columns are parallel to the axis"),
};
SKG_TABLE(skg_keys_curved, "Curved", curved);

static const skg_json_key grid[] = {
    SKG_KEY("Ratio", "number 0<..", "height of the strips over the width of an interspace"),
    SKG_KEY("LinesPerCm", "number 0<..", "strips per cm"),
    SKG_KEY("Interspace", "material", "between the strips; vacuum by default"),
    SKG_KEY("FocusDistance", "length",
            "from the grid to the line in which the planes of the strips meet; parallel by default"),
    SKG_KEY("StripThickness", "length", "of a strip"),
    SKG_KEY("Strip", "material", "of a strip; lead by default"),
    SKG_KEY("Direction", "direction", "across the strips; by default along the detector's rows"),
};
SKG_TABLE(skg_keys_grid, "Grid", grid);

static const skg_json_key response[] = {
    SKG_KEY("File", "text", "a text file of the columns of LUT"),
    SKG_KEY("LUT", "rows",
            "[photon energy, recorded energy], in every row or none also efficiency and Swank factor"),
    SKG_KEY("PulseHeights", "object PulseHeights", "the probability of each height of a pulse"),
    SKG_KEY("Unit", "energy_unit", "of all energies; keV by default"),
    SKG_ALSO("Energy", "Unit"), /* files in use have this */
    SKG_KEY("Meaning", "words signal, absorbed", "of a table without efficiencies; signal by default"),
};
SKG_TABLE(skg_keys_response, "EnergyResponse", response);

static const skg_json_key pulses[] = {
    SKG_KEY("Heights", "numbers", "energies of the pulses"),
    SKG_KEY("Rows", "rows", "a photon energy, and the probability of every height"),
};
SKG_TABLE(skg_keys_pulses, "PulseHeights", pulses);

static const skg_json_key scintillator[] = {
    SKG_KEY("Material", "material", "of the layer"),
    SKG_KEY("Thickness", "number 0<..", "of the layer, in Unit"),
    SKG_KEY("Unit", "words mg/cm2 | unit", "of Thickness"),
    SKG_KEY("Density", "number 0<..", "g/cm3, instead of the tables'"),
    SKG_KEY("Packing", "number 0<..1", "filled share of the volume; 0.75 to 0.85 for needles of CsI"),
    SKG_KEY("Oblique", "flag", "true: the path of a ray through the layer is longer by 1 / cos of its angle"),
    SKG_KEY("Escape", "flag", "true: K fluorescence leaves the layer"),
    SKG_KEY("DQE", "rows 2", "keV, and measured detective quantum efficiency at spatial frequency 0"),
    SKG_KEY("Depths", "list object Depth", "blur that depends on the depth of interaction"),
    SKG_KEY("Deposition", "words transport, all",
            "transport, the default: scattered photons carry energy out of the layer"),
};
SKG_TABLE(skg_keys_scintillator, "Scintillator", scintillator);

static const skg_json_key counting[] = {
    SKG_KEY("Material", "material", "of the sensor"),
    SKG_KEY("Density", "number 0<..", "g/cm3, instead of the tables'"),
    SKG_KEY("Thickness", "length", "of the sensor"),
    SKG_KEY("Thresholds", "numbers", "keV, rising; each begins a window, which is a channel of the image"),
    SKG_KEY("ElectronicNoise", "number 0..", "keV, standard deviation of a pixel's pulse; 0 by default"),
    SKG_KEY("Bias", "number 0..",
            "V over the sensor: charge spreads by diffusion on its way; 0, the default: not at all"),
    SKG_KEY("Cloud", "length", "standard deviation of the charge where it is set free; 0 by default"),
    SKG_KEY("Fluorescence", "flag", "true: K fluorescence leaves the place of absorption"),
    SKG_KEY("AntiCoincidence", "flag", "true: 2 x 2 pixels are summed for each photon, which counts once"),
    SKG_KEY("PileUp", "words none, nonparalysable, paralysable", "what ends a dead time; none by default"),
    SKG_KEY("DeadTime", "number 0<..", "ns, of a pixel after a pulse"),
    SKG_KEY("ExposureTime", "number 0<..", "s, in which the photons of an image arrive"),
};
SKG_TABLE(skg_keys_counting, "Counting", counting);

static const skg_json_key depth[] = {
    SKG_KEY("To", "number", "where the depth ends: a share of the layer's thickness; the last is 1"),
    BLUR_KEYS,
};
SKG_TABLE(skg_keys_depth, "Depth", depth);

static const skg_json_key grey_values[] = {
    SKG_KEY("Dark", "number 0..", "grey value without radiation; 0 by default"),
    SKG_KEY("Full", "number 0..", "grey value where the free beam is strongest; 60000 by default"),
    SKG_KEY("PerJoule", "number 0..", "instead of Full: grey values for each joule that a pixel collects"),
    SKG_KEY("Curve", "rows 2", "instead of these: joule and grey value, linear between the points"),
    SKG_KEY("Bits", "integer 0..16", "whole numbers from 0 to 2^Bits - 1; 0: floats; 16 by default"),
    SKG_KEY("SNR", "number 0..", "ratio of grey value to standard deviation at Full"),
    SKG_KEY("NoiseCurve", "rows 2", "instead of SNR: grey value and ratio"),
    SKG_KEY("Frames", "integer 1..", "frames of which each image is averaged; 1 by default"),
    SKG_KEY("BadColumns", "rows 2", "numbers of columns, from 0 on, and the grey value of their pixels"),
    SKG_KEY("BadRows", "rows 2", "numbers of rows, from 0 on, and the grey value of their pixels"),
    SKG_KEY("Gain", "object PixelMap",
            "the factor of each pixel on its grey value beyond that without radiation"),
    SKG_KEY("Offset", "object PixelMap", "the grey value that each pixel has more"),
    SKG_KEY("Saturation", "number 0..", "grey value at which pixels saturate, before the bits do"),
    SKG_KEY(
        "Lag", "rows 2",
        "shares of the signal that a projection leaves to the next ones, and their constants in projections"),
    SKG_KEY(
        "Ghosting", "rows 2",
        "changes of the sensitivity after a long exposure to the open beam, and their constants in projections"),
    SKG_KEY("BadPixels", "object PixelMap",
            "an image with -1 for a good pixel, and the grey value of a bad one"),
    SKG_KEY("Seed", "integer 0..", "of the noise; 0 by default"),
};
SKG_TABLE(skg_keys_grey_values, "GreyValues", grey_values);

static const skg_json_key pixel_map[] = {
    SKG_KEY("Path", "text", "file of the pixels"),
    SKG_KEY("Format", "words uint8, int8, uint16, int16, float32, float64", "of a pixel"),
    SKG_KEY("ByteOrder", "words little, big", "of a pixel; little by default"),
    SKG_KEY("Header", "integer 0..", "bytes before the first pixel; 0 by default"),
};
SKG_TABLE(skg_keys_pixel_map, "PixelMap", pixel_map);
