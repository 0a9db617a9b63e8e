# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluation of whole maps: data sets, runs of methods, metrics, comparison, report. Driven by scripts/evaluate.py."""
