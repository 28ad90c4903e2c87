#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Some thousand scenes of a fuzzer are read or refused by name, under sanitizers. Skipped where tools/fuzz has not been built
(build-fuzz/): that takes minutes and clang."""

import subprocess
import sys

from scene_support import ROOT, check, finish

if not (ROOT / "build-fuzz" / "scene_fuzz").exists():
    print("skip  tools/fuzz has not been built")
    sys.exit(77)
done = subprocess.run([str(ROOT / "tools" / "fuzz"), "--runs", "2000", "--seconds", "60"], capture_output=True, text=True, check=False)
check(done.returncode == 0, "tools/fuzz", done.stderr[-1500:] if done.returncode else done.stderr.strip().splitlines()[-1])
finish()
