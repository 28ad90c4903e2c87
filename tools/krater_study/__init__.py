# SPDX-License-Identifier: GPL-3.0-or-later
"""`krater study`: many runs of one scene, and what they say. Started by src/app/study.cpp.

    study_file  the study file -> Study        members     runs as child processes with folders of their own
    refinement  convergence                    settings    pareto, ablation, sweep
    search      ballistic_limit, calibrate     accuracy    krater run --accuracy
    uncertainty error of a number by cells     results     csv, h5, json; page: html; pictures

A kind is a class with `next(rows)`, the members that it wants run now (none: the question can be answered), and
`answer(rows)`. What it asks next depends on finished rows only, so a study goes on from what lies on disk.
"""
