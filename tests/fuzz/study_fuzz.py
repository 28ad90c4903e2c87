#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Study files that are nearly right (tools/fuzz study): each is read, and its first members are made, or it is refused by
name. Anything else that is thrown is a fault; the input is then kept in build-fuzz/."""

import argparse
import os
import pathlib
import random
import shutil
import sys
import tempfile
import time
import traceback

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / "krater_study"), str(ROOT / "tests" / "fuzz")]
from command import KINDS, makes  # noqa: E402
from mutants import mutant  # noqa: E402
from study_file import InputError, Study  # noqa: E402


def read(path):
    """What `krater study` does before its first run; false where that is refused."""
    try:
        study = Study(path)
        question = KINDS[study.kind](study)
        for one in question.next([]):
            if not one.name:
                raise AssertionError("a member without a name")
        makes(study)
        study.fixed()
        return True
    except InputError as error:
        if not str(error).startswith((path, os.path.dirname(path))):
            raise AssertionError(f"the refusal does not name the file: {error}") from error
        return False


def starts():
    """The project's studies beside their scenes, and what once failed."""
    found = [path for folder in ("inputs/studies", "inputs/hypervelocity", "inputs/snl", "tests/data/fuzz/study")
             for path in sorted((ROOT / folder).glob("*.yaml"))]
    return [(path, path.read_bytes()) for path in found if b"study:" in path.read_bytes()]


def copy_scenes(folder):
    """A folder like inputs/, in which the scenes of studies are found; returns where studies lie."""
    for name in ("inputs", "inputs/hypervelocity", "inputs/snl"):
        os.makedirs(os.path.join(folder, name), exist_ok=True)
        for path in (ROOT / name).glob("*.yaml"):
            shutil.copy(path, os.path.join(folder, name))
    os.makedirs(os.path.join(folder, "inputs", "studies"))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=20000)
    parser.add_argument("--seconds", type=float, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--replay", action="store_true", help="the files themselves, once each")
    options = parser.parse_args()
    draw, begun, files = random.Random(options.seed), time.monotonic(), starts()
    texts = [text for _, text in files]
    done, accepted = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        copy_scenes(folder)
        total = len(files) if options.replay else options.runs
        for done in range(1, total + 1):
            path, text = files[done - 1] if options.replay else draw.choice(files)
            kind = path.parent.name if path.parent.name in ("hypervelocity", "snl") else "studies"
            target = os.path.join(folder, "inputs", kind, "fuzzed.yaml")
            data = text if options.replay else mutant(draw, text, texts)
            pathlib.Path(target).write_bytes(data)
            try:
                accepted += read(target)
            except Exception:  # noqa: BLE001
                kept = ROOT / "build-fuzz" / f"study-{options.seed}-{done}.yaml"
                kept.parent.mkdir(exist_ok=True)
                kept.write_bytes(data)
                traceback.print_exc()
                sys.exit(f"tools/fuzz: study: input {done} of seed {options.seed} is kept in {kept}")
            if options.seconds and time.monotonic() - begun > options.seconds:
                break
    print(f"study: {done} files: {accepted} read, the rest refused by name; in {time.monotonic() - begun:.0f} s")


if __name__ == "__main__":
    main()
