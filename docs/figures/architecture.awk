# awk -f architecture.awk HOUSE docs/architecture.md: draws docs/architecture.svg. HOUSE lists the rooms from the ground up (the
# build writes it, tests/house/house.txt); what a room does is the row of the table in architecture.md.
function text(class, x, y, words) {
    gsub(/&/, "\\&amp;", words); gsub(/</, "\\&lt;", words)
    printf "<text class=\"%s\" x=\"%g\" y=\"%g\">%s</text>\n", class, x, y, words
}
function box(class, x, y, w, h, name, line,   n, lines, i) {
    printf "<rect class=\"%s\" x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" rx=\"4\"/>\n", class, x, y, w, h
    text("n", x + w / 2, y + 18, name)
    n = split(line, lines, "|")
    for (i = 1; i <= n; i++) text("s", x + w / 2, y + 20 + 14 * i, lines[i])
}
function arrow(x, y, to_x, to_y) { printf "<path class=\"a\" d=\"M%g %gL%g %g\"/>\n", x, y, to_x, to_y }
function room(y, name, what) {
    printf "<rect class=\"%s\" x=\"40\" y=\"%g\" width=\"500\" height=\"20\" rx=\"3\"/>\n", name ~ /^lib\/(stage|plan|frame)$/ ? "k" : name ~ /^(lib|kernels|materials)/ ? "b" : "g", y
    text("r", 48, y + 14.5, name)
    text("w", 190, y + 14.5, what)
}
function stage(y, name, host, kernels) {
    box("b", 590, y, 270, 44, name, host)
    box("b", 920, y, 220, 44, "kernels", kernels)
    arrow(860, y + 22, 918, y + 22)
    if (stages++) arrow(1030, y - 10, 1030, y - 1)
}
FNR == NR && $1 == "room" && $3 != "-" {
    name = $3
    if (match(name, /\/lib\/include\/skiagraph$/)) next
    if (match(name, /\/host\/include\/skiagraph$/)) next
    match(name, /\/(lib|host|kernels|materials|python|bench)(\/[a-z\/]*)?$/)
    rooms[++count] = substr(name, RSTART + 1)
    next
}
/^\| `[a-z\/]*` \|/ { split($0, cell, / *\| */); gsub(/`/, "", cell[2]); what[cell[2]] = cell[3] }
END {
    LONGEST = 64 # characters that a room of the drawing holds
    height = 70 + 23 * (count + 1)
    if (height < 740) height = 740
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1160 %g\" font-family=\"sans-serif\">\n", height
    print "<style>rect{stroke:#456;stroke-width:1}.b{fill:#eef3f8}.g{fill:#f4f4f0}.k{fill:#d8e6f3}text{text-anchor:middle;fill:#123}.n{font-size:14px}.s{font-size:11px}.h{font-size:18px}.r{font-size:12px;text-anchor:start}.w{font-size:11px;text-anchor:start}.a{stroke:#456;stroke-width:1.5;fill:none;marker-end:url(#m)}</style>"
    print "<defs><marker id=\"m\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#456\"/></marker></defs>"
    printf "<rect width=\"1160\" height=\"%g\" style=\"fill:#fff;stroke:none\"/>\n", height
    text("h", 290, 24, "Rooms")
    text("s", 290, 42, "a room includes and calls only those below it")
    y = 56
    room(y, "tests, examples", "what proves it, and how it is used")
    for (i = count; i > 0; i--) {
        if (!(rooms[i] in what)) { print "architecture.md says nothing of the room " rooms[i] >"/dev/stderr"; failed = 1 }
        if (length(what[rooms[i]]) > LONGEST) { print "architecture.md: too long for the drawing: " rooms[i] >"/dev/stderr"; failed = 1 }
        room(y += 23, rooms[i], what[rooms[i]])
    }
    arrow(24, 56, 24, y + 20)
    text("h", 865, 24, "The way of a frame")
    text("s", 865, 42, "once for each plan, and then for each frame")
    box("g", 590, 60, 550, 44, "skg_plan_create", "frame/create.c")
    box("k", 590, 140, 170, 80, "recipe", "plan/recipe.c|what the scene calls for,|constant")
    box("k", 780, 140, 170, 80, "machine", "frame/assemble.c|buffers, kernels,|cache of rasters")
    box("k", 970, 140, 170, 80, "outcome", "plan/outcome.c|report, times,|warnings given")
    arrow(675, 104, 675, 138); arrow(865, 104, 865, 138); arrow(1055, 104, 1055, 138)
    box("g", 590, 262, 270, 44, "skg_plan_submit", "frame/submit.c, submit_frames.c")
    arrow(675, 220, 675, 260); arrow(820, 220, 820, 260)
    box("k", 920, 262, 220, 44, "pass", "frame/parts.c: one sample")
    arrow(860, 284, 918, 284)
    text("s", 725, 332, "on the host"); text("s", 1030, 326, "on the device")
    stage(340, "project", "stage/project.c", "project.cl, fine.clh")
    stage(394, "raster", "stage/raster_run.c", "raster_*.cl, tiles.cl, bands.cl")
    stage(448, "leaky parts, priority", "stage/leaky.c, stage/hits.c", "counts.cl, leaky.cl, hits.cl")
    stage(502, "attenuate", "stage/attenuate.c", "attenuate.cl")
    stage(556, "blur", "stage/layers.c, stage/blur.c", "blur.cl")
    stage(610, "detect", "stage/detect.c", "detect.cl")
    box("g", 590, 664, 270, 44, "skg_job_wait", "frame/job.c")
    box("g", 920, 664, 220, 44, "image", "caller’s memory or cl_mem")
    arrow(1030, 654, 1030, 663)
    print "</svg>"
    exit failed
}
