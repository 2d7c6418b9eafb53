"""A walk outside the command line, tick by tick, for benchmarks that look inside a control tick."""

import time
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from models.types import RobotDescription
from planner.sampling import PlanSampler
from planner.types import CentroidalState, FeetState
from scenarios.assembly import Rig, assemble
from scenarios.load import load_scenario
from scenarios.log import LogWriter
from scenarios.log.channels import Sizes
from scenarios.recorder import Recorder
from scenarios.reference import whole_body_reference
from scenarios.robots import describe
from scenarios.schema import Scenario
from scenarios.timeline import run_duration
from wbc.types import FootSensing, RobotState, WbcReference, WbcReport


@dataclass
class Laps:
    """Wall-clock times of named parts [s]."""

    parts: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    last: float = field(default_factory=time.perf_counter)

    def start(self) -> None:
        self.last = time.perf_counter()

    def lap(self, part: str) -> None:
        now = time.perf_counter()
        self.parts[part].append(now - self.last)
        self.last = now


@dataclass(frozen=True)
class Tick:
    """Inputs and outputs of one control tick; the report's arrays belong to the controller."""

    time: float
    state: RobotState
    reference: WbcReference
    sensing: FootSensing
    report: WbcReport


class BareWalk:
    """The closed loop of a scenario without faults, with a stop watch between its parts."""

    def __init__(self, name: str, overrides: tuple[str, ...] = ()) -> None:
        self.scenario: Scenario = load_scenario(name, list(overrides))
        self.robot: RobotDescription = describe(self.scenario)
        self.rig: Rig = assemble(self.scenario, self.robot)
        self.laps = Laps()

    def ticks(self, log: Path) -> Iterator[Tick]:
        """Walk to the end, with the log's control-rate channels written to the file ``log``."""
        rates, rig, laps = self.scenario.rates, self.rig, self.laps
        layout = rig.controller.layout
        sizes = Sizes(nj=layout.joints, nq=layout.joints + 7, nv=layout.nv, horizon=self.scenario.planner.horizon)
        landed = (True, True)
        with LogWriter(log, {}) as writer:
            recorder = Recorder(writer, sizes, self.robot.torque_limit)
            for tick in range(round(run_duration(self.scenario) * rates.control)):
                now, now_ns = tick / rates.control, tick * 1_000_000_000 // rates.control
                laps.start()
                measurement = rig.world.measure()
                laps.lap("measure")
                state = RobotState(measurement.q, measurement.v)
                terms = rig.controller.observe(state)
                laps.lap("Pinocchio terms")
                if tick % (rates.control // rates.planner) == 0:
                    R = terms.sole_rotation
                    feet = FeetState(terms.sole_position.copy(), np.arctan2(R[:, 1, 0], R[:, 0, 0]), landed)
                    plan = rig.planner.update(CentroidalState(now, terms.com.copy(), terms.com_velocity.copy()), feet)
                    sampler = PlanSampler(plan)
                    laps.lap("planner")
                    recorder.plan(now_ns, plan)
                    laps.lap("logging of a plan")
                sample = sampler.sample(now)
                reference = whole_body_reference(plan, sample)
                laps.lap("reference sampling")
                sensing = FootSensing((float(measurement.wrench[0, 2]), float(measurement.wrench[1, 2])))
                report = rig.controller.update(reference, sensing)
                landed = report.active
                laps.parts["QP assembly"].append(report.build_time)
                laps.parts["QP solve"].append(report.solve_time)
                laps.start()
                recorder.body(now_ns, measurement, terms)
                recorder.estimate(now_ns, terms, state.q, state.v, sample.omega)
                recorder.contact(now_ns, measurement, terms, reference, report)
                recorder.reference(now_ns, plan, sample)
                recorder.control(now_ns, report, report.torque)
                laps.lap("logging")
                yield Tick(now, state, reference, sensing, report)
                laps.start()
                rig.world.advance(report.torque, rates.physics // rates.control)
                laps.lap("physics steps")
