#!/bin/sh
# manual_test.sh FOLDER INTERFACE: every function of interface.json has its page in section 3, and groff has nothing to say of any.
set -eu
folder=$1
command -v groff >/dev/null 2>&1 || {
    echo "skipped: no groff"
    exit 77
}
bad=0
names=$(sed -n '/"functions": \[/,$s/.*{"name": "\(skg_[a-z0-9_]*\)".*/\1/p' "$2")
for name in $names; do
    page=$folder/$name.3
    if ! grep -q "^$name "'\\- .' "$page" 2>/dev/null || ! grep -q "$name (" "$page" || ! grep -q 'skiagraph_[a-z_]*\.h.*(3)' "$page"; then
        echo "$name has no page with its name, what it does, its call and its header"
        bad=1
    fi
done
said=$(cd "$folder" && groff -man -ww -z -Tutf8 ./*.3 2>&1)
if [ -n "$said" ]; then
    echo "$said"
    bad=1
fi
if grep -rl DoubleQuote "$folder"; then bad=1; fi
grep -q 'driver=\\(dq/' "$folder/skg_context_create.3" || bad=1
[ "$(find "$folder" -name 'skiagraph_*.h.3' | wc -l)" -gt 30 ] || bad=1
exit $bad
