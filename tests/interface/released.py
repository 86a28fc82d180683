"""Compares the interface with that of the last release: an older program still runs, and what is new says since when.

    python3 released.py check INTERFACE RELEASED VERSION SOVERSION
    python3 released.py keep INTERFACE RELEASED VERSION SOVERSION

INTERFACE is lib/bindings/interface.json, RELEASED the same of a release, compressed: released.json.gz. `keep` writes it anew, which is
a step of a release (CONTRIBUTING.md). Nodes of versions and what the library exports are interface_symbols's.

Descriptions of a binary (abidw, abidiff) are no help here. Every signature has int32_t for the enums, so that they name no enumerator.
A struct may grow at its end, which callers say by its size; abidiff of Debian 12 lets it by a suppression
(has_data_member_inserted_at = end) that also hides a field of another type and fields that changed places. And a library has private
structs beside the public ones, or no types where it is built without debug information.
"""
import gzip
import json
import pathlib
import sys


def number(version):
    return tuple(int(part) for part in version.split("."))


def named(items):
    return {item["name"]: item for item in items}


def signature(function):
    """Types with which a caller was compiled; names of parameters do not count."""
    return [function["returns"], [kind for _, kind in function["parameters"]]]


def compare_functions(old, new, what):
    """Changes of functions, or of the callbacks that programs hand over."""
    for name, function in named(old).items():
        its = named(new).get(name)
        if its is None:
            yield f"{what} {name} is gone"
        elif signature(its) != signature(function):
            yield f"{what} {name}: {signature(function)} has become {signature(its)}"


def compare_structs(old, new):
    """A struct grows at its end: bytes between fields, and those after the last one, are garbage in older programs."""
    for name, struct in named(old).items():
        its = named(new).get(name)
        if its is None:
            yield f"struct {name} is gone"
            continue
        before, now = named(struct["fields"]), named(its["fields"])
        for field in before:
            if now.get(field) != before[field]:
                yield f"field {name}.{field}: {before[field]} has become {now.get(field, 'nothing')}"
        for field in now.keys() - before.keys():
            if now[field]["offset"] < struct["size"]:
                yield (f"field {name}.{field} begins at byte {now[field]['offset']}, inside the {struct['size']} bytes that older "
                       "programs have; put it at the end")


def compare_values(old, new):
    for name, enum in named(old).items():
        now = dict(named(new).get(name, {"values": []})["values"])
        for value, its in enum["values"]:
            if now.get(value) != its:
                yield f"{value}: {its} has become {now.get(value, 'nothing')}"


def breaks(old, new):
    """Changes with which a program of the release does not run, or does something else."""
    yield from compare_functions(old["functions"], new["functions"], "function")
    yield from compare_functions(old["callbacks"], new["callbacks"], "callback")
    yield from compare_structs(old["structs"], new["structs"])
    yield from compare_values(old["enums"], new["enums"])
    for key in ("handles", "macros"):
        for name in old[key]:
            if name not in new[key]:
                yield f"{name} is gone"


def since(interface, function):
    return function.get("since", interface["since"][function["header"]])


def ages(released, new, version):
    """Functions whose @since is wrong. A release that has a function says since when; later ones are younger than it."""
    before = named(released["interface"]["functions"])
    for name, function in named(new["functions"]).items():
        its = since(new, function)
        if name in before:
            if its != since(released["interface"], before[name]):
                yield f"{name}: since {its}, but {released['version']} has it since {since(released['interface'], before[name])}"
        elif number(its) > number(version):
            yield f"{name}: since {its}, and this is {version}"
        elif number(released["version"]) < number(version) and number(its) <= number(released["version"]):
            yield f"{name}: since {its}, but {released['version']} does not have it; add @since {version} to its comment"


def check(new, released, version, soversion):
    """Violations of the released interface, a sentence each."""
    found = list(ages(released, new, version))
    if soversion == released["soversion"]:
        mend = ("a program of {0} would not run: raise SKG_SOVERSION in CMakeLists.txt" if released["version"] != version else
                "if {0} is not out yet: cmake --build BUILD --target interface_keep; or else raise SKG_SOVERSION in CMakeLists.txt")
        found += [f"{one}; {mend.format(released['version'])}" for one in breaks(released["interface"], new)]
    return found


def read(path):
    return json.loads(gzip.decompress(pathlib.Path(path).read_bytes()))


def main():
    if len(sys.argv) != 6 or sys.argv[1] not in ("check", "keep"):
        sys.exit(__doc__)
    new, path, version, soversion = json.loads(pathlib.Path(sys.argv[2]).read_text()), *sys.argv[3:]
    found = []
    if sys.argv[1] == "check":
        found = check(new, read(path), version, soversion)
    elif pathlib.Path(path).exists():
        found = list(ages(read(path), new, version))
    if found:
        sys.exit("\n".join(found))
    if sys.argv[1] == "keep":
        kept = json.dumps({"version": version, "soversion": soversion, "interface": new}, separators=(",", ":"))
        pathlib.Path(path).write_bytes(gzip.compress(kept.encode(), 9, mtime=0))


if __name__ == "__main__":
    main()
