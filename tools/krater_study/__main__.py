# SPDX-License-Identifier: GPL-3.0-or-later
"""Started as `python3 krater_study WORDS...` by src/app/study.cpp."""

import sys

from command import main

sys.exit(main(sys.argv[1:]))
