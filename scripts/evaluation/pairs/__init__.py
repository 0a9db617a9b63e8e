# SPDX-License-Identifier: GPL-3.0-or-later
"""Judging alignments of single pairs of positions: logs with known poses, verdicts, tables, pictures."""
