# render_pages.sh GROFF FOLDER: every man page of the folder renders without a warning.
failed=0
for page in "$2"/*.1; do
    warnings=$("$1" -man -ww -Tutf8 -z "$page" 2>&1)
    if [ $? -ne 0 ] || [ -n "$warnings" ]; then
        echo "$page: $warnings"
        failed=1
    fi
done
exit $failed
