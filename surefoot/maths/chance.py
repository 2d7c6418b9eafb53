"""Laws of chance: shares and means with their intervals, two samples against each other, and looks one after another.

They are written out where scipy.stats has them too, since that takes longer to be imported than a short run takes.
"""

import math
from collections.abc import Sequence
from statistics import NormalDist, fmean, variance
from typing import NamedTuple


class SuccessRate(NamedTuple):
    """A share with its interval."""

    rate: float
    low: float
    high: float

    @property
    def between(self) -> str:
        """The interval in percent."""
        return f"{100 * self.low:.1f} to {100 * self.high:.1f}"


def wilson(successes: int, trials: int, error: float = 0.05) -> SuccessRate:
    """A success rate with its interval by Wilson's score, which holds near 0 and 1 and for few trials too.

    E. B. Wilson, Probable inference, the law of succession, and statistical inference, JASA 22, 1927.

    Args:
        successes: among the trials.
        trials: one at least.
        error: share of intervals that may miss the true rate, 5 % by default [-].
    """
    rate, z_squared = successes / trials, NormalDist().inv_cdf(0.5 * error) ** 2
    center = (successes + 0.5 * z_squared) / (trials + z_squared)
    half = math.sqrt(z_squared * (trials * rate * (1.0 - rate) + 0.25 * z_squared)) / (trials + z_squared)
    return SuccessRate(rate, center - half if successes else 0.0, center + half if successes < trials else 1.0)


class Difference(NamedTuple):
    """A difference, now minus before, with its interval."""

    value: float
    low: float
    high: float

    def within(self, margin: float) -> bool:
        """Return true if the whole interval lies within a margin of zero."""
        return -margin <= self.low and self.high <= margin

    @property
    def excludes_zero(self) -> bool:
        """True if zero lies outside of the interval."""
        return self.low > 0.0 or self.high < 0.0


def paired_mean(differences: Sequence[float], error: float) -> Difference:
    """Mean of the differences of pairs with its interval by Student's t.

    Student, The probable error of a mean, Biometrika 6, 1908.

    Args:
        differences: of each pair, two at least.
        error: share of intervals that may miss the true mean [-].
    """
    count = len(differences)
    half = _student(count - 1, error) * math.sqrt(variance(differences) / count)
    return _around(fmean(differences), half)


def unpaired_mean(before: Sequence[float], now: Sequence[float], error: float) -> Difference:
    """Difference of two means with its interval by Welch's t, which takes no variances for equal.

    B. L. Welch, The generalization of Student's problem when several different population variances are involved,
    Biometrika 34, 1947.

    Args:
        before: values of one sample, two at least.
        now: values of the other, two at least.
        error: share of intervals that may miss the true difference [-].
    """
    parts = [variance(values) / len(values) for values in (before, now)]
    spread, value = math.fsum(parts), fmean(now) - fmean(before)
    if spread == 0.0:
        return _around(value, 0.0)
    below = math.fsum(
        (part / spread) ** 2 / (len(values) - 1) for part, values in zip(parts, (before, now), strict=True)
    )
    return _around(value, _student(1.0 / below, error) * math.sqrt(spread))


def _around(value: float, half: float) -> Difference:
    return Difference(value, value - half, value + half)


def _student(freedom: float, error: float) -> float:
    """Distance from zero that Student's t exceeds, on either side, with the probability of the error."""
    from scipy.special import stdtrit

    return -float(stdtrit(freedom, 0.5 * error))


def mcnemar(lost: int, gained: int) -> float:
    """Probability of so uneven a change of pairs by chance alone, to both sides, exactly.

    Each of the pairs that changed is lost or gained with the same probability. Q. McNemar, Note on the sampling error
    of the difference between correlated proportions or percentages, Psychometrika 12, 1947; F. Mosteller, Some
    statistical problems in measuring the subjective response to drugs, Biometrics 8, 1952.

    Args:
        lost: pairs that were successes and are none.
        gained: pairs that were none and are successes.
    """
    changed, fewer = lost + gained, min(lost, gained)
    return min(1.0, 2.0 * sum(math.comb(changed, one) for one in range(fewer + 1)) / float(2**changed))


def fisher(before: tuple[int, int], now: tuple[int, int]) -> float:
    """Probability of two shares so far apart, or farther, where both are of one rate, exactly.

    R. A. Fisher, The logic of inductive inference, Journal of the Royal Statistical Society 98, 1935.

    Args:
        before: successes and trials of one sample.
        now: successes and trials of the other.
    """
    successes, trials = before[0] + now[0], before[1] + now[1]
    least, most = max(0, successes - now[1]), min(successes, before[1])
    ways = {one: math.comb(before[1], one) * math.comb(now[1], successes - one) for one in range(least, most + 1)}
    return sum(way for way in ways.values() if way <= ways[before[0]]) / math.comb(trials, successes)


def unpaired_share(before: tuple[int, int], now: tuple[int, int], error: float) -> Difference:
    """Difference of two shares with its interval, of the two intervals of Wilson.

    R. G. Newcombe, Interval estimation for the difference between independent proportions, Statistics in Medicine 17,
    1998, method 10.

    Args:
        before: successes and trials of one sample.
        now: successes and trials of the other.
        error: share of intervals that may miss the true difference [-].
    """
    return _of_scores(wilson(*before, error), wilson(*now, error), 0.0)


def paired_share(both: int, lost: int, gained: int, neither: int, error: float) -> Difference:
    """Difference of two shares of the same pairs with its interval, of the two intervals of Wilson.

    R. G. Newcombe, Improved confidence intervals for the difference between binomial proportions based on paired data,
    Statistics in Medicine 17, 1998, method 10.

    Args:
        both: pairs that were successes and are.
        lost: pairs that were and are none.
        gained: pairs that were none and are.
        neither: pairs that were none and are none.
        error: share of intervals that may miss the true difference [-].
    """
    count = both + lost + gained + neither
    sides = (both + lost) * (gained + neither) * (both + gained) * (lost + neither)
    product = float(both * neither - lost * gained)
    if product > 0.0:
        product = max(product - 0.5 * count, 0.0)
    alike = product / math.sqrt(sides) if sides else 0.0
    return _of_scores(wilson(both + lost, count, error), wilson(both + gained, count, error), alike)


def _of_scores(before: SuccessRate, now: SuccessRate, alike: float) -> Difference:
    """Interval of a difference of two shares whose correlation is `alike`."""
    down, up = now.rate - now.low, now.high - now.rate
    back_down, back_up = before.rate - before.low, before.high - before.rate
    value = now.rate - before.rate
    below = math.sqrt(max(down**2 - 2.0 * alike * down * back_up + back_up**2, 0.0))
    above = math.sqrt(max(up**2 - 2.0 * alike * up * back_down + back_down**2, 0.0))
    return Difference(value, value - below, value + above)


def look_error(error: float, look: int) -> float:
    """Part of an error that a look may spend, so that all looks together, however many, spend no more than the whole.

    The parts 1/2, 1/6, 1/12, ... sum to one, so that intervals that miss with these probabilities hold at all looks at
    once. K. K. G. Lan and D. L. DeMets, Discrete sequential boundaries for clinical trials, Biometrika 70, 1983;
    C. Jennison and B. W. Turnbull, Interim analyses: the repeated confidence interval approach, JRSS B 51, 1989.

    Args:
        error: of all looks together [-].
        look: its number, from 1 on.
    """
    return error / (look * (look + 1))
