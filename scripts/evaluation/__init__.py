# SPDX-License-Identifier: GPL-3.0-or-later
"""What judges shapemap: `scripts/evaluate.py COMMAND`. A folder imports only itself and those above it in this list.

common      command line, tables, files, shares with intervals, poses, running programs
simulation  worlds, robots and lasers, and the logs that they make, with the truth
logs        which logs there are, their references, variants of them, and how the programs get them
mapping     runs of shapemap-cli on logs, its report, and all of its outputs
judging     how good a map is: pairs of scans, whole maps, loops, joined logs, growth, hard scenes
pairs       alignments of single pairs by `shapemap-cli align`: verdicts, tables, pictures
maps        whole maps of all methods on all data sets: runs, scores, comparison, report
fitting     fits of the weights in use
figures     the figures of the paper from traces, and the gallery of maps
commands    one module for each command; what a command computes belongs into a folder above
"""
