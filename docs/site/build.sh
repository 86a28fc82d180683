#!/bin/sh
# Builds the site: BUILD/site/html/index.html. A warning is an error, so that no link between pages is broken.
# usage: build.sh BUILD    a build with the package of Python and the command; needs doxygen, and the Python registry or pip's cache
# Exit status 77: something that it needs is not there.
set -eu
build=$(cd "$1" && pwd)
source=$(cd "$(dirname "$0")/../.." && pwd)
site=$build/site
skip() {
    echo "skipped: $1"
    exit 77
}
command -v doxygen >/dev/null || skip "no doxygen"
[ -x "$build/bin/skiagraph" ] || skip "$build has no command"
mkdir -p "$site"

# Anew when the list of packages has changed.
if ! cmp -s "$source/docs/site/requirements.txt" "$site/venv/requirements.txt"; then
    rm -rf "$site/venv"
    python3 -m venv "$site/venv" >"$site/venv.log" 2>&1 || skip "no venv (python3-venv)"
    "$site/venv/bin/pip" install -q -r "$source/docs/site/requirements.txt" >"$site/pip.log" 2>&1 ||
        skip "pip found no packages: $(tail -n 1 "$site/pip.log")"
    cp "$source/docs/site/requirements.txt" "$site/venv"
fi
for component in python python_gvxr; do cmake --install "$build" --component $component --prefix "$site/python"; done >"$site/install.log"
PYTHONPATH=$site/python PATH=$build/bin:$PATH
export PYTHONPATH PATH PYTHONDONTWRITEBYTECODE=1

rm -rf "$site/doctrees" "$site/html"
python3 "$source/docs/site/stage.py" "$source" "$site/source"
mkdir -p "$site/doxygen" "$site/extra"
{
    cat "$build/docs/Doxyfile"
    echo "GENERATE_HTML = NO"
    echo "GENERATE_XML = YES"
    echo "OUTPUT_DIRECTORY = $site/doxygen"
} | doxygen - >"$site/doxygen.log" 2>&1 || { cat "$site/doxygen.log"; exit 1; }

# Files that the first page shows.
skiagraph thorax -o "$site/thorax" --quiet
skiagraph view "$site/thorax/thorax.json" --seconds 4 -o "$site/extra/thorax.html" --quiet
skiagraph image "$site/thorax/thorax.json" -o "$site/extra/thorax.png" --quiet
cp "$source/docs/turned-cube.png" "$source/docs/turned-cube-gvxr.png" "$site/extra"

SKG_SITE_VERSION=$(skiagraph --version | awk '{ print $2; exit }') SKG_SITE_XML=$site/doxygen/xml SKG_SITE_CACHE=$site/notebooks \
    SKG_SITE_EXTRA=$site/extra \
    "$site/venv/bin/sphinx-build" -q -W --keep-going -c "$source/docs/site" -d "$site/doctrees" "$site/source" "$site/html"
python3 "$source/docs/site/links.py" "$site/html"
echo "$site/html/index.html: $(find "$site/html" -name '*.html' | wc -l) pages"
