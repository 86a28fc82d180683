# From the facts of house.sh to arrows: FROM TO "includes" FILE, or FROM TO "calls" NAME.
# skiagraph.hpp keeps its ending: it includes the header of the same name.
function stem(path) { if (path !~ /\.hpp$/) sub(/\.[a-z]+$/, "", path); return path }
# An object's file, as room/file without ending. Folders above the room's are left out.
function node(room, object,   name, start) {
    name = object
    sub(/.*\.dir\/(\.\/)?/, "", name) # Ninja writes X.dir/./file
    sub(/\.o$/, "", name)
    if (name ~ /^\// || name ~ /__\//) sub(/.*\//, "", name) # made at build time
    sub(/^\.\//, "", name) # Ninja names them ./room/file
    sub(/^\.\.\//, "", name)
    name = stem(name)
    start = index("/" name, "/" room "/")
    return start ? substr(name, start) : room "/" name
}
$1 == "file" { known[$2] = 1 }
$1 == "hook" { hook[$2] = 1 }
$1 == "include" { n++; from[n] = $2; what[n] = $3 }
$1 == "import" { n++; from[n] = $2; what[n] = $3 }
$1 == "symbol" {
    symbols++
    at[symbols] = node($2, $4); program[symbols] = $3; name[symbols] = $5; type[symbols] = $6
    if ($6 !~ /[Uw]/) {
        own[$3, $5] = at[symbols]
        if ($3 !~ /^program:/) shared[$5] = at[symbols]
        if ($6 ~ /[RD]/) data[$5] = 1
    }
}
END {
    for (i = 1; i <= n; i++) {
        path = substr(what[i], 2, length(what[i]) - 2)
        folder = from[i]
        sub(/[^\/]*$/, "", folder)
        to = ""
        if (what[i] ~ /^<skiagraph\//) {
            sub(/^skiagraph\//, "", path)
            to = ("host/include/" path) in known ? "host/include/" path : "include/" path
        } else if (what[i] ~ /^\./) { # of Python: one dot is the folder, two dots the one above
            path = what[i]
            sub(/\/$/, "", folder)
            for (sub(/^\./, "", path); sub(/^\./, "", path);) sub(/\/[^\/]*$/, "", folder)
            gsub(/\./, "/", path)
            to = folder "/" path ".py"
            if (!(to in known)) to = folder "/" path "/__init__.py"
            if (!(to in known)) to = ""
        } else if (what[i] ~ /^"/) {
            if ((folder path) in known) to = folder path
            else if (from[i] ~ /^bench\// && ("bench/" path) in known) to = "bench/" path
            else if (from[i] ~ /^(cli|bench)\// && ("cli/" path) in known) to = "cli/" path
            else if (path in known) to = path
            else if (("kernels/shared/" path) in known) to = "kernels/shared/" path
        }
        if (to != "" && stem(to) != stem(from[i])) print stem(from[i]), stem(to), "includes", path
    }
    for (i = 1; i <= symbols; i++) {
        if (type[i] !~ /[Uw]/) continue
        to = (program[i], name[i]) in own ? own[program[i], name[i]] : shared[name[i]]
        if (name[i] in hook && name[i] in data) continue
        if (to != "" && to != at[i]) print at[i], to, "calls", name[i]
    }
}
