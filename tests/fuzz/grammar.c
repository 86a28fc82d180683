/* Scene files by a grammar: each byte of the input chooses an alternative, so that most files get past the reader of JSON and
 * the checks of single keys. */
#include "fuzz/fuzz.h"
#include "fuzz/read_scene.h"

#include <string.h>

enum { ALTERNATIVES_MAX = 24, LONGEST = 1 << 16, DEEPEST = 24 };

/* <name> in an alternative stands for one of the alternatives of that rule. The first one ends every recursion. */
typedef struct {
    const char *name, *alternatives[ALTERNATIVES_MAX];
} rule;

/* clang-format off */
static const rule rules[] = {
    {"scene", {"{\"Source\":<source>,\"Detector\":<detector>,\"Samples\":<samples><more>}"}},
    {"more", {"", ",<key><more>", ",<key>,<key>,<key><more>"}},
    {"key", {"\"World\":<material>", "\"Precision\":<precision>", "\"Tolerance\":<number>", "\"Noise\":<noise>",
             "\"Repair\":\"exact\"", "\"Clip\":<bool>", "\"Falloff\":<bool>", "\"BandWeight\":\"energy\"",
             "\"Collimation\":<field>", "\"Scatter\":<scatter>", "\"Scan\":<scan>", "\"Breathing\":<breathing>", "\"WindowSize\":[8,8]", "\"File format version\":[1,0,0]"}},
    {"field", {"\"open\"", "{\"Rectangle\":[[<number>,<number>],[<number>,<number>],<unit>],\"Distance\":[<number>,<unit>]}",
               "{\"Field\":\"detector\",\"Margin\":[<number>,<unit>]}", "{\"Field\":\"<word>\",\"Distance\":[<number>]}",
               "{\"Rectangle\":[<number>,[<number>]]}", "<bool>"}},
    {"scatter", {"<bool>", "<number>", "{\"Tolerance\":<number>,\"Seed\":<whole>}", "{\"Histories\":<number>,\"Voxel\":[<number>,<unit>]}",
                 "{\"Tolerance\":<number>,\"Histories\":<number>}", "{\"Detector\":[<whole>,<whole>]}", "{\"Detector\":<number>,\"Voxel\":<number>}"}},
    {"precision", {"\"single\"", "\"double\"", "\"half\"", "\"<word>\""}},
    {"bool", {"true", "false", "null", "<number>"}},
    {"number", {"1", "0", "-1", "0.5", "2", "10", "60", "100", "1000", "1e-9", "1e9", "-1e300", "1e-320", "0.1", "3", "7",
                "64", "255", "32768", "2147483648", "-0.0", "12.5", "45", "360"}},
    {"whole", {"1", "2", "3", "4", "16", "48", "64", "0", "-1", "90", "2.5"}},
    {"unit", {"\"mm\"", "\"cm\"", "\"m\"", "\"um\"", "\"dm\"", "\"<word>\""}},
    {"energies", {"\"keV\"", "\"MeV\"", "\"eV\"", "\"mm\""}},
    {"word", {"skin", "bone", "liver", "lung right", "diaphragm", "rib 5 left", "needle", "", "a\\nb", "\\u00e9", "exact"}},
    {"point", {"[0,-40,0,\"cm\"]", "[<number>,<number>,<number>,<unit>]", "[<number>,<number>,<number>]", "[]"}},
    {"axis", {"[0,0,-1]", "[0,1,0]", "[<number>,<number>,<number>]", "[0,0,0]", "[1]"}},
    {"source", {"{\"Position\":<point>,\"Shape\":<shape>,\"Beam\":<beam><spot>}",
                "{\"Direction\":<axis>,\"Shape\":\"ParallelBeam\",\"Beam\":<beam>}"}},
    {"shape", {"\"PointSource\"", "\"ParallelBeam\"", "\"ConeBeam\"", "[\"Line\",<number>,<unit>]",
               "[\"Rectangle\",<number>,<number>,<unit>]", "[\"Cube\",<number>,<unit>]", "[\"Disc\",<number>,<unit>]",
               "[\"Sphere\",<number>,<unit>]", "[\"Gaussian\",<number>,<number>,<unit>]",
               "[\"FocalSpot\",<number>,<unit>,<whole>]", "\"<word>\""}},
    {"spot", {"", ",\"Samples\":<whole>", ",\"SampleTolerance\":<number>", ",\"Grid\":<whole>", ",\"Axis\":<axis>",
              ",\"Samples\":<whole>,\"Axis\":<axis>"}},
    {"beam", {"[{\"Energy\":60,\"Unit\":\"keV\",\"PhotonCount\":1000}]", "[<bin>]", "[<bin>,<bin>,<bin>]",
              "{\"TextFile\":\"table.txt\",\"Unit\":<energies>}", "{\"kVp\":<number>}", "{\"kVp\":80<tube>}", "[]"}},
    {"bin", {"{\"Energy\":<number>,\"Unit\":<energies>,\"PhotonCount\":<number>}"}},
    {"tube", {"", ",\"Filter\":[<filter>]<tube>", ",\"Filter\":[<filter>,<filter>]", ",\"TubeAngle\":<number><tube>",
              ",\"mAs\":<number><tube>", ",\"MaxNumberOfEnergyBins\":<whole><tube>", ",\"Anode\":\"Mo\"<tube>",
              ",\"Model\":\"Birch\"<tube>", ",\"Output\":[<number>,\"uGy/mAs\",<number>,<unit>]<tube>",
              ",\"ExposureTime\":[<number>,\"ms\"],\"X-ray tube current\":[<number>,\"mA\"]"}},
    {"filter", {"[\"Al\",2.5,\"mm\"]", "[<number>,<number>,<unit>]", "[\"Cu\",<number>]", "[\"<word>\",1,\"mm\"]"}},
    {"detector", {"{\"Position\":[0,10,0,\"cm\"],\"UpVector\":[0,0,-1],\"NumberOfPixels\":[64,48],\"Size\":[32,24,\"cm\"]<screen>}",
                  "{\"Position\":<point>,\"UpVector\":<axis>,\"NumberOfPixels\":[<whole>,<whole>],\"Spacing\":[<number>,<number>,<unit>]<screen>}",
                  "{\"Position\":<point>,\"UpVector\":<axis>,\"RightVector\":<axis>,\"NumberOfPixels\":[<whole>,<whole>],\"Size\":[<number>,<number>,<unit>]<screen>}"}},
    {"screen", {"", ",\"Oversampling\":<whole><screen>", ",\"EnergyResponse\":{\"File\":\"table.txt\",\"Unit\":<energies>}<screen>",
                ",\"EnergyResponse\":{\"LUT\":[[<number>,<number>],[<number>,<number>]],\"Unit\":<energies>}<screen>",
                ",\"Scintillator\":{\"Material\":\"CsI\",\"Thickness\":<number>,\"Unit\":<unit>}<screen>",
                ",\"Scintillator\":{\"Material\":<material>,\"Thickness\":<number>,\"Unit\":\"mg/cm2\",\"Density\":<number>,\"Packing\":<number>}",
                ",\"LSF\":[<number>,<number>,<number>]<screen>", ",\"LSF\":[[<number>],[<number>,<number>,<number>]]",
                ",\"PSF\":[[0,1,0],[1,<number>,1],[0,1,0]]"}},
    {"samples", {"[<sample>]", "[<sample>,<sample>]", "[<sample>,<sample>,<sample>,\"MoveToCentre\"]", "[]"}},
    {"sample", {"{\"Label\":\"<word>\",<body>,\"Material\":<material><extra>}", "{<body>,\"Material\":<material><extra>}"}},
    {"body", {"\"Cube\":[<number>,<unit>]", "\"Cuboid\":[<number>,<number>,<number>,<unit>]", "\"Path\":\"box.stl\",\"Unit\":<unit>",
              "\"Cylinder\":[<whole>,<number>,<number>,<unit>]", "\"Sphere\":[<whole>,<number>,<unit>]",
              "\"StepWedge\":{\"NumberOfSteps\":<whole>,\"TotalLength\":<number>,\"Width\":<number>,\"FirstStepHeight\":5,\"OtherStepHeight\":<number>,\"Unit\":<unit>}",
              "\"Path\":\"none.stl\",\"Unit\":\"mm\""}},
    {"material", {"[\"mu\",<number>]", "[\"HU\",<number>]", "[\"Element\",\"Cu\"]", "[\"Element\",<whole>]", "[\"Compound\",\"H2O\"]",
                  "[\"Mixture\",[1,0.112,8,0.888]]", "[\"Mixture\",[<whole>,<number>,<whole>,<number>]]", "[\"Mixture\",\"Ti90Al6V4\"]",
                  "[\"Table\",\"table.txt\",<energies>]", "\"liver\"", "\"Vacuum\"", "[\"Compound\",\"Ca5(PO4)<whole>OH\"]", "\"<word>\""}},
    {"extra", {"", ",\"Type\":\"outer\"<extra>", ",\"Type\":\"inner\"<extra>", ",\"Parent\":\"<word>\"<extra>", ",\"Density\":<number><extra>",
               ",\"Priority\":<whole><extra>", ",\"MoveToCentre\":<bool><extra>", ",\"FlipNormals\":<bool><extra>", ",\"Parent\":null",
               ",\"Transform\":[<move>]", ",\"Transform\":[<move>,<move>]<extra>"}},
    {"move", {"[\"Rotation\",<number>,0,0,1]", "[\"Rotation\",<number>,<number>,<number>,<number>]", "[\"Scaling\",<number>,1,1]",
              "[\"Translation\",<number>,<number>,<number>,<unit>]", "[\"Matrix\",[1,0,0,0,0,<number>,0,0,0,0,1,0,<number>,0,0,1]]"}},
    {"noise", {"true", "{\"Quantum\":<bool>}", "{\"Electronic\":[<number>,<energies>],\"Step\":[<number>,<energies>]}",
               "{\"Swank\":<number>,\"Seed\":<whole>}"}},
    {"scan", {"{\"NumberOfProjections\":<whole>,\"AngleStep\":<number>,\"StartAngle\":<number>}",
              "{\"NumberOfProjections\":<whole>,\"FinalAngle\":<number>,\"IncludeFinalAngle\":<bool>}",
              "{\"NumberOfProjections\":2,\"AngleStep\":1,\"CentreOfRotation\":<point>,\"RotationAxis\":<axis>}"}},
    {"breathing", {"{}", "{<breath>}", "{<breath>,<breath>,<breath>}"}},
    {"breath", {"\"Pattern\":\"deep\"", "\"Waveform\":[<number>,<number>,<number>]", "\"Waveform\":\"Lujan\"", "\"Exponent\":<number>",
                "\"Period\":<number>", "\"Thoracic\":<number>", "\"Reference\":<number>", "\"Tendon\":[0,0,<number>,\"mm\"]",
                "\"TendonPlane\":[<number>,0,1,<number>]", "\"Hysteresis\":<number>", "\"Relaxation\":<whole>",
                "\"Organs\":{\"<word>\":{<organ>}}", "\"Events\":[<event>]", "\"Events\":[<event>,<event>]"}},
    {"organ", {"\"As\":\"<word>\"", "\"Kind\":\"Rigid\",\"Gamma\":<number>,\"Lambda\":<number>", "\"Tissue\":[<number>,<number>,<number>]",
               "\"Kind\":\"Deformable\",\"Links\":[{\"To\":\"<word>\",\"Distance\":[<number>,\"mm\"]}]",
               "\"Kind\":\"Rigid\",\"Axis\":<axis>,\"Angle\":<number>,\"Centre\":<point>"}},
    {"event", {"{\"Hold\":[<number>,<number>]}", "{\"Weight\":[[<number>,<number>],[<number>,<number>]]}",
               "{\"Needle\":[[<number>,<number>],[6,<number>]]}", "{\"Contrast\":\"<word>\",\"Share\":[[<number>,<number>]]}"}}};
/* clang-format on */

typedef struct {
    const uint8_t *next, *end;
    char text[LONGEST];
    size_t length;
} writer;

static const rule *find_rule(const char *name, size_t length) {
    for (size_t n = 0; n < sizeof rules / sizeof *rules; n++)
        if (strlen(rules[n].name) == length && strncmp(rules[n].name, name, length) == 0) return &rules[n];
    return NULL;
}

/* The first alternative when the input is used up, or at the depth where recursion has to end. */
static const char *choose(writer *w, const rule *from, int depth) {
    int count = 0;
    while (count < ALTERNATIVES_MAX && from->alternatives[count]) count++;
    if (w->next == w->end || depth >= DEEPEST) return from->alternatives[0];
    return from->alternatives[*w->next++ % count];
}

static void write_rule(writer *w, const rule *from, int depth) {
    for (const char *at = choose(w, from, depth); *at && w->length < LONGEST; at++) {
        const char *close = *at == '<' ? strchr(at, '>') : NULL;
        if (!close) {
            w->text[w->length++] = *at;
            continue;
        }
        write_rule(w, find_rule(at + 1, (size_t)(close - at - 1)), depth + 1);
        at = close;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static writer w;
    w.next = data;
    w.end = data + size;
    w.length = 0;
    write_rule(&w, &rules[0], 0);
    fuzz_read_scene(w.text, w.length);
    return 0;
}
