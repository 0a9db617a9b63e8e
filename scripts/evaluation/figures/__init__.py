# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of "Robot Mapping for Rescue Robots", drawn from the traces that `shapemap-cli --trace` writes."""
