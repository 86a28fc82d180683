"""Writes skiagraph.f90, the module of Fortran, from the list of the interface.

    python3 fortran.py interface.json MODULE [TEST]

TEST receives a program that compares the layout of every type with the list and looks at every function's address.
"""
import json
import re
import sys

SCALARS = {"int32_t": "integer(c_int32_t)", "int64_t": "integer(c_int64_t)", "double": "real(c_double)",
           "float": "real(c_float)", "skg_status": "integer(c_int32_t)", "cl_int": "integer(c_int32_t)",
           "char": "character(kind=c_char)"}
# Results of numbers that are arrays; all others are one number.
ARRAYS = {"positions", "corners", "edges_kev", "weights"}
WIDTH = 110

HEAD = """\
! Skiagraph from Fortran 2018: every function, struct and enumerator of the library. Made by fortran.py from the list of
! the interface; do not edit.
!
! Names and arguments are those of C, which <skiagraph/*.h> documents. A handle is a type(c_ptr). What C takes by pointer is
! optional here: leave it out for NULL, and name the arguments behind it. A text ends with c_null_char. skg_init prepares any
! struct, skg_text makes a string of a C text, and skg_check stops the program with the library's sentence if a call failed.
module skiagraph
    use, intrinsic :: iso_c_binding
    implicit none
    public
"""

TAIL = """
contains

    ! The characters of a C text; "" for a null pointer.
    function skg_text(pointer) result(text)
        type(c_ptr), intent(in) :: pointer
        character(len=:), allocatable :: text
        character(kind=c_char), pointer :: characters(:)
        integer :: i, length
        text = ''
        if (.not. c_associated(pointer)) return
        call c_f_pointer(pointer, characters, [65536])
        length = 0
        do while (characters(length + 1) /= c_null_char)
            length = length + 1
        end do
        allocate (character(len=length) :: text)
        do i = 1, length
            text(i:i) = characters(i)
        end do
    end function

    ! Stops the program if a status is a failure.
    subroutine skg_check(status)
        integer(c_int32_t), intent(in) :: status
        if (status >= 0) return
        print '(3a)', skg_text(skg_status_name(status)), ': ', skg_text(skg_last_error())
        error stop 1
    end subroutine
"""


def base(kind):
    return re.sub(r"\bconst\b|\*", "", kind).strip()


def field(name, kind, count):
    pointer = "*" in kind
    if "function" in kind:
        return f"type(c_funptr) :: {name}"
    made = "type(c_ptr)" if pointer else SCALARS[kind]
    return f"{made} :: {name}" + (f"({count})" if count > 1 else "")


def parameter(name, kind, before, structs):
    """The declaration of an argument. before: the name of the one that stands before it."""
    stars, plain = kind.count("*"), base(kind)
    if "function" in kind:
        return f"type(c_funptr), value :: {name}"
    if not stars:
        return f"{SCALARS.get(plain, 'type(c_ptr)')}, value :: {name}"
    if plain == "void" or (stars == 1 and plain not in structs and plain not in SCALARS and not plain.startswith("cl_")):
        return f"type(c_ptr), value :: {name}"
    constant = kind.startswith("const")
    intent = "intent(in)" if constant and stars == 1 else "intent(inout)"
    if plain.startswith("cl_"):
        return f"type(c_ptr), {intent}, optional :: {name}" + ("(*)" if constant else "")
    if stars == 2:
        many = "const * const" in kind or kind.count("const") == 2
        return f"type(c_ptr), {'intent(in)' if many else 'intent(inout)'}, optional :: {name}" + ("(*)" if many else "")
    if plain in structs:
        array = constant and before.endswith("count")
        return f"type({plain}), {intent}, optional :: {name}" + ("(*)" if array else "")
    array = constant or name in ARRAYS or plain == "char"
    return f"{SCALARS[plain]}, {intent}, optional :: {name}" + ("(*)" if array else "")


def wrap(text, indent):
    """A statement over several lines."""
    lines, line = [], ""
    for word in text.split(" "):
        if line and len(indent) + len(line) + len(word) + 3 > WIDTH:
            lines.append(line + " &")
            line = "    " + word
        else:
            line += (" " if line else "") + word
    return [indent + part for part in lines + [line]]


def function(listed, structs):
    names = [name for name, _ in listed["parameters"]]
    arguments = f"({', '.join(names)}) bind(c)"
    returns = listed["returns"]
    if returns == "void":
        head, end = f"subroutine {listed['name']}{arguments}", "end subroutine"
    else:
        result = "type(c_ptr)" if "*" in returns else SCALARS[returns]
        head, end = f"{result} function {listed['name']}{arguments}", "end function"
    lines = wrap(head, "        ") + ["            import"]
    before = ""
    for name, kind in listed["parameters"]:
        lines.append("            " + parameter(name, kind, before, structs))
        before = name
    return lines + ["        " + end]


def module(found):
    structs = {struct["name"] for struct in found["structs"]}
    lines = [HEAD]
    for enum in found["enums"]:
        lines.append(f"    ! enum {enum['name']}")
        lines += [f"    integer(c_int32_t), parameter :: {name} = {value}_c_int32_t" for name, value in enum["values"]]
    for struct in found["structs"]:
        lines.append(f"\n    type, bind(c) :: {struct['name']}")
        lines += ["        " + field(f["name"], f["type"], f["count"]) for f in struct["fields"]]
        lines.append("    end type")
    lines.append("\n    interface skg_init")
    lines += [f"        module procedure {name}_init" for name in sorted(structs)]
    lines.append("    end interface\n\n    interface")
    for listed in found["functions"]:
        lines += function(listed, structs)
    lines.append("    end interface")
    lines.append(TAIL)
    for name in sorted(structs):
        lines += [f"    subroutine {name}_init(it)", f"        type({name}), intent(inout), target :: it",
                  f"        call {name}_init_sized(c_loc(it), int(c_sizeof(it), c_int32_t))", "    end subroutine\n"]
    return "\n".join(lines).rstrip() + "\nend module\n"


def program(found):
    """Every struct's size, every field's place, every function's address."""
    lines = ["! Made by fortran.py.", "program every_call", "    use skiagraph", "    implicit none",
             "    integer :: wrong = 0"]
    lines += [f"    type({struct['name']}), target :: s{i}" for i, struct in enumerate(found["structs"])]
    for i, struct in enumerate(found["structs"]):
        lines.append(f"    call same('{struct['name']}', int(c_sizeof(s{i}), c_int64_t), {struct['size']}_c_int64_t)")
        for f in struct["fields"]:
            place = f"place(c_loc(s{i}%{f['name']})) - place(c_loc(s{i}))"
            lines.append(f"    call same('{struct['name']}%{f['name']}', &\n        {place}, {f['offset']}_c_int64_t)")
    lines += [f"    call there('{f['name']}', c_funloc({f['name']}))" for f in found["functions"]]
    lines.append(f"    if (wrong > 0) error stop 1\n    print '(a)', '{len(found['structs'])} structs and "
                 f"{len(found['functions'])} functions'")
    lines.append("""
contains

    integer(c_int64_t) function place(pointer)
        type(c_ptr), intent(in) :: pointer
        place = transfer(pointer, 0_c_int64_t)
    end function

    subroutine same(name, got, expected)
        character(len=*), intent(in) :: name
        integer(c_int64_t), intent(in) :: got, expected
        if (got == expected) return
        print '(2a, i0, a, i0)', name, ': ', got, ' instead of ', expected
        wrong = wrong + 1
    end subroutine

    subroutine there(name, address)
        character(len=*), intent(in) :: name
        type(c_funptr), intent(in) :: address
        if (c_associated(address)) return
        print '(2a)', name, ' is not there'
        wrong = wrong + 1
    end subroutine
end program""")
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit("usage: python3 fortran.py interface.json MODULE [TEST]")
    with open(sys.argv[1], encoding="utf-8") as file:
        found = json.load(file)
    for path, make in zip(sys.argv[2:], (module, program)):
        with open(path, "w", encoding="utf-8") as file:
            file.write(make(found))


main()
