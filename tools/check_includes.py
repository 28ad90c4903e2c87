#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Enforces the layering of the sources: who may include whom, which library may appear where, and sizes.

The rules are the tables below (reasons: src/README.md). Prints file:line: message and returns 1 on any error.
"""

import argparse
import pathlib
import re
import sys
import tempfile

# Folder -> folders of include/krater and src it may include besides itself.
LAYERS = {
    "core": set(),
    "points": {"core"},
    "grid": {"core", "points"},
    "geometry": {"core"},
    "materials": {"core", "points"},  # a law knows no dimension, mesh or method
    "contact": {"core", "points", "grid"},  # nodes and fields, for every kinematics
    "kinematics": {"core", "points", "grid", "contact", "geometry"},
    "distribute": {"core", "points", "grid", "kinematics"},  # blocks on several ranks
    "kinematics/mpm": {"core", "points", "grid", "geometry", "materials", "contact", "kinematics", "distribute"},
    "kinematics/mesh": {"core", "points", "geometry", "materials", "contact", "kinematics"},
    "kinematics/sph": {"core", "points", "geometry", "materials", "contact", "kinematics"},
    "output": {"core", "points", "grid", "geometry"},
    "scene": {"core", "points", "grid", "geometry", "materials", "contact", "kinematics", "kinematics/mpm", "kinematics/mesh",
              "kinematics/sph", "output"},
}
for folder, also in {"simulation": {"scene", "kinematics", "distribute"}, "measure": {"simulation"}, "point_driver": {"simulation"},
                     "app": {"measure", "point_driver"}}.items():
    LAYERS[folder] = LAYERS["scene"] | {"scene", "simulation", "kinematics"} | also - {folder}
LAYERS["main"] = {"app", "core"}

# Header -> where it may appear: folders, or paths from the top of a folder's include/krater or src.
LIBRARIES = [
    (r"(CGAL|boost)/", ["geometry"]),
    (r"yaml-cpp/", ["scene"]),
    (r"(udunits2?|muParser)\.h", ["scene"]),
    (r"(hdf5|hdf5_hl|H5\w+)\.h", ["output"]),
    (r"isa-l/.*\.h", ["output"]),
    (r"omp\.h", ["core/parallel"]),
    (r"mpi\.h", ["core/ranks", "distribute/partition"]),
    (r"trilinos/zoltan\.h", ["distribute/partition"]),
    (r"(CLI|spdlog)/", ["app", "main"]),
    (r"[xp]mmintrin\.h", ["core/simd", "core/parallel"]),  # the flush-to-zero flag of each thread
    (r"(\w*intrin|cpuid|arm_neon|arm_sve)\.h", ["core/simd"]),
    (r"krater/version_generated\.hpp", ["app/version"]),
    (r"(Eigen|fmt)/", [""]),
    (r"(sys/(stat|resource|time|types|utsname|auxv)|unistd|fcntl|sched|pthread)\.h",
     ["core", "output", "simulation", "app"]),
]
STANDARD = re.compile(r"[a-z_0-9]+")  # <vector>, <cmath>: no folder, no suffix

MAX_FILE_LINES = 400
MAX_FUNCTION_LINES = 60
MAX_PARAMETERS = 8  # five as a rule
MAX_COLUMNS = 100  # clang-format leaves comments alone
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(<[^>\n]+>|"[^"\n]+")', re.M)
PRAGMA_OMP = re.compile(r"^[ \t]*#[ \t]*pragma[ \t]+omp[ \t]+(.*)$", re.M)


class Checker:
    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.errors = []

    def error(self, path, line, message):
        self.errors.append(f"{path.relative_to(self.root)}:{line}: {message}")

    def run(self):
        for top in ("include", "src", "tests"):
            files = [p for p in (self.root / top).rglob("*") if p.suffix in (".hpp", ".cpp", ".inl", ".h")]
            for path in sorted(files):
                self.check_file(path, top)
        return self.errors

    def place(self, path):
        """The path below include/krater or src, without suffix; 'main' for src/main.cpp."""
        parts = path.relative_to(self.root).parts
        below = parts[2:] if parts[0] == "include" else parts[1:]
        return "/".join(below).rsplit(".", 1)[0]

    def check_file(self, path, top):
        raw = path.read_text(encoding="utf-8")
        text = blank_comments(raw)
        code = blank_strings(text)
        place = None if top == "tests" else self.place(path)
        folder = None if place is None else layer_of(place.split("/"))
        if folder is not None and folder not in LAYERS:
            self.error(path, 1, f"folder '{folder}' is unknown to the layering (known: {', '.join(LAYERS)})")
            return
        for line, columns in enumerate(map(len, raw.splitlines()), 1):
            if columns > MAX_COLUMNS:
                self.error(path, line, f"{columns} columns, more than {MAX_COLUMNS}")
        for match in INCLUDE.finditer(text):
            self.check_include(path, line_of(text, match.start(1)), match.group(1), place, folder)
        if top == "tests":
            return
        for match in PRAGMA_OMP.finditer(code):
            self.check_omp(path, line_of(code, match.start(1)), match.group(1), place)
        lines = raw.count("\n") + (not raw.endswith("\n"))
        if lines > MAX_FILE_LINES:
            self.error(path, lines, f"{lines} lines, more than {MAX_FILE_LINES}")
        for line, statement in comma_statements(code):
            self.error(path, line, f"a comma joins statements: {statement[:60]}")
        for line, length, name, parameters in functions(code):
            if parameters > MAX_PARAMETERS:
                self.error(path, line, f"function {name} has {parameters} parameters, more than {MAX_PARAMETERS}")
            if length > MAX_FUNCTION_LINES:
                self.error(path, line, f"function {name} has {length} lines, more than {MAX_FUNCTION_LINES}")
        if path.suffix == ".hpp":
            if "#pragma once" not in code:
                self.error(path, 1, "header without #pragma once")
            for match in re.finditer(r"^using[ \t]+namespace\b", code, re.M):
                self.error(path, line_of(code, match.start()), "using namespace at the top of a header")

    def check_include(self, path, line, include, place, folder):
        name = include[1:-1]
        for pattern, places in LIBRARIES:
            if re.match(pattern, name):
                if folder is not None and not any(inside(place, p) for p in places):
                    self.error(path, line, f"{include} may only be included in {', '.join(places)}")
                return
        if name.startswith("krater/") or include[0] == '"':
            self.check_own(path, line, name, folder)
        elif folder is None and name.startswith("doctest/"):
            return
        elif not STANDARD.fullmatch(name):
            self.error(path, line, f"{include} is neither standard C++ nor a library known to "
                                   "tools/check_includes.py")

    def check_own(self, path, line, name, folder):
        top = self.root / ("tests" if folder is None else "src")
        candidates = [path.parent / name, top / name, self.root / "src" / name, self.root / "include" / name]
        target = next((c for c in candidates if c.is_file()), None)
        if target is None:
            self.error(path, line, f"included file '{name}' does not exist")
            return
        target = target.resolve()
        if folder is None or (self.root / "tests").resolve() in target.parents:
            if folder is not None:
                self.error(path, line, f"'{name}' is a test's file")
            return
        base = self.root.resolve()
        parts = target.relative_to(base).parts
        other = layer_of(parts[2:] if parts[0] == "include" else parts[1:])
        if other != folder and other not in LAYERS[folder]:
            allowed = ", ".join(sorted(LAYERS[folder])) or "nothing else"
            self.error(path, line, f"{folder} may not include {other} ({name}); allowed: {allowed}")

    def check_omp(self, path, line, directive, place):
        if inside(place, "core/parallel"):
            return
        if re.match(r"(declare[ \t]+)?simd\b", directive):
            if "reduction" in directive:
                self.error(path, line, "omp simd reduction: the sum's order would depend on the vector width")
        else:
            self.error(path, line, "OpenMP only in core/parallel (omp simd without reduction anywhere)")


def layer_of(parts):
    """Of a path below include/krater or src: its folder; each kinematics is a layer of its own."""
    pair = "/".join(parts[:2])
    return pair if pair in LAYERS else parts[0]


def inside(place, allowed):
    """Whether place is the folder `allowed` or a file whose name begins with it ('core/simd' -> core/simd_math)."""
    return not allowed or place == allowed or place.startswith(allowed + "/") or ("/" in allowed and place.startswith(allowed))


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def blank(match):
    return re.sub(r"[^\n]", " ", match.group(0))


TOKEN = re.compile(r'R"(?P<d>[^()\\\s]{0,16})\(.*?\)(?P=d)"|"(?:[^"\\\n]|\\.)*"'
                   r"|(?<![0-9a-zA-Z_])'(?:[^'\\\n]|\\.)+'|//(?:[^\n\\]|\\.|\\\n)*|/\*.*?\*/", re.S)


def blank_comments(text):
    return TOKEN.sub(lambda m: blank(m) if m.group(0).startswith("/") else m.group(0), text)


def blank_strings(text):
    """Blanks string and character literals of text without comments; keeps their quotes."""
    return TOKEN.sub(lambda m: '"' + blank(m)[1:-1] + '"', text)


def functions(code):
    """Yields (line, length, name, parameters) of function bodies. A heuristic on braces: in namespaces and classes a
    brace after a parameter list opens a function; all within it belongs to it."""
    code = re.sub(r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", blank, code, flags=re.M | re.S)
    statement = ""
    stack = []  # kinds of the open braces: scope, function, other
    start = (0, "", 0)
    for match in re.finditer(r"[{};]|[^{};]+", code):
        token = match.group(0)
        nested = any(kind != "scope" for kind, _ in stack)
        if token == "{":
            kind = "other" if nested else brace_kind(statement)
            if kind == "function":
                start = (line_of(code, match.start()), function_name(statement), parameter_count(statement))
            stack.append((kind, statement))
            if not nested and kind != "other":
                statement = ""
        elif token == "}":
            kind, before = stack.pop() if stack else ("other", "")
            if kind == "function":
                yield start[0], line_of(code, match.start()) - start[0] + 1, *start[1:]
            if not any(k != "scope" for k, _ in stack):
                statement = before + "()" if kind == "other" else ""
        elif not nested:
            statement = "" if token == ";" else statement + token


def brace_kind(statement):
    text = re.sub(r"\[\[.*?\]\]|\balignas\s*\([^()]*\)|\b__attribute__\s*\(\(.*?\)\)", " ", statement, flags=re.S)
    text = strip_templates(text).strip()
    text = re.sub(r"^((public|private|protected)\s*:\s*)+", "", text)
    if re.search(r"\bnamespace\b", text) or re.match(r'extern\s+"\s*"$', text):
        return "scope"
    if re.match(r"(inline\s+|static\s+|constexpr\s+|typedef\s+)*(class|struct|union|enum)\b[^()=]*$", text):
        return "scope"
    if "(" not in text or re.search(r"(?<![=!<>+\-*/])=\s*(\w|::|<|>)*$", text):
        return "other"  # an initialiser: int a{..}, Table t = {..}
    # A constructor's member initialised with braces: `X(int a) : a_{a}`.
    if re.search(r"\)\s*(noexcept\s*)?:(?!:)", text) and re.search(r"[\w>]$", text) \
            and not re.search(r"\b(noexcept|const|override|final)$", text):
        return "other"
    return "function"


def strip_templates(text):
    """Removes a leading template<...>, which may hold parentheses and the word class."""
    text = text.strip()
    while text.startswith("template"):
        depth = 0
        for i, char in enumerate(text):
            depth += (char == "<") - (char == ">" and text[i - 1] != "-")
            if char == ">" and depth == 0:
                text = text[i + 1:].strip()
                break
        else:
            return text
    return text


def function_name(statement):
    names = re.findall(r"(operator\s*\(\)|operator\s*[^\s\w(]+|[~\w:]+)\s*(?=\()", strip_templates(statement))
    names = [n for n in names if n not in ("noexcept", "requires", "decltype")]
    return names[0].strip() if names else "?"


def parameter_count(statement):
    text = re.sub(r"\[\[.*?\]\]", "", strip_templates(statement))
    head = re.search(r"([\w:]*\boperator\s*\(\)|operator\s*[^\s\w(]+|[~\w:]+)\s*\(", text)
    depth = angle = commas = 0
    for i, char in enumerate(text[head.end() - 1:] if head else ""):
        depth += (char in "([{") - (char in ")]}")
        angle += (char == "<") - (char == ">")
        commas += char == "," and depth == 1 and angle == 0
        if depth == 0:
            return commas + 1 if text[head.end():head.end() - 1 + i].strip() else 0
    return 0


def comma_statements(code):
    """Yields (line, text) of statements joined by a comma operator where a semicolon would do. Contents of brackets are
    left out of the text, and so are declarations, and Eigen's `m << 1, 2`."""
    code = re.sub(r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", blank, code, flags=re.M | re.S)
    stack = [["{", ""]]  # open brackets, each with the text before its next one
    for i, char in enumerate(code):
        top = stack[-1]
        if char in "{([":
            top[1] += char if char != "{" else ""
            stack.append([char, ""])
        elif char in "})]" and len(stack) > 1:
            stack.pop()
            top = stack[-1]
            top[1] += "{}" if char == "}" else char
            if char == "}" and top[0] == "{" and code[i + 1:].lstrip()[:1] not in ",;).]=+-*/<>?:&|":
                top[1] = ""  # the end of a block
        elif char == ";" and top[0] == "{":
            text = plain_statement(top[1])
            if joined_by_comma(text):
                yield line_of(code, i), text
            top[1] = ""
        elif top[0] == "{" or char == ";":
            top[1] += char


def plain_statement(text):
    """Without labels, conditions, template arguments and alignas."""
    text, before = " ".join(text.split()), None
    while text != before:
        before = text
        text = re.sub(r"^((else|do)\b|(if|for|while|switch)( constexpr)? ?\(\)|(public|private|protected) ?:|default ?:"
                      r"|case [^:]*:|alignas ?\(\)) ?", "", text)
        text = re.sub(r"(?<=\w) ?<[^<>;]*>", "", text)
    return text


def joined_by_comma(text):
    first = text.partition(",")[0]
    if first == text or re.match(r"(using|template|friend|typedef|enum|namespace)\b", text):
        return False
    if re.match(r"(return|throw|delete)\b", first):
        return True
    declaration = re.match(r"(\[\[[^\]]*\]\] ?)?([\w:]+[ *&]+)+(\[\]|[\w:~]+) ?(\[\]|=|\{|\(|:|$)", first)
    return not declaration and ("<<" not in first or "=" in first)


def self_test():
    """Plants one error of each kind and one long function among harmless code; returns what went unnoticed."""
    long_body = "  x += 1;\n" * 60
    planted = {
        "include/krater/core/a.hpp": ('#pragma once\n#include <vector>\n#include "krater/points/p.hpp"\n', 1),
        "include/krater/points/p.hpp": ("#include <CGAL/x.h>\nusing namespace std;\n", 3),
        "src/core/parallel_for.cpp": ("#include <omp.h>\n#pragma omp parallel for\n", 0),
        "src/contact/b.cpp": ('#include "missing.hpp"\n#pragma omp parallel\n#pragma omp simd\n'
                           "#pragma omp simd reduction(+ : s)\n// #include <hdf5.h>\n#include <hdf5.h>\n", 4),
        "src/contact/c.cpp": ("struct A {\n A(int a) : a_{a} {\n" + long_body + "}\n int a_ = {};\n};\n"
                           "const int table[] = {\n" + "1,\n" * 70 + "};\n"
                           "template <class T> requires(sizeof(T) > 1)\nint f(T x) noexcept {\n" + long_body +
                           "}\nnamespace n {\nstruct alignas(64) S {\n" + "int i;\n" * 70 + "};\n"
                           "int short_one() { return '{' + 1'000; }\n}\n", 2),
        "src/app/d.cpp": ("int i;\n" * 401, 1),
        "src/elsewhere/e.cpp": ("\n", 1),
        "src/app/g.cpp": ("void f(int a, int b) {\n  int c = a, d[2] = {b, b};\n  const std::map<int, int> m, n;\n"
                          "  double *p, *q;\n  for (int i = 0, j = 1; i < j; ++i, --j) g(i, j);\n  v << a, b;\n"
                          "  alignas(64) double x[8], y[8];\n  auto h = [&](int k) { c = k, d[0] = k; };\n"
                          "  if (a > b) c = a, d[0] = b;\n  g(a, b), g(b, a);\n  return g(a, b), c;\n}\n"
                          "struct A {\n  A() : i{1}, j{2} {}\n  int i, j;\n};\nenum class E { one, two };\n", 4),
        "src/app/h.cpp": ("int f(std::map<int, int> a, int b = g(1, 2), int c, int d, int e, int f, int g, int h) {}\n"
                          "template <class A, class B>\nint A<B>::operator()(A a, int b, int c, int d, int e, int f, "
                          "int g, int h,\n int i) const {}\n", 1),
        "src/app/f.cpp": ("//" + "x" * 98 + "\n//" + "x" * 99 + "\n", 1),
        "tests/unit/t.cpp": ('#include <doctest/doctest.h>\n#include <hdf5.h>\n#include "krater/core/z.hpp"\n', 1),
    }
    missed = []
    with tempfile.TemporaryDirectory() as folder:
        for name, (text, _) in planted.items():
            path = pathlib.Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        errors = Checker(folder).run()
        for name, (_, expected) in planted.items():
            found = [e for e in errors if e.startswith(name + ":")]
            if len(found) != expected:
                missed.append(f"{name}: {expected} errors planted, found: {found}")
    return missed


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--self-test", action="store_true", help="check this checker on planted errors")
    parser.add_argument("--root", default=pathlib.Path(__file__).resolve().parent.parent)
    options = parser.parse_args()
    errors = self_test() if options.self_test else Checker(options.root).run()
    for error in errors:
        print(error)
    print(f"check_includes: {len(errors)} errors")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
