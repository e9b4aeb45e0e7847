# SPDX-License-Identifier: Apache-2.0
"""Turns the results of make bench into docs/results/performance.md."""
