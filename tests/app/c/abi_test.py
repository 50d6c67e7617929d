# SPDX-License-Identifier: MIT
"""The C face's promises to programs that are compiled already: abi.txt lists each exported function with its types, each struct with the size
and places of its members, and each constant. A line that is there stays as it is; what changes one raises WH_ABI, and an addition adds lines.

`abi_test.py --write` writes the list anew. STAGED: the folder where the packages are unpacked."""
import glob
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
LIST = os.path.join(HERE, "abi.txt")


def without_comments(text):
    return re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL)


def words(text):
    return " ".join(text.split())


def declared(header):
    """What a header declares: functions, structs with their members, enums with their constants."""
    text = without_comments(header)
    functions = {}
    for result, name, arguments in re.findall(r"WH_API\s+([\w\s*]+?)\s*\b(wh_\w+)\s*\(([^)]*)\)\s*;", text):
        functions[name] = f"{words(result)} ({words(arguments)})"
    structs = {}
    for body, name in re.findall(r"typedef struct \w+ \{(.*?)\}\s*(\w+)\s*;", text, flags=re.DOTALL):
        members = []
        for line in body.split(";"):
            for part in line.split(","):
                if part.strip():
                    members.append(re.search(r"(\w+)\s*(\[\s*\w+\s*\]\s*)*$", part.strip()).group(1))
        structs[name] = members
    constants = []
    for body in re.findall(r"enum(?: \w+)? \{(.*?)\}", text, flags=re.DOTALL):
        constants += [part.split("=")[0].strip() for part in body.split(",") if part.strip()]
    return functions, structs, constants


def measured(include, structs, constants):
    """Sizes, places and values as a C compiler sees them."""
    lines = ['#include <stddef.h>', '#include <stdio.h>', '#include <wholehand/wholehand.h>', 'int main(void) {']
    lines.append('  printf("abi %d\\n", WH_ABI);')
    for name in constants:
        lines.append(f'  printf("constant {name} = %d\\n", (int){name});')
    for name, members in structs.items():
        lines.append(f'  printf("struct {name}: %zu bytes\\n", sizeof({name}));')
        for member in members:
            size = f"sizeof((({name}*)0)->{member})"
            lines.append(f'  printf("struct {name}.{member} at %zu, %zu bytes\\n", offsetof({name}, {member}), {size});')
    lines += ["  return 0;", "}"]
    with tempfile.TemporaryDirectory() as work:
        source, program = os.path.join(work, "sizes.c"), os.path.join(work, "sizes")
        with open(source, "w") as file:
            file.write("\n".join(lines))
        subprocess.run(["cc", "-std=c11", "-I", include, source, "-o", program], check=True)
        return subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()


def exported(library):
    """Names that programs can be linked to, with the version that each has."""
    out = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    return [line.split()[-1] for line in out.splitlines() if line.split()[-2] != "A"]


def soname(library):
    out = subprocess.run(["objdump", "-p", library], check=True, capture_output=True, text=True).stdout
    return re.search(r"SONAME\s+(\S+)", out).group(1)


def has_grown(line, now):
    """Whether the line is the size of a struct that is larger now: then FIRST_SIZE (app/c/status.h) keeps what it was."""
    size = re.fullmatch(r"struct (\w+): (\d+) bytes", line)
    found = size and [int(other[len(f"struct {size[1]}: "):-len(" bytes")]) for other in now if other.startswith(f"struct {size[1]}: ")]
    return bool(found) and found[0] > int(size[2])


def main():
    staged = os.environ["STAGED"]
    include = os.path.join(staged, "usr/include")
    (library,) = glob.glob(os.path.join(staged, "usr/lib/*/libwholehand.so"))
    library = os.path.realpath(library)
    with open(os.path.join(include, "wholehand/wholehand.h")) as file:
        functions, structs, constants = declared(file.read())
    assert len(functions) > 20 and len(structs) > 8 and len(constants) > 15, "the header was not understood"
    names = exported(library)
    assert sorted(name.split("@@")[0] for name in names) == sorted(functions), (
        f"the header declares what the library lacks, or the other way: "
        f"{sorted(set(functions) ^ {name.split('@@')[0] for name in names})}")
    now = measured(include, structs, constants)
    abi = int(now[0].split()[1])
    assert soname(library) == f"libwholehand.so.{abi}", f"{soname(library)} has not the number of WH_ABI, {abi}"
    now += [f"symbol {name}" for name in names]
    now += [f"function {name}: {types}" for name, types in sorted(functions.items())]
    if sys.argv[1:] == ["--write"]:
        with open(LIST, "w") as file:
            file.write("\n".join(now) + "\n")
        return
    with open(LIST) as file:
        before = file.read().splitlines()
    gone, new = [line for line in before if line not in now and not has_grown(line, now)], [line for line in now if line not in before]
    assert not gone, "programs rely on what has changed; raise WH_ABI (and the number in app/c/exported.map):\n" + "\n".join(gone)
    assert not new, "new; run abi_test.py --write:\n" + "\n".join(new)
    print(f"{len(functions)} functions, {len(structs)} structs, {len(constants)} constants: as they were")


main()
