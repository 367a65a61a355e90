# SPDX-License-Identifier: BSD-3-Clause
"""Touchdown: optimization-centric trajectory planning, from Python (docs/python.md)."""
from touchdown._touchdown import *  # noqa: F401,F403
from touchdown._touchdown import __version__  # noqa: F401
from touchdown._campaigns import CompareResult, StudyResult, SweepResult, compare, study, sweep  # noqa: F401
from touchdown._flight import Record, Touchdown, TrialResult, explain_step, load_scenario, run_trial  # noqa: F401
from touchdown._parts import KEEP, Controller, PadPredictor, Planner, PlanRequest  # noqa: F401
from touchdown._program import ProgramFailed, program_path, run_program, use_share as _use_share  # noqa: F401
from touchdown._results import read  # noqa: F401
from touchdown._solve import solve  # noqa: F401
from touchdown._terms import Term, Windows  # noqa: F401
from touchdown._tunable import Parameter  # noqa: F401

_use_share()
