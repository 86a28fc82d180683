/* The manual of `view`: operands, flags, text, examples. */
#include "manual/manual.h"

static const cli_flag view_output = {
    "-o", "FILE",
    "The file to write: a picture, .png; a page, .html, in which the scene can be turned; a model of the parts for other viewers, "
    ".glb (glTF 2.0); or a film, .gif, .mp4 or .webm. "
    "May be repeated.",
    NULL, CLI_NAMES_FILE};
static const cli_flag view_from = {
    "--from", "front|side|top|ANGLES|X,Y,Z",
    "The side from which the scene is seen: front is -y, side is +x, top is +z; AP, PA, LAT or the ANGLES of a C-arm such as 'LAO 30 CRAN "
    "20', as its radiograph is seen; or the direction from the scene to the "
    "eye. From a side +z is up, from the top +y. By default the scene is seen obliquely from the side of the source, with "
    "the detector's row 0 on top.",
    NULL, CLI_NAMES_NOTHING};
static const cli_flag view_size = {"--size", "W,H", "Columns and rows of the picture; 1280,800 by default.",
                                   NULL, CLI_NAMES_NOTHING};
static const cli_flag view_orthographic = {
    "--orthographic", NULL, "Keeps parallel lines parallel, without perspective.", NULL, CLI_NAMES_NOTHING};
static const cli_flag view_phase = {
    "--phase", "P", "Shows the scene at this phase of its breath: from 0, end-inspiration, to below 1.", NULL,
    CLI_NAMES_NOTHING};
static const cli_flag view_at = {"--at", "SECONDS", "Shows the scene at this time of its breath.", NULL,
                                 CLI_NAMES_NOTHING};

static const cli_flag view_seconds = {
    "--seconds", "T",
    "Shows the breath for T seconds: in a page, or as a film, which lasts one breath otherwise.", NULL,
    CLI_NAMES_NOTHING};

static const cli_flag view_zoom = {
    "--zoom", "Z[@PART]",
    "Shows the parts Z times as large as they fill a picture or a film, about the middle of all parts or of one PART, whatever else "
    "is then beyond its edges: 1 for all of them without source and detector, 8@needle for a small one.",
    NULL, CLI_NAMES_NOTHING};

static const cli_flag view_sensitivity = {
    "--sensitivity", NULL,
    "In a page, colours each part by how much the image changes when it moves by a mm, and writes the number beside its name: what "
    "`cost --sensitivity` prints. Takes three derivatives for each part.",
    NULL, CLI_NAMES_NOTHING};

static const char *const text[] = {
    "Draws a scene as it stands in the room: source, beam, detector with its image, every part shaded and named, and the "
    "axes. It shows whether everything is where it should be before images are computed.",
    "A part that holds several others, and one that holds the whole scene, is translucent. Colours follow the density of "
    "the material. With a Scan, the path of the source is drawn. The caption has the distances and the magnification of "
    "the centre of the parts.",
    "The detector shows the attenuation, dense matter white, between the percentiles 0.5 and 99.5. It is plain if the "
    "scene has no beam.",
    "A page is one file that needs nothing else: drag to turn the scene, with Shift to move it, roll to zoom; fingers and the "
    "arrow keys do the same. It lists the parts, which can be hidden and made translucent, and names the one pointed at. It "
    "stays below 5 MB: of more than 100000 triangles it shows fewer, and says so. With --seconds it breathes.",
    "A model holds every part with all its triangles and its colour, as it stands at --phase or --at, in metres with y up, as "
    "glTF has it: Blender and others turn it back to z up.",
    "A film shows the detector's image over the range of its first frame, and the labels where they are in it. See "
    "`skiagraph help breathe` about formats.",
    "--json prints {files, source_detector_mm, source_object_mm, magnification, parts: [{label, column, row, colour}]}; "
    "column and row are where the centre of a part is in the picture. With --sensitivity it has the key sensitivity of `cost --json`.",
    NULL};

static const cli_flag *const flags[] = {&view_output,
                                        &view_from,
                                        &view_size,
                                        &view_zoom,
                                        &view_orthographic,
                                        &view_phase,
                                        &view_at,
                                        &view_seconds,
                                        &cli_flag_breathe_fps,
                                        &view_sensitivity,
                                        &cli_flag_device,
                                        &cli_flag_tolerance,
                                        &cli_flag_set,
                                        &cli_flag_lenient,
                                        &cli_flag_json,
                                        &cli_flag_verbose,
                                        &cli_flag_strict,
                                        &cli_flag_quiet,
                                        NULL};

static const cli_item examples[] = {{"skiagraph view scene.json -o view.png", "draws the scene"},
                                    {"skiagraph view thorax/thorax.json --seconds 4 -o view.html",
                                     "makes a page in which the thorax breathes and can be turned"},
                                    {"skiagraph view scene.json --zoom 2@liver -o view.png",
                                     "draws the liver twice as large as it would fill the picture"},
                                    {"skiagraph view scene.json --sensitivity -o view.html",
                                     "makes a page that shows which part's place shows most in the image"},
                                    {"skiagraph view thorax/thorax.json --from top --phase 0.5 -o view.png",
                                     "the breathing thorax from above, at half of its cycle"},
                                    {NULL, NULL}};

const cli_manual cli_manual_view = {.name = "view",
                                    .operands = "SCENE",
                                    .required = "-o FILE",
                                    .summary = "a picture of the scene, a page to turn it in, or a film",
                                    .text = text,
                                    .least = 1,
                                    .most = 1,
                                    .names = CLI_NAMES_SCENE,
                                    .flags = flags,
                                    .examples = examples,
                                    .has_device = 1};
