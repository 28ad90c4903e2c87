# SPDX-License-Identifier: GPL-3.0-or-later
"""Every YAML block of the manual is a scene that krater takes, every tutorial is run from an empty folder by its own
commands, and the pages are made.

A whole scene is checked as it stands. A fragment is laid on a scene of src/manual/bases that the comment before it names:
<!-- base: all -->, with `; bodies: these` for a scene of the fragment's bodies alone. In tutorials `Write this as X:` stands
before a file, and <!-- suite: A -> B --> before commands says what the suite replaces in the file, <!-- suite: --set a=b -->
what it adds to krater run, check and study, so that it is quick.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import yaml
from scene_support import KRATER, ROOT, Folder, check, finish, krater

PAGES = ROOT / "src" / "manual" / "pages"
FENCE = re.compile(r"((?:<!--[^>]*-->\n)*)^(`{3,})(\w+)\n(.*?)^\2$", re.S | re.M)
NAMED = re.compile(r"Write this as `([\w.]+)`[^`]*\Z")
# Where one of several is chosen, another choice replaces it.
CHOICES = {"shape", "velocity", "kinematics", "eos", "strength", "model", "damage", "transfer", "filter", "where"}
TOOLS = ("plot_run", "plot_scene", "plot_point", "show_summary", "three_cells", "to_vtkhdf")


def overlay(base, over):
    """`over` on `base`, block by block."""
    merged = dict(base)
    for key, value in over.items():
        both = isinstance(value, dict) and isinstance(base.get(key), dict) and key not in CHOICES
        merged[key] = overlay(base[key], value) if both else value
    return merged


def blocks(page):
    """[(language, text, comments, name of the file or None)]."""
    text = page.read_text(encoding="utf-8")
    found = []
    for match in FENCE.finditer(text):
        name = NAMED.search(text[:match.start()].rstrip())
        comments = re.findall(r"<!--\s*(.*?)\s*-->", match[1])
        found.append((match[3], match[4], comments, name[1] if name else None))
    return found


def scene_of(text, comments):
    """The scene to check, or None for what is none (a study)."""
    value = yaml.safe_load(text)
    for comment in comments:
        if comment.startswith("base: "):
            name, _, more = comment[len("base: "):].partition(";")
            base = yaml.safe_load((ROOT / "src/manual/bases" / f"{name}.yaml").read_text(encoding="utf-8"))
            if more.strip() == "bodies: these":
                base["bodies"] = {}
            return overlay(base, value)
    return None if "study" in value else value


def stl_prism(path):
    """A column of 5 mm radius from z = 10 to 40 mm, eight-sided."""
    import math  # pylint: disable=import-outside-toplevel
    ring = [[(5 * math.cos(k * math.pi / 4), 5 * math.sin(k * math.pi / 4), z) for k in range(8)] for z in (10, 40)]
    facets = []
    for k in range(8):
        j = (k + 1) % 8
        facets += [(ring[0][k], ring[0][j], ring[1][j]), (ring[0][k], ring[1][j], ring[1][k]),
                   ((0, 0, 10), ring[0][j], ring[0][k]), ((0, 0, 40), ring[1][k], ring[1][j])]
    text = "".join("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in facet) +
                   "endloop\nendfacet\n" for facet in facets)
    path.write_text(f"solid filler\n{text}endsolid\n", encoding="utf-8")


def every_block(folder):
    stl_prism(folder / "filler.stl")
    shutil.copy(ROOT / "inputs/meshes/round_nosed_rod.inp", folder / "rod.inp")
    count = 0
    for page in sorted(PAGES.rglob("*.md")):
        for number, (language, text, comments, _) in enumerate(blocks(page)):
            if language != "yaml" or "guide: steps" in comments:  # guide_test.py's
                continue
            value = scene_of(text, comments)
            if value is None or page.parent.name == "tutorials":  # run there
                continue
            count += 1
            name = f"{page.stem}_{number}.yaml"
            (folder / name).write_text(yaml.safe_dump(value), encoding="utf-8")
            done = krater("point", name, "-o", f"{name}_out") if "point" in value else krater("check", name)
            check(done.returncode == 0, f"{page.name}, YAML block {number + 1}", done.stderr[:400])
    check(count >= 12, "blocks of YAML were found", str(count))


def commands_folder(folder):
    """krater and its tools by the names they are installed under."""
    folder.mkdir()
    (folder / "krater").symlink_to(KRATER)
    (folder / "python3").symlink_to(sys.executable)  # one that sees Debian's packages
    for tool in TOOLS:
        (folder / f"krater-{tool.replace('_', '-')}").symlink_to(ROOT / "tools" / tool)
    return folder


def prepared(text, comments):
    """Commands with what the suite adds; files are shortened where they stand."""
    more = " ".join(c[len("suite: "):] for c in comments if c.startswith("suite: --"))
    for comment in comments:
        if comment.startswith("suite: ") and " -> " in comment:
            name, _, change = comment[len("suite: "):].partition(": ")
            before, after = change.split(" -> ")
            path = pathlib.Path(name)
            if before not in path.read_text(encoding="utf-8"):
                raise ValueError(f"{name} has no {before}")
            path.write_text(path.read_text(encoding="utf-8").replace(before, after), encoding="utf-8")
    return "\n".join(line + (" " + more if re.match(r"krater (run|check|study) ", line) and more else "")
                     for line in text.splitlines())


def tutorial(page, folder, path):
    """What went wrong, or what was run."""
    work = folder / page.stem
    work.mkdir()
    environment = {**os.environ, "PATH": f"{path}:{os.environ['PATH']}", "OMP_NUM_THREADS": "1", "KRATER": KRATER,
                   "OMP_WAIT_POLICY": "passive", "KRATER_CARDS": str(ROOT / "inputs/materials"),
                   "PYTHONPATH": str(ROOT / "tools"), "MPLBACKEND": "Agg"}
    ran = 0
    for language, text, comments, name in blocks(page):
        if name:
            (work / name).write_text(text, encoding="utf-8")
        elif language == "sh":
            here = os.getcwd()
            os.chdir(work)
            try:
                text = prepared(text, comments)
            except (OSError, ValueError) as error:
                return f"{page.name}: {error}", ran
            finally:
                os.chdir(here)
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=work, env=environment, capture_output=True,
                                  text=True, check=False, timeout=300)
            ran += len(text.splitlines())
            if done.returncode != 0:
                return f"{page.name}: {text.strip()}: exit code {done.returncode}: {(done.stdout + done.stderr)[-500:]}", ran
    return "", ran


def every_tutorial(folder):
    path = commands_folder(folder / "bin")
    pages = sorted((PAGES / "tutorials").glob("*.md"))
    check(len(pages) == 8, "eight tutorials", ", ".join(page.stem for page in pages))
    for page in pages:
        wrong, ran = tutorial(page, folder, path)
        check(not wrong and ran > 0, f"tutorial {page.stem} from an empty folder, {ran} commands", wrong)


def pages_are_made(folder):
    site = shutil.which("mkdocs") is not None
    done = subprocess.run([sys.executable, str(ROOT / "tools/manual"), "-o", str(folder / "manual"),
                           *([] if site else ["--no-site"])], capture_output=True, text=True, check=False,
                          env={**os.environ, "KRATER": KRATER})
    check(done.returncode == 0, "tools/manual" if site else "tools/manual --no-site (mkdocs is missing)", done.stderr[-600:])
    made = (folder / "manual/pages/reference.md").read_text(encoding="utf-8")
    schema = json.loads(krater("schema").stdout)
    blocks = schema["definitions"]
    within = {one["$ref"].rpartition("/")[2]: block["title"] for block in blocks.values() for one in block.get("anyOf", [])}
    missing = [f"{name}.{key}" for name, block in blocks.items() for key in block.get("properties", {})
               if f"| `{key}` |" not in made.partition(f"\n## {within.get(name, block['title'])}\n")[2].partition("\n## ")[0]]
    silent = [name for name in within if f"| `{name.rpartition('.')[2]}` | " not in made]
    check(within and not silent, "and every kind of measure", ", ".join(silent))
    check(not missing, "the reference has every key of every block", ", ".join(missing[:5]))
    if site:
        check((folder / "manual/site/tutorials/taylor.html").is_file(), "pages of the site")


def main():
    with Folder() as folder:
        every_block(folder)
        pages_are_made(folder)
        every_tutorial(folder)
    finish()


if __name__ == "__main__":
    main()
