# SPDX-License-Identifier: BSD-3-Clause
"""Which outcomes of a trial are a success: the task is done."""

DONE = ("landed", "followed", "arrived")
