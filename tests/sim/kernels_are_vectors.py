#!/usr/bin/env python3
"""Are the loops over contacts and bonds vector code? A compiler that gives up on one says nothing, and the program is only several times slower.

usage: kernels_are_vectors.py OBJDUMP OBJECT...

OBJECT: what a kernel file was compiled to, with the name of its instruction set (contacts_avx2.cpp.o, single_avx512.cpp.o, bonds_portable.cpp.o). Every
pass over contacts and bonds must have a fair share of operations on whole vectors of that width: those on single numbers are for the contacts that
are left over at the end of a loop, and every loop has both. And no function that is not its own may be left in it as a copy that the linker could choose.
Objects of the portable set have scalar loops; of all sets none may touch MMX registers, after which nothing works that is done in long double.
"""

import re
import subprocess
import sys

WIDTH = {"avx2": "ymm", "avx512": "zmm"}
PASSES = r"\b((passPairs|passWalls|passBonds|findDirections|findSlip|stretchBonds|pullBonds)<|findPaths\()"
# Operations on vectors over operations on numbers: g++ writes the rest of a loop out, which for single numbers may be twice as long.
LEAST = {"d": 0.2, "s": 0.1}


def scalar_passes(objdump, file, register, precision):
    """The passes of an object file that are not vector code, and how many passes there are."""
    listing = subprocess.run([objdump, "-d", "-C", "--no-show-raw-insn", file], capture_output=True, text=True, check=True).stdout
    operations = {}
    name = None
    for line in listing.splitlines():
        if head := re.match(r"[0-9a-f]+ <(.*)>:$", line):
            name = head[1] if re.search(PASSES, head[1]) else None
            if name:
                operations[name] = [0, 0]
        elif name and re.search(rf"\bv(mul|add|sub|div|sqrt)p{precision}\b.*{register}", line):
            operations[name][0] += 1
        elif name and re.search(rf"\bv(mul|add|sub|div|sqrt)s{precision}\b", line):
            operations[name][1] += 1
    return [(name, *count) for name, count in operations.items() if count[0] < LEAST[precision] * count[1]], len(operations)


def leaks(objdump, file):
    """Functions of which the linker may take this copy for every processor: weak ones that are defined here."""
    table = subprocess.run([objdump, "-t", "-C", file], capture_output=True, text=True, check=True).stdout
    return [line.split(None, 5)[-1] for line in table.splitlines() if re.match(r"[0-9a-f]+ .w....F (?!\*UND\*)", line)]


def touches_mmx(objdump, file):
    listing = subprocess.run([objdump, "-d", "--no-show-raw-insn", file], capture_output=True, text=True, check=True).stdout
    return re.search(r"%mm[0-7]\b", listing) is not None


def main(objdump, *files):
    failed = not files
    for file in files:
        part, isa = re.search(rf"(contacts|single|bonds|grains)_({'|'.join(WIDTH)}|portable)\.", file).groups()
        if touches_mmx(objdump, file):
            print(f"{isa}, {part}: MMX registers (-mno-mmx is missing)")
            failed = True
        if isa == "portable":
            continue
        for name in leaks(objdump, file):
            print(f"{isa}, {part}: not inlined, and every processor may get this copy: {name}")
            failed = True
        if part == "grains":  # vectors of four, written as such
            continue
        scalar, passes = scalar_passes(objdump, file, WIDTH[isa], "s" if part == "single" else "d")
        print(f"{isa}, {part}: {passes} passes, {len(scalar)} of them scalar")
        for name, vectors, numbers in scalar:
            print(f"  {vectors} on vectors, {numbers} on numbers:", name.replace("tsubu::sim::", "").replace("(anonymous namespace)::", ""))
        failed = failed or scalar or passes == 0
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
