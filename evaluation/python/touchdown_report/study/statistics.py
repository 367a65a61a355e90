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


def _resampled(sample, statistic, **options):
    """Interval of `statistic` under resampling of `sample`."""
    for method in ("BCa", "percentile"):  # BCa is not defined where the jackknife does not vary
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            result = stats.bootstrap(
                (sample,),
                statistic,
                n_resamples=RESAMPLES,
                confidence_level=LEVEL,
                method=method,
                random_state=SEED,
                **options,
            )
        interval = result.confidence_interval
        if np.isfinite(interval.low) and np.isfinite(interval.high):
            break
    return float(interval.low), float(interval.high)


def bootstrap(values):
    """Median of a sample with its bias-corrected accelerated bootstrap interval. Fewer than
    six values have no interval: resampling never leaves the sample's range, and that range then holds the median of
    the population with less than 95 %. Equal values have an interval of zero width."""
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    if values.size == 0:
        return Estimate(np.nan, np.nan, np.nan, 0)
    figure = float(np.median(values))
    if values.size < LEAST:
        return Estimate(figure, np.nan, np.nan, values.size)
    if np.ptp(values) == 0.0:
        return Estimate(figure, figure, figure, values.size)
    return Estimate(figure, *_resampled(values, np.median, vectorized=True), values.size)


def clustered_bootstrap(values):
    """Median of all values of a table of seeds (rows) by cells, NaN where there is none. Its interval is by
    resampling of whole seeds. The same seed is nearly the same trial in several cells, so values of one
    row carry less information than as many of different rows. `n` counts the values."""
    table = np.asarray(values, dtype=float)
    table = table[np.isfinite(table).any(axis=1)]
    count = int(np.isfinite(table).sum())
    if count == 0:
        return Estimate(np.nan, np.nan, np.nan, 0)
    figure = float(np.nanmedian(table))
    if len(table) < LEAST:
        return Estimate(figure, np.nan, np.nan, count)
    if np.nanmax(table) == np.nanmin(table):
        return Estimate(figure, figure, figure, count)

    def median(rows):
        return np.nanmedian(table[np.asarray(rows, dtype=int)])

    return Estimate(figure, *_resampled(np.arange(len(table)), median, vectorized=False), count)


def _differences(first, second):
    both = pd.concat([first, second], axis=1, join="inner").dropna()
    return both.iloc[:, 0] - both.iloc[:, 1]


def paired_difference(first, second):
    """Median of `first` - `second` over the seeds that have both (pandas Series by seed)."""
    return bootstrap(_differences(first, second).to_numpy())


def pooled_difference(pairs):
    """The same over all cells: `pairs` are (first, second) of each."""
    return clustered_bootstrap(pd.concat([_differences(a, b) for a, b in pairs], axis=1).to_numpy())


def paired_success(first, second):
    """Exact McNemar test of two methods on the same seeds (boolean Series by seed)."""
    both = pd.concat([first, second], axis=1, join="inner").astype(bool)
    a, b = both.iloc[:, 0], both.iloc[:, 1]
    table = [[int((a & b).sum()), int((a & ~b).sum())], [int((~a & b).sum()), int((~a & ~b).sum())]]
    p = float(mcnemar(table, exact=True).pvalue) if len(both) else np.nan
    return Discordance(len(both), table[0][1], table[1][0], min(p, 1.0))


def pooled_success(pairs):
    """Compares two methods on the same seeds in several cells ((first, second) of each: boolean Series by seed).
    It is a permutation test of the sum of the differences in success. It swaps the methods in all cells of a seed at
    once, because pairs of one seed are not independent; pairs of different seeds are. Exact for few seeds, by
    9999 permutations for many, where p is at least 0.0002."""
    cells = [paired_success(first, second) for first, second in pairs]
    net = pd.concat([a.astype(float) - b.astype(float) for a, b in pairs], axis=1).sum(axis=1).to_numpy()
    p = 1.0 if len(net) else np.nan
    net = net[net != 0]  # equal results decide nothing
    if len(net) > 1:
        result = stats.permutation_test(
            (net, np.zeros_like(net)),
            lambda x, y, axis: np.sum(x - y, axis=axis),
            permutation_type="samples",
            vectorized=True,
            n_resamples=RESAMPLES,
            random_state=SEED,
        )
        p = min(float(result.pvalue), 1.0)
    return Discordance(
        sum(c.pairs for c in cells), sum(c.first_only for c in cells), sum(c.second_only for c in cells), p
    )


def holm(p_values):
    """Holm's adjusted p-values, in the same order. An entry without a p-value is no test."""
    adjusted = np.array(p_values, dtype=float)
    tests = np.isfinite(adjusted)
    if tests.any():
        adjusted[tests] = multipletests(adjusted[tests], alpha=1.0 - LEVEL, method="holm")[1]
    return list(adjusted)


@dataclass
class Survival:
    """Share that has landed over time (Kaplan-Meier), as a step function that begins at t = 0, with
    pointwise 95 % bounds. `median` is the time by which half has landed (infinite: less than half ever does)."""

    time: np.ndarray
    landed: np.ndarray
    lo: np.ndarray
    hi: np.ndarray
    median: Estimate


def time_to_land(times, landed, horizon):
    """Kaplan-Meier estimate. A flight that did not land is censored at the end of its time, `horizon`, whenever
    it ended: a crash does not land later. Nothing is censored earlier, so the share at each time is a
    proportion. It has the bounds of Clopper and Pearson; Greenwood's would have no width at 0 and 1."""
    landed = np.asarray(landed, dtype=bool)
    times = np.where(landed, np.asarray(times, dtype=float), np.asarray(horizon, dtype=float))
    count = len(times)
    at, share = np.zeros(1), np.zeros(1)
    if landed.any():
        function = SurvfuncRight(times, landed.astype(int))
        at = np.append(at, function.surv_times)
        # The product of the estimate rounds; k of n is exact.
        share = np.append(share, np.round((1.0 - function.surv_prob) * count) / count)
    bounds = [rate(round(s * count), count) for s in share]
    lo, hi = np.array([b.lo for b in bounds]), np.array([b.hi for b in bounds])

    def first(reaches):
        return float(at[np.argmax(reaches)]) if reaches.any() else np.inf

    half = Estimate(first(share >= 0.5), np.nan, np.nan, count)
    if count >= LEAST:
        half.lo, half.hi = first(hi >= 0.5), first(lo >= 0.5)

    def to_the_end(values):
        return np.append(values, values[-1])

    return Survival(
        np.append(at, times.max()), to_the_end(share), to_the_end(lo), to_the_end(hi), half
    )


def performance_profile(costs):
    """Dolan and More's profile of a table of costs (rows: problems, columns: solvers; infinite where a
    solver failed): {solver: (ratios, share of problems within them)}. Problems that no solver solves count."""
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
