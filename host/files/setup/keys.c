/* Keys at the top of a scene file, and those of Noise, Collimation, Scatter and World. */
#include "setup/keys.h"

static const skg_json_key scene[] = {
    SKG_KEY("File format version", "numbers 3", "[1, 0, 0]"),
    SKG_ASIDE("WindowSize"),
    {"$schema", NULL, SKG_KEY_IGNORED, "text", "this schema, for editors"},
    SKG_KEY("Source", "object Source", "where rays start, and with which energies"),
    SKG_KEY("Detector", "object Detector",
            "where rays end; without it, or without its Position, one is fitted to the samples"),
    SKG_KEY("Samples", "list object Sample | words MoveToCentre, MoveToCenter",
            "what rays pass: meshes with a material and a pose"),
    SKG_KEY("Scan", "object Scan", "the projections of a CT scan"),
    SKG_KEY("Precision", "words single, double, half", "of path lengths and images; single by default"),
    SKG_KEY("Tolerance", "number 0..<1",
            "largest error that a compressed spectrum may make; 0, the default: every energy is used"),
    SKG_KEY("SceneGraph", "object Sample", "one more sample, whose shape is all meshes of a file together"),
    SKG_KEY("Breathing", "null | object Breathing", "how the samples move with the breath"),
    SKG_KEY("Noise", "flag | object Noise", "noise of the photons and of the electronics; none by default"),
    SKG_KEY(
        "Falloff", "flag",
        "whether intensity falls with distance and obliquity; by default if photon numbers come from mAs"),
    SKG_KEY("Collimation", "words open | object Collimation", "jaws that limit the beam; none by default"),
    SKG_KEY("Scatter", "flag | number 0<..<1 | object Scatter",
            "scattered photons; a number is the Tolerance"),
    SKG_KEY("BandWeight", "words photons, energy",
            "what transmission and attenuation of energy bands count; photons by default"),
    SKG_KEY("World", "material | object World", "what surrounds the samples; Vacuum by default"),
    SKG_KEY("WorldScatter", "flag", "false: photons that scatter do not meet World; true by default"),
    SKG_KEY(
        "Repair",
        "words neighbours, exact, none, orientation, union | list words neighbours, exact, none, orientation, union",
        "what pixels behind leaky, inverted or overlapping meshes receive; neighbours by default"),
    SKG_KEY("Clip", "flag", "true: a sample counts only where its parent is"),
};
SKG_TABLE(skg_keys_scene, "Scene", scene);

static const skg_json_key world[] = {
    SKG_KEY("Material", "material", "of what surrounds the samples"),
    SKG_KEY("Density", "number 0<..", "g/cm3, instead of the tables'"),
};
SKG_TABLE(skg_keys_world, "World", world);

static const skg_json_key noise[] = {
    SKG_KEY("Quantum", "flag", "of the photons that each pixel detects; true by default"),
    SKG_KEY("Electronic", "energy", "standard deviation for each pixel"),
    SKG_KEY("Step", "energy", "values become whole multiples of this"),
    SKG_KEY("Swank", "number 0<..1",
            "Swank factor at all energies, times that of the energy response; 1 by default"),
    SKG_KEY("Seed", "integer -2147483648..2147483647", "of the random numbers; 0 by default"),
};
SKG_TABLE(skg_keys_noise, "Noise", noise);

static const skg_json_key collimation[] = {
    SKG_KEY("Rectangle", "rectangle",
            "[[left, right], [bottom, top], unit]: what the jaws leave open, in their plane"),
    SKG_KEY("Distance", "length", "from the source to the plane of the jaws; none in a parallel beam"),
    SKG_KEY("Field", "words detector", "instead of both: the rectangle of the detector's pixels"),
    SKG_KEY("Margin", "length", "around the field of the detector; below 0 the field is smaller"),
};
SKG_TABLE(skg_keys_collimation, "Collimation", collimation);

static const skg_json_key scatter[] = {
    SKG_KEY("Tolerance", "number 0<..<1",
            "standard error that is aimed at, over the mean of the scatter; 0.01 by default"),
    SKG_KEY("Histories", "integer 1..1073741824", "instead, the number of photons to follow"),
    SKG_KEY("Seed", "integer -2147483648..2147483647",
            "other seeds give other noise of the scatter; 0 by default"),
    SKG_KEY("Voxel", "length", "side of the cells of the object, about; by default 64 along each side"),
    SKG_KEY("Detector", "places",
            "[columns, rows] of the places that photons are counted in; 32 along the longer side by default"),
    SKG_KEY("Fluorescence", "flag",
            "whether samples emit K and L lines; by default from Z = 30 on whose edge is in the beam"),
};
SKG_TABLE(skg_keys_scatter, "Scatter", scatter);
