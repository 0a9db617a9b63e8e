# SPDX-License-Identifier: GPL-3.0-or-later
"""What all of the evaluation shares: command line, tables, files, shares with intervals, poses, running programs."""
