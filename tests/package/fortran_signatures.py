"""Compares the Fortran module with the list of the interface, function by function. The C prototypes are those that gfortran
itself makes of the module; whether a pointer is passed by value is read from the module, because they do not tell.

    python3 fortran_signatures.py interface.json skiagraph.f90 PROTOTYPES
"""
import json
import re
import sys

SCALARS = {"int32_t": "int", "skg_status": "int", "cl_int": "int", "int64_t": "long", "double": "double", "float": "float",
           "void": "void", "char": "char"}


def expected(kind, listed):
    """The C types that a parameter of this kind may have in gfortran's words."""
    structs = {struct["name"] for struct in listed["structs"]}
    if kind in SCALARS:
        return {SCALARS[kind]}
    if kind in {callback["name"] for callback in listed["callbacks"]}:
        return {"int (*)()"}
    base = re.sub(r"const|\s|\*", "", kind)
    plain = "const " if kind.startswith("const") else ""
    if kind.count("*") == 1 and (base in SCALARS or base in structs) and base != "void":
        return {f"{plain}{SCALARS.get(base, base)} *"} | ({"void *"} if base == "char" else set())
    return {"void *", "const void *"}


def is_handle_by_value(kind, listed):
    base = re.sub(r"const|\s|\*", "", kind)
    return base in listed["handles"] and kind.count("*") == 1 or base.startswith("cl_") and "*" not in kind and base != "cl_int"


def parse_prototypes(text):
    found = {}
    for returns, name, parameters in re.findall(r"^([\w ]+?[ *]+)(skg_\w+) \((.*)\);$", text, re.M):
        kinds = [] if parameters in ("", "void") else parameters.split(", ")
        kinds = [re.sub(r"\(\*\w+\)", "(*)", k) if "(" in k else re.sub(r"\w+$", "", k).strip() for k in kinds]
        found[name] = returns.strip(), kinds
    return found


def parse_values(text):
    """For each function the names of the dummies that are pointers passed by value."""
    joined = re.sub(r"&\s*\n\s*&?", "", text)
    found = {}
    for kind, name, body in re.findall(r"^\s*(?:[\w()]+ )*(function|subroutine) (skg_\w+)\((.*?)^\s*end (?:function|subroutine)", joined,
                                       re.M | re.S):
        values = re.findall(r"type\(c_ptr\)([^:\n]*)::([^\n]*)", body)
        found[name] = {n.strip() for attributes, names in values if "value" in attributes for n in names.split(",")}
    return found


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        listed = json.load(file)
    with open(sys.argv[2], encoding="utf-8") as file:
        by_value = parse_values(file.read())
    with open(sys.argv[3], encoding="utf-8") as file:
        prototypes = parse_prototypes(file.read())
    wrong = []
    for function in listed["functions"]:
        name, parameters = function["name"], function["parameters"]
        if name not in prototypes or name not in by_value:
            wrong.append(f"{name}: is not in the module")
            continue
        returns, kinds = prototypes[name]
        if returns.replace(" ", "") not in {k.replace(" ", "") for k in expected(function["returns"], listed)}:
            wrong.append(f"{name}: returns {returns} instead of {function['returns']}")
        if len(kinds) != len(parameters):
            wrong.append(f"{name}: has {len(kinds)} arguments instead of {len(parameters)}")
            continue
        for (parameter, kind), got in zip(parameters, kinds):
            if got not in expected(kind, listed):
                wrong.append(f"{name}: {parameter} is {got} instead of {kind}")
            if is_handle_by_value(kind, listed) and parameter not in by_value[name]:
                wrong.append(f"{name}: the handle {parameter} is passed by reference")
            if kind.count("*") == 2 and "const char *" not in kind and parameter in by_value[name] and \
                    not re.search(r"\bconst\b.*\*.*\bconst\b", kind):
                wrong.append(f"{name}: the result {parameter} is passed by value")
    print("\n".join(wrong) or f"{len(listed['functions'])} functions have the signatures of the list")
    sys.exit(bool(wrong))


main()
