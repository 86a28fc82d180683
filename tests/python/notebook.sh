#!/bin/sh
# usage: notebook.sh SOURCE BUILD PYTHON [FOLDER for pictures]
# scene.live() in JupyterLab, which pip installs into an environment of its own, driven by Chromium. Exit status 77: it cannot be
# tried here.
set -eu
source=$1 build=$2 python=$3 pictures=${4-}
stage=$build/python-notebook
skip() {
    echo "skipped: $1"
    exit 77
}
rm -rf "$stage/site" "$stage/jupyter"
mkdir -p "$stage"
export PYTHONDONTWRITEBYTECODE=1
if ! "$stage/venv/bin/python" -c "import anywidget, cffi, jupyterlab, numpy" 2>/dev/null; then
    "$python" -m venv --clear "$stage/venv" >"$stage/venv.log" 2>&1 || skip "no venv (python3-venv)"
    "$stage/venv/bin/python" -m pip install -q anywidget cffi jupyterlab numpy >"$stage/pip.log" 2>&1 ||
        skip "pip found no packages: $(tail -n 1 "$stage/pip.log")"
fi
cmake --install "$build" --component python --prefix "$stage/site" >"$stage/install.log"
# shellcheck disable=SC2086 # a folder, or nothing
PATH=$build/bin:$PATH PYTHONPATH=$stage/site "$stage/venv/bin/python" "$source/tests/python/notebook_page.py" "$stage/jupyter" $pictures
