# Prints each struct with more than `most` members: FILE NAME MEMBERS. A declaration of several names has as many members.
function note() { if (count > most) print FILENAME, name, count }
{
    line = $0
    gsub(/"([^"\\]|\\.)*"/, "", line)
    while (comment || line ~ /\/\*/) { # comments
        if (comment) {
            if (!match(line, /\*\//)) { line = ""; break }
            line = substr(line, RSTART + 2); comment = 0
        } else {
            match(line, /\/\*/)
            head = substr(line, 1, RSTART - 1); line = substr(line, RSTART + 2)
            if (match(line, /\*\//)) line = head substr(line, RSTART + 2)
            else { comment = 1; line = head; break }
        }
    }
}
!depth && line ~ /^(typedef )?struct( [a-z_]+)? \{/ { depth = 1; count = 0; pending = ""; name = $0; sub(/^(typedef )?struct /, "", name); sub(/ ?\{.*/, "", name); next }
depth {
    pending = pending line
    opened = gsub(/\{/, "{", line); closed = gsub(/\}/, "}", line)
    depth += opened - closed
    if (depth == 0) {
        if (match(line, /\} *[a-z_]+;/)) { name = substr(line, RSTART + 1, RLENGTH - 2); gsub(/ /, "", name) }
        gsub(/\([^()]*\)/, "", pending) # the arguments of functions
        gsub(/\([^()]*\)/, "", pending)
        sub(/\}[^}]*$/, "", pending)
        n = split(pending, declaration, ";")
        for (i = 1; i < n; i++) count += gsub(/,/, ",", declaration[i]) + 1
        note()
        pending = ""
    }
}
