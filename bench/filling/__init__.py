# SPDX-License-Identifier: Apache-2.0
"""What bench/fill.py measures: label maps of which some slices are left, filled by `kontur fill` and by its peers."""
