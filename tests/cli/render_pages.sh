# render_pages.sh FOLDER: every man page of the folder renders without a warning. 77: groff is not installed.
command -v groff >/dev/null || { echo "skipped: no groff"; exit 77; }
failed=0
for page in "$1"/*.1; do
    warnings=$(groff -man -ww -Tutf8 -z "$page" 2>&1)
    if [ $? -ne 0 ] || [ -n "$warnings" ]; then
        echo "$page: $warnings"
        failed=1
    fi
done
exit $failed
