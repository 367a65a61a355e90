# SPDX-License-Identifier: BSD-3-Clause
"""Every statistic of a study's report against values from another source."""
import numpy as np
import pandas as pd
import pytest

pytest.importorskip("statsmodels")

from touchdown_report.study import statistics  # noqa: E402


def test_clopper_pearson_of_none_and_all_is_the_closed_form():
    none, everything = statistics.rate(0, 10), statistics.rate(100, 100)
    assert none.lo == 0.0 and none.hi == pytest.approx(1.0 - 0.025**0.1)
    assert everything.hi == 1.0 and everything.lo == pytest.approx(0.025**0.01)  # 0.9638


def test_clopper_pearson_between():
    rate = statistics.rate(97, 100)
    assert (rate.value, rate.n) == (0.97, 100)
    assert (rate.lo, rate.hi) == (pytest.approx(0.9148, abs=1e-4), pytest.approx(0.9938, abs=1e-4))


def test_the_bootstrap_of_a_median():
    median = statistics.bootstrap(np.arange(1.0, 102.0))
    assert median.value == 51.0 and median.n == 101
    # The interval of the order statistics that the binomial distribution names is [41, 61].
    assert median.lo == pytest.approx(41.0, abs=2.0) and median.hi == pytest.approx(61.0, abs=2.0)
    assert statistics.bootstrap(np.arange(1.0, 102.0)) == median  # the same each time


def test_the_bootstrap_without_spread_or_values():
    assert statistics.bootstrap([2.0] * 6) == statistics.Estimate(2.0, 2.0, 2.0, 6)
    for few in ([1.0, 2.0, np.nan], [1.0, 1.0, 2.0, 2.0, 9.0]):  # too few for 95 %
        median = statistics.bootstrap(few)
        assert median.value == np.nanmedian(few) and median.n == np.isfinite(few).sum()
        assert np.isnan(median.lo) and np.isnan(median.hi)
    assert np.isfinite(statistics.bootstrap([1.0, 1.0, 2.0, 2.0, 9.0, 9.0]).lo)
    assert np.isnan(statistics.bootstrap([]).value)


def test_paired_differences_take_common_seeds_alone():
    first = pd.Series([3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0], index=[1, 2, 3, 4, 5, 6, 7])
    second = pd.Series([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, np.nan, 7.0], index=[1, 2, 3, 4, 5, 6, 7, 8])
    assert statistics.paired_difference(first, second) == statistics.Estimate(2.0, 2.0, 2.0, 6)


def test_mcnemar_is_the_binomial_test_of_the_discordant_pairs():
    first = pd.Series([True] * 8 + [False] + [True] * 11)
    second = pd.Series([False] * 8 + [True] + [True] * 11)
    result = statistics.paired_success(first, second)
    assert (result.pairs, result.first_only, result.second_only) == (20, 8, 1)
    assert result.p == pytest.approx(2.0 * (1 + 9) / 512)
    assert statistics.paired_success(first, first).p == 1.0


def test_cells_that_share_their_seeds_say_no_more_than_one():
    seeds = range(12)
    first = pd.Series([True] * 11 + [False], index=seeds)
    second = pd.Series([True] * 7 + [False] * 5, index=seeds)
    alone = statistics.paired_success(first, second)
    assert alone.p == 0.125 and (alone.first_only, alone.second_only) == (4, 0)
    pooled = statistics.pooled_success([(first, second)] * 8)
    assert (pooled.pairs, pooled.first_only, pooled.second_only) == (96, 32, 0)
    assert pooled.p == pytest.approx(alone.p)  # exact: all 2^12 swaps; McNemar's of 32 to 0 is 5e-10
    assert statistics.pooled_success([(first, first)]).p == 1.0

    rng = np.random.default_rng(3)
    times = pd.Series(rng.normal(size=30))
    zero = pd.Series(np.zeros(30))
    once = statistics.paired_difference(times, zero)
    often = statistics.pooled_difference([(times, zero)] * 8)
    assert often.n == 240 and often.value == once.value
    assert often.hi - often.lo == pytest.approx(once.hi - once.lo, rel=0.25)
    # Cells that have nothing to do with each other do say more.
    apart = [(pd.Series(rng.normal(size=30)), zero) for _ in range(8)]
    apart = statistics.pooled_difference(apart)
    assert apart.hi - apart.lo < 0.6 * (once.hi - once.lo)


def test_seeds_that_only_some_cells_have_count_where_they_are():
    first = pd.Series([3.0, np.nan, 5.0], index=[1, 2, 3])
    second = pd.Series([1.0, 1.0, 1.0], index=[1, 2, 3])
    pooled = statistics.pooled_difference([(first, second), (first[:1] + 1, second)])
    assert (pooled.value, pooled.n) == (3.0, 3) and np.isnan(pooled.lo)  # of 2, 4 and 3


def test_holm():
    assert statistics.holm([0.01, 0.04, 0.03]) == pytest.approx([0.03, 0.06, 0.06])
    assert statistics.holm([]) == []


def test_kaplan_meier_censors_what_did_not_land():
    curve = statistics.time_to_land([1.0, 2.0, 3.0, 4.0, np.nan], [True] * 4 + [False], [10.0] * 5)
    assert curve.median.value == 3.0
    assert curve.time[-1] == 10.0 and curve.landed[-1] == pytest.approx(0.8)
    at = dict(zip(curve.time, curve.landed))
    assert [at[t] for t in (1.0, 2.0, 3.0, 4.0)] == pytest.approx([0.2, 0.4, 0.6, 0.8])
    # Nothing is censored before the end, so that each step is a proportion.
    third = list(curve.time).index(3.0)
    three_of_five = statistics.rate(3, 5)
    assert (curve.lo[third], curve.hi[third]) == (three_of_five.lo, three_of_five.hi)


def test_half_that_never_lands_has_an_infinite_median():
    assert statistics.time_to_land([1.0, 0, 0], [True, False, False], [10.0] * 3).median.value == np.inf
    never = statistics.time_to_land([np.nan] * 3, [False] * 3, [10.0] * 3)
    assert never.median.value == np.inf and never.landed[-1] == 0.0
    assert never.hi[-1] == statistics.rate(0, 3).hi  # none of three is not never


def test_half_of_all_is_half():
    times = np.arange(1.0, 101.0)
    curve = statistics.time_to_land(times, times <= 50, np.full(100, 200.0))
    assert curve.median.value == 50.0 and curve.landed[-1] == 0.5
    # The bounds of the median are where those of the share cross one half. The interval of k of 100 holds 50 % for k
    # from 40 to 60.
    assert curve.median.lo == 40.0 and curve.median.hi == np.inf
    whole = statistics.time_to_land(times, times > 0, np.full(100, 200.0))
    assert (whole.median.value, whole.median.lo, whole.median.hi) == (50.0, 40.0, 61.0)
    few = statistics.time_to_land([1.0, 2.0, 3.0], [True] * 3, [9.0] * 3)
    assert few.median.value == 2.0 and np.isnan(few.median.lo) and np.isnan(few.median.hi)


def test_performance_profiles_count_failures_as_infinite():
    costs = pd.DataFrame({"a": [1.0, 2.0, np.inf], "b": [2.0, 1.0, np.inf], "c": [4.0, np.inf, np.inf]})
    profile = statistics.performance_profile(costs)
    assert profile["a"][0].tolist() == [1.0, 2.0] and profile["a"][1] == pytest.approx([1 / 3, 2 / 3])
    assert profile["c"][0].tolist() == [4.0] and profile["c"][1] == pytest.approx([1 / 3])


def test_quantiles():
    assert statistics.quantiles(np.arange(101.0)) == [50.0, 95.0, 99.0]
    assert np.isnan(statistics.quantiles([])).all()
