"""Variations of `diagonal-walk` that must pass with nothing else changed; run as a script for a table of all.

python tests/scenarios/run/variations.py [--jobs N] [--only TEXT]
"""

import argparse
import math
import tempfile
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

SCENARIO = "diagonal-walk"
START_NOISE = ("start.position_noise=0.001", f"start.angle_noise={math.radians(1.0)}")


@dataclass(frozen=True, slots=True)
class Variation:
    """Overrides of the scenario, and whether the physics tier runs it on every change."""

    name: str
    overrides: tuple[str, ...] = ()
    every_change: bool = False


VARIATIONS = (
    Variation("as it is", (), True),
    *(Variation(f"step length {v} m", (f"gait.step_length={v}",), v == -0.15) for v in (0.0, 0.1, 0.25, -0.15)),
    *(Variation(f"single support {v} s", (f"gait.single_support={v}",)) for v in (0.8, 1.0, 2.0)),
    Variation("20 steps", ("gait.steps=20",)),
    Variation("human-size feet", ("robot_options.foot_length=0.22", "robot_options.foot_width=0.11"), True),
    Variation("friction 0.5", ("terrain.friction=0.5",), True),
    *(Variation(f"control at {v} Hz", (f"rates.control={v}",), v == 250) for v in (250, 1000)),
    Variation("100 m away, turned 90 deg", ("start.x=100", "start.y=100", f"start.yaw={math.pi / 2}"), True),
    *(Variation(f"start noise, seed {v}", (*START_NOISE, f"seed={v}"), v == 1) for v in range(10)),
)

COMMANDED = "stop-and-go"

SOUND = "criteria={fell: false, steps_taken: steps_planned, standing_time_final: {min: 1}, cop_ratio_p99: {max: 1},\
 footstep_error_max: {max: 0.01}, foot_slip_max: {max: 0.01}, self_contact_time: {max: 0}, wbc_fallbacks: {max: 0},\
 torque_at_limit_fraction: {max: 0.01}}"
"""Criteria that any walk must meet, wherever it leads; those of the catalogue are for its scenarios as they are."""

SOUND_ON_STEPS = SOUND.replace("footstep_error_max: {max: 0.01}", "stair_edge_margin_min: {min: 0}")
"""The same where a tread may lie elsewhere than a foot was told, which counts as an error of the footstep."""


def _velocity(*rows: tuple[float, ...]) -> str:
    """Override of the velocity by rows of time, v_x, v_y and yaw rate, of which the last ones may be left out."""
    names = ("time", "v_x", "v_y", "yaw_rate")
    commands = [", ".join(f"{name}: {value}" for name, value in zip(names, row, strict=False)) for row in rows]
    return f"gait.velocity=[{', '.join('{' + command + '}' for command in commands)}]"


COMMANDS = (
    Variation("at 0.6 m/s, with a stop", (_velocity((0, 0.6), (5,), (8.5, 0.6), (12,)),)),
    Variation("from 0.6 m/s forward to 0.6 m/s backward", (_velocity((0, 0.6), (4, -0.6), (8,)),)),
    Variation("stops for a moment", (_velocity((0, 0.5), (5,), (5.5, 0.5), (9,)),)),
    Variation("four short stops", (_velocity((0, 0.3), (2,), (4, 0.3), (5,), (7, 0.3), (8,), (10, 0.3), (12,)),)),
    Variation(
        "forward, sideways, turning, a backward curve",
        (_velocity((0, 0.4), (4, 0, 0.2), (7, 0, 0, -0.7), (9,), (11, -0.3, 0, 0.3), (14,)),),
    ),
    Variation("sideways there and back", (_velocity((0, 0, 0.2), (5, 0, -0.2), (10,)),)),
    Variation("a circle of 1 m at 0.5 m/s", (_velocity((0, 0.5, 0, 0.5), (13,)),)),
    Variation("a circle to the right, crabwise", (_velocity((0, 0.3, 0.1, -0.3), (10,)),)),
    Variation("a backward curve", (_velocity((0, -0.25, 0, 0.25), (10,)),)),
    Variation("fast turns to and fro", (_velocity((0, 0, 0, 0.75), (5, 0, 0, -0.75), (9,)),)),
    Variation("backward at 0.5 m/s", (_velocity((0, -0.5), (10,)),)),
    Variation("feet 7.5 cm square", ("robot_options.foot_length=null", "robot_options.foot_width=null")),
    *(
        Variation(f"start noise, seed {v}", ("start.position_noise=0.005", "start.angle_noise=0.005", f"seed={v}"))
        for v in range(5)
    ),
)
"""Variations of `stop-and-go`: other commands than its own, of which only a sound walk is asked."""


def run(variation: Variation) -> dict[str, object]:
    """Metrics of one variation, computed from its log."""
    from surefoot.scenarios.run.run import run_scenario
    from surefoot.scenarios.setup.load import load as load_scenario

    scenario = load_scenario(SCENARIO, list(variation.overrides))
    with tempfile.TemporaryDirectory() as folder:
        verdict = run_scenario(scenario, Path(folder)).verdict
    return verdict.to_json()


def _row(variation: Variation, metrics: dict[str, object]) -> str:
    def number(name: str, scale: float = 1.0) -> str:
        value = metrics.get(name)
        values = value if isinstance(value, list) else [value]
        return "/".join("-" if v is None else f"{scale * v:.3g}" for v in values)

    cells = [
        metrics["verdict"], f"{metrics['steps_taken']}/{metrics['steps_planned']}", number("zmp_inside_fraction"),
        number("cop_ratio_p99"), number("com_error_rms", 1e3), number("zmp_error_rms", 1e3), number("torque_ratio_max"),
        number("real_time_factor"), "; ".join(metrics["reasons"]),
    ]  # fmt: skip
    return "| " + " | ".join([variation.name, *map(str, cells)]) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    chosen = [v for v in VARIATIONS if options.only in v.name]
    columns = ("variation", "verdict", "steps", "inside", "CoP p99", "CoM error [mm]", "ZMP error [mm]", "torque")
    print("| " + " | ".join((*columns, "real time", "why")) + " |")
    print("|" + 10 * "---|")
    with ProcessPoolExecutor(options.jobs) as pool:
        for variation, metrics in zip(chosen, pool.map(run, chosen), strict=True):
            print(_row(variation, metrics), flush=True)


if __name__ == "__main__":
    main()
