# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs that are evaluated: which there are, their references, variants of them, and how the programs get them."""
