#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Proves that code compiled for one instruction set cannot be linked into another.

Objects of *_hot.cpp files are compiled once per level (isa_portable, isa_v3, isa_v4). The linker keeps one copy of
every symbol two objects define in common - so an inline function of a library, compiled with AVX-512 in a hot
object, could end up in the portable program. Hence every symbol a hot object defines with external linkage must
carry its level in its mangled name: be in krater::isa_<level>, have a type of it among its arguments, or be named
..._isa_<level>.
"""

import argparse
import re
import subprocess
import sys

DEFINED = set("TDBRGSCWVui")  # nm's letters for defined symbols with external linkage
# The same bytes in every object; data, or code without vector registers.
HARMLESS = re.compile(r"^(DW\.ref\.__gxx_personality_v0|__clang_call_terminate|__odr_asan.*)$")

ADVICE = """Such a symbol is an inline function or template of a library (std::vector, std::string, Eigen, fmt) or of
another krater namespace that the compiler did not inline. In *_hot.cpp use raw pointers, std::span, fixed arrays and
functions of krater::KRATER_ISA; leave allocation and messages to the code that calls it; or put a header's function
that hot code uses into the inline namespace KRATER_ISA."""


def symbols(path):
    """(mangled name, letter, section) of the symbols that the object defines and exports."""
    lines = subprocess.run(["nm", "--defined-only", "--extern-only", "--format=sysv", path],
                           check=True, capture_output=True, text=True).stdout.splitlines()
    rows = [[field.strip() for field in line.split("|")] for line in lines]
    return [(row[0], row[2], row[6]) for row in rows if len(row) == 7]


def is_constant(letter, section):
    """Inline constants (V, u) in read-only data: constant-initialised, the same bytes at every level."""
    return letter in "Vu" and section.startswith((".rodata", ".data.rel.ro"))


def demangle(names):
    if not names:
        return []
    return subprocess.run(["c++filt"], input="\n".join(names), check=True, capture_output=True,
                          text=True).stdout.splitlines()


def leaks(level, path):
    """Symbols of the object that another level's object could define as well."""
    return [name for name, letter, section in symbols(path)
            if letter in DEFINED and level not in name and not is_constant(letter, section)
            and not HARMLESS.match(name)]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--level", nargs="+", action="append", required=True,
                        metavar=("NAME", "OBJECT"), help="a level and its objects")
    errors = objects = 0
    for level, *paths in parser.parse_args().level:
        for path in paths:
            objects += 1
            names = leaks(level, path)
            errors += len(names)
            for name in demangle(names):
                print(f"{path}: defines {name}, which is not {level}'s own")
    print(f"check_isa: {errors} errors in {objects} objects")
    if errors:
        print(ADVICE)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
