# awk -f manual.awk -v folder=man3 -v base=context.h.3 <context.h.3: writes the page of a header that Doxygen has made as
# skiagraph_context.h.3, and a page for each of its functions.
BEGIN {
    header = substr(base, 1, length(base) - 2)
    page = folder "/skiagraph_" base
}
# To groff such a line is a request.
/^'/ { $0 = "\\&" $0 }
# Doxygen writes the day on which it ran, and itself as the author.
/^\.TH / {
    $0 = ".TH \"skiagraph/" header "\" 3 \"\" \"Skiagraph\" \"Skiagraph\""
}
/^\.SH "Author"/ { exit }
/^\.SH / { is_functions = /"Function Documentation"/ }
is_functions && /^\.SS / {
    call = substr($0, 6, length($0) - 6)
    sub(/^static /, "", call)
    sub(/\\fC \[inline.*/, "", call)
    name = call
    sub(/ *\(.*/, "", name)
    sub(/.*[ *]/, "", name)
    if (its) close(its)
    its = folder "/" name ".3"
    is_named = 0
    print > page
    next
}
{ print > page }
# The first sentence is the line of `apropos`.
is_functions && its && !is_named && !/^\./ && NF {
    brief = $0
    sub(/\\&\.( .*)?$/, "", brief)
    sub(/\\&: .*$/, "", brief)
    printf ".TH \"%s\" 3 \"\" \"Skiagraph\" \"Skiagraph\"\n.ad l\n.nh\n.SH NAME\n%s \\- %s\n", name, name, brief > its
    printf ".SH SYNOPSIS\n\\fC#include <skiagraph/%s>\\fP\n.PP\n%s\n.SH DESCRIPTION\n", header, call > its
    is_named = 1
}
is_functions && its && is_named { print > its }
