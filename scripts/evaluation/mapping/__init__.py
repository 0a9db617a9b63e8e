# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of shapemap-cli on logs, and what its report says."""
