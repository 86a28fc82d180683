# Doxygen's input filter: gives each field of `double a, b;` the comment above the line, which Doxygen gives to a only.
/^ *\/\*\*/ { comment = ""; inside = 1 }
inside { comment = comment $0 "\n"; if (/\*\//) inside = 0; print; next }
/^    [A-Za-z_].*,.*;$/ && !/[(){}]/ {
    n = split($0, field, /, */)
    match(field[1], /^ *(const |struct |enum )*[A-Za-z_0-9]+ /)
    type = substr(field[1], 1, RLENGTH)
    sub(/;$/, "", field[n])
    print field[1] ";"
    for (i = 2; i <= n; i++) printf "%s%s%s;\n", comment, type, field[i]
    next
}
{ print }
