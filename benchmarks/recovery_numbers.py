"""What each number of recovery is good for: the threshold of a pushed pendulum that moves when it is halved or doubled.

    python benchmarks/recovery_numbers.py [--only NAME ...] [--cases] [--out TABLE.md]

A planner is built with one number replaced (`planner.parameters.RecoveryParameters`) and walks the pendulum of
`planner.plants`. The threshold of a case is a rung of a ladder of 5 % from 0.1 N·s/kg up that is passed, with two above
it that are not; holes below it are not looked for. A number moves it that moves it by two rungs. The first case that
moves is told, none where none does. It takes some ten minutes on one core.
"""

import argparse
import math
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Site
from surefoot.planner.model.leg_chain import LegChain, Link
from surefoot.planner.parameters import LegInertia, PlannerParameters, RecoveryParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import PendulumTrace, PointPush, walk_pendulum
from surefoot.planner.references.com_height import Rise, SmoothHeight
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import FeetState, PhaseKind

FIRST, RUNG, RUNGS, STRIDE = 0.1, 1.05, 75, 6
"""First impulse of the ladder [N·s/kg], ratio of two rungs, their number, and how many are taken at once [-]."""

MASS, PUSH = 100.0, 0.1
"""Of the pendulum [kg], and duration of its push [s]."""

HIP = 0.1
"""Height of the CoM above the hips [m]."""

NUMBERS = RecoveryParameters()
LINK = Link(0.4, 0.08, 0.45, 0.003)
CHAIN = LegChain(0.1, (0.0, 0.0, 0.25), LINK, LINK, 0.02, (0.03, 0.0, -0.05), (0.0, 0.0, 0.1))
NATURAL = GaitParameters(
    steps=4, step_length=0.36, single_support=0.5, double_support=0.12, com_height=0.95, initial_stand=0.2
)
SLOW = GaitParameters(steps=3, step_length=0.2, single_support=1.0, double_support=0.4, initial_stand=0.2)
STANDING = GaitParameters(steps=0, single_support=0.5, double_support=0.12, com_height=0.95, initial_stand=0.2)
DESCENT = GaitParameters(steps=5, step_length=0.28, single_support=0.9, double_support=0.3, initial_stand=0.4)

Passed = Callable[[PendulumTrace, "Case"], bool]


def survived(trace: PendulumTrace, case: "Case") -> bool:
    """No fall, and at the end the robot stands."""
    return trace.fall_time is None and trace.plans[-1].phase.kind is PhaseKind.STAND


def swung(trace: PendulumTrace, case: "Case") -> bool:
    """Survived, and no foot is swung by more than the hips can, by a tenth."""
    most = np.array(case.legs(NUMBERS).acceleration)
    bends = (np.abs(plan.swing.evaluate(plan.time)[2, :2] / most).max() for plan in trace.plans if plan.swing)
    return survived(trace, case) and max(bends, default=0.0) <= 1.1


def spanned(trace: PendulumTrace, case: "Case") -> bool:
    """Survived, and no leg is longer than straight as both feet stand, with two centimetres to spare."""
    for plan in trace.plans:
        if plan.phase.kind is PhaseKind.DOUBLE and survived(trace, case):
            reach = [
                math.dist(plan.com[0] - (0.0, -0.1 * hold.foot.side, HIP), hold.position) for hold in plan.footholds
            ]
            if max(reach) > 0.96:
                return False
    return survived(trace, case)


def level(trace: PendulumTrace, case: "Case") -> bool:
    """Survived, and the body is not accelerated up or down by more than half of gravity."""
    return survived(trace, case) and max(abs(plan.com_acceleration[0, 2]) for plan in trace.plans) < 5.2


def silent(trace: PendulumTrace, case: "Case") -> bool:
    """No plan says that a fall is coming."""
    return not any(plan.status.falling for plan in trace.plans)


def early(trace: PendulumTrace, case: "Case") -> bool:
    """No fall is told in the first quarter of a second after the push."""
    return not any(plan.status.falling for plan in trace.plans if plan.time < case.begin + PUSH + 0.25)


def captured(trace: PendulumTrace, case: "Case") -> bool:
    """The capture margin does not come below 5 cm."""
    return min(plan.balance.movable for plan in trace.plans) > 0.05


def together(trace: PendulumTrace, case: "Case") -> bool:
    """Survived, and the feet are side by side at the end, to within two centimetres."""
    holds = trace.plans[-1].footholds
    way = (holds[0].position - holds[1].position)[:2]
    return survived(trace, case) and float(np.hypot(*(way - (0.0, 0.2)))) < 0.02


def apart(trace: PendulumTrace, case: "Case") -> bool:
    """Survived without a step."""
    return survived(trace, case) and trace.plans[-1].phase.step == 0


@dataclass(frozen=True)
class Case:
    """A pushed walk of the pendulum, and what it has to pass.

    Attributes:
        name: of it.
        direction: of the push, from x to the left [rad].
        gait: the walk.
        at: step and share of its single support at which the push begins; negative shares are before it [-].
        passed: what it has to pass.
        sole: length and width of the soles [m].
        after: how long it goes on after the gait [s].
        stairs: it goes down a flight.
        special: it is looked at only for numbers that begin with it (`FIRST_SEEN`).
        more: other parameters of the planner.
    """

    name: str
    direction: float
    gait: GaitParameters = NATURAL
    at: tuple[int, float] = (2, 0.5)
    passed: Passed = survived
    sole: tuple[float, float] = (0.22, 0.11)
    after: float = 2.0
    stairs: bool = False
    special: bool = False
    more: dict[str, Any] = field(default_factory=dict)

    @cached_property
    def begin(self) -> float:
        """When the push begins [s]."""
        step, share = self.at
        return 0.5 if not self.gait.steps else self.gait.lift_off(step) + share * self.gait.single_support

    def legs(self, numbers: RecoveryParameters) -> LegReach:
        """Those of the reference robot."""
        near, clear = self.sole[1] + 0.005, self.sole[0] + numbers.clear
        return LegReach(0.36, 0.2, near, numbers.across, clear, (60.0, 50.0), self.sole, 0.85, 0.94)

    def walk(self, numbers: RecoveryParameters, impulse: float) -> PendulumTrace:
        """Walk it with a push [N·s/kg]."""
        position = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]])
        terrain, heights = None, None
        if self.stairs:
            flight = Stairs(0.185, 0.28, 4, Direction.DOWN, start=0.14, landing=1.0, beyond=2.0)
            terrain, heights = flight.build(Site(np.zeros(2), 0.0, 0.8)), SmoothHeight(Rise.SINGLE)
            position[:, 2] = terrain.height(0.0, 0.0)
        feet = FeetState(position, np.zeros(2), np.array([True, True]))
        parameters = PlannerParameters(recovery=numbers, **self.more)
        planner = WalkingPlanner(
            self.gait, feet, *self.sole, terrain, parameters, height_profile=heights, legs=self.legs(numbers)
        )
        force = MASS * impulse / PUSH * np.array([math.cos(self.direction), math.sin(self.direction)])
        com = np.array([0.0, 0.0, position[0, 2] + self.gait.com_height])
        push = PointPush(self.begin, PUSH, force)
        end = self.gait.duration + self.after
        return walk_pendulum(planner, feet, end, com=com, pushes=(push,), mass=MASS, substeps=4)

    def passes(self, numbers: RecoveryParameters, rung: int) -> bool:
        """Whether a rung of the ladder is passed."""
        return rung < 0 or (rung < RUNGS and self.passed(self.walk(numbers, FIRST * RUNG**rung), self))


STILL = {"gait": STANDING, "after": 5.0}
CASES = (
    Case("forward, SS 0.5", 0.0),
    Case("over the stance foot, SS 0.5", 0.5 * math.pi),
    Case("over the stance foot, DS 0.5", 0.5 * math.pi, at=(2, -0.12)),
    Case("aslant, the hips swing it", 0.7 * math.pi, at=(2, 0.2), passed=swung),
    Case("standing, left", 0.5 * math.pi, **STILL),
    Case("7.5 cm feet, over the stance foot", 0.5 * math.pi, SLOW, sole=(0.075, 0.075)),
    Case("down stairs, over the stance foot", -0.5 * math.pi, DESCENT, at=(3, 0.2), stairs=True, after=3.0),
    Case("standing, feet together again", 0.3 * math.pi, passed=together, **STILL),
    Case("standing, no step", 0.3 * math.pi, passed=apart, gait=STANDING, after=2.0, special=True),
    Case("side edges, over the stance foot", 0.5 * math.pi, special=True, more={"cop_authority": (math.inf, 0.0)}),
    Case("forward, the hips swing it", 0.0, at=(2, 0.2), passed=swung, special=True),
    Case("forward, legs span it", 0.0, passed=spanned, special=True),
    Case("forward, 5 m/s^2 up or down", 0.0, passed=level, special=True),
    Case("legs with inertia, forward", 0.0, at=(2, 0.2), special=True, more={"leg": LegInertia(0.06, CHAIN)}),
    Case("forward, no fall told", 0.0, passed=silent, special=True),
    Case("forward, no fall told in 0.25 s", 0.0, passed=early, special=True),
    Case("forward, margin of 5 cm", 0.0, passed=captured, special=True),
)

FIRST_SEEN = {
    "fall_margin": "forward, no fall told", "fall_ticks": "forward, no fall told in 0.25 s",
    "most_steps": "forward, margin of 5 cm", "margin_times": "forward, margin of 5 cm",
    "longer": "forward, margin of 5 cm", "across": "over the stance foot, SS 0.5",
    "swing_weight": "forward, the hips swing it", "spanned": "forward, legs span it",
    "lifting": "forward, 5 m/s^2 up or down", "same_height": "forward, 5 m/s^2 up or down",
    "aside": "standing, left", "apart": "standing, feet together again", "calm": "standing, feet together again",
    "stand_share": "standing, no step", "unheld_share": "side edges, over the stance foot",
    "offset_ticks": "legs with inertia, forward", "same_swing": "legs with inertia, forward",
    "landing_share": "7.5 cm feet, over the stance foot", "least_single": "7.5 cm feet, over the stance foot",
}  # fmt: skip
"""Case of which a number is looked at first, as the likeliest to move."""


def changed(name: str, factor: float) -> RecoveryParameters:
    """The numbers with one of them times a factor."""
    value = getattr(NUMBERS, name)
    if isinstance(value, tuple):
        return replace(NUMBERS, **{name: tuple(factor * part for part in value)})
    return replace(NUMBERS, **{name: max(1, round(factor * value)) if isinstance(value, int) else factor * value})


def up(case: Case, numbers: RecoveryParameters, rung: int) -> int:
    """The next rung, from one on, that is passed and has two above it that are not."""
    while True:
        if case.passes(numbers, rung + 2):
            rung += 2
        elif case.passes(numbers, rung + 1):
            rung += 1
        else:
            return rung


def threshold(case: Case, rung: int = 0) -> int:
    """A passed rung with two above it that are not, looked for in strides."""
    while case.passes(NUMBERS, rung):
        rung += STRIDE
    rung -= 1
    while not case.passes(NUMBERS, rung):
        rung -= 1
    return up(case, NUMBERS, rung)


def moved(case: Case, numbers: RecoveryParameters, usual: int) -> int | None:
    """The rung of other numbers; None where it is less than two from the usual one."""
    if case.passes(numbers, usual + 2):
        return up(case, numbers, usual + 2)
    rung = usual
    while not case.passes(numbers, rung):
        rung -= 1
    return rung if rung < usual - 1 else None


def told(rung: int) -> str:
    """Impulse of a rung [N·s/kg]."""
    return f"< {FIRST:.2f}" if rung < 0 else f"{FIRST * RUNG**rung:.2f}"


def rows(names: list[str], usual: dict[str, int]) -> Iterator[tuple[str, str, str, str, str]]:
    """A number, its factor, the case that moves, and its threshold before and after."""
    for name in names:
        first = FIRST_SEEN.get(name)
        order = [case for case in CASES if case.name == first]
        order += [case for case in CASES if case.name != first and not case.special]
        for factor in (0.5, 2.0):
            numbers = changed(name, factor)
            for case in order:
                found = moved(case, numbers, usual[case.name]) if numbers != NUMBERS else None
                if found is not None:
                    yield name, f"{factor:g}", case.name, told(usual[case.name]), told(found)
                    break
            else:
                yield name, f"{factor:g}", "none", "", ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--only", nargs="*", default=None, help="numbers to look at")
    parser.add_argument("--cases", action="store_true", help="the thresholds of the cases alone")
    parser.add_argument("--out", type=Path, help="file to write the table to, in Markdown")
    options = parser.parse_args()
    names, begin = options.only or [entry.name for entry in fields(NUMBERS)], time.process_time()
    with threadpool_limits(1):
        usual = {}
        for case in CASES:
            usual[case.name] = threshold(case)
            print(f"{case.name:<36} {told(usual[case.name])}  {time.process_time() - begin:.0f} s", flush=True)
        lines = ["| number | times | threshold that moves, N·s/kg | from | to |", "|---|---|---|---|---|"]
        for row in rows([] if options.cases else names, usual):
            lines.append(f"| `{row[0]}` | {' | '.join(row[1:])} |")
            print(lines[-1], flush=True)
    print(f"{time.process_time() - begin:.0f} s", file=sys.stderr)
    if options.out is not None:
        options.out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
