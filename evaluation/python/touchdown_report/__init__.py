# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of what the program `touchdown` wrote. Reads result files only."""
