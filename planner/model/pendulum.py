"""The pendulum of the DCM over some time on one axis: what a CoP does to DCM and CoM.

At constant ω the DCM obeys ξ' = ω (ξ - p) and the CoM c' = ω (ξ - c).
"""

import math


def moving_cop(start: float, end: float, omega: float, time: float) -> float:
    """Decrease of the DCM in a time by a CoP that moves evenly from start to end [m].

    ξ(T) = e^{ωT} ξ - p0 (e^{ωT} - 1) - (p1 - p0) ((e^{ωT} - 1) / (ωT) - 1).
    """
    growth = math.exp(omega * time) - 1.0
    return growth * start + (growth / (omega * time) - 1.0) * (end - start)


def com_after(com: float, dcm: float, cop: float, growth: float) -> float:
    """CoM once the DCM's distance from a constant CoP has grown by a factor e^{ωt} [m].

    c(t) = c e^{-ωt} + p (1 - e^{-ωt}) + (ξ - p) sinh ωt.
    """
    return com / growth + cop * (1.0 - 1.0 / growth) + 0.5 * (dcm - cop) * (growth - 1.0 / growth)
