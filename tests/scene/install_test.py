# SPDX-License-Identifier: GPL-3.0-or-later
"""What `cmake --install` puts somewhere works from there: program, cards, examples, tools, manual page, completion, the
Python module; and a checkout that its user may not write is built elsewhere."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np
from scene_support import KRATER, ROOT, Folder, check, finish, gauge_table, history, summary

BUILD = pathlib.Path(os.environ.get("KRATER_BUILD_DIR", pathlib.Path(KRATER).parent))
SHORT = ["--set", "time.end=2 us", "--set", "grid.cell=1.27 mm", "--set", "output.frames=1 us"]
GAUGE = "gauges={visar: {body: rod, at: [0, 25.4 mm], fields: [velocity_z], every: 0.1 us}}"


def call(*words, env=None, cwd=None):
    clean = {name: value for name, value in os.environ.items() if not name.startswith("KRATER")}
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False, cwd=cwd,
                          env={**clean, "OMP_WAIT_POLICY": "passive", **(env or {})})
    done.text = done.stdout + done.stderr
    return done


def tools_work(bin_folder):
    """Every command that is installed knows what it is; those that draw, draw."""
    found = sorted(path.name for path in bin_folder.iterdir())
    check({"krater", "krater-plot-run", "krater-plot-scene", "krater-show-summary", "krater-three-cells"} <= set(found),
          "commands", ", ".join(found))
    for command, wanted in ((["krater-show-summary", "out"], "final_length"), (["krater-plot-run", "out"], "final_shape.png"),
                            (["krater-to-vtkhdf", "out"], "vtkhdf"),
                            (["krater-plot-scene", "taylor_copper.yaml", "-o", "setup.png"], "setup.png"),
                            (["krater-three-cells", "taylor_copper.yaml", "--have", "out", *SHORT], "final_length")):
        done = call(bin_folder / command[0], *command[1:])
        check(done.returncode == 0 and wanted in done.text, f"{command[0]} from the installed place", done.text[-300:])
    done = call(bin_folder / "krater", "study", "--help")
    check(done.returncode == 0, "krater study from the installed place", done.text[-200:])


def pages(prefix):
    page = (prefix / "share/man/man1/krater.1").read_text(encoding="utf-8")
    help_text = call(prefix / "bin/krater", "--help").stdout
    commands = re.findall(r"^  (\w+) +\S", help_text.partition("Subcommands:")[2], re.M)
    check(len(commands) >= 6 and all(f".SS krater {name}" in page for name in commands), "manual page: every command",
          ", ".join(commands))
    check(all(text.replace("-", "\\-") in page for text in ("--accuracy", "--strict", "--set", "--restart")),
          "manual page: options")
    script = (f'PATH="{prefix}/bin:$PATH"; . "{prefix}/share/bash-completion/completions/krater"; '
              'try() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _krater; echo "${COMPREPLY[*]}"; }; '
              'try krater ""; try krater run --re; try krater models ofhc; try krater run taylor')
    said = call("bash", "-c", script).stdout.splitlines()
    check(len(said) == 4 and all(name in said[0].split() for name in commands) and said[1] == "--restart"
          and said[2] == "ofhc_copper" and "taylor_copper.yaml" in said[3], "completion", " | ".join(said))


def module_reads(prefix):
    """krater_results against what the other readers of the suite say."""
    sys.path.insert(0, str(prefix / "lib/python3/dist-packages"))
    import krater_results  # pylint: disable=import-error,import-outside-toplevel
    run = krater_results.read("out")
    told = summary("out")
    rows = history("out")
    check(run.summary == told and np.array_equal(run.history["kinetic_energy"], rows["kinetic_energy"])
          and run.units["kinetic_energy"] == "J" and run.units["time"] == "s", "krater_results: summary, history, units")
    check(run.measures.loc["final_length", "value"] == told["measures"]["final_length"]["value"]
          and run.measures.loc["final_length", "unit"] == "m"
          and run.measures.loc["final_length", "reference"] == 16.205e-3, "krater_results: measures")
    check(np.array_equal(run.gauges["visar"]["velocity_z"], gauge_table("out", "visar")["velocity_z"]),
          "krater_results: gauges")
    last = run.frames[-1]
    table = last.table("rod")
    check(len(run.frames) == 3 and abs(last.time - 2e-6) < 1e-12 and run.frames.at(1.1e-6).time == run.frames[1].time
          and last["rod"]["coordinates"].shape == (len(table), 3) and last.units["rod"]["velocity"] == "m/s"
          and np.array_equal(table["velocity_z"], last["rod"]["velocity"][:, 2])
          and np.array_equal(table["coordinates_z"], last["rod"]["coordinates"][:, 2]), "krater_results: frames",
          f"{len(run.frames)} frames, {list(table.columns)[:6]}")
    for ask, error, word in ((lambda: krater_results.read("nothing"), FileNotFoundError, "holds no results"),
                             (lambda: last["bar"], KeyError, "rod"), (lambda: last["rod"]["colour"], KeyError, "velocity"),
                             (lambda: run.gauges["x"], KeyError, "visar")):
        try:
            ask()
            check(False, f"krater_results: {word}: an error")
        except error as said:
            check(word in str(said), f"krater_results says {word}", str(said)[:120])


def version_tells():
    done = call(KRATER, "--version")
    lines = done.stdout.splitlines()
    check(done.returncode == 0 and len(lines) == 3 and re.match(r"^krater \d+\.\d+\.\d+ \(.*(GNU|Clang)", lines[0])
          and "levels" in lines[1] and "portable" in lines[1] and "HDF5 1." in lines[1] and "runs with: " in lines[2],
          "krater --version: compiler, levels, options", done.text[:300])
    wrong = call(KRATER, "--version", env={"KRATER_ISA": "v9"})
    check(wrong.returncode == 2 and "v9" in wrong.text, "an unknown KRATER_ISA is named", wrong.text[:150])


def read_only_checkout(folder):
    """Another user's checkout: as nobody, who may not write it."""
    shared = folder / "shared"
    (shared / "tools").mkdir(parents=True)
    shutil.copy(ROOT / "tools" / "build_folder", shared / "tools")
    for path in (folder.parent, folder, shared, shared / "tools"):
        path.chmod(0o755)
    mine = call("bash", shared / "tools/build_folder").stdout.strip()
    check(mine == str(shared / "build"), "one's own checkout is built in build/", mine)
    if os.getuid() != 0 or not shutil.which("setpriv"):
        return
    theirs = call("setpriv", "--reuid", "65534", "--clear-groups", "bash", shared / "tools/build_folder",
                  env={"HOME": "/nowhere", "XDG_CACHE_HOME": "/var/cache/x"}).stdout.strip()
    check(theirs.startswith("/var/cache/x/krater/build-"), "a read-only one in the user's cache", theirs)


def main():
    with Folder() as folder:
        version_tells()
        read_only_checkout(folder / "clone")
        prefix = folder / "usr"
        done = call("cmake", "--install", BUILD, "--prefix", prefix)
        if not check(done.returncode == 0, "cmake --install", done.text[-300:]):
            finish()
        examples = prefix / "share/krater/examples"
        check((examples / "taylor_copper.yaml").is_file() and (examples / "meshes/round_nosed_rod.inp").is_file()
              and (prefix / "share/doc/krater/README.md").is_file(), "examples and documents are installed")
        shutil.copy(examples / "taylor_copper.yaml", ".")
        done = call(prefix / "bin/krater", "run", "taylor_copper.yaml", "-o", "out", *SHORT, "--set", GAUGE)
        if check(done.returncode == 0, "the first example runs from the installed place", done.text[-300:]):
            module_reads(prefix)
            tools_work(prefix / "bin")
        pages(prefix)
    finish()


if __name__ == "__main__":
    main()
