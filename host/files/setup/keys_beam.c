/* Keys of Source, and of what stands at the source: the beam, the heel effect, the bow-tie filter. */
#include "setup/keys.h"

static const skg_json_key source[] = {
    SKG_KEY("Position", "lengths 3", "[x, y, z, unit]"),
    SKG_KEY("Direction", "direction", "instead of Position: a parallel beam from infinity"),
    SKG_KEY("Shape", "words PointSource, Point, Cone, ConeBeam, ParallelBeam, Parallel | spot",
            "a point, a parallel beam, or a focal spot; PointSource by default"),
    SKG_KEY("Samples", "integer 0..65536",
            "source samples of a focal spot; 0, the default: as many as SampleTolerance needs"),
    SKG_KEY("Grid", "integer 1..256",
            "instead of Samples: the middles of n, n x n or n x n x n equal pieces"),
    SKG_KEY("SampleTolerance", "number 0<..<1",
            "change, of the flat field, at which the number of samples suffices; 0.005 by default"),
    SKG_KEY("OffFocal", "object OffFocal", "photons that leave the anode beside the focal spot"),
    SKG_KEY("Axis", "direction", "normal of a flat focal spot; by default the line to the detector's centre"),
    SKG_KEY("Beam", "null | object Beam | list object Channel", "energies, a file of them, or a tube"),
    SKG_KEY(
        "From", "text | direction",
        "the side on which the source stands, instead of Position: front, side, top, AP, PA, LAT, angles such as LAO 30 CRAN 20"),
    SKG_KEY("SOD", "length", "with From: from the source to the isocentre"),
    SKG_KEY("SDD", "length", "with From: from the source to the detector"),
    SKG_KEY(
        "Isocentre", "lengths 3",
        "with From: the point through which the beam's axis goes; the centre of the samples' bounds by default"),
    SKG_ALSO("Isocenter", "Isocentre"),
    SKG_KEY("Heel", "object Heel", "the heel effect of a tube"),
    SKG_KEY("Bowtie", "object Bowtie", "a filter whose thickness changes along the fan of rays"),
    SKG_KEY("LSF", "any",
            "passed over with a warning, as gVXR does; a line spread function belongs to Detector"),
};
SKG_TABLE(skg_keys_source, "Source", source);

static const skg_json_key off_focal[] = {
    SKG_KEY("Share", "number 0<..<1", "of all photons"),
    SKG_KEY("Diameter", "length", "of the disc from which they come"),
};
SKG_TABLE(skg_keys_off_focal, "OffFocal", off_focal);

static const skg_json_key heel[] = {
    SKG_KEY("AnodeAngle", "number 0<..",
            "degrees, of the ray to the detector's centre; by default the TubeAngle of the beam"),
    SKG_KEY("Direction", "direction",
            "from the detector's centre to the side of the anode, where the image is darkest"),
};
SKG_TABLE(skg_keys_heel, "Heel", heel);

static const skg_json_key bowtie[] = {
    SKG_KEY("Material", "material", "of the filter"),
    SKG_KEY("Density", "number 0<..", "g/cm3, instead of the tables'"),
    SKG_KEY(
        "Profile", "text | rows 2",
        "angles in the fan, degrees, rising, and the path of that ray through the filter; or a file of them"),
    SKG_KEY("Unit", "unit", "of the paths; mm by default"),
    SKG_KEY("Direction", "direction", "in which the angles grow; by default along the detector's rows"),
};
SKG_TABLE(skg_keys_bowtie, "Bowtie", bowtie);

static const skg_json_key channel[] = {
    SKG_KEY("Energy", "number 0<..", "of the photons"),
    SKG_KEY("Unit", "energy_unit", "of Energy"),
    SKG_KEY("PhotonCount", "number 0..", "photons for each pixel"),
};
SKG_TABLE(skg_keys_channel, "Channel", channel);

static const skg_json_key beam[] = {
    SKG_KEY("TextFile", "text", "two columns: energy, and photons for each pixel"),
    SKG_KEY("GateMacro", "text", "a macro of GATE, of which the lines with histpoint are read"),
    SKG_KEY("Unit", "energy_unit", "of the energies in the file"),
    SKG_KEY("kVp", "number 10..450", "peak voltage of a tube, kV"),
    SKG_ALSO("PeakKiloVoltage", "kVp"),
    SKG_KEY("TubeAngle", "number 0<..", "of the anode, degrees; 12 by default"),
    SKG_KEY("Anode", "text", "symbol of the element; W by default"),
    SKG_KEY("Model", "words Ebel, Birch", "of the tube's spectrum; Ebel by default"),
    SKG_KEY("mAs", "number 0<..", "photon numbers are then counted per solid angle at the source"),
    SKG_KEY("ExposureTime", "time", "with the tube's current, instead of mAs"),
    SKG_KEY("X-ray tube current", "current", "with ExposureTime, instead of mAs"),
    SKG_ALSO("Current", "X-ray tube current"),
    SKG_KEY("Filter", "list filter", "all filters of the tube: [material, thickness, unit]"),
    SKG_ALSO("Filtration", "Filter"),
    SKG_ALSO("Filters", "Filter"),
    SKG_KEY("MaxNumberOfEnergyBins", "integer 1..5000",
            "bins are 1 keV wide, or wider if there would be more than this"),
    SKG_KEY("Output", "output",
            "[65, \"uGy/mAs\", 100, \"cm\"]: measured air kerma behind the filters, instead of the model's"),
    SKG_KEY("Bins", "rows 2", "keV and photons for each pixel"),
    SKG_KEY("At1m", "flag", "true: photons of Bins are per mm2 at 1 m"),
};
SKG_TABLE(skg_keys_beam, "Beam", beam);
