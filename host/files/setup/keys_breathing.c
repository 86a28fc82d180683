/* Keys of Breathing. */
#include "setup/keys.h"

static const skg_json_key breathing[] = {
    SKG_KEY("Pattern", "text",
            "quiet (the default), diaphragmatic, thoracic, shallow, deep or hyperventilation"),
    SKG_KEY("Waveform", "words Sine, Lujan, Asymmetric | numbers",
            "or samples over one breath, from end-inspiration"),
    SKG_KEY("Exponent", "integer 1..8", "of Lujan's waveform"),
    SKG_KEY("Period", "number 0.2..60", "s"),
    SKG_KEY("StartPhase", "number", "phase at time 0, where 0 is end-inspiration"),
    SKG_KEY("ExpirationRatio", "number 0.2..5",
            "duration of expiration over that of inspiration, for Asymmetric"),
    SKG_KEY("Thoracic", "number 0..4", "weight of the ribs; 1: quiet"),
    SKG_KEY("Diaphragmatic", "number 0..4", "weight of the diaphragm; 1: quiet"),
    SKG_KEY("ThoracicLag", "number", "delay of the ribs, as a fraction of a breath"),
    SKG_KEY("Reference", "number 0..1",
            "amplitude at which the meshes were made; 0, end-expiration, by default"),
    SKG_KEY("Tendon", "lengths 3", "displacement of the diaphragm's tendon at weight 1"),
    SKG_KEY("TendonPlane", "numbers 4",
            "a vertex belongs to the tendon if ax + by + cz + d > 0; found from the mesh by default"),
    SKG_KEY("Hysteresis", "number 0..1", "0 by default; 1: as in the paper"),
    SKG_KEY("Relaxation", "integer 0..20", "passes of elastic relaxation; 0 by default"),
    SKG_KEY("LungDensity", "flag", "true, the default: the lungs keep their mass"),
    SKG_KEY("Organs", "map object Organ", "rules of single samples, by their labels"),
    SKG_KEY("Events", "list object Event", "what happens at a time"),
    SKG_KEY("RibAxes", "words Literature, Bones", "Literature by default"),
    SKG_KEY("DiaphragmRibs", "length",
            "with Coupling Paper: how near to ribs 6 to 12 the rim of the diaphragm goes with them"),
    SKG_KEY("DiaphragmLiver", "length", "with Coupling Paper: how near to the tendon the liver goes with it"),
    SKG_KEY("Coupling", "words Anatomical, Paper", "of ribs and diaphragm; Anatomical by default"),
    SKG_KEY("Fit", "object Fit", "what skiagraph fit searches"),
    SKG_KEY(
        "Domes", "lengths 3",
        "[left, right, back, unit]: how much farther the tops of the domes and the back go than the tendon"),
    SKG_KEY("MuscleLength", "number 0.1..1",
            "of the diaphragm, of the greatest distance from the rim; 0.8 by default"),
    SKG_KEY("RibAngles", "numbers 2",
            "degrees of rib 5, and how much more they fall for each rib; [14.6, 0] by default"),
    SKG_KEY("LiverFollows", "number 0..2",
            "the part of the dome's motion with which the liver goes; 1 by default"),
    SKG_KEY("LiverHeld", "number 0..1",
            "by which part of it the liver's lower end goes less than its top; 0.25 by default"),
    SKG_KEY("Signal", "text", "a table of time, s, and amplitude: what was recorded of a patient"),
};
SKG_TABLE(skg_keys_breathing, "Breathing", breathing);

static const skg_json_key event[] = {
    SKG_KEY("Hold", "numbers 2", "the breath stops in this interval, s"),
    SKG_KEY("Weight", "rows 2", "time, s, and a factor on both weights"),
    SKG_KEY("Needle", "rows 2", "time, s, and depth of the sample \"needle\" below the skin, mm"),
    SKG_KEY("Contrast", "text", "label of the sample whose material fills its volume in part"),
    SKG_KEY("Share", "rows 2", "time, s, and the share that is filled"),
};
SKG_TABLE(skg_keys_event, "Event", event);

static const skg_json_key organ[] = {
    SKG_KEY("As", "text", "label whose rule the sample follows, instead of its own"),
    SKG_KEY("Kind", "words ByLabel, Static, Rigid, Deformable", "how it moves; ByLabel by default"),
    SKG_KEY("Tissue", "numbers 3", "how far it may be compressed, stretched and sheared"),
    SKG_KEY("Links", "list object Link", "of a deformable sample, instead of those of its label"),
    SKG_KEY("Axis", "direction", "of the rotation of a rigid sample, with Angle"),
    SKG_KEY("Angle", "number -180..180", "degrees, counter-clockwise as seen from the tip of Axis"),
    SKG_KEY("Centre", "lengths 3", "of the rotation"),
    SKG_KEY("Gamma", "number -180..180", "of a rigid sample: degrees about the axis from back to front"),
    SKG_KEY("Lambda", "number -180..180", "of a rigid sample: degrees about the axis from left to right"),
    SKG_ALSO("Center", "Centre"),
};
SKG_TABLE(skg_keys_organ, "Organ", organ);

static const skg_json_key link[] = {
    SKG_KEY("To", "text", "label of another sample, or the word that several labels begin with"),
    SKG_KEY("Distance", "length", "vertices nearer to it are linked"),
    SKG_KEY("RigidDistance", "length", "vertices nearer to it follow it; Distance by default"),
};
SKG_TABLE(skg_keys_link, "Link", link);

static const skg_json_key body_fit[] = {
    SKG_KEY("Parameters", "list text", "names of what is fitted"),
    SKG_KEY("Bounds", "map any", "ranges by the names of parameters; those in mm have a unit"),
};
SKG_TABLE(skg_keys_body_fit, "Fit", body_fit);
