# SPDX-License-Identifier: GPL-3.0-or-later
"""Alignments of single pairs of positions, judged: runs of `shapemap-cli align`, verdicts, tables, pictures."""
