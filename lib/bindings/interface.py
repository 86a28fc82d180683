"""Writes interface.json: all functions, structs and enums of the public headers, for bindings and tests.

    python3 interface.py SOURCE BUILD OUTPUT

SOURCE is the folder of the repository, BUILD a configured build tree (it has version.h). Names and types come from
Doxygen's XML; sizes, offsets and values from a C program that is compiled against the same headers. Both are needed
only to make the list anew: `cmake --build BUILD --target interface_list`.
"""
import json
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

# Functions that return no status, besides skg_X_init_sized and skg_X_release. error.h lists them too.
NO_STATUS = ["skg_last_cl_error", "skg_last_error", "skg_lung_hounsfield", "skg_status_name", "skg_status_text",
             "skg_version", "skg_version_number"]

DOXYFILE = """
INPUT = {folders}
FILE_PATTERNS = *.h
INCLUDE_PATH = {includes}
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
OUTPUT_DIRECTORY = {output}
QUIET = YES
EXTRACT_ALL = YES
EXTRACT_STATIC = YES
JAVADOC_AUTOBRIEF = YES
OPTIMIZE_OUTPUT_FOR_C = YES
MACRO_EXPANSION = YES
PREDEFINED = "SKG_API="
"""


def fail(text):
    sys.exit("interface.py: " + text)


def text_of(element):
    """The text of an XML element, without its tags, blanks as C has them."""
    text = " ".join("".join(element.itertext()).split()) if element is not None else ""
    return text.replace("* ", "*").replace("*const", "* const")


def members(root, kind):
    return [m for m in root.iter("memberdef") if m.get("kind") == kind]


def header_of(member):
    return os.path.basename(member.find("location").get("file"))


def since_of(element):
    """The version that a comment names with @since; "" if it names none."""
    return next((text_of(s) for s in element.findall("detaileddescription//simplesect") if s.get("kind") == "since"), "")


def is_exported(member):
    """Static functions are inline: they leave no symbol."""
    return member.get("static") == "no"


def count_of(array):
    """Elements of "[3]"; 1 of ""."""
    return int(array.strip("[]")) if array else 1


def read_function(member):
    name = member.findtext("name")
    parameters = [[p.findtext("declname"), text_of(p.find("type"))] for p in member.findall("param")
                  if p.findtext("declname")]
    returns = text_of(member.find("type"))
    plain = name.endswith("_init_sized") or name.endswith("_release")
    if returns != "skg_status" and not plain and name not in NO_STATUS:
        fail(f"{name} returns {returns}; a function returns skg_status unless error.h lists it")
    function = {"name": name, "header": header_of(member), "returns": returns, "parameters": parameters}
    since = since_of(member)
    return {**function, "since": since} if since else function


def read_callback(member):
    """A typedef of a pointer to a function."""
    arguments = text_of(member.find("argsstring")).lstrip(")").strip("()")
    parameters = []
    for argument in arguments.split(", "):
        cut = max(argument.rfind(" "), argument.rfind("*")) + 1
        parameters.append([argument[cut:], argument[:cut].strip()])
    return {"name": member.findtext("name"), "header": header_of(member),
            "returns": text_of(member.find("type")).split("(")[0].strip(), "parameters": parameters}


def read_struct(folder, identifier):
    root = xml.parse(f"{folder}/{identifier}.xml").getroot().find("compounddef")
    fields = [{"name": m.findtext("name"), "type": text_of(m.find("type")),
               "count": count_of(m.findtext("argsstring") or "")} for m in members(root, "variable")]
    return {"name": root.findtext("compoundname"), "header": os.path.basename(root.find("location").get("file")),
            "fields": fields}


def read_xml(folder):
    found = {"since": {}, "macros": [], "enums": [], "handles": [], "callbacks": [], "structs": [], "functions": []}
    for entry in xml.parse(f"{folder}/index.xml").getroot():
        identifier = entry.get("refid")
        if entry.get("kind") == "struct" and entry.findtext("name").startswith("skg_"):
            struct = read_struct(folder, identifier)
            if struct["fields"]:
                found["structs"].append(struct)
        if entry.get("kind") != "file":
            continue
        root = xml.parse(f"{folder}/{identifier}.xml").getroot()
        header, since = entry.findtext("name"), since_of(root.find("compounddef"))
        if not since:
            fail(f"{header}: the comment at its head does not say since which version it is there: @since 0.1.0")
        found["since"][header] = since
        found["macros"] += [m.findtext("name") for m in members(root, "define")
                            if m.findtext("name").startswith("SKG_")]
        found["enums"] += [{"name": m.findtext("name"), "header": header_of(m),
                            "values": [v.findtext("name") for v in m.findall("enumvalue")]}
                           for m in members(root, "enum")]
        found["functions"] += [read_function(m) for m in members(root, "function") if is_exported(m)]
        for member in members(root, "typedef"):
            kind = text_of(member.find("type"))
            if kind == f"struct {member.findtext('name')}":
                found["handles"].append(member.findtext("name"))
            elif "(*" in kind.replace(" ", ""):
                found["callbacks"].append(read_callback(member))
    found["macros"].sort()
    found["handles"].sort()
    for key in ("enums", "callbacks", "structs", "functions"):
        found[key].sort(key=lambda item: item["name"])
    return found


def measure(found, includes, folder):
    """Compiles and runs a program that prints every value, size and offset."""
    lines = []
    for enum in found["enums"]:
        lines += [f'printf("%ld\\n", (long){value});' for value in enum["values"]]
    for struct in found["structs"]:
        name = struct["name"]
        lines.append(f'printf("%zu\\n", sizeof({name}));')
        for field in struct["fields"]:
            lines.append(f'printf("%zu\\n%zu\\n", offsetof({name}, {field["name"]}), '
                         f'sizeof((({name} *)0)->{field["name"]}));')
    program = f"{folder}/measure"
    with open(program + ".c", "w") as file:
        headers = [f"skiagraph/{header}.h" for header in ("breathing", "live", "opencl", "registration", "scanning", "skiagraph")]
        file.write("".join(f"#include <{header}>\n" for header in headers + ["stddef.h", "stdio.h"]) +
                   "int main(void) {\n" + "\n".join(lines) + "\nreturn 0;\n}\n")
    command = [os.environ.get("CC", "cc"), "-std=c11", "-Wno-unused-function"]
    command += [f"-I{path}" for path in includes] + ["-c", program + ".c", "-o", program + ".o"]
    subprocess.run(command, check=True)
    # The inline skg_X_init call functions that this program never runs: nothing of the library is needed.
    subprocess.run([command[0], program + ".o", "-Wl,--unresolved-symbols=ignore-all", "-o", program], check=True)
    numbers = iter(subprocess.run([program], check=True, capture_output=True, text=True).stdout.split())
    for enum in found["enums"]:
        enum["values"] = [[value, int(next(numbers))] for value in enum["values"]]
    for struct in found["structs"]:
        struct["size"] = int(next(numbers))
        for field in struct["fields"]:
            field["offset"], field["size"] = int(next(numbers)), int(next(numbers))


def write_list(items, indent):
    return ",\n".join(" " * indent + json.dumps(item) for item in items)


def write_json(found):
    """One line for each function, field and enumerator, so that a change shows as a line."""
    parts = ['  "about": ' + json.dumps("All of the interface, for bindings: made by interface.py from the headers. "
                                        "Sizes and offsets are bytes of a 64-bit platform. A type of a parameter or "
                                        "field is as C has it; count: elements of an array. since: the first version with "
                                        "a header's names, and with a function that is younger than its header.")]
    parts.append('  "no_status": ' + json.dumps(NO_STATUS))
    parts.append('  "since": ' + json.dumps(dict(sorted(found["since"].items()))))
    parts.append('  "macros": ' + json.dumps(found["macros"]))
    parts.append('  "handles": ' + json.dumps(found["handles"]))
    enums = [f'    {{"name": "{e["name"]}", "header": "{e["header"]}", "values": [\n'
             + write_list(e["values"], 6) + "]}" for e in found["enums"]]
    parts.append('  "enums": [\n' + ",\n".join(enums) + "]")
    structs = [f'    {{"name": "{s["name"]}", "header": "{s["header"]}", "size": {s["size"]}, "fields": [\n'
               + write_list(s["fields"], 6) + "]}" for s in found["structs"]]
    parts.append('  "structs": [\n' + ",\n".join(structs) + "]")
    for key in ("callbacks", "functions"):
        parts.append(f'  "{key}": [\n' + write_list(found[key], 4) + "]")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def main():
    if len(sys.argv) != 4:
        fail("usage: python3 interface.py SOURCE BUILD OUTPUT")
    source, build, output = sys.argv[1:]
    includes = [f"{source}/lib/include", f"{source}/host/include", f"{build}/include"]
    with tempfile.TemporaryDirectory() as folder:
        doxyfile = DOXYFILE.format(folders=" ".join(f"{path}/skiagraph" for path in includes), output=folder,
                                   includes=" ".join(includes))
        subprocess.run(["doxygen", "-"], input=doxyfile, check=True, text=True, stdout=subprocess.DEVNULL)
        found = read_xml(f"{folder}/xml")
        measure(found, includes, folder)
    with open(output, "w") as file:
        file.write(write_json(found))


main()
