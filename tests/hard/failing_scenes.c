/* The scenes of failing_test, and the effects of its runs. */
#include "hard/failing_scenes.h"
#include "suite.h"

#include <stdio.h>

/* A closed part, one from a file, an open one, a tube, a response, the world, a scan. */
static const char scene_text[] =
    "{\"Source\": {\"Position\": [0, -40, 0, \"cm\"], \"Shape\": \"PointSource\",\n"
    " \"Beam\": {\"kVp\": 60, \"Filter\": [[\"Al\", 2.5, \"mm\"]], \"MaxNumberOfEnergyBins\": 6}},\n"
    " \"Detector\": {\"Position\": [0, 10, 0, \"cm\"], \"UpVector\": [0, 0, -1],\n"
    "  \"NumberOfPixels\": [24, 18], \"Size\": [12, 9, \"cm\"],\n"
    "  \"EnergyResponse\": {\"File\": \"response.txt\", \"Unit\": \"keV\"}},\n"
    " \"Samples\": [{\"Label\": \"skin\", \"Cube\": [40, \"mm\"], \"Material\": [\"HU\", 20], \"Type\": \"outer\"},\n"
    " {\"Label\": \"bone\", \"Path\": \"bone.obj\", \"Unit\": \"mm\", \"Material\": [\"Compound\", \"Ca5(PO4)3OH\"],\n"
    "  \"Density\": 1.5, \"Transform\": [[\"Rotation\", 30, 0, 0, 1]]},\n"
    " {\"Label\": \"sheet\", \"Path\": \"sheet.stl\", \"Unit\": \"mm\", \"Material\": [\"Element\", \"Cu\"]}],\n"
    " \"World\": \"Air\", \"Tolerance\": 1e-3}\n";
/* Enough of a body that breathes. */
static const char body_text[] =
    "{\"Source\": {\"Position\": [0, -860, -20, \"mm\"], \"Shape\": \"PointSource\",\n"
    "  \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1}]},\n"
    " \"Detector\": {\"Position\": [0, 140, -20, \"mm\"], \"UpVector\": [0, 0, -1],\n"
    "  \"NumberOfPixels\": [24, 18], \"Size\": [480, 360, \"mm\"]},\n \"Samples\": [\n"
    "  {\"Label\": \"lung right\", \"Sphere\": [8, 40, \"mm\"], \"Material\": [\"HU\", -700]},\n"
    "  {\"Label\": \"flat\", \"Sphere\": [9, 60, \"mm\"], \"Material\": [\"mu\", 0.2]},\n"
    "  {\"Label\": \"inside\", \"Sphere\": [6, 5, \"mm\"], \"Material\": [\"mu\", 0.3], \"Parent\": \"lung "
    "right\"}],\n"
    " \"Breathing\": {\"Waveform\": [1, 0.2, 0, 0.2], \"Hysteresis\": 0.5, \"Relaxation\": 2,\n"
    "  \"Organs\": {\"flat\": {\"As\": \"diaphragm\", \"Tissue\": [0.6, 1.2, 0.2]}},\n"
    "  \"Events\": [{\"Hold\": [1, 2]}, {\"Contrast\": \"inside\", \"Share\": [[0, 0.5]]}]}}\n";
static const char response_text[] = "1 1\n60 58\n200 150\n";
static const char bone_text[] = "v -5 -5 -5\nv 8 0 0\nv 0 8 0\nv 0 0 8\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
/* So thin that its vertices keep what rounding has lost. */
static const char plate_text[] =
    "v -5 -5 0\nv 8 0 0\nv 0 8 0\nv 0 0 0.01\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
static const char sheet_text[] =
    "solid s\nfacet normal 0 0 0\nouter loop\nvertex 5 0 5\nvertex 5 9 5\nvertex 9 0 5\n"
    "endloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 5 9 5\nvertex 9 9 5\nvertex 9 0 5\n"
    "endloop\nendfacet\nendsolid s\n";

const effects failing_runs[] = {
    /* nothing but the test of the device and the first image of a machine */
    {.file = "scene.json", .settings = {"Tolerance=0"}, .strategy = SKG_STRATEGY_COPIES, .fresh = 1},
    /* compression, neighbours' repair, world, response, source samples, tiles */
    {.file = "scene.json",
     .strategy = SKG_STRATEGY_TILES,
     .spot = {.shape = SKG_SPOT_RECTANGLE, .extent = {1, 1, 0}, .samples = 4}},
    /* exact repair, priority, two line spread functions, noise and its variance, falloff, copies, one thread */
    {.file = "scene.json",
     .settings = {"Repair=exact", "Samples.bone.Priority=2", "Detector.LSF=[[0.2,1,0.2],[1,2,1]]",
                  "Noise={\"Quantum\":true,\"Electronic\":[2,\"keV\"],\"Step\":[0.5,\"keV\"],\"Swank\":0.9}"},
     .strategy = SKG_STRATEGY_COPIES,
     .falloff = 1,
     .ratio = 1,
     .varies = 1,
     .device = "threads=1"},
    /* double, every bin, point spread function, pixels of four rays, bands, clipping, atomics, rows with gaps */
    {.file = "scene.json",
     .settings = {"Precision=double", "Tolerance=0", "Detector.PSF=[[0,1,0],[1,4,1],[0,1,0]]",
                  "Detector.Oversampling=2", "Samples.bone.Parent=skin"},
     .strategy = SKG_STRATEGY_ATOMICS,
     .bands = 2,
     .clip = 1,
     .strided = 1},
    /* half, which knows closed meshes only; four rays of a pixel in one pass */
    {.file = "scene.json",
     .settings = {"Precision=half", "World=Vacuum", "Samples.sheet.Path=bone.obj", "Detector.Oversampling=2",
                  "Samples.sheet.Transform=[[\"Scaling\",0.5,0.5,0.5]]"}},
    /* samples of the source as their tolerance asks for; a table of attenuation; the caller's OpenCL objects; a thin mesh;
     * vertices of an open mesh that part */
    {.file = "scene.json",
     .settings = {"Samples.skin.Material=[\"Table\",\"response.txt\",\"keV\"]",
                  "Samples.bone.Path=plate.obj"},
     .strategy = SKG_STRATEGY_COPIES,
     .spot = {.shape = SKG_SPOT_DISC, .extent = {0.2, 0, 0}, .tolerance = 0.2, .samples_max = 8},
     .shared = 1},
    /* samples that are drawn together, because meshes are closed */
    {.file = "scene.json",
     .settings = {"Samples.sheet.Path=bone.obj", "Samples.sheet.Transform=[[\"Scaling\",0.5,0.5,0.5]]"},
     .strategy = SKG_STRATEGY_COPIES,
     .spot = {.shape = SKG_SPOT_RECTANGLE, .extent = {1, 1, 0}, .samples = 4}},
    /* scattered photons, with their noise */
    {.file = "scene.json",
     .settings = {"Samples.sheet.Path=bone.obj", "Samples.sheet.Transform=[[\"Scaling\",0.5,0.5,0.5]]",
                  "World=Vacuum", "Tolerance=0",
                  "Scatter={\"Histories\":32,\"Detector\":[4,4],\"Voxel\":[5,\"mm\"]}", "Noise=true"},
     .strategy = SKG_STRATEGY_COPIES,
     .series = 1},
    /* scattered photons of a beam that differs over its directions, over the open beam, in an oblique scintillator */
    {.file = "scene.json",
     .settings =
         {"Samples.sheet.Path=bone.obj", "Samples.sheet.Transform=[[\"Scaling\",0.5,0.5,0.5]]", "Tolerance=0",
          "Scatter={\"Histories\":32,\"Detector\":[4,4],\"Voxel\":[5,\"mm\"]}",
          "Source.Heel={\"AnodeAngle\":20,\"Direction\":[1,0,0]}",
          "Source.Bowtie={\"Material\":\"Al\",\"Profile\":[[-20,2],[20,3]]}",
          "Detector.Grid={\"Ratio\":8,\"LinesPerCm\":40,\"StripThickness\":[0.05,\"mm\"]}",
          "Detector.EnergyResponse=null",
          "Detector.Scintillator={\"Material\":\"CsI\",\"Thickness\":600,\"Unit\":\"um\",\"Oblique\":true}"},
     .strategy = SKG_STRATEGY_COPIES,
     .ratio = 1},
    /* derivatives: priorities, compression, a world, blur */
    {.file = "scene.json",
     .settings = {"Samples.sheet.Path=bone.obj", "Samples.sheet.Transform=[[\"Scaling\",0.5,0.5,0.5]]",
                  "Samples.bone.Priority=2", "Detector.LSF=[[0.2,1,0.2],[1,2,1]]"},
     .strategy = SKG_STRATEGY_COPIES,
     .shared = 1,
     .derives = 1},
    /* and of a parallel beam, in double, along which faces lie; densities of nested parts without priorities; -ln */
    {.file = "scene.json",
     .settings = {"Samples.sheet.Path=bone.obj", "Samples.sheet.Transform=[[\"Scaling\",0.5,0.5,0.5]]",
                  "World=Vacuum", "Source.Shape=ParallelBeam", "Precision=double"},
     .strategy = SKG_STRATEGY_COPIES,
     .shared = 1,
     .ratio = 1,
     .derives = 1},
    /* the same faces of a hole that displaces a part by priority */
    {.file = "scene.json",
     .settings =
         {"Samples.sheet={\"Label\":\"sheet\",\"Cube\":[9,\"mm\"],\"Material\":[\"mu\",0],\"Priority\":2}",
          "World=Vacuum", "Source.Shape=ParallelBeam"},
     .strategy = SKG_STRATEGY_COPIES,
     .shared = 1,
     .derives = 1},
    {.file = "body.json", .breathes = 1},
    {.file = "scene.json",
     .settings = {"Tolerance=0", "World=Vacuum"},
     .strategy = SKG_STRATEGY_COPIES,
     .scans = 1}};
_Static_assert(sizeof failing_runs / sizeof *failing_runs == FAILING_RUNS, "a run was added or left out");

static void write_text(const char *folder, const char *name, const char *text) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_ge(fputs(text, file), 0);
    ck_assert_int_eq(fclose(file), 0);
}

void failing_write_scenes(const char *folder) {
    write_text(folder, "scene.json", scene_text);
    write_text(folder, "body.json", body_text);
    write_text(folder, "response.txt", response_text);
    write_text(folder, "bone.obj", bone_text);
    write_text(folder, "plate.obj", plate_text);
    write_text(folder, "sheet.stl", sheet_text);
}
