"""released.py finds each change that would stop a program of the release, and lets pass what would not.

    python3 released_test.py INTERFACE
"""
import copy
import json
import pathlib
import sys

import released

INTERFACE = json.loads(pathlib.Path(sys.argv[1]).read_text())
RELEASED = {"version": "0.1.0", "soversion": "0", "interface": INTERFACE}


def find(key, name):
    return lambda new: released.named(new[key])[name]


def take_out(key, name):
    return lambda new: new[key].remove(find(key, name)(new))


def edit(key, name, change):
    return lambda new: change(find(key, name)(new))


def new_function(**more):
    return lambda new: new["functions"].append({"name": "skg_new", "header": "mesh.h", "returns": "skg_status",
                                                "parameters": [], **more})


def new_field(offset):
    return edit("structs", "skg_view", lambda view: view["fields"].append(
        {"name": "new", "type": "double", "count": 1, "offset": view["size"] + offset, "size": 8}))


def swap_fields(struct):
    one, other = struct["fields"][1:3]
    one["offset"], other["offset"] = other["offset"], one["offset"]


# A change, the version that makes it, and a word of the sentence about it; None: it may be made.
CASES = [
    (lambda new: None, "0.1.0", None),
    (take_out("functions", "skg_mesh_load"), "0.1.0", "interface_keep"),
    (take_out("functions", "skg_mesh_load"), "0.2.0", "function skg_mesh_load is gone; a program of 0.1.0"),
    (edit("functions", "skg_mesh_load", lambda f: f["parameters"].pop()), "0.2.0", "skg_mesh_load"),
    (edit("functions", "skg_mesh_load", lambda f: f["parameters"][0].__setitem__(0, "renamed")), "0.2.0", None),
    (edit("callbacks", "skg_progress_function", lambda f: f.__setitem__("returns", "void")), "0.2.0", "skg_progress_function"),
    (take_out("structs", "skg_view"), "0.2.0", "struct skg_view is gone"),
    (edit("structs", "skg_view", swap_fields), "0.2.0", "skg_view.columns"),
    (edit("structs", "skg_view", lambda s: s["fields"][1].__setitem__("type", "double")), "0.2.0", "skg_view.projection"),
    (edit("structs", "skg_view", lambda s: s["fields"].pop()), "0.2.0", "skg_view.radius"),
    (new_field(-4), "0.2.0", "put it at the end"),
    (new_field(0), "0.2.0", None),
    (edit("enums", "skg_type", lambda e: e["values"][0].__setitem__(1, 7)), "0.2.0", "SKG_TYPE_FLOAT32: 0 has become 7"),
    (edit("enums", "skg_type", lambda e: e["values"].append(["SKG_TYPE_NEW", 9])), "0.2.0", None),
    (lambda new: new["macros"].remove("SKG_FAILED"), "0.2.0", "SKG_FAILED is gone"),
    (lambda new: new["handles"].remove("skg_mesh"), "0.2.0", "skg_mesh is gone"),
    (new_function(), "0.1.0", None),
    (new_function(), "0.2.0", "skg_new: since 0.1.0, but 0.1.0 does not have it; add @since 0.2.0"),
    (new_function(since="0.2.0"), "0.2.0", None),
    (new_function(since="0.2.0"), "0.10.0", None),
    (new_function(since="0.3.0"), "0.2.0", "and this is 0.2.0"),
    (edit("functions", "skg_mesh_load", lambda f: f.__setitem__("since", "0.2.0")), "0.2.0", "skg_mesh_load: since 0.2.0"),
]


def main():
    for change, version, word in CASES:
        new = copy.deepcopy(INTERFACE)
        change(new)
        found = released.check(new, RELEASED, version, "0")
        assert bool(found) == bool(word), (version, word, found)
        assert not word or any(word in sentence for sentence in found), (word, found)
    new = copy.deepcopy(INTERFACE)
    take_out("functions", "skg_mesh_load")(new)
    assert not released.check(new, RELEASED, "1.0.0", "1"), "another number of the interface may break what it likes"
    print(f"{len(CASES) + 1} changes")


main()
