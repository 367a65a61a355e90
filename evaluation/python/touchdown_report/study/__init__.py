# SPDX-License-Identifier: BSD-3-Clause
"""The report of a study's folder: tables, statistics, figures, report.html and report.md.

    /usr/bin/python3 -m touchdown_report.study FOLDER

The folder is what `touchdown study` flew (docs/record.md). Statistics are those of scipy and
statsmodels; nothing is flown here.
"""
