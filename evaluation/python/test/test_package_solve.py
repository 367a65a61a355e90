# SPDX-License-Identifier: BSD-3-Clause
"""Problems, terms and solves from Python."""
import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import the_package

td = the_package.touchdown


class Valley(td.Term):
    """Rosenbrock's valley as a chain."""

    window, outputs, weight = 2, 2, 2.0

    def value(self, w):
        x, y = w.q[:, 0, 0], w.q[:, 1, 0]
        return 10.0 * (y - x**2), 1.0 - x


class ValleyWithSlopes(Valley):
    def jacobian(self, w):
        du = np.zeros((len(w.t), 2, 2, 1))
        du[:, 0, 0, 0] = -20.0 * w.q[:, 0, 0]
        du[:, 0, 1, 0] = 10.0
        du[:, 1, 0, 0] = -1.0
        return du


class Product(td.Term):
    window = 3

    def value(self, w):
        x = w.q[:, :, 0]
        return x[:, 0] * x[:, 1] + x[:, 2]

    def loss(self):
        return td.RangeLoss(-np.inf, 1.5)


def valley(n, term=Valley):
    problem = td.Problem(n)
    problem.add(term())
    return problem


@pytest.mark.parametrize("backend", [b["name"] for b in td.backends() if b["compiled"]])
def test_every_backend_solves_a_problem_of_ones_own(backend):
    solved = td.solve(valley(10), np.full(10, 0.5), backend, max_iterations=5000, max_evaluations=100000)
    assert solved.usable
    assert solved.cost < 1e-4, (backend, solved)
    assert np.allclose(solved.x, 1.0, atol=5e-2)


@pytest.mark.parametrize("term", [Valley, ValleyWithSlopes])
def test_own_slopes_and_differences_come_to_the_same(term):
    problem = valley(30, term)
    at = problem.evaluate(np.linspace(-1.0, 1.0, 30), hessian=True)
    exact = valley(30, ValleyWithSlopes).evaluate(np.linspace(-1.0, 1.0, 30), hessian=True)
    assert at["cost"] == exact["cost"]
    np.testing.assert_allclose(at["gradient"], exact["gradient"], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(at["hessian"], exact["hessian"], rtol=1e-6, atol=1e-5)
    assert problem.check_derivatives(np.linspace(-1.0, 1.0, 30)).worst < 1e-4


def test_rows_and_bounds_are_kept():
    problem = valley(50)
    problem.add(Product(), "rows")
    problem.set_bounds(np.full(50, -2.0), np.full(50, 0.9))
    solved = td.solve(problem, np.full(50, -1.0))
    assert solved.status == "converged"
    assert solved.max_violation <= 1e-6 and solved.x.max() <= 0.9 + 1e-9
    assert len(solved.multipliers) == 2 and len(solved.multipliers[1]) == 48


def test_a_free_interval_is_the_last_variable():
    class Way(td.Term):
        window, uses_interval, weight = 2, True, 1.0

        def value(self, w):  # speed 2, of a step in h
            return (w.q[:, 1, 0] - w.q[:, 0, 0]) / w.h - 2.0

    class Step(td.Term):
        window, linear = 2, True

        def value(self, w):
            return w.q[:, 1, 0] - w.q[:, 0, 0] - 1.0

    class First(td.Term):
        windows = 1

        def value(self, w):
            return w.q[:, 0, 0]

    problem = td.Problem(5, free_interval=True, interval=2.0)
    for term in (Way(), Step(), First()):
        problem.add(term)
    solved = td.solve(problem, [0.0, 1.0, 2.0, 3.0, 4.0, 2.0])
    assert solved.status == "converged"
    assert solved.x[-1] == pytest.approx(0.5, abs=1e-6)
    assert problem.check_derivatives(solved.x + 0.1).worst < 1e-4


def test_the_time_of_a_window_moves_with_the_interval():
    class Clock(td.Term):
        uses_interval = True

        def value(self, w):
            return w.t * w.q[:, 0, 0]

    problem = td.Problem(4, free_interval=True, interval=0.5, t0=3.0)
    problem.add(Clock())
    at = problem.evaluate([1.0, 1.0, 1.0, 1.0, 0.5])
    assert at["cost"] == pytest.approx(0.5 * sum((3.0 + 0.5 * k) ** 2 for k in range(4)))
    assert at["gradient"][-1] == pytest.approx(sum(k * (3.0 + 0.5 * k) for k in range(4)), rel=1e-9)


def test_trace_and_shares_are_there_where_they_are_asked_for():
    solved = td.solve(valley(10), np.full(10, 0.5), trace=True, shares=True)
    assert len(solved.trace) == solved.iterations > 0
    assert solved.shares["evaluation_s"] > 0.0
    assert not td.solve(valley(10), np.full(10, 0.5)).trace


def test_a_callback_ends_the_solve_and_sees_its_points():
    seen = []

    def callback(y, cost, max_violation, evaluations):
        seen.append((y.copy(), cost))
        return evaluations >= 3

    solved = td.solve(valley(10), np.full(10, 0.5), callback=callback)
    assert solved.status == "stopped" and solved.usable
    assert len(seen) >= 3 and seen[0][0].shape == (10,)


def test_what_python_raises_comes_out():
    class Broken(td.Term):
        def value(self, w):
            raise KeyError("mine")

    problem = td.Problem(3)
    problem.add(Broken())
    with pytest.raises(KeyError, match="mine"):
        td.solve(problem, np.zeros(3))
    with pytest.raises(KeyError, match="mine"):
        problem.evaluate(np.zeros(3))

    def callback(*_):
        raise ZeroDivisionError("of the callback")

    with pytest.raises(ZeroDivisionError, match="of the callback"):
        td.solve(valley(3), np.zeros(3), callback=callback)


@pytest.mark.parametrize(
    "value, error",
    [
        (lambda w: np.zeros(3), "of shape \\(3,\\), it must be \\(9, 1\\)"),
        (lambda w: "text", "no array of numbers"),
        (lambda w: None, "of shape|no array of numbers"),
        (lambda w: (np.zeros(9), np.zeros(9)), "2 outputs, and `outputs` is 1"),
        (lambda w: np.zeros((9, 2)), "of shape"),
    ],
)
def test_a_value_that_does_not_fit_is_named(value, error):
    class Odd(td.Term):
        linear = True

    Odd.value = lambda self, w: value(w)
    problem = td.Problem(9)
    problem.add(Odd())
    with pytest.raises((ValueError, TypeError), match=error):
        problem.evaluate(np.zeros(9), gradient=False)


def test_a_value_that_is_no_number_is_a_status():
    class Nowhere(td.Term):
        def value(self, w):
            return w.q[:, 0] * np.nan

    problem = td.Problem(3)
    problem.add(Nowhere())
    assert td.solve(problem, np.zeros(3)).status == "evaluation_failed"


@pytest.mark.parametrize(
    "attributes, error",
    [
        ({"window": 0}, "window is 0"),
        ({"window": 7}, "window is 7"),
        ({"window": "wide"}, "window is 'wide'"),
        ({"outputs": 0}, "outputs is 0"),
        ({"first_block": 99}, "first_block 99"),
        ({"windows": 99}, "windows 99"),
        ({"windows": -1}, "windows -1"),
    ],
)
def test_attributes_that_do_not_fit_are_named(attributes, error):
    class Odd(td.Term):
        def value(self, w):
            return w.q[:, 0, 0]

    term = Odd()
    for name, value in attributes.items():
        setattr(term, name, value)
    with pytest.raises((ValueError, TypeError), match=error):
        td.Problem(9).add(term)


def test_weight_and_loss_are_read_when_a_term_is_added_and_parameters_are_live():
    class Low(td.Term):
        parameters = {"height": td.Parameter(2.0, 0.5, 10.0)}

        def value(self, w):
            return w.q[:, 0, 0] - self.height

    term, problem = Low(), td.Problem(1)
    problem.add(term)
    assert problem.evaluate([0.0])["cost"] == pytest.approx(2.0)
    term.weight = 10.0
    term.loss = lambda: td.SquareLoss(7.0)
    assert problem.evaluate([0.0])["cost"] == pytest.approx(2.0)
    term.height = 4.0
    assert problem.evaluate([0.0])["cost"] == pytest.approx(8.0)


def test_settings_of_a_term_are_checked():
    class Low(td.Term):
        parameters = {"height": td.Parameter(2.0, 0.5, 10.0)}

    assert Low().height == 2.0 and Low(height=3, weight=4).weight == 4.0
    with pytest.raises(TypeError, match="Low has no hight, it has weight, height"):
        Low(hight=3.0)
    with pytest.raises(ValueError, match=r"Low.height is 11.0, it must be a number in \[0.5, 10\]"):
        Low(height=11.0)
    with pytest.raises(ValueError, match="Low.weight is -1.0"):
        Low(weight=-1.0)


@pytest.mark.parametrize(
    "call, error",
    [
        (lambda p: td.solve(p, np.zeros(3)), "start has 3 numbers, the problem has 5 variables"),
        (lambda p: td.solve(p, np.full(5, np.nan)), "finite"),
        (lambda p: td.solve(p, np.zeros(5), "simplex"), "simplex is unknown; known: banded"),
        (lambda p: td.solve(p, np.zeros(5), gap=1.0), "gap is 1"),
        (lambda p: td.solve(p, np.zeros(5), max_iterations=-1), "at least 0"),
        (lambda p: td.solve(p, np.zeros(5), options={"nothing": 1.0}), "nothing"),
        (lambda p: p.set_bounds([0.0], [1.0]), "bounds"),
        (lambda p: p.add(Valley(), "costs"), '"costs" is not among cost, rows'),
        (lambda p: td.Problem(0), "blocks"),
        (lambda p: td.Problem(3, interval=0.0), "interval is 0"),
    ],
)
def test_mistakes_are_value_errors_with_a_sentence(call, error):
    with pytest.raises(ValueError, match=error):
        call(valley(5))


def test_unknown_arguments_are_type_errors():
    for solve in (td.solve, lambda *given, **named: td.Solver().solve(*given, **named)):
        with pytest.raises(TypeError, match="argument '?max_iteration\\b"):
            solve(valley(5), np.zeros(5), max_iteration=3)


def test_solve_has_the_defaults_of_a_solver():
    given = {**td.solve.__kwdefaults__, "options": None}
    assert given["max_evaluations"] > 10**9 and given["wall_limit_s"] == np.inf and given["callback"] is None
    told = td.Solver.solve.__doc__
    for name in ("max_iterations", "gap", "confirm", "trace", "shares"):
        assert f"{name}={given[name]}" in told
    assert all(name in told for name in given if name != "options")


def test_a_solve_begins_with_the_multipliers_of_another():
    problem = valley(50)
    problem.add(Product(), "rows")
    first = td.solve(problem, np.full(50, -1.0))
    again = td.solve(problem, first.x, multipliers=first.multipliers)
    assert again.status == "converged" and again.iterations < td.solve(problem, first.x).iterations


def test_a_problem_is_solved_by_one_call_at_a_time():
    problem = td.Problem(3)

    class Inside(td.Term):
        def value(self, w):
            td.solve(problem, np.zeros(3))
            return w.q[:, 0]

    problem.add(Inside())
    with pytest.raises(RuntimeError, match="this Problem is in use by another call"):
        td.solve(problem, np.zeros(3))
    assert valley(3).evaluate(np.zeros(3))["ok"]


def test_threads_solve_their_own_problems():
    costs = [None] * 4

    def work(i):
        costs[i] = td.solve(valley(40), np.full(40, 0.5)).cost

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(costs)) == 1 and costs[0] < 1e-6


def test_a_solve_ends_at_ctrl_c():
    script = """
import numpy as np, touchdown as td
class Slow(td.Term):
    outputs, window = 2, 2
    def value(self, w):
        x, y = w.q[:, 0, 0], w.q[:, 1, 0]
        return 10 * (y - x**2), 1 - x + 0 * sum(range(2000))
problem = td.Problem(400)
problem.add(Slow())
print("begins", flush=True)
try:
    while True:
        td.solve(problem, np.full(400, -1.0), "nlopt-lbfgs", max_iterations=10**9, max_evaluations=10**9)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "begins\n"
        threading.Timer(0.3, lambda: os.kill(process.pid, signal.SIGINT)).start()
        assert process.communicate(timeout=20)[0] == "interrupted\n"
    assert process.returncode == 0


def test_ten_thousand_solves_leave_nothing_behind():
    def solve_many(n):
        for _ in range(n):
            problem = valley(5, ValleyWithSlopes)
            td.solve(problem, np.zeros(5), max_iterations=3)

    solve_many(500)
    before = the_package.resident_kb()
    solve_many(10000)
    assert the_package.resident_kb() - before < 2000, "less than 0.2 kB a solve"


@pytest.mark.parametrize("backend", ["banded", "nlopt-lbfgs", "ceres", "ipopt"])
def test_the_interpreter_ends_while_a_thread_solves(backend):
    script = f"""
import threading, time, numpy as np, touchdown as td
class Slow(td.Term):
    window, outputs = 2, 2
    def value(self, w):
        x, y = w.q[:, 0, 0], w.q[:, 1, 0]
        time.sleep(0.001)
        return 10 * (y - x**2), 1 - x
def work():
    problem = td.Problem(20)
    problem.add(Slow())
    while True:
        td.solve(problem, np.full(20, -1.0), {backend!r})
threading.Thread(target=work, daemon=True).start()
time.sleep(0.2)
"""
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=30, check=False)
        assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("backend", [b["name"] for b in td.backends() if b["compiled"]])
def test_a_term_may_solve_with_the_same_backend(backend):
    class Outer(td.Term):
        def value(self, w):
            td.backends()
            inner = td.solve(valley(4), np.full(4, 0.5), backend, max_iterations=5)
            return w.q[:, 0] - inner.usable

    problem = td.Problem(1)
    problem.add(Outer())
    assert td.solve(problem, [3.0], backend, max_iterations=20).x[0] == pytest.approx(1.0, abs=1e-3)


def test_threads_solve_with_ipopt_and_make_and_drop_solvers():
    script = """
import threading, numpy as np, touchdown as td
class Valley(td.Term):
    window, outputs = 2, 2
    def value(self, w):
        x, y = w.q[:, 0, 0], w.q[:, 1, 0]
        return 10 * (y - x**2), 1 - x
def work():
    for _ in range(5):
        problem = td.Problem(10)
        problem.add(Valley())
        td.Solver("ipopt").solve(problem, np.full(10, -1.0))
        td.backends()
threads = [threading.Thread(target=work) for _ in range(4)]
[t.start() for t in threads]
[t.join() for t in threads]
"""
    assert subprocess.run([sys.executable, "-c", script], timeout=60, check=False).returncode == 0


def test_steps_are_shares_of_a_terms_scale():
    class Range(td.Term):
        def value(self, w):  # a distance of metres in large coordinates
            return 1.0 / (w.q[:, 0, 0] - 5e5)

    problem = td.Problem(1)
    problem.add(Range())
    assert problem.evaluate([5e5 + 3.0])["gradient"][0] == pytest.approx(-1.0 / 27.0, rel=1e-5)

    class Small(td.Term):
        scale = 1e-6

        def value(self, w):
            return np.sin(w.q[:, 0, 0] / 1e-6)

    problem = td.Problem(1)
    problem.add(Small())
    slope = problem.evaluate([1e-6])["gradient"][0]
    assert slope == pytest.approx(np.sin(1.0) * np.cos(1.0) * 1e6, rel=1e-6)


@pytest.mark.parametrize("what", [3, Valley, td.Planner, None])
def test_what_is_no_term_is_refused(what):
    with pytest.raises(TypeError, match="derives from touchdown.Term"):
        td.Problem(3).add(what)
    if what is not Valley:
        with pytest.raises(TypeError, match="derives from touchdown.Term"):
            td.check_term(what)


def test_positions_need_three_control_points():
    class Two(td.Term):
        window = 2

        def value(self, w):
            return w.position[:, :1]

    problem = td.Problem(4, block_size=3)
    problem.add(Two())
    with pytest.raises(ValueError, match="position needs a window of 3 control points, and this has 2"):
        problem.evaluate(np.zeros(12))


def test_a_second_term_of_one_name_is_refused():
    problem = valley(4)
    with pytest.raises(ValueError, match="there is a term valley already"):
        problem.add(Valley())


def test_a_point_that_cannot_be_evaluated_is_named():
    class Nowhere(td.Term):
        def value(self, w):
            return w.q[:, 0] * np.nan

    problem = td.Problem(3)
    problem.add(Nowhere())
    at = problem.evaluate(np.zeros(3))
    assert not at["ok"] and at["failure"] == "term nowhere is not finite" and np.isnan(at["gradient"]).all()


def test_what_a_solve_returns_is_ones_own():
    solved = td.solve(valley(4), np.full(4, 0.5))
    point = solved.x
    point += 1.0
    assert not np.allclose(point, solved.x)


def test_losses():
    assert td.SquareLoss(2.0).value(3.0) == (9.0, 6.0, 2.0)
    assert td.HingeLoss(1.0, 0.5).value(-1.0) == (0.0, 0.0, 0.0)
    assert td.LinearLoss(2.0).value(3.0) == (6.0, 2.0, 0.0)
    assert td.RangeLoss(-1.0, 1.0).value(0.0)[0] == 0.0 < td.RangeLoss(-1.0, 1.0).value(2.0)[0]
    with pytest.raises(ValueError):
        td.HingeLoss(-1.0, 0.5)
