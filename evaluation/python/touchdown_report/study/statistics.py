# SPDX-License-Identifier: BSD-3-Clause
"""Statistics of the report, each by a library: scipy and statsmodels. Confidence is 95 % throughout."""
import warnings
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats
from statsmodels.duration.survfunc import SurvfuncRight
from statsmodels.stats.contingency_tables import mcnemar
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.proportion import proportion_confint

LEVEL = 0.95
LEAST = 6  # values that an interval of a median asks for: 1 - 2 / 2^6 > 0.95
RESAMPLES = 9999
SEED = 20221  # of the bootstrap: a report that is made again has the same intervals


@dataclass
class Estimate:
    """A figure with its 95 % interval over `n` values; `lo` and `hi` are NaN where there is none."""

    value: float
    lo: float
    hi: float
    n: int


@dataclass
class Discordance:
    """Two methods on the same seeds: pairs in all, those that one alone succeeded in, and the p-value."""

    pairs: int
    first_only: int
    second_only: int
    p: float


def rate(successes, trials):
    """A success rate with its Clopper-Pearson interval."""
    if trials == 0:
        return Estimate(np.nan, 0.0, 1.0, 0)
    lo, hi = proportion_confint(successes, trials, alpha=1.0 - LEVEL, method="beta")
    lo = 0.0 if successes == 0 else float(lo)
    hi = 1.0 if successes == trials else float(hi)
    return Estimate(successes / trials, lo, hi, trials)


def bootstrap(values, statistic=np.median):
    """`statistic` of a sample with its bias-corrected accelerated bootstrap interval. Fewer than
    six values have no interval: resampling never leaves the sample's range, which holds the median of what was
    sampled with less than 95 % then. Values that are all alike have one of no width."""
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    if values.size == 0:
        return Estimate(np.nan, np.nan, np.nan, 0)
    figure = float(statistic(values))
    if values.size < LEAST:
        return Estimate(figure, np.nan, np.nan, values.size)
    if np.ptp(values) == 0.0:
        return Estimate(figure, figure, figure, values.size)
    interval = None
    for method in ("BCa", "percentile"):  # BCa is not defined where the jackknife does not vary
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            result = stats.bootstrap(
                (values,),
                statistic,
                n_resamples=RESAMPLES,
                confidence_level=LEVEL,
                method=method,
                vectorized=True,
                random_state=SEED,
            )
        interval = result.confidence_interval
        if np.isfinite(interval.low) and np.isfinite(interval.high):
            break
    return Estimate(figure, float(interval.low), float(interval.high), values.size)


def paired_difference(first, second):
    """Median of `first` - `second` over the seeds that have both (pandas Series by seed)."""
    both = pd.concat([first, second], axis=1, join="inner").dropna()
    return bootstrap((both.iloc[:, 0] - both.iloc[:, 1]).to_numpy())


def paired_success(first, second):
    """Exact McNemar test of two methods on the same seeds (boolean Series by seed)."""
    both = pd.concat([first, second], axis=1, join="inner").astype(bool)
    a, b = both.iloc[:, 0], both.iloc[:, 1]
    table = [[int((a & b).sum()), int((a & ~b).sum())], [int((~a & b).sum()), int((~a & ~b).sum())]]
    p = float(mcnemar(table, exact=True).pvalue) if len(both) else np.nan
    return Discordance(len(both), table[0][1], table[1][0], min(p, 1.0))


def holm(p_values):
    """Holm's adjusted p-values, in the same order."""
    if len(p_values) == 0:
        return []
    return list(multipletests(p_values, alpha=1.0 - LEVEL, method="holm")[1])


@dataclass
class Survival:
    """Share that has landed over time (Kaplan-Meier), as a step function that begins at (0, 0), with
    pointwise 95 % bounds, and the time by which half has landed (infinite: less than half ever does)."""

    time: np.ndarray
    landed: np.ndarray
    lo: np.ndarray
    hi: np.ndarray
    median: Estimate


def time_to_land(times, landed, horizon):
    """Kaplan-Meier estimate. What did not land is censored at the end of its time, `horizon`, whenever
    it ended: a crash does not land later."""
    landed = np.asarray(landed, dtype=bool)
    times = np.where(landed, np.asarray(times, dtype=float), np.asarray(horizon, dtype=float))
    flat = np.zeros(2)
    if not landed.any():
        never = Estimate(np.inf, np.nan, np.nan, len(times))
        return Survival(np.array([0.0, times.max()]), flat, flat, flat, never)
    function = SurvfuncRight(times, landed.astype(int))
    error = stats.norm.ppf(0.5 + 0.5 * LEVEL) * np.nan_to_num(function.surv_prob_se)
    share = 1.0 - function.surv_prob
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        lo, hi = function.quantile_ci(0.5, alpha=1.0 - LEVEL)
    half = float(function.quantile(0.5))
    half = half if np.isfinite(half) else np.inf  # less than half ever land
    end = float(np.max(times))

    def steps(values):
        return np.concatenate([[0.0], values, [values[-1]]])

    return Survival(
        np.concatenate([[0.0], function.surv_times, [end]]),
        steps(share),
        steps(np.clip(share - error, 0.0, 1.0)),
        steps(np.clip(share + error, 0.0, 1.0)),
        Estimate(half, float(lo), float(hi), len(times)),
    )


def performance_profile(costs):
    """Dolan and More's profile of a table of costs (rows: problems, columns: solvers; infinite where a
    solver failed): {solver: (ratios, share of problems within them)}. Problems that nobody solves count."""
    best = costs.min(axis=1)
    profiles = {}
    for solver in costs.columns:
        ratios = (costs[solver] / best)[np.isfinite(costs[solver])].sort_values().to_numpy()
        profiles[solver] = (ratios, np.arange(1, len(ratios) + 1) / len(costs))
    return profiles


def quantiles(values, shares=(0.5, 0.95, 0.99)):
    """Quantiles of a sample, NaN where it is empty."""
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    return [float(np.quantile(values, s)) if values.size else np.nan for s in shares]
