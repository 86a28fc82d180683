"""Shared code of the tests of Python. Those marked `full` run where SKG_FULL is set, as ./check --full does: each says what else proves
it."""
import os

import numpy as np
import pytest

import skiagraph as sk
from skiagraph import _command

SIDE = 48
MU = 0.2


def pytest_configure(config):
    config.addinivalue_line("markers", "full: takes long, and another test proves the same")


def pytest_collection_modifyitems(config, items):
    if "SKG_FULL" not in os.environ:
        late = [item for item in items if item.get_closest_marker("full")]
        config.hook.pytest_deselected(items=late)
        items[:] = [item for item in items if item not in late]


@pytest.fixture
def command():
    """The command, which a library that was built without it does not have."""
    try:
        _command.path()
    except sk.UnsupportedError as missing:
        pytest.skip(str(missing))


@pytest.fixture
def view():
    return sk.View(source=(0, 0, -1000), detector=(0, 0, 200), column_step=(2, 0, 0), row_step=(0, 2, 0),
                   pixels=(SIDE + 16, SIDE))


@pytest.fixture
def scene(view):
    """A cube of 40 mm with a ball inside."""
    made = sk.Scene()
    made.add("block", sk.Mesh.cube(40), material=sk.Material.mu(MU))
    made.add("ball", sk.Mesh.sphere(10, 64), material=sk.Material.mu(0.5), inside="block")
    made.view = view
    made.beam = sk.Beam.mono(60, 1000)
    return made


@pytest.fixture
def poses():
    return np.stack([sk.translate(x, 0, 0) for x in np.linspace(-5, 5, 7)])
