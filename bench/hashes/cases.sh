# The cases of bench/hashes/run, which reads this file: a function a section, a line a command.

# A function a verb; SCENE without .json, so that the name of a case is the command without its outputs.
image() { scene=$1; shift; try "image $scene $*" image "$scene.json" "$@" --json -o out/image.mha; }
lbuffer() { scene=$1; shift; try "lbuffer $scene $*" lbuffer "$scene.json" "$@" --json -o out/lengths.mha; }
plan() { scene=$1; shift; try "plan $scene $*" plan "$scene.json" "$@" --json; }
files() { verb=$1 scene=$2; shift 2; try "$verb $scene $*" "$verb" "$scene.json" "$@" -o out/a.png -o out/a.tif; }
moment() { try "breathe $*" breathe breath.json "$@" --json -o out/frame.mha; }
breathe() { try "breathe $*" breathe breath.json "$@" --json -o out/frames --meshes out/meshes; }
beam() { try "beam $*" beam "$@" --json -o out/beam.csv; }
material() { try "material $*" material "$@" --json -o out/material.csv; }

meshes() {
    for triangles in 10000 42000; do
        try "thorax --simple --triangles $triangles" thorax --simple --triangles $triangles -o out/thorax
        try "thorax --triangles $triangles" thorax --triangles $triangles -o out/thorax
    done
    for file in liver.stl heart.obj lung.ply thorax/liver.ply thorax/spine.ply; do
        try "mesh $file" mesh "$file" --unit cm --json
    done
}

# Every strategy, precision, tolerance and quantity; images of one pixel, one row, odd sizes and several tiles.
strategies() {
    for strategy in auto copies tiles atomics; do
        for precision in half single double; do
            image body --precision $precision --strategy $strategy
            image thorax --precision $precision --strategy $strategy
        done
        image leaky --strategy $strategy
        image leaky --precision double --strategy $strategy
        for size in 1,1 33,65 700,500; do
            image body --strategy $strategy --set "Detector.NumberOfPixels=[$size]"
            image leaky --strategy $strategy --set "Detector.NumberOfPixels=[$size]"
        done
    done
    image leaky --precision half # refused
    image body --precision double --strategy tiles --set Detector.NumberOfPixels=[700,500]
    image thorax --strategy tiles --set Detector.NumberOfPixels=[1024,1024]
    image body --set Detector.NumberOfPixels=[203,1]
    image body --device 'cpu threads=1' --repeat 2
    for scene in body leaky thorax; do
        for tolerance in 0 1e-4; do
            image $scene --tolerance $tolerance
            image $scene --tolerance $tolerance --precision double
            plan $scene --tolerance $tolerance
        done
        plan $scene --tolerance 1e-2
        for quantity in fluence photons transmission attenuation; do
            image $scene --quantity $quantity
        done
    done
    for quantity in photons attenuation; do
        image body --quantity $quantity --precision half
        image body --quantity $quantity --precision double
    done
}

# Leaky meshes: repair, turned inside out, beside every way to take more rays.
leaky() {
    for repair in none neighbours exact; do
        for strategy in copies tiles atomics; do
            image leaky --set Repair=$repair --strategy $strategy
        done
        image leaky --set Repair=$repair --precision double
        image leaky --set Repair=$repair --set Detector.Oversampling=3
        image leaky --set Repair=$repair --set 'Source.Shape=["Disc",4,"mm"]' --set Source.Samples=5
        image leaky --set Repair=$repair --set Source.Shape=Parallel
        lbuffer leaky --part liver --set Repair=$repair
        lbuffer leaky --part liver --surface --set Repair=$repair --precision double
    done
    image leaky --set Samples.heart.FlipNormals=true
    image leaky --set Samples.heart.MoveToCentre=true
    image leaky --set Source.Position='[0,-60,-90,"mm"]'
    image leaky --set Repair=exact --set Detector.PSF=[[1,2,1],[2,4,2],[1,2,1]] --quantity attenuation
    image leaky --bands 30,50,70 --quantity photons
}

# Overlaps, nesting, the world around, and sources among the samples. "aside" leaves its parent.
lines='[{"Energy":40,"Unit":"keV","PhotonCount":100},{"Energy":0.06,"Unit":"MeV","PhotonCount":900}]'
overlap='Samples.cyst.Transform=[["Translation",-2,5,9,"mm"]]'
aside='Samples.cyst.Transform=[["Translation",-38,5,9,"mm"]]'
nesting() {
    for strategy in copies tiles atomics; do
        image body --set "$overlap" --set Samples.cyst.Priority=2 --strategy $strategy
        image body --set "$aside" --set Clip=true --strategy $strategy
        image body --set Source.Position='[0,-30,0,"mm"]' --strategy $strategy
    done
    image body --set "$overlap"
    image body --set "$aside"
    image body --set "$overlap" --set Samples.bone.Priority=1 --set Clip=true --precision double
    image body --set "$overlap" --set Samples.cyst.Priority=2 --set Detector.Oversampling=2
    lbuffer body --part bone --set "$overlap" --set Samples.cyst.Priority=2
    image body --set Samples.bone.Parent=null --set Samples.cyst.Parent=null
    image body --set Samples.skin.Type=outer --set Samples.wedge.Parent=skin
    image body --set Samples.2.Material='["mu",0.2]' --set Samples.3.Density=1.3
    image body --set 'Samples.stone.Transform=[["Scaling",1,2,0.5],["Matrix",[1,0,0,0,0,1,0,0,0,0,1,0,-9,3,4,1]]]'
    for world in Air '["Compound","H2O"]'; do
        image body --set World="$world"
        image body --set World="$world" --precision double --set Source.Shape=Parallel
    done
    for place in '[0,-30,0,"mm"]' '[5,0,2,"mm"]' '[-18,-9,9,"mm"]'; do
        image body --set Source.Position="$place" --precision double
        image body --set Source.Position="$place" --set Source.Shape=Parallel
        image body --set Source.Position="$place" --set Samples.bone.Priority=1 --set "$overlap"
    done
}

# Parallel beams, extended sources (grids, samples asked for and adaptive, an axis), more rays a pixel.
sources() {
    far='"Direction":[0.1,1,0.05],"Shape":"Parallel"'
    for precision in single double; do
        image body --set Source.Shape=Parallel --precision $precision
        image body --precision $precision --set "Source={$far,\"Beam\":$lines}"
    done
    for shape in '"Line",6' '"Rectangle",6,4' '"Cube",5' '"Disc",6' '"Sphere",6' '"Gaussian",5,3'; do
        image body --set "Source.Shape=[$shape,\"mm\"]"
        image body --set "Source.Shape=[$shape,\"mm\"]" --set Source.Samples=7 --precision double
        image body --set "Source.Shape=[$shape,\"mm\"]" --set Source.Samples=5 --set Source.Axis=[0.2,1,0]
    done
    image body --set 'Source.Shape=["FocalSpot",5,"mm",2]'
    image body --set 'Source.Shape=["Cube",5,"mm"]' --set Source.Grid=3
    image body --set 'Source.Shape=["Rectangle",6,4,"mm"]' --set Source.Grid=2 --set Detector.Oversampling=2
    image body --set 'Source.Shape=["Disc",12,"mm"]' --set Source.SampleTolerance=0.002
    for rays in 2 3 8; do
        image body --set Detector.Oversampling=$rays
        image body --set Detector.Oversampling=$rays --precision double --strategy tiles
    done
    image body --set Detector.Oversampling=2 --precision half
}

# Noise, blur, steps, response, scintillator, falloff, bands, poses of the detector, a scan.
detector() {
    for noise in true '{"Seed":7}' '{"Electronic":[2.5,"keV"],"Quantum":false}' '{"Step":[50,"keV"],"Quantum":false}' \
        '{"Seed":3,"Swank":0.8,"Electronic":[30,"keV"],"Step":[5,"keV"]}'; do
        image body --set Noise="$noise" --set Source.Beam="$lines"
        image body --set Noise="$noise" --set Source.Beam="$lines" --precision double
        image body --set Noise="$noise" --set Source.Beam="$lines" --set Detector.LSF=[0.1,0.8,0.1] --bands 30,50,70
    done
    for key in LSF=[0.1,0.8,0.1] LSF=[[0.2,0.6,0.2],[0.05,0.1,0.7,0.1,0.05]] PSF=[[1,2,1],[2,4,2],[1,2,1]] \
        PSF=[[0,0.1,0],[0.1,0.6,0.1],[0,0.1,0]] 'EnergyResponse={"LUT":[[10,10],[30,28],[90,61.5]],"Unit":"keV"}' \
        'Scintillator={"Material":"CsI","Thickness":600,"Unit":"um","Packing":0.8}' \
        'Scintillator={"Material":"CsI","Thickness":150,"Unit":"mg/cm2"}' 'UpVector=[0.3,0.1,-1]' \
        'Position=[30,160,-20,"mm"]' 'Size=[130,77,"mm"]'; do
        image body --set "Detector.$key"
        image body --set "Detector.$key" --precision double --tolerance 1e-4
    done
    image body --set Falloff=true
    image body --set Falloff=true --set 'Source.Shape=["Disc",6,"mm"]' --set Source.Samples=5 --precision double
    image body --set Source.Beam.mAs=2 --set Noise=true
    image body --bands 20,40,60,80
    image body --bands 20,33.5,80 --quantity photons --tolerance 1e-4 --precision double
    image body --set 'Scan={"NumberOfProjections":4,"AngleStep":90,"StartAngle":37}'
    scan='"NumberOfProjections":20,"FinalAngle":360,"StartAngle":5'
    image body --tolerance 1e-3 --set "Scan={$scan,\"CentreOfRotation\":[3,4,5],\"RotationAxis\":[0.1,0,1]}"
}

# Path lengths, errors of the dials, files of the other formats.
outputs() {
    for part in skin bone marrow wedge; do
        for precision in half single double; do
            lbuffer body --part $part --precision $precision
        done
        lbuffer body --part $part --surface --strategy atomics
    done
    lbuffer body --part skin --strategy tiles
    lbuffer thorax --part 'lung left' --surface
    lbuffer thorax --part liver --precision double
    for scene in body leaky; do
        try "cost $scene" cost $scene.json --quick --json --set Detector.NumberOfPixels=[24,20]
    done
    files image body
    files image body --display transmission --range 0.1:0.8
    files image body --precision double --bands 20,40,60,80
    files image body --set Detector.RightVector=[1,0.1,0.2]
    files lbuffer body --part skin --range 0:50
}

# Phases, times among the events, sequences with every mesh and motion.csv, dials of the body.
breathing() {
    for phase in 0 0.2 0.5 0.85; do
        moment --phase $phase
    done
    for time in 0.7 3 6 8 11; do
        moment --at $time --precision double
    done
    breathe --seconds 12 --fps 2
    breathe --seconds 1 --fps 8 --tolerance 1e-4 --outline ribs,diaphragm@0
    links='[{"To":"rib","Distance":[15,"mm"],"RigidDistance":[3,"mm"]}]'
    for set in 'Pattern="diaphragmatic"' 'Pattern="thoracic"' 'Pattern="shallow"' 'Pattern="deep"' \
        'Pattern="hyperventilation"' 'Waveform="Sine"' 'Waveform="Lujan"' 'Waveform="Asymmetric"' \
        'Waveform=[1,0.7,0,0.2]' Hysteresis=1 Relaxation=3 LungDensity=false 'RibAxes="Bones"' Reference=0.5 \
        'Tendon=[0,1,-22,"mm"]' ThoracicLag=0.1 'Organs={"heart":{"Kind":"Static"},"liver":{"Tissue":[0.6,1.3,0.2]}}' \
        'Organs={"sternum body":{"Kind":"Rigid","Gamma":2,"Lambda":-3}}' \
        'Organs={"clavicle left":{"Kind":"Rigid","Axis":[1,0,0],"Angle":4},"stomach":{"As":"liver"}}' \
        "Organs={\"spleen\":{\"Kind\":\"Deformable\",\"Links\":$links}}"; do
        breathe --set Breathing.Events=[] --set "Breathing.$set" --seconds 3 --fps 1
    done
}

# Tables: every material by name, elements, tissues; beams; what is refused with which status.
each_material() { # names on standard input; one hash of all
    count=0
    while read -r word; do
        count=$((count + 1))
        "$skg" material "$word" --json --energy 5:150:7.25 >out/$count.json 2>>messages ||
            echo '"failed"' >out/$count.json
    done
    hash_out "material, $count $1"
}
tables() {
    "$skg" material --list | sed 's/^.*g\/cm3  *//; s/;.*//' | each_material 'of the tables'
    for symbol in H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca Sc Ti V Cr Mn Fe Co Ni Cu Zn Ga Ge As Se Br Kr \
        Rb Sr Y Zr Nb Mo Tc Ru Rh Pd Ag Cd In Sn Sb Te I Xe Cs Ba La Ce Pr Nd Pm Sm Eu Gd Tb Dy Ho Er Tm Yb Lu Hf Ta \
        W Re Os Ir Pt Au Hg Tl Pb Bi Po At Rn Fr Ra Ac Th Pa U; do
        echo $symbol
    done | each_material elements
    seq -1050 75 3000 | sed 's/^/HU:/' | each_material 'tissues by Hounsfield number'
    for name in Fe weight:Ti90Al6V4 mu:0.2 'soft tissue icru44'; do
        material "$name"
    done
    material H2O --density 0.917 --energy 1:20000:777
    material HU:300 --naive bilinear
    material HU:300 --naive bilogarithmic
    for model in ebel birch; do
        for kv in 25 50 80 120 150; do
            beam --model $model --kvp $kv --filter Al:2.5 --filter Cu:0.1
        done
        beam --model $model --kvp 100 --angle 8 --bin 0.5 --mas 3 --distance 700 --filter Al:3
        beam --model $model --kvp 100 --filter Al:3 --output 65uGy/mAs@100cm
    done
    printf '20 5\n40 100.5\n60 33\n' >beam.txt
    printf '/gps/hist/point 0.02 1\n/gps/hist/point 0.04 7\n/gps/hist/point 0.08 3\n' >beam.mac
    beam --file beam.txt --unit keV --filter Al:1
    beam --file beam.mac --unit MeV
    image body --set 'Source.Beam={"TextFile":"beam.txt","Unit":"keV"}'
    output='"Output":[65,"uGy/mAs",100,"cm"]'
    image body --set "Source.Beam={\"kVp\":100,\"Model\":\"Birch\",\"Filter\":[[\"Cu\",0.2,\"mm\"]],$output}"
    image body --set Detector.NumberOfPixel=[3,3]
    image body --set Samples.bone.Material=Unobtainium
    lbuffer body --part nothing
    beam --kvp 900
}
