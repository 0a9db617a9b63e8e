# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole maps of all methods on all data sets: runs, scores, comparison of two versions, and the report."""
