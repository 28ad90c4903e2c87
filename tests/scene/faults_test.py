#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every fault that was met once stays mended: the inputs of tests/scene/faults/ with their pass criteria.

    tests/scene/faults_test.py             the fast ones
    tests/scene/faults_test.py --long      those that take minutes (tools/hard --faults)
    tests/scene/faults_test.py 05 b13      the named ones
"""

import sys

from faults_support import main

main(sys.argv[1:])
