# SPDX-License-Identifier: Apache-2.0
"""What make bench measured, turned into docs/performance.md."""
