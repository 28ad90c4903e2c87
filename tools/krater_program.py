# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the program lies that a tool starts: $KRATER, the one built from this checkout, or the one it was installed with."""

import os
import pathlib
import subprocess

HERE = pathlib.Path(__file__).resolve().parent


def krater():
    """Path of the program as text; it need not be there, so that the caller can say what is missing."""
    if os.environ.get("KRATER"):
        return os.environ["KRATER"]
    folder = HERE / "build_folder"
    if folder.is_file():  # a checkout
        said = subprocess.run([str(folder)], capture_output=True, text=True, check=True).stdout
        return str(pathlib.Path(said.strip()) / "krater")
    return str(HERE.parents[2] / "bin" / "krater")  # PREFIX/share/krater/tools
