"""The program of docs/recovery.md, written from the page, has the solutions of the code.

Boxes and the way round the stance leg are those of `LegReach`, which tests of its own hold.
"""

import math
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import pytest

from surefoot.planner.model.dcm import nominal_dcm
from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.recovery.reach import StepReach
from surefoot.planner.recovery.step_adjustment import StepAdjustment
from surefoot.planner.recovery.step_problem import StepProblem
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.references.window import Window
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.swing.leg_reach import ANYWHERE, LegReach
from surefoot.planner.types import Foot, Footstep

pytestmark = pytest.mark.unit

P = PlannerParameters()
N, DT, OMEGA = P.recovery, P.sample_time, 3.0
LEGS = LegReach(0.3, 0.2, 0.115, 0.12, 0.24, (60.0, 50.0), (0.22, 0.11))
SIDEWAYS = np.array([0.0, 1.0])


@dataclass(frozen=True)
class Case:
    """The page's given values, and what the code takes them from."""

    com: np.ndarray
    dcm: np.ndarray
    step: StepProblem
    window: Window
    half: np.ndarray
    authority: np.ndarray
    stand: np.ndarray
    timing: bool


def between(value, low, high):
    return np.minimum(np.maximum(value, low), high)


def integral(values, start):
    """ω ∫ e^{-ω (t' - t)} z(t') dt' of values that are linear between samples, the last one for ever."""
    values, fade = values[start:], np.exp(-OMEGA * DT * np.arange(len(values) - start))
    slope = (values[1:] - values[:-1]) / DT
    parts = values[:-1].T * fade[:-1] - values[1:].T * fade[1:] + slope.T * (fade[:-1] - fade[1:]) / OMEGA
    return parts.sum(axis=-1) + values[-1] * fade[-1]


def times_of(nominal, least):
    changed = [min(nominal, least - min(N.time_changes)) + change for change in N.time_changes]
    return [nominal, *(time for time in changed if time >= min(nominal, least))]


def solved(case):
    """End of the present phase, the box, whether s is more than 0, and the cost; None where nothing is solved."""
    step, reference = case.step, case.window.driving
    lift, land = round(step.double / DT), round((step.double + step.single) / DT)
    bounded = [integral(reference.point, at) for at in (0, lift, land)]
    g, m = integral(reference.gain[:, 0], land), integral(reference.half_size[:-1] - case.half, 0)
    a, fade = np.minimum(case.half, case.authority), math.exp(-OMEGA * DT * land)
    allowed = np.where(a < case.half, N.unheld_share * case.half, N.tolerance)
    held = bool((np.abs(case.dcm - bounded[0]) <= (1.0 - fade) * a + m + fade * allowed).all())
    if held and not step.adapted:
        return None
    only, legs, side = held or not case.timing, LEGS.turned(step.place.yaw), step.place.foot.side
    doubles = [step.double] if only or not step.double else times_of(step.double, N.least_double)
    if step.adapted:
        doubles = [time for time in doubles if time <= step.double]
    singles = [step.single] if only else times_of(step.single, max(N.least_single, step.shortest))
    h = N.cop_share * a
    found = []
    for number, box in enumerate(legs.allowed(side, step.face, step.crosses)):
        here = [priced(case, legs, box, pair, bounded, (g, h, m)) for pair in product(doubles, singles)]
        best = min(here, key=lambda one: one[0])
        best = best if best[0] < here[0][0] - N.least_saving else here[0]
        found.append((best[0], number, box, best))
    cost, number, box, (_, time, p, wanted, hip, low, high, more) = min(found, key=lambda one: one[0])
    spare = np.maximum(N.landing_share * h, a - N.landing_spare) / g
    bounded = np.full(2, number == 0) | ((wanted >= box[0]) & (wanted <= box[1]))
    low = np.where(bounded, np.maximum(low, wanted - spare), low)
    high = np.where(bounded, np.minimum(high, wanted + spare), high)
    ends = legs.around(p, hip, box, legs.radius)
    return time, np.maximum(ends[0], np.minimum(low, p)), np.minimum(ends[1], np.maximum(high, p)), more, cost


def priced(case, legs, box, times, bounded, means):
    """Cost, time, p, p*, hip, limits of the swing, and whether s is more than 0."""
    step, (T_d, T_s), (xi_0, xi_1, xi_2), (g, h, m) = case.step, times, bounded, means
    side, nominal, (f, speed) = step.place.foot.side, step.nominal, step.swing
    G_d, G_s, once = math.exp(OMEGA * T_d), math.exp(OMEGA * T_s), math.exp(OMEGA * step.single)
    z_0, z_1 = case.window.driving.point[0], (xi_2 - once * xi_1) / (1.0 - once)
    lifted = case.dcm
    if step.double:
        growth = math.exp(OMEGA * step.double)

        def taken(t):
            grown = math.exp(OMEGA * t) - 1.0
            return grown * z_0 + (grown / (OMEGA * t) - 1.0) * (z_1 - z_0)

        beside = (growth * xi_0 - taken(step.double) - xi_1) / (growth - 1.0)
        lifted = G_d * case.dcm - taken(T_d) - (G_d - 1.0) * beside
    d, most = G_s * (lifted - z_1) + z_1 - xi_2, (G_d * G_s - 1.0) * h + G_d * G_s * N.cop_share * m
    e = d - between(d, -most, most)
    wanted, q = nominal + e / g, z_1 + h * (d - e) / np.maximum(most, 1e-9)

    def moved(c, xi, cop, G):
        return c / G + cop * (1.0 - 1.0 / G) + 0.5 * (xi - cop) * (G - 1.0 / G)

    com = moved(case.com, case.dcm, 0.5 * (z_0 + q), G_d) if step.double else case.com
    com, hip = moved(com, lifted, q, G_s), 0.5 * legs.hip_width * side * SIDEWAYS
    own, stance = com + hip, com - hip
    tau, usual = (max(time - P.touchdown_lead, DT) for time in (T_s, step.single))
    hardest = np.maximum(legs.acceleration, np.abs(5.77 * (nominal - f) / usual**2 - 1.9 * speed / usual))
    high = f + (hardest * tau**2 + np.where(speed > 0.0, 1.9, 3.9) * speed * tau) / 5.77
    low = f - (hardest * tau**2 - np.where(speed < 0.0, 1.9, 3.9) * speed * tau) / 5.77
    p = between(between(wanted, low, high), *box)
    p = own + (p - own) * min(1.0, legs.radius / max(math.dist(p, own), 1e-9))
    p = between(p, *box)
    u, r = p - between(p, low, high), max(math.hypot(*stance) - legs.radius, 0.0)
    reach = StepReach(LEGS)
    reach.see(step)
    v = reach.shortfall(T_s, *p)
    growth = math.exp(OMEGA * step.cycle)
    s = np.maximum(0.0, g * growth * np.abs(wanted - p) - (
        growth * N.stand_share * case.stand if step.last else (growth - 1.0) * h))  # fmt: skip
    priced_s = s * np.where(side * (wanted - p)[1] > 0.0, (1.0, N.cross_factor), 1.0)
    cost = (
        N.shift_weight * ((p - nominal) ** 2).sum()
        + N.time_weight * ((T_d - step.double) ** 2 + (T_s - step.single) ** 2) / step.cycle**2
        + N.second_weight * (priced_s**2).sum()
        + N.stretch_weight * r**2
        + N.swing_weight * ((u**2).sum() + v**2)
    )
    return cost, T_d if step.double else T_s, p, wanted, own, low, high, bool(s.any())


def drawn(rng):
    """A step in any phase, of feet with or without room, after any push."""
    count, side = P.horizon + P.preview + 1, float(rng.choice([1.0, -1.0]))
    lift, swing = int(rng.choice([0, 0, 3, 6, 8])), int(rng.integers(5, 46))
    times = np.arange(count)
    nominal = np.array([rng.uniform(-0.3, 0.4), side * rng.uniform(0.15, 0.3)])
    share, up = np.clip((times - lift - swing) / 8.0, 0.0, 1.0), np.clip(1.0 - times / max(lift, 1), 0.0, 1.0)
    point = share[:, None] * nominal + (0.5 * up if lift else 0.0 * up)[:, None] * (rng.uniform(-0.3, 0.1), side * 0.2)
    half, stand = np.array([0.1, 0.05]) * rng.choice([1.0, 0.35]), np.array([0.1, 0.15])
    sizes = half + (0.1 * up if lift else 0.0 * up)[:, None] * SIDEWAYS
    sizes[-1] = stand
    reference = ZmpReference(point, np.column_stack((share, 0.0 * share)), sizes, np.zeros(count), np.zeros((count, 2)))
    stiffness, omega = np.full(count, OMEGA**2), np.full(count, OMEGA)
    height = HeightPreview(np.ones((3, count)), stiffness)
    window = Window(reference, reference, point, height, stiffness, omega, omega, point > 0.0)
    bounded = nominal_dcm(stiffness, omega, point, DT)[0]
    foot = Foot.LEFT if side > 0.0 else Foot.RIGHT
    step = StepProblem(
        place=Footstep(foot, np.append(nominal, 0.0), float(rng.choice([0.0, 0.15]))),
        swing=np.array([[rng.uniform(-0.4, 0.3), side * rng.uniform(-0.05, 0.25)],
                        [0.0 if lift else rng.uniform(-1.0, 3.0), 0.0]]),
        double=lift * DT, single=swing * DT, cycle=0.66, shortest=float(rng.choice([0.0, 0.3])),
        face=ANYWHERE if rng.random() < 0.75 else nominal + np.array([[-0.6, -0.4], [0.6, 0.4]]),
        crosses=bool(rng.random() < 0.8), last=bool(rng.random() < 0.3), adapted=bool(rng.random() < 0.3),
    )  # fmt: skip
    com = bounded + (-0.1, 0.0) + rng.normal(size=2) * 0.03
    authority = np.array([np.inf, 0.0 if rng.random() < 0.15 else np.inf])
    timing = bool(rng.random() < 0.8)
    return Case(com, bounded + rng.normal(size=2) * (0.12, 0.08), step, window, half, authority, stand, timing)


def code(case, numbers=N):
    """Results of the code on a case, with its numbers of recovery."""
    adaptation = StepAdaptation.CROSSING if case.timing else StepAdaptation.LOCATION
    authority = tuple(case.authority.tolist())
    parameters = replace(P, cop_authority=authority, step_adaptation=adaptation, recovery=numbers)
    return StepAdjustment(LEGS, parameters).solve(case.com, case.dcm, case.window, case.step)


def agree(found, told):
    """Assert that they are the same, but for what the code sums up by samples and the page integrates."""
    if found is None or told is None:
        return found is told
    time, low, high, more, cost = told
    same = abs(found.left - time) < 1e-9 and found.more == more and np.abs(found.box - (low, high)).max() < 2e-3
    return same and found.cost == pytest.approx(cost, rel=0.02, abs=1e-3)


SEEDS, CASES = (0, 1, 2, 4), 40
"""Seeds and cases of each; in one of the last seed `unheld_share` decides, as it does in few."""


@pytest.fixture(scope="module")
def told():
    """Give cases for each seed, with what the page makes of them."""
    rngs = map(np.random.default_rng, SEEDS)
    return [[(case, solved(case)) for case in (drawn(rng) for _ in range(CASES))] for rng in rngs]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_program_of_the_page_is_that_of_the_code(seed, told):
    solutions, beyond = 0, 0
    for case, page in told[SEEDS.index(seed)]:
        found = code(case)
        assert agree(found, page)
        if found is not None:
            beside = case.step.place.foot.side * found.box[:, 1]
            solutions, beyond = solutions + 1, beyond + bool(beside.min() < 0.1)
    assert solutions > 20
    assert beyond > 1


@pytest.mark.parametrize(
    "name",
    ["time_weight", "second_weight", "stretch_weight", "cross_factor", "cop_share", "tolerance", "unheld_share",
     "stand_share", "landing_share", "least_double", "least_single"],
)  # fmt: skip
def test_another_number_of_the_code_is_noticed(name, told):
    other = replace(N, **{name: 3.0 * getattr(N, name)})
    assert not all(agree(code(case, other), page) for one in told for case, page in one)
