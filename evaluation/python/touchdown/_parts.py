# SPDX-License-Identifier: BSD-3-Clause
"""Planners, controllers and pad predictors that are written in Python."""
from dataclasses import dataclass
from typing import Any, ClassVar, Dict, Union

from touchdown import _touchdown
from touchdown._ranges import Range
from touchdown._tunable import Tunable


class _Keep:
    def __repr__(self) -> str:
        return "KEEP"


KEEP = _Keep()
"""What `Planner.plan` gives where the committed curve is to go on."""


@dataclass
class PlanRequest:
    """What a planner is asked.

    t_now     when the question is put [s]
    t_start   when the answer takes over [s]: where its curve has to start
    start     SplineState of the committed curve at t_start, in W
    vehicle   VehicleState, estimated at t_now
    pad       where the pad will be: pad.at(t), pad.positions(times), pad.end_state(endpoint, t_arrival)
    endpoint  EndpointTarget: where above the pad the curve is to end; endpoint.touches: in contact
    map       MapView: what is known of the obstacles, grown by planning.clearance
    limits    Limits of speed and acceleration

    `pad` and `map` may be used only during the call.
    """

    t_now: float
    t_start: float
    start: _touchdown.SplineState
    vehicle: _touchdown.VehicleState
    pad: _touchdown.PadPrediction
    endpoint: _touchdown.EndpointTarget
    map: _touchdown.MapView
    limits: _touchdown.Limits


class _Part(Tunable):
    """What parts of a scenario have in common.

    name        the word in a scenario; by default the class's in snake case
    summary     one line; by default the first of the docstring
    parameters  {name: Parameter}: attributes of an instance, and keys NAME.PARAMETER of a scenario. A number of that
                name in the body of a subclass is its default
    """

    summary: str = ""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if not cls.__dict__.get("summary"):
            cls.summary = ((cls.__doc__ or "").strip() or "written in Python").splitlines()[0]


class Planner(_Part):
    """A planner of one's own, in the loop of our own and of EGO-Planner: `plan` gives a curve for each question.

    lands   True: its plans may end in contact, and it flies `descent: planned`. False: it stays above the pad and sinks
            with it
    avoids  it keeps clear of the map
    rate    at which it is asked [Hz]; 0: `planning.rate`

    An instance also has `limits`, `floor_height` and `ceiling_height` of the scenario. The library holds the curves and
    flies the older one until t_start. It brakes where there is no plan and climbs when the mission asks.
    """

    lands: bool = True
    avoids: bool = True
    rate: float = 0.0
    limits: _touchdown.Limits
    floor_height: float = 0.0
    ceiling_height: float = 0.0
    _ranges: ClassVar[Dict[str, Range]] = {"rate": (0.0, 100.0)}

    def plan(self, request: PlanRequest) -> Union[_touchdown.UniformBspline, _Keep, str, None]:
        """The curve to be flown from request.t_start on: a UniformBspline whose t0 is request.t_start. KEEP: the
        committed curve goes on. None, or a word of ReplanReason ("search_failed"): no curve, and the vehicle brakes."""
        raise NotImplementedError(f"planner {self.name} has no plan(self, request)")


class Controller(_Part):
    """A tracking law of one's own, asked 500 times a second.

    compensates  it is told of the estimated disturbance, and its thrusts lead the rotors' lag
    vehicle      VehicleModel
    """

    compensates: bool = True
    vehicle: _touchdown.VehicleModel

    def update(
        self,
        state: _touchdown.VehicleState,
        reference: _touchdown.FlatState,
        disturbance: _touchdown.Disturbance,
        tilt_most: float,
    ) -> _touchdown.ControlOutput:
        """A ControlOutput for the VehicleState and the wanted FlatState."""
        raise NotImplementedError(f"controller {self.name} has no update(...)")


class PadPredictor(_Part):
    """Predicts the pad from what the filter knows of it."""

    def predict(self, known: _touchdown.PadKnowledge) -> Any:
        """An object with at(t), which gives a PadState, for PadKnowledge; known.predict() is the library's."""
        raise NotImplementedError(f"predictor {self.name} has no predict(self, known)")
