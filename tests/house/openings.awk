# Prints each comment and docstring that begins with a word that names nothing: FILE:LINE OPENING. A reader who sees the comment alone must
# know its subject, so it begins with a noun or a verb ("Digest of ...", "Reads ..."). There are no exceptions; a question is a sentence with
# a noun, too.
function begins_empty(text) {
    return text ~ /^(--- )?(What|The same|Those|That|They|Them|It|Its|Who|Whoever|Whatever|So many)([^A-Za-z0-9_]|$)/
}
FNR == 1 { hash = FILENAME ~ /\.(py|sh|cmake|awk)$|CMakeLists\.txt$/; python = FILENAME ~ /\.py$/; open = "" }
{
    text = ""
    if (open != "") { # a comment whose first line has no words, or "@file" alone
        text = $0
        sub(/^ *\*? */, "", text)
    } else if (hash && match($0, /(^|[ \t])#+ /)) text = substr($0, RSTART + RLENGTH)
    else if (python && match($0, /(^|[ \t])r?"""/)) text = substr($0, RSTART + RLENGTH)
    else if (!hash && match($0, /\/\*+<? *(@file *)?|(^|[ \t;{}])\/\/+<? */)) text = substr($0, RSTART + RLENGTH)
    if (begins_empty(text)) print FILENAME ":" FNR " " substr(text, 1, 40)
    open = ""
    if ($0 ~ /^ *(\/\*\*?( @file)?|r?""")$/) open = $0
}
