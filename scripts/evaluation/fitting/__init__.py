# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits of the weights in use: scores of poses, and the probabilities of alignments and edges."""
