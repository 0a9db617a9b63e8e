#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The one entry of the evaluation: `evaluate.py --help` lists its commands."""

import sys

from evaluation.commands import main

if __name__ == "__main__":
    sys.exit(main())
