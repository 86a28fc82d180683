"""Every public function of C is reached from Python, or listed in not_in_python.txt with a reason."""
import pathlib
import re

import skiagraph as sk

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parents[1]
#: Names that the package puts together.
MADE = {f"skg_motion_pose_at_{name}" for name in ("phase", "time")}


def functions():
    """The functions of the public headers, without those that prepare structs, which are made from the kinds."""
    found = set()
    for folder in ("lib/include/skiagraph", "host/include/skiagraph"):
        for header in (ROOT / folder).glob("*.h"):
            found |= set(re.findall(r"^SKG_API [\w ]*?[ *](skg_\w+)\(", header.read_text(), re.M))
    return {name for name in found if not name.endswith("_init_sized")}


def used():
    """The names in the package, and owners that are added and removed by the kind of a handle."""
    text = "\n".join(path.read_text() for path in pathlib.Path(sk.__path__[0]).rglob("*.py") if path.name != "_interface.py")
    words = set(re.findall(r"\bskg_\w+", text)) | MADE
    return words | {word + end for word in words for end in ("_release", "_retain", "_count", "_get")}


def listed():
    """name -> reason"""
    found = {}
    for line in (HERE / "not_in_python.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            names, reason = line.split(": ", 1)
            found.update(dict.fromkeys(names.split(), reason))
    return found


def test_every_function_of_c_is_reached_or_listed():
    there, reached, out = functions(), used(), listed()
    assert len(there) > 200
    assert there - reached == set(out) & there - reached, sorted(there - reached - set(out))
    assert not set(out) - there, "listed, and no function of C"
    assert not set(out) & reached, "listed, and reached all the same"


def test_no_message_names_a_function_of_c():
    for path in pathlib.Path(sk.__path__[0]).rglob("*.py"):
        if path.name != "_interface.py":
            for sentence in re.findall(r"(?:Error|warn)\(\s*f?\"([^\"]*)\"", path.read_text()):
                assert "skg_" not in sentence, (path.name, sentence)
