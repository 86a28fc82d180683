# Doxygen's input filter. Gives each field of `double a, b;` the comment above the line, which Doxygen gives to a only, and
# writes out what SKG_INIT declares. -v quote=TEXT: instead of double quotes.
/^ *\/\*\*/ { comment = ""; inside = 1 }
inside {
    if (quote) gsub(/\\?"/, quote)
    # Rows of a table, `    name    what it is`, become a list: Doxygen would run them together, or show them as code.
    if (match($0, /^ \*     [^ ]+( [^ ]+)*  +/)) {
        name = substr($0, 8, RLENGTH - 7)
        sub(/ +$/, "", name)
        $0 = " * - **" name "**: " substr($0, RLENGTH + 1)
        row = 1
        nested = 0
    } else if (row && match($0, /^ \*       +/)) {
        # Words of a row have a row each: `device=cpu   what it is`.
        text = substr($0, RLENGTH + 1)
        if (text ~ /^[a-z]+=[A-Za-z]/) {
            nested = RLENGTH
            sub(/  +/, ": ", text)
            $0 = " *   - " text
        } else if (nested && RLENGTH > nested) $0 = " *     " text
        else {
            $0 = (nested ? " *\n" : "") " *   " text
            nested = 0
        }
    } else row = 0
    comment = comment $0 "\n"
    if (/\*\//) inside = row = 0
    print
    next
}
/^    [A-Za-z_].*,.*;$/ && !/[(){}]/ {
    n = split($0, field, /, */)
    match(field[1], /^ *(const |struct |enum )*[A-Za-z_0-9]+ /)
    type = substr(field[1], 1, RLENGTH)
    sub(/;$/, "", field[n])
    print field[1] ";"
    for (i = 2; i <= n; i++) printf "%s%s%s;\n", comment, type, field[i]
    next
}
/^SKG_INIT\(/ {
    gsub(/^SKG_INIT\(|\)$/, "")
    print "/** Prepares a struct of `size` bytes (export.h). */\nSKG_API void " $0 "_init_sized(void *object, int32_t size);\n"
    print "/** Prepares a struct with its defaults. */\nstatic inline void " $0 "_init(" $0 " *object);"
    next
}
{ print }
