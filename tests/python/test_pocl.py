"""Drivers that are not installed: driver=PATH, and the one of the package pocl-binary-distribution."""
import os
import pathlib
import subprocess
import sys

import pytest

import skiagraph as sk

IMAGE = """if True:
    import hashlib, os, skiagraph as sk
    before = dict(os.environ)
    scene = sk.Scene({"Source": {"Position": [0, -40, 0, "cm"], "Shape": "PointSource",
                                 "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
                      "Detector": {"Position": [0, 10, 0, "cm"], "UpVector": [0, 0, -1],
                                   "NumberOfPixels": [64, 48], "Size": [32, 24, "cm"]},
                      "Samples": [{"Label": "block", "Cube": [80, "mm"], "Material": ["mu", 0.2]}]})
    print(hashlib.sha256(scene.image().tobytes()).hexdigest())
    assert dict(os.environ) == before
"""


@pytest.fixture(scope="module")
def library():
    """The library of an installed driver."""
    sk.Device().close()
    for icd in sorted(pathlib.Path("/etc/OpenCL/vendors").glob("*.icd")):
        name = icd.read_text().strip()
        for line in pathlib.Path("/proc/self/maps").read_text().splitlines():
            path = line.split(maxsplit=5)[-1]
            if os.path.basename(path) == os.path.basename(os.path.realpath(name)):
                return path
    pytest.skip("no driver of /etc/OpenCL/vendors is loaded")


@pytest.fixture
def bare(tmp_path, library):
    """Runs a program where the OpenCL loader finds no driver; a package like pocl-binary-distribution may be there."""
    (tmp_path / "vendors").mkdir()

    def run(program, package=True, expect=0, **variables):
        site = tmp_path / f"site-{package}"
        if package:
            info = site / "pocl_binary_distribution-3.0.dist-info"
            info.mkdir(parents=True, exist_ok=True)
            (info / "METADATA").write_text("Metadata-Version: 2.1\nName: pocl-binary-distribution\nVersion: 3.0\n")
            (info / "RECORD").write_text("pocl_binary_distribution/.libs/pocl.icd,,\n")
            libraries = site / "pocl_binary_distribution" / ".libs"
            libraries.mkdir(parents=True, exist_ok=True)
            (libraries / "pocl.icd").write_text(library + "\n")
        environment = {name: value for name, value in os.environ.items() if name != "SKG_DEVICE"}
        environment.update(OCL_ICD_VENDORS=str(tmp_path / "vendors"), **variables,
                           PYTHONPATH=os.pathsep.join([str(site), *sys.path]))
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment, check=False)
        assert done.returncode == expect, done.stderr
        return done.stdout + done.stderr

    return run


def test_the_package_is_found_where_nothing_else_is(bare, library):
    with_loader = subprocess.run([sys.executable, "-c", IMAGE], capture_output=True, text=True, check=True).stdout
    assert bare(IMAGE) == with_loader
    assert bare(IMAGE, package=False, SKG_DEVICE=f"driver={library}") == with_loader
    assert bare("import skiagraph as sk; sk.Device(); sk.Device(); print(len(sk.devices()) > 0)") == "True\n"
    assert bare("import skiagraph as sk; print(sk.Device('cpu threads=1').info['compute_units'])") == "1\n"
    assert bare("import skiagraph as sk; print(len(sk.devices()) > 0)", SKG_DEVICE="Babbage") == "True\n"


def test_without_it_the_sentence_says_how_to_install_it(bare):
    said = bare("import skiagraph as sk; sk.Device()", package=False, expect=1)
    assert "NoDeviceError: no OpenCL device on this machine" in said and 'pip install "skiagraph[pocl]"' in said
    assert bare("import skiagraph as sk; print(sk.devices())", package=False) == "[]\n"


def test_without_a_compiler_pocl_is_not_started(bare, tmp_path):
    """PoCL 3.0 would end the process."""
    said = bare("import skiagraph as sk; sk.Device()", expect=1, PATH=str(tmp_path))
    assert "NoDeviceError" in said and "C compiler's tools" in said and "Aborted" not in said


def test_what_is_asked_for_wins(bare, library):
    asked = "import skiagraph as sk; sk.Device()"
    assert "driver=/no/such.so cannot be loaded" in bare(asked, expect=1, SKG_DEVICE="driver=/no/such.so")
    assert "no device that fits device=Babbage" in bare(asked, expect=1, SKG_DEVICE="Babbage")
    said = bare("import skiagraph as sk; sk.Device('driver=/no/such.so')", expect=1)
    assert "driver=/no/such.so cannot be loaded" in said and "pip install" not in said


def test_another_driver_wins():
    assert sk._pocl.word() is None
    assert sk._pocl.configuration("threads=1") == "threads=1"


def test_a_driver_by_its_path(library):
    with sk.Device(f'driver="{library}" threads=1') as device:
        assert device.info["compute_units"] == 1
    with pytest.raises(sk.NoDeviceError, match="cannot be loaded"):
        sk.Device(f"driver={__file__}")
