"""Writes _interface.py, the part of the package that follows the library: declarations, enumerations and errors.

    python3 generate.py interface.json SOVERSION OUTPUT

interface.json is the list of the library's interface (lib/bindings/interface.py makes it from the headers).
"""
import json
import sys

# OpenCL's own types, which are handles or numbers for us.
OPENCL = "".join(f"typedef void *{name};\n" for name in ("cl_context", "cl_device_id", "cl_command_queue", "cl_mem",
                                                        "cl_event")) + "typedef int32_t cl_int;\n"


def declare(listed):
    """The whole interface, as cffi reads it."""
    lines = ["typedef int32_t skg_status;", OPENCL.rstrip()]
    lines += [f"typedef struct {name} {name};" for name in listed["handles"]]
    lines += [f"typedef struct {struct['name']} {struct['name']};" for struct in listed["structs"]]
    for callback in listed["callbacks"]:
        parameters = ", ".join(f"{kind} {name}" for name, kind in callback["parameters"])
        lines.append(f"typedef {callback['returns']} (*{callback['name']})({parameters});")
    for struct in listed["structs"]:
        fields = "".join(f" {field['type']} {field['name']}" + (f"[{field['count']}]" if field["count"] > 1 else "") + ";"
                         for field in struct["fields"])
        lines.append(f"struct {struct['name']} {{{fields} }};")
    for function in listed["functions"]:
        parameters = ", ".join(f"{kind} {name}" for name, kind in function["parameters"]) or "void"
        lines.append(f"{function['returns']} {function['name']}({parameters});")
    return "\n".join(lines)


def common_prefix(names):
    """SKG_QUANTITY_ of SKG_QUANTITY_ENERGY, SKG_QUANTITY_PHOTONS."""
    first, last = min(names), max(names)
    length = next((i for i, (a, b) in enumerate(zip(first, last)) if a != b), len(first))
    return first[:first.rfind("_", 0, length) + 1]


def enumerations(listed):
    """quantity -> {"energy": 0, ...}, without the status codes."""
    found = {}
    for enum in listed["enums"]:
        if enum["name"] == "skg_status_code" or len(enum["values"]) < 2:
            continue
        prefix = common_prefix([name for name, _ in enum["values"]])
        found[enum["name"][len("skg_"):]] = {name[len(prefix):].lower(): value for name, value in enum["values"]}
    return found


def statuses(listed):
    return next(enum["values"] for enum in listed["enums"] if enum["name"] == "skg_status_code")


def class_name(status):
    """NoDeviceError of SKG_ERR_NO_DEVICE."""
    return "".join(word.capitalize() for word in status[len("SKG_ERR_"):].split("_")) + "Error"


def write(listed, soversion):
    errors = [(class_name(name), name, value) for name, value in statuses(listed) if value < 0]
    answers = {name[len("SKG_"):]: value for name, value in statuses(listed) if value >= 0}
    text = ['"""Made by generate.py from the list of the library\'s interface. Do not edit."""',
            f'SONAME = "libskiagraph.so.{soversion}"', f"ENUMS: dict[str, dict[str, int]] = {enumerations(listed)!r}",
            f"NO_STATUS = frozenset({listed['no_status']!r})"]
    text += [f"{name} = {value}" for name, value in answers.items()]
    text.append('''

class Error(Exception):
    """A call of the library failed. The text says what failed, where, and how to mend it.

    There is a subclass for each status, such as MeshError for SKG_ERR_MESH.
    """

    #: The status of the library.
    status = 0
    #: Its name, such as "SKG_ERR_MESH".
    status_name = ""
''')
    for name, status, value in errors:
        text.append(f'''
class {name}(Error):
    """The status {status} of the library."""

    status = {value}
    status_name = "{status}"
''')
    text.append(f"\nERRORS: dict[int, type[Error]] = {{{', '.join(f'{value}: {name}' for name, _, value in errors)}}}")
    text.append(f"__all__ = {['Error'] + [name for name, _, _ in errors]!r}")
    text.append(f'CDEF = """\n{declare(listed)}\n"""')
    return "\n".join(text) + "\n"


def main():
    if len(sys.argv) != 4:
        sys.exit("usage: python3 generate.py interface.json SOVERSION OUTPUT")
    with open(sys.argv[1], encoding="utf-8") as file:
        listed = json.load(file)
    with open(sys.argv[3], "w", encoding="utf-8") as file:
        file.write(write(listed, sys.argv[2]))


main()
