# SPDX-License-Identifier: GPL-3.0-or-later
"""How good a map is: pairs of scans, whole maps, loops, joined logs, growth; and scenes with what is expected there."""
