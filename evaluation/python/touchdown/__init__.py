# SPDX-License-Identifier: BSD-3-Clause
"""Touchdown: optimization-centric trajectory planning, from Python (docs/python.md)."""
from touchdown._touchdown import *  # noqa: F403
from touchdown._touchdown import __version__  # noqa: F401
from touchdown._campaigns import CompareResult, StudyResult, SweepResult, compare, study, sweep
from touchdown._flight import Record, Touchdown, TrialResult, explain_step, load_scenario, run_trial
from touchdown._parts import KEEP, Controller, PadPredictor, Planner, PlanRequest
from touchdown._program import ProgramFailed, program_path, run_program, use_share as _use_share
from touchdown._results import read
from touchdown._solve import solve
from touchdown._terms import Term, Windows
from touchdown._tunable import Parameter

__all__ = [
    "Actuator", "ArrivalMode", "BadInput", "CameraIntrinsics", "CellState", "Certificate", "CheckedPoint", "CheckedView",
    "CompareResult", "ControlOutput", "Controller", "DepthFrame", "DepthImage", "DerivativeErrors", "DescentHold",
    "DescentStyle", "Disturbance", "EndpointMode", "EndpointTarget", "Envelope", "FlatState", "FootForce", "Gate",
    "GoalAt", "HeadingSample", "HeightSample", "HingeLoss", "ImuSample", "KEEP", "LandingContext", "LandingProblem",
    "Limits", "LimitsMode", "LinearLoss", "MapView", "Margins", "MissionMode", "MovingGoal", "OccupancyMap",
    "OccupancyMapOptions", "Onboard", "Optimality", "OwnPositionFix", "OwnStatus", "OwnVelocityFix", "PadGpsFix",
    "PadKnowledge", "PadOutline", "PadPrediction", "PadPredictor", "PadSighting", "PadState", "Parameter",
    "PlanRequest", "Planner", "Problem", "ProgramFailed", "RangeLoss", "Record", "Registries", "ReplanInput",
    "ReplanReason", "ReplanResult", "ReplanStatus", "Replanner", "ReplannerOptions", "Role", "Scenario", "Setpoint",
    "Solvable", "SolveStatus", "Solver", "SolverResult", "SplineState", "SquareLoss", "StudyResult", "SweepResult",
    "Taken", "Taylor", "Term", "TermSetup", "Touchdown", "TransitionReason", "TrialResult", "UniformBspline",
    "VehicleFacts", "VehicleModel", "VehicleState", "Windows", "Wrench", "backends", "check_term", "compare",
    "explain_reason", "explain_step", "hermite", "load_scenario", "program_path", "read", "rest_trajectory",
    "rotor_at", "run_program", "run_trial", "scenarios", "solve", "study", "sweep",
]  # fmt: skip

_use_share()
