/* Keys of Scan. */
#include "setup/keys.h"

static const skg_json_key scan[] = {
    SKG_KEY("NumberOfProjections", "integer 1..2147483647", "how many there are"),
    SKG_KEY("AngleStep", "number", "degrees from one projection to the next"),
    SKG_KEY("StartAngle", "number", "degrees; 0 by default"),
    SKG_KEY("FinalAngle", "number", "degrees"),
    SKG_KEY("IncludeLastAngle", "flag", "whether the last projection is at FinalAngle; false by default"),
    SKG_ALSO("IncludeFinalAngle", "IncludeLastAngle"),
    SKG_KEY("Short", "flag", "true: 180 degrees and the angle of the fan, instead of FinalAngle"),
    SKG_KEY("Pitch", "lengths 1", "how far the samples move along the axis in a full turn"),
    SKG_KEY("SourceTravel", "lengths 3", "from the source of the first projection to that of the last"),
    SKG_KEY("FixedDetector", "flag", "true: the detector stays, and only the source turns"),
    SKG_KEY("Table", "text | rows 12",
            "x, y, z of source, detector centre, column step and row step, mm, for each projection"),
    SKG_KEY("KnownTable", "text | rows 12", "poses that are written for the reconstruction, if they differ"),
    SKG_KEY("Intensity", "numbers",
            "the beam's intensity over that of the first projection, for grey values"),
    SKG_KEY("Flats", "object Fields", "flat fields"),
    SKG_KEY("Darks", "object Fields", "dark fields"),
    SKG_KEY("Layout", "words CTSimU", "how a folder of projections is laid out"),
    SKG_KEY("DetectorOffset", "lengths 2", "displacement along the columns' step and the rows' step"),
    SKG_KEY("DetectorTilt", "numbers 3",
            "degrees about the columns' step, the rows' step and the detector's normal"),
    SKG_KEY("DetectorSkew", "number", "degrees by which the rows' step leans towards the columns' step"),
    SKG_KEY("Drift", "object Drift", "displacements that grow from 0 in the first projection"),
    SKG_KEY("Jitter", "object Jitter", "random displacements"),
    SKG_KEY("StartTime", "number", "s, of the first projection; 0 by default"),
    SKG_KEY("Interval", "number", "s, from one projection to the next; 0 by default"),
    SKG_KEY("Exposure", "number", "s; 0 by default"),
    SKG_KEY("Flat-Field Correction", "any", "without effect"),
    SKG_KEY("NumberOfWhiteImages", "any", "without effect"),
    SKG_KEY("CentreOfRotation", "numbers 3 | lengths 3", "mm if there is no unit; the origin by default"),
    SKG_ALSO("CenterOfRotation", "CentreOfRotation"),
    SKG_KEY("RotationAxis", "direction", "UpVector by default"),
    SKG_KEY("OutFolder", "text", "without effect"),
    SKG_ASIDE("GifPath"),
};
SKG_TABLE(skg_keys_scan, "Scan", scan);

static const skg_json_key drift[] = {
    SKG_KEY("Source", "lengths 3", "of the source in the last projection"),
    SKG_KEY("Detector", "lengths 3", "of the detector in the last projection"),
};
SKG_TABLE(skg_keys_drift, "Drift", drift);

static const skg_json_key jitter[] = {
    SKG_KEY("Source", "lengths 1", "standard deviation along each axis"),
    SKG_KEY("Detector", "lengths 1", "standard deviation along each axis"),
    SKG_KEY("Angle", "number", "standard deviation, degrees"),
    SKG_KEY("Seed", "integer 0..", "of the random numbers; 0 by default"),
};
SKG_TABLE(skg_keys_jitter, "Jitter", jitter);

static const skg_json_key fields[] = {
    SKG_KEY("Number", "integer 0..2147483647", "how many images"),
    SKG_KEY("Frames", "integer 1..2147483647", "of grey values, frames of which each is averaged"),
    SKG_KEY("Noise", "flag", "of grey values, whether they have noise"),
};
SKG_TABLE(skg_keys_fields, "Fields", fields);
