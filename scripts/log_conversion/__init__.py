# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads laser logs that shapemap does not read itself, and writes them in its text format.

The modules decide nothing that the mapping program can decide: they write down what each message says. They never
print; what a user should know stands in the notes of the log.
"""
