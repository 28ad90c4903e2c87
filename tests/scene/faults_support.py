# SPDX-License-Identifier: GPL-3.0-or-later
"""Register of faults that were met once, and the runner of faults_test.py. Not a test.

A module of tests/scene/faults/ registers a test for each fault; its input, whose header says what was seen and what is
right, lies beside it. A fault that another issue will mend is registered with `until`: it must fail, and the suite turns
red when it passes by itself.
"""

import dataclasses
import importlib.util
import pathlib
import sys
import time
import traceback

import scene_support
from scene_support import Folder, check, failures

INPUTS = pathlib.Path(__file__).resolve().parent / "faults"
sys.path.insert(0, str(scene_support.ROOT / "tools"))  # expectations


@dataclasses.dataclass
class Fault:
    name: str
    what: str
    test: callable
    until: str  # the issue that will mend it, or ""
    long: bool  # run by tools/hard --faults, not by the fast suite


register = []


def fault(name, what, until="", long=False):
    """Decorator: `name` as in the name of the input ("05", "b13") or a word; `what` is right, in a line."""

    def add(test):
        register.append(Fault(name, what, test, until, long))
        return test

    return add


def scene(start):
    """The input whose name starts so."""
    found = sorted(INPUTS.glob(f"{start}-*.yaml"))
    assert len(found) == 1, f"{start}: {found}"
    return found[0]


def load():
    for path in sorted(INPUTS.glob("*.py")):
        spec = importlib.util.spec_from_file_location(f"faults_{path.stem}", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)


def attempt(one):
    """Failures of one fault's test, in a folder of its own."""
    failures.clear()
    try:
        with Folder():
            one.test()
    except Exception:  # a test that breaks has failed, whatever broke it
        check(False, f"{one.name} ran to its end", traceback.format_exc(limit=3))
    found = list(failures)
    failures.clear()
    return found


def main(arguments):
    """faults_test.py [--long] [NAME...]: all fast faults, all long ones, or those named."""
    load()
    names = [a for a in arguments if not a.startswith("-")]
    unknown = sorted(set(names) - {one.name for one in register})
    if unknown:
        sys.exit(f"no fault {', '.join(unknown)}; known: {' '.join(sorted(one.name for one in register))}")
    chosen = [one for one in register if (one.name in names if names else one.long == ("--long" in arguments))]
    wrong = []
    for one in sorted(chosen, key=lambda f: f.name):
        print(f"---- {one.name}: {one.what}", flush=True)
        start = time.monotonic()
        found = attempt(one)
        took = f"{time.monotonic() - start:.1f} s"
        if one.until and found:
            print(f"---- {one.name}: fails as expected until {one.until} ({took})", flush=True)
        elif one.until:
            wrong.append(f"{one.name}: passes before {one.until}: remove `until`")
        elif found:
            wrong += [f"{one.name}: {text}" for text in found]
        print(f"---- {one.name}: {'FAILED' if wrong and wrong[-1].startswith(one.name + ':') else 'done'} ({took})",
              flush=True)
    scene_support.failures.extend(wrong)
    print(f"{len(chosen)} faults; wrong: {wrong if wrong else 'none'}")
    scene_support.finish()
