#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every reference leads somewhere: sections, equations and decisions of src/THEORY.md, files, tests, constants.

Checked in comments, texts and pages of the whole tree:
  theory 9, theory D9, (9.4) in THEORY.md, Decision 6      an entry of src/THEORY.md
  CCF (7), SPEAR (S.36)                                    in the table of the two papers at its end
  kValley in THEORY.md                                     a constant of the sources
  kinematics/audit.hpp, `app/material_plan`, `unit/scene/cards`  a file, or a test by the name that ctest gives it
  [text](path#anchor)                                      a file, and a heading in it
Files of runs (summary.json) and of users (filler.stl) are no references. Prints file:line: message, returns 1 on any.
"""

import argparse
import fnmatch
import pathlib
import re
import sys
import tempfile

PLACES = ["CMakeLists.txt", "README.md", "include", "src", "inputs", "tests", "tools", "validation"]
SUFFIXES = {".hpp", ".cpp", ".md", ".py", ".yaml", ".txt", ".cmake", ""}
NO_REFERENCES = {"tools/check_references.py", "tools/check_includes.py"}  # their self tests plant errors

SECTION = re.compile(r"\b[Tt]heory\s+(D?\d+(?:\s*(?:,|and|-)\s*D?\d+\b(?!\.\d))*)")
THEORY_PAGE = re.compile(r"THEORY\.md,? (?:section )?(\d+)\b(?!\.)")
DECISION = re.compile(r"\bDecision\s+(\d+)\b")
PAPER = re.compile(r"\b(CCF|SPEAR)\s+(\(S?\.?\d+\)(?:\s*(?:,|and|-|to)\s*\(S?\.?\d+\))*)")
LOST = re.compile(r"\b(?:[Nn]umerics|[Aa]rchitecture)(?:\.md)? (?:section )?[A-D]?\d+\b")  # studies never shipped
ENDINGS = r"(?:hpp|cpp|py|md|yaml|csv|cmake|txt|inl)"
FILE = re.compile(r"(?<![\w./*{}<>$-])((?:\.\./)*[\w*][\w*/.-]*\." + ENDINGS + r")\b(?![\w(/]|:\d)")
TEST = re.compile(r"(?<![\w./-])((?:unit|contract|verification|scene|style)/[\w/.*-]*\w)")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
QUOTED = re.compile(r"`([^`\n]+)`")
PLACE = re.compile(r"(?<![\w./<-])((?:tools|inputs|validation|tests|include|src|core|points|grid|geometry|materials"
                   r"|contact|kinematics|scene|output|simulation|measure|point_driver|app)/[\w/.*-]*\w)")

# Written by runs, a user's (in capitals, or x), or another program's.
NOT_OURS = re.compile(r"(^|/)(resolved\.yaml|log\.txt|(history|point|study|gauge_\w+)\.csv|[A-Z]+\.\w+|x\.\w+)$|^examples/solid_mech/")


class Checker:
    def __init__(self, root):
        self.root = pathlib.Path(root).resolve()
        self.errors = []
        self.files = [p for place in PLACES for p in sorted(self.expand(self.root / place))]
        self.names = {p.name for p in self.files}
        self.theory = self.root / "src/THEORY.md"
        text = self.theory.read_text(encoding="utf-8") if self.theory.is_file() else ""
        self.sections = set(re.findall(r"^## (\d+)\.", text, re.M)) | set(re.findall(r"^\*\*(D\d+),", text, re.M))
        after = text.partition("## 14.")[2].partition("\n## ")[0]
        self.decisions = set(re.findall(r"^(\d+)\. ", after, re.M))
        self.equations = {"CCF": set(), "SPEAR": set()}
        papers = text.partition("## 23.")[2]
        for line in papers.splitlines():
            if line.startswith("| (") or line.startswith("| Theorem"):
                self.equations["CCF"] |= numbers(line.split("|")[1])
        self.equations["SPEAR"] = numbers(papers.partition("**[SPEAR]**")[2])
        self.own = set(re.findall(r"\((\d+\.\d+)\)[ ]*$", text, re.M))

    @staticmethod
    def expand(place):
        if place.is_file():
            return [place]
        return [p for p in place.rglob("*") if p.is_file() and "__pycache__" not in p.parts]

    def error(self, path, line, message):
        self.errors.append(f"{path.relative_to(self.root)}:{line}: {message}")

    def run(self):
        for path in self.files:
            if path.suffix in SUFFIXES and path.relative_to(self.root).as_posix() not in NO_REFERENCES:
                self.check(path)
        return sorted(set(self.errors))

    def check(self, path):
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            return
        prose = text if path.suffix == ".md" else comments(text, path.suffix)
        # Messages name sections too; a reference may run over the end of a line.
        self.check_theory(path, joined(text))
        self.check_files(path, prose)
        if path.suffix == ".md":
            self.check_page(path, text)
        if path == self.theory:
            self.check_equations(path, text)

    def check_theory(self, path, text):
        for match in SECTION.finditer(text):
            for part in span(match.group(1)):
                if part not in self.sections:
                    self.error(path, line_of(text, match.start()), f"src/THEORY.md has no section {part}")
        for match in THEORY_PAGE.finditer(text):
            if match.group(1) not in self.sections:
                self.error(path, line_of(text, match.start()), f"src/THEORY.md has no section {match.group(1)}")
        for match in DECISION.finditer(text):
            if match.group(1) not in self.decisions:
                self.error(path, line_of(text, match.start()), f"src/THEORY.md has no Decision {match.group(1)}")
        for match in PAPER.finditer(text):
            missing = numbers(match.group(2)) - self.equations[match.group(1)]
            if missing and path != self.theory:
                self.error(path, line_of(text, match.start()),
                           f"{match.group(1)} {', '.join(sorted(missing))} is not in section 23 of src/THEORY.md")
        for match in LOST.finditer(text):
            self.error(path, line_of(text, match.start()), f"'{match.group(0)}': no such document in the tree")

    def of_manual(self, path, text, name):
        """A page that tools/manual makes (it stands in mkdocs.yml), or a file that the page lets its reader write."""
        pages = self.root / "src/manual"
        if pages not in path.parents or not name:
            return False
        if any(written.endswith(name) for written in re.findall(r"Write this as `([^`]+)`", text)):
            return True
        menu = (pages / "mkdocs.yml").read_text(encoding="utf-8")
        return f": {name.rpartition('../')[2]}\n" in menu

    def check_files(self, path, text):
        for match in FILE.finditer(text):
            name = match.group(1)
            if not NOT_OURS.search(name) and not self.find(path, name) and not self.of_manual(path, text, name):
                self.error(path, line_of(text, match.start()), f"no file '{name}'")
        for match in TEST.finditer(text):
            name = match.group(1).rstrip(".")
            if not self.find(path, name) and not self.find_test(name):
                self.error(path, line_of(text, match.start()), f"no test '{name}'")

    def check_page(self, path, text):
        """Links, and what stands in backticks and looks like a place in the tree."""
        for match in LINK.finditer(text):
            target, _, anchor = match.group(1).partition("#")
            if re.match(r"[a-z]+:", target):
                continue
            at = path if not target else path.parent / target
            if self.of_manual(path, text, target):
                continue
            if not at.exists():
                self.error(path, line_of(text, match.start()), f"link to '{target}', which does not exist")
            elif anchor and anchor not in anchors(at.read_text(encoding="utf-8")):
                self.error(path, line_of(text, match.start()), f"'{target}' has no heading '{anchor}'")
        for match in QUOTED.finditer(text):
            for place in PLACE.finditer(match.group(1)):
                name = place.group(1)
                if not (self.find(path, name) or self.find(path, name + ".*") or self.find_test(name)
                        or self.of_manual(path, text, name)):
                    self.error(path, line_of(text, match.start()), f"no '{name}'")

    def check_equations(self, path, text):
        for match in re.finditer(r"\((\d+\.\d+)\)", text):
            if match.group(1) not in self.own:
                self.error(path, line_of(text, match.start()), f"no equation ({match.group(1)})")
        sources = "\n".join(p.read_text(encoding="utf-8") for p in self.files if p.suffix in (".hpp", ".cpp"))
        for match in re.finditer(r"`(k[A-Z]\w+)`|= (k[A-Z]\w+)", text):
            name = match.group(1) or match.group(2)
            if not re.search(rf"\b{name}\b", sources):
                self.error(path, line_of(text, match.start()), f"no constant {name}")

    def find(self, path, name):
        """A file or folder by its path from the root, from the page, or as the sources name it."""
        root = self.root
        if "/" not in name:
            return any(fnmatch.fnmatch(n, name) for n in self.names)
        bases = [path.parent, root, root / "src", root / "src/kinematics", root / "include/krater", root / "include",
                 root / "tests", root / "include/krater/materials", root / "include/krater/kinematics", root / "inputs"]
        if "*" in name:
            return any(next(base.glob(name), None) for base in bases)
        return any((base / name).exists() for base in bases)

    def find_test(self, name):
        """As ctest names it: the path below tests without _test.cpp, of a script without _test.py or .py."""
        if name.startswith("style/"):
            return f"NAME {name}" in (self.root / "tests/tests.cmake").read_text(encoding="utf-8")
        at = self.root / "tests" / name
        return at.is_dir() or any(at.with_name(at.name + e).is_file() for e in ("_test.cpp", ".cpp", "_test.py", ".py"))


def numbers(text):
    """The numbers of '(8)-(25), (S.36)', ranges filled."""
    out = set()
    for first, last in re.findall(r"\((S?\.?\d+)\)(?:\s*(?:-|to)\s*\((S?\.?\d+)\))?", text):
        mark = "S." if first.startswith("S.") else ""
        low = int(first.removeprefix("S."))
        high = int(last.removeprefix("S.")) if last else low
        out |= {f"({mark}{n})" for n in range(low, high + 1)}
    if "Theorem 1" in text:
        out.add("(Theorem 1)")
    return out


def span(text):
    """The sections of '2-4, 11'."""
    out = []
    for part in re.split(r"\s*(?:,|and)\s*", text):
        ends = re.split(r"\s*-\s*", part)
        if len(ends) == 2 and ends[0].isdigit() and ends[1].isdigit():
            out += [str(n) for n in range(int(ends[0]), int(ends[1]) + 1)]
        else:
            out += ends
    return [part for part in out if part]


def joined(text):
    """A comment that goes on in the next line reads on; positions stay."""
    return re.sub(r"\n([ \t]*(?:///?<?|#)?[ \t]*)", lambda m: "\n" + " " * len(m.group(1)), text)


def comments(text, suffix):
    """Only the comments, the rest blank; positions stay."""
    mark = re.compile(r'"(?:[^"\\\n]|\\.)*"|' + (r"//[^\n]*|/\*.*?\*/" if suffix in (".hpp", ".cpp", ".inl")
                                                 else r'#[^\n]*|"""(.|\n)*?"""'), re.S)
    out, at = [], 0
    for match in mark.finditer(text):
        out.append(re.sub(r"[^\n]", " ", text[at:match.start()]))
        keep = match.group(0).startswith(("/", "#", '"""'))
        out.append(match.group(0) if keep else re.sub(r"[^\n]", " ", match.group(0)))
        at = match.end()
    out.append(re.sub(r"[^\n]", " ", text[at:]))
    return joined("".join(out))


def anchors(text):
    heads = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^\w -]", "", h.lower()).replace(" ", "-") for h in heads}


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def self_test():
    """Plants references that lead nowhere among some that do; returns what went unnoticed."""
    theory = ("# T\n\n## 2. B\n\n    a = b      (2.1)\n\nsee (2.1) and (2.2), `kThere`, `kNot`\n\n## 14. Decisions\n\n"
              "1. one\n\n## 22. X\n\n**D1, impact**\n\n## 23. Papers\n\n| (1)-(3) | x |\n\n**[SPEAR]** (S.36)\n")
    planted = {
        "src/THEORY.md": (theory, 2),
        "src/a.hpp": ("// theory 2, 14, theory\n// 3 and Decision 1, CCF (2), (5); theory D1, theory D2\n"
                      "constexpr int kThere = 1;  ///< numerics A3, architecture 10; b.hpp\n"
                      'const char* text = "theory 4, no.hpp";\n// (unit/a) unit/b, SPEAR (S.36)-(S.37)\n', 9),
        "tests/unit/a_test.cpp": ("\n", 0),
        "tests/tests.cmake": ("add_test(NAME style/x\n", 0),
        "README.md": ("# Head\n[x](src/THEORY.md#2-b) [y](#head) [z](no.md) [w](#none) `tools/no` `style/x` `style/y`\n"
                      "summary.json resolved.yaml `run tests/unit contact/no -o x_out`\n", 6),
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
                missed.append(f"{name}: {expected} errors planted, found {len(found)}: {found}")
    return missed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--self-test", action="store_true", help="check this checker on planted errors")
    parser.add_argument("--root", default=pathlib.Path(__file__).resolve().parent.parent)
    options = parser.parse_args()
    errors = self_test() if options.self_test else Checker(options.root).run()
    for error in errors:
        print(error)
    print(f"check_references: {len(errors)} errors")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
