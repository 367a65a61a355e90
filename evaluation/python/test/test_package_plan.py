# SPDX-License-Identifier: BSD-3-Clause
"""Curves, maps, predictions, landing problems, replanning and the part that would fly, from Python."""
import copy
import gc
import pickle

import numpy as np
import pytest

import the_package

td = the_package.touchdown

START = [-4.0, 0.0, 1.5]


def wall(**options):
    place = td.OccupancyMap(td.OccupancyMapOptions(**options), centre=START)
    y, z = np.meshgrid(np.arange(-1.0, 1.01, 0.1), np.arange(0.05, 3.0, 0.1))
    place.set_occupied(np.stack([np.zeros(y.size), y.ravel(), z.ravel()], axis=1))
    place.mark_rest_free()
    return place


def ask(t=0.0, p=START, v=(0.0, 0.0, 0.0)):
    vehicle = td.VehicleState(t=t, p_WB=p, v_WB=v)
    return td.ReplanInput(t_now=t, t_start=t + 0.02, vehicle=vehicle, endpoint=td.EndpointTarget(height=0.0))


# Plain data


def test_plain_data_takes_its_attributes_by_name_and_tells_them():
    limits = td.Limits(speed=2.0, pull_W=[0.0, 1.0, 0.0])
    assert limits.speed == 2.0 and limits.acceleration == 6.0
    assert "speed=2.0" in repr(limits)
    with pytest.raises(ValueError, match="read-only"):  # a view
        limits.pull_W[0] = 3.0
    limits.pull_W = [3.0, 1.0, 0.0]
    assert limits.pull_W.tolist() == [3.0, 1.0, 0.0]
    twin = copy.deepcopy(limits)
    twin.speed = 5.0
    assert limits.speed == 2.0


def test_plain_data_refuses_what_it_has_not():
    with pytest.raises(TypeError, match="Limits has no sped, it has speed, acceleration"):
        td.Limits(sped=2.0)
    with pytest.raises(TypeError):
        td.Limits(speed="fast")
    with pytest.raises(TypeError):
        td.Limits(pull_W=[1.0, 2.0])


def test_a_view_outlives_its_owner():
    pull = td.Limits(pull_W=[1.0, 2.0, 3.0]).pull_W
    points = td.hermite(td.SplineState(), td.SplineState(p=[1.0, 0.0, 0.0]), 6, 2.0).control_points
    gc.collect()
    [td.Limits() for _ in range(1000)]
    assert pull.tolist() == [1.0, 2.0, 3.0]
    assert points.shape == (9, 3) and points[-2].tolist() == pytest.approx([1.0, 0.0, 0.0])


# Curves


def test_a_curve_meets_its_ends_and_cannot_be_written():
    curve = td.hermite(td.SplineState(p=[0, 0, 1], v=[1, 0, 0]), td.SplineState(p=[4, 1, 2]), 10, 3.0, t0=5.0)
    assert (curve.t0, curve.t_end, curve.segments) == (5.0, pytest.approx(8.0), 10)
    assert curve.at(5.0).v_WB == pytest.approx([1, 0, 0])
    assert curve.at(curve.t_end).p_WB == pytest.approx([4, 1, 2])
    with pytest.raises(ValueError):
        curve.control_points[0, 0] = 1.0
    times = np.linspace(5.0, 8.0, 7)
    np.testing.assert_allclose(curve.sample(times)[3], curve.at(6.5).p_WB)
    np.testing.assert_allclose(curve.sample(times, 2)[3], curve.at(6.5).a_WB)
    same = td.UniformBspline(curve.control_points, curve.interval, curve.t0)
    assert same.squared_jerk() == curve.squared_jerk()
    bounds = curve.bounds()
    assert np.linalg.norm(curve.sample(times, 1), axis=1).max() <= bounds["speed"]


@pytest.mark.parametrize(
    "points, interval", [(np.zeros((3, 3)), 1.0), (np.full((6, 3), np.nan), 1.0), (np.zeros((6, 3)), 0.0)]
)
def test_a_curve_that_is_none_is_refused(points, interval):
    with pytest.raises(ValueError):
        td.UniformBspline(points, interval)


def test_a_rest_trajectory_ends_at_rest():
    curve = td.rest_trajectory(td.SplineState(v=[2.0, 0.0, 0.0]), 1.0)
    assert np.linalg.norm(curve.at(curve.t_end).v_WB) < 1e-9
    with pytest.raises(ValueError, match="must be > 0"):
        td.rest_trajectory(td.SplineState(), 0.0, limits=td.Limits(speed=0.0))


# Predictions


def test_a_goal_that_moves_is_differentiated_exactly():
    goal = td.MovingGoal(lambda t: (2.0 + 0.5 * t, np.sin(t), np.exp(-t) + np.sqrt(t + 1.0)))
    at = goal.at(2.0)
    assert at.p_WP == pytest.approx([3.0, np.sin(2.0), np.exp(-2.0) + np.sqrt(3.0)])
    assert at.v_WP == pytest.approx([0.5, np.cos(2.0), -np.exp(-2.0) + 0.5 / np.sqrt(3.0)])
    assert at.a_WP[1] == pytest.approx(-np.sin(2.0)) and at.j_WP[1] == pytest.approx(-np.cos(2.0))
    assert not goal.has_deck
    assert goal.positions([0.0, 1.0]).shape == (2, 3)


def test_a_goal_that_is_no_function_is_refused():
    with pytest.raises(TypeError):
        td.MovingGoal(3.0)
    with pytest.raises(ValueError):
        td.GoalAt([np.nan, 0.0, 0.0])


# Maps


def test_a_map_from_points_blocks_around_them():
    place = wall()
    assert place.blocked([[0.0, 0.0, 1.5], [-3.0, 0.0, 1.5], [500.0, 0.0, 0.0]]).tolist() == [True, False, False]
    states = place.states()
    assert states.shape == tuple(place.size[::-1]) and set(np.unique(states)) == {1, 2}
    assert (states == 2).sum() >= 0.95 * 21 * 29
    through = td.hermite(td.SplineState(p=START), td.SplineState(p=[4, 0, 1.5]), 10, 4.0)
    assert 0.0 < place.first_blocked(through) < 4.0
    twin = td.OccupancyMap(centre=START)
    twin.set_states(states)
    np.testing.assert_array_equal(twin.states(), states)


@pytest.mark.parametrize(
    "call",
    [
        lambda m: m.set_occupied([[np.nan, 0.0, 0.0]]),
        lambda m: m.set_states(np.zeros((2, 2, 2), np.uint8)),
        lambda m: m.set_states(np.full(m.size[::-1], 9, np.uint8)),
        lambda m: m.mark_free([0.0, 0.0, np.inf], 1.0),
        lambda m: m.mark_free([0.0, 0.0, 0.0], -1.0),
        lambda m: m.recentre([np.nan, 0.0, 0.0]),
        lambda m: m.integrate(td.DepthFrame(depth=[1.0, 2.0])),
        lambda m: m.read_octomap("nowhere.bt"),
        lambda m: td.OccupancyMap(td.OccupancyMapOptions(resolution=-1.0)),
    ],
)
def test_a_map_refuses(call):
    with pytest.raises(ValueError):
        call(wall())


def test_a_depth_image_frees_and_blocks():
    place = td.OccupancyMap(centre=[0.0, 0.0, 1.5])
    frame = td.DepthFrame(
        p_WC=[0.0, 0.0, 1.5], R_WC=[[0, 0, 1], [-1, 0, 0], [0, -1, 0]], depth=np.full(80 * 60, 3.0)
    )
    place.integrate(frame)
    assert place.count_observed_free() > 1000
    assert place.blocked([[3.05, 0.0, 1.5]])[0]


# The landing problem


def landing(**options):
    problem = td.LandingProblem(20, **options)
    problem.set_boundary(td.SplineState(p=[0.0, 0.0, 3.0]), td.MovingGoal(lambda t: (5.0 + t, np.sin(t), 1.0)))
    problem.set_duration(4.0)
    return problem


def test_a_landing_ends_above_the_pad():
    for arrival in ("fixed", "free"):
        problem = landing(arrival=arrival)
        solved = td.solve(problem)
        assert solved.status == "converged"
        curve = problem.curve(solved.x)
        pad = td.MovingGoal(lambda t: (5.0 + t, np.sin(t), 1.0)).at(curve.t_end)
        np.testing.assert_allclose(curve.at(curve.t_end).p_WB, pad.p_WP + [0.0, 0.0, 1.5], atol=1e-6)
        np.testing.assert_allclose(curve.at(curve.t_end).v_WB, pad.v_WP, atol=1e-6)


def test_the_pad_lives_as_long_as_the_problem():
    problem = landing()
    gc.collect()
    assert td.solve(problem).usable


def test_a_boundary_that_raises_leaves_nothing_dangling():
    class Odd:
        raises = False

        def at(self, t):
            if self.raises:
                raise LookupError("no pad")
            return td.PadState(p_WP=[5.0, 0.0, 1.0])

    problem = td.LandingProblem(10)
    problem.set_boundary(td.SplineState(p=[0.0, 0.0, 3.0]), td.GoalAt([5.0, 0.0, 1.0]))
    odd = Odd()
    odd.raises = True
    for _ in range(5):
        with pytest.raises(LookupError, match="no pad"):
            problem.set_boundary(td.SplineState(p=[0.0, 0.0, 3.0]), odd)
            td.solve(problem)
        gc.collect()
        with pytest.raises(LookupError, match="no pad"):
            problem.set_duration(3.0)
            td.solve(problem)
    odd.raises = False
    problem.set_boundary(td.SplineState(p=[0.0, 0.0, 3.0]), odd)
    assert td.solve(problem).usable


def test_what_a_goal_raises_comes_out():
    with pytest.raises(ZeroDivisionError):
        td.MovingGoal(lambda t: 1 / 0).at(0.0)


@pytest.mark.parametrize(
    "thing", [td.Limits(speed=2.0, pull_W=[1.0, 2.0, 3.0]), td.hermite(td.SplineState(), td.SplineState(p=[1, 0, 0]), 6, 1.0)]
)
def test_plain_data_and_curves_are_pickled(thing):
    for twin in (pickle.loads(pickle.dumps(thing)), copy.copy(thing), copy.deepcopy(thing)):
        assert repr(twin) == repr(thing) and twin is not thing


def test_a_map_tells_what_was_observed_free():
    place = wall()
    assert place.observed_free([[0.0, 0.0, 1.5], [-3.0, 0.0, 1.5], [500.0, 0.0, 0.0]]).tolist() == [False, True, False]
    place.set_states(np.where(place.states() == 2, 0, 1))  # of int64
    assert place.observed_free([[-3.0, 0.0, 1.5]])[0] and not place.blocked([[0.0, 0.0, 1.5]])[0]


def test_a_landing_problem_refuses():
    with pytest.raises(ValueError, match="segments"):
        td.LandingProblem(3)
    with pytest.raises(ValueError, match="before SetBoundary"):
        td.LandingProblem(10).guess()
    with pytest.raises(ValueError, match="smothness"):
        td.LandingProblem(10, terms={"smothness": {"weight": 1.0}})
    with pytest.raises(TypeError, match="predicts nothing"):
        td.LandingProblem(10).set_boundary(td.SplineState(), 3.0)
    with pytest.raises(ValueError, match="duration"):
        landing().set_duration(-1.0)
    with pytest.raises(ValueError, match="pairs"):
        landing().set_pairs(np.arange(999) % 20, np.zeros((999, 3)), np.ones((999, 3)))


def test_a_term_sees_the_pad_during_the_call_alone():
    kept = []

    class Above(td.Term):
        window, uses_interval, weight = 3, True, 5.0

        def value(self, w):
            pad = self.context.pad.positions(w.t)
            kept.append(self.context.pad)
            return w.position[:, 2:] - pad[:, 2:] - 1.0

        def loss(self):
            return td.HingeLoss(self.weight, 0.5)

    parts = td.Registries()
    parts.add(Above)
    problem = landing(registries=parts)
    without = td.solve(landing())
    solved = td.solve(problem)
    assert solved.cost_by_term["above"] > 0.0 and not np.allclose(solved.x, without.x)
    with pytest.raises(RuntimeError, match="of a call that has ended"):
        kept[-1].at(0.0)


def test_the_time_of_a_window_is_that_of_its_position():
    seen = []

    class Looks(td.Term):
        window, uses_interval = 3, True

        def value(self, w):
            seen.append((w.t, w.position, w.velocity, w.acceleration))
            return 0.0 * w.position[:, 2]

    parts = td.Registries()
    parts.add(Looks, check=False)
    problem = landing(registries=parts)
    guess = problem.guess()
    problem.evaluate(guess, gradient=False)
    curve = problem.curve(guess)
    t, *states = seen[-1]
    assert len(t) > 3 and t[0] == curve.t0
    for k in range(len(t)):
        at = curve.at(t[k])
        np.testing.assert_allclose([s[k] for s in states], [at.p_WB, at.v_WB, at.a_WB], atol=1e-9)


def test_wrong_slopes_are_found_when_a_term_is_entered():
    class Wrong(td.Term):
        window = 3

        def value(self, w):
            return np.sin(w.position)[:, 2:]

        def jacobian(self, w):
            return np.ones((len(w.t), 1, 3, 3))

    with pytest.raises(ValueError, match=r"derivatives disagree.*jacobian gives du\[.*\] = 1, differences"):
        td.Registries().add(Wrong)
    with pytest.raises(ValueError, match="derivatives disagree"):
        td.check_term(Wrong)
    parts = td.Registries()
    before = parts.terms
    with pytest.raises(ValueError):
        parts.add(Wrong)
    assert parts.terms == before


@pytest.mark.parametrize("name", td.Registries().terms)
def test_the_librarys_terms_pass_the_check(name):
    rows = td.check_term(name, trials=2)
    assert max(row["gradient"] for row in rows) < 1e-4


# Replanning


def test_a_replanner_flies_around_a_wall():
    place, planner, there = wall(), td.Replanner(), np.array([4.0, 0.5, 1.2])
    planner.commit_hover(START)
    goal, clearance = td.GoalAt(there), []
    for k in range(200):
        now = planner.reference(0.1 * k)
        clearance.append(place.blocked([now.p_WB])[0])
        if np.linalg.norm(now.p_WB - there) < 0.05 and np.linalg.norm(now.v_WB) < 0.05:
            break
        answer = planner.replan(place, ask(0.1 * k, now.p_WB, now.v_WB), goal, explain=k == 0)
        if k == 0:
            first = answer
    assert k == 52, "as docs/library.md's program in C++: there after 5.2 s"
    assert not any(clearance)
    assert first.status == "planned" and first.reason == "none" and first.certificate.passed
    assert first.attempts[0]["rounds"][0]["cost_by_term"]
    assert first.curve.t0 == pytest.approx(0.02) and first.times["total"]["wall_s"] > 0.0


def test_an_answer_is_kept_while_the_next_is_asked():
    place, planner = wall(), td.Replanner()
    planner.commit_hover(START)
    first = planner.replan(place, ask(), td.GoalAt([4.0, 0.5, 1.2]))
    before = first.curve.control_points.copy()
    planner.replan(place, ask(0.1, planner.reference(0.1).p_WB), td.GoalAt([4.0, -3.0, 1.2]))
    np.testing.assert_array_equal(first.curve.control_points, before)


def test_a_term_of_ones_own_is_in_the_replanner():
    class Low(td.Term):
        window, weight = 3, 50.0

        def value(self, w):
            return w.position[:, 2:] - 1.4

        def loss(self):
            return td.HingeLoss(self.weight, 0.2)

    parts = td.Registries()
    parts.add(Low)
    heights = []
    for registries in (None, parts):
        planner = td.Replanner(registries=registries)
        planner.commit_hover(START)
        answer = planner.replan(wall(), ask(), td.GoalAt([4.0, 0.5, 1.2]))
        curve = answer.curve
        heights.append(curve.sample(np.linspace(curve.t0, curve.t_end, 50))[:, 2].mean())
    assert heights[1] < heights[0] - 0.02


def test_a_replanner_refuses():
    with pytest.raises(ValueError, match="simplex"):
        td.Replanner(td.ReplannerOptions(backend="simplex"))
    planner = td.Replanner()
    with pytest.raises(ValueError, match="before commit_hover"):
        planner.reference(0.0)
    with pytest.raises(ValueError, match="CommitHover"):
        planner.replan(wall(), ask(), td.GoalAt([0.0, 0.0, 2.0]))
    planner.commit_hover(START)
    odd = planner.replan(wall(), td.ReplanInput(t_now=np.nan), td.GoalAt([0.0, 0.0, 2.0]))
    assert odd.reason == "invalid_input" and odd.detail and odd.explanation


def test_what_a_prediction_raises_comes_out():
    class Odd:
        def at(self, t):
            raise LookupError("no pad today")

    planner = td.Replanner()
    planner.commit_hover(START)
    with pytest.raises(LookupError, match="no pad today"):
        planner.replan(wall(), ask(), Odd())


# The part that would fly


def test_onboard_hovers_and_follows_what_it_is_told():
    model = td.load_scenario("open").vehicle_model()
    onboard = td.Onboard(model, deck_height=0.5)
    state = td.VehicleState(p_WB=[0.0, 0.0, 2.0])
    assert onboard.take(state) == "used"
    onboard.begin(0.0, np.full(4, 0.25 * model.hover_thrust))
    for k in range(200):
        t = 0.002 * k
        state.t = t
        onboard.take(state)
        if k % 50 == 0:
            assert onboard.take(td.PadGpsFix(t=t, p_WP=[4.0 + 0.5 * t, 1.0], sigma=0.05)) == "used"
        setpoint = onboard.step(t)
    assert setpoint.armed and setpoint.wrench.thrust == pytest.approx(model.hover_thrust, rel=0.5)
    assert onboard.status["pad_known"] and onboard.pad_at(0.4).p_WP[0] == pytest.approx(4.2, abs=0.2)
    assert onboard.own.p_WB.tolist() == [0.0, 0.0, 2.0]
    assert onboard.map().count_observed_free() > 0
    assert onboard.take(td.FootForce(t=np.nan)) == "invalid"
    assert onboard.status["time"] == "good" and setpoint.valid_until == setpoint.t + 0.1
    assert not setpoint.level and onboard.step(1.7e9).t == setpoint.t and onboard.status["time"] == "leap"


def test_a_vehicle_of_ones_own_lands_in_a_world_of_ones_own():
    """docs/examples/onboard in Python, without its wall: an autopilot at the wanted attitude, feet on a spring."""
    hubs = [(0.12, 0.12), (-0.12, 0.12), (-0.12, -0.12), (0.12, -0.12)]
    rotors = [td.rotor_at([*hub, 0.04], 0.016 if i % 2 == 0 else -0.016, 7.0) for i, hub in enumerate(hubs)]
    model = td.VehicleModel(actuators=rotors)
    onboard = td.Onboard(model, deck_height=0.5, estimate_disturbance=False)
    p, v, t, force, dt = np.array([0.0, 0.0, 2.0]), np.zeros(3), 0.0, 0.0, 0.002
    frame = td.DepthImage(p_BC=[0.1, 0, 0], R_BC=[[0, 0, 1], [-1, 0, 0], [0, -1, 0]])
    onboard.take(td.VehicleState(p_WB=p))
    onboard.begin(0.0, np.full(4, 0.25 * model.hover_thrust))
    for k in range(15000):
        pad = np.array([3.0 + 0.3 * t, 0.5, 0.5])
        onboard.take(td.VehicleState(t=t, p_WB=p, v_WB=v))
        onboard.take(td.FootForce(t=t, force=force))
        if k % 50 == 0:
            onboard.take(td.PadGpsFix(t=t, p_WP=pad[:2], sigma=0.05))
            rows = (np.arange(60) - 29.5) / 40.0  # of the image, down; what lies below is the ground
            depth = np.where(rows > 0.0, p[2] / np.maximum(rows, 1e-9), np.inf)
            far = depth * np.sqrt(1.0 + rows**2) > frame.max_range
            frame.depth = np.repeat(np.where(far, np.inf, depth), 80)
            frame.t = t
            onboard.take(frame)
        if k % 25 == 0 and np.linalg.norm((pad - p)[:2]) < 0.8 * (p - pad)[2]:
            onboard.take(td.PadSighting(t=t, p_BP_B=pad - p, sigma_p=[0.005] * 3, sigma_yaw=0.01, tags_seen=5))
        setpoint = onboard.step(t)
        if not setpoint.armed:
            break
        a = setpoint.R_WB[:, 2] * setpoint.wrench.thrust / model.mass_kg - [0.0, 0.0, 9.81]
        stands = (p - pad)[2] < model.foot_depth and np.abs((p - pad)[:2]).max() < 0.75
        force = max(0.0, 2000.0 * (model.foot_depth - (p - pad)[2]) - 60.0 * v[2]) if stands else 0.0
        a = a + [0.0, 0.0, force / model.mass_kg] - (20.0 / model.mass_kg * (v - [0.3, 0, 0]) * [1, 1, 0] if stands else 0.0)
        v = v + dt * a
        p = p + dt * v
        t += dt
    assert not setpoint.armed and np.linalg.norm((p - pad)[:2]) < 0.3, (onboard.status, p - pad)


def test_onboard_refuses():
    model = td.load_scenario("open").vehicle_model()
    with pytest.raises(ValueError):
        td.Onboard(model, 0.5, envelope=td.Envelope(speed=-1.0))
    with pytest.raises(ValueError):
        td.Onboard(model, 0.5).begin(0.0, np.full(4, 2.0))
    with pytest.raises(ValueError, match="thrusts has 99 numbers"):
        td.Onboard(model, 0.5).begin(0.0, np.zeros(99))
