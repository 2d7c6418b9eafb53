"""Limits of the jerk for laws without a QP."""

from planner.parameters import PlannerParameters


def limited(jerk: float, last: float, parameters: PlannerParameters) -> float:
    """The jerk nearest to a wanted one within the limits of jerk and rate.

    Args:
        jerk: wanted [m/s^3].
        last: jerk of the sample before [m/s^3].
        parameters: give the limits.
    """
    rate, limit = parameters.jerk_rate_limit, parameters.jerk_limit
    return min(max(jerk, last - rate, -limit), last + rate, limit)
