"""A simulation that is stepped from outside, one control tick at a time: looked into, pushed, stopped at will."""

import json
import math
from collections.abc import Callable, Sequence
from copy import deepcopy
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self, cast

import numpy as np
from numpy.typing import ArrayLike
from pydantic import ValidationError

from surefoot.errors import ParameterError
from surefoot.forces import Push
from surefoot.parts.guard import shown
from surefoot.planner.laws.profiles import Profile
from surefoot.planner.plan.plan import Planner
from surefoot.planner.steps.commands import Command
from surefoot.scenarios.errors import LogError, nearest
from surefoot.scenarios.file.gait import CommandSettings
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.log import LogWriter, NoLog
from surefoot.scenarios.record.provenance import COMMAND_RECORD, PUSH_RECORD, STOPPED, AskedPush, relevant_versions
from surefoot.scenarios.run.assembly import Parts
from surefoot.scenarios.run.planning import RunFault
from surefoot.scenarios.run.run import closed_loop, note_parts, one_thread, open_log, write_end
from surefoot.scenarios.run.saved import State
from surefoot.scenarios.run.skeleton import ClosedLoop, End, refusing
from surefoot.scenarios.run.tick import Tick
from surefoot.scenarios.setup.groups.gait import command_keys, command_of
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.sim.measurement import Measurement

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription
    from surefoot.scenarios.run.plant import PlantMaker
    from surefoot.scenarios.run.seat import Seated
    from surefoot.scenarios.run.sensing import Estimator
    from surefoot.wbc.controller import WholeBodyController
    from surefoot.wbc.tasks import TaskFactory

__all__ = ["Simulation", "Tick"]


class Simulation:
    """A walk in simulation, from outside.

        sim = Simulation("walk", seed=3)
        while not sim.done:
            tick = sim.step()

    While one is open, numpy's linear algebra keeps to one thread. Usable as a context manager.

    Args:
        scenario: a scenario, or what `surefoot.load` takes to find one.
        seed: over that of the scenario.
        log: file that becomes the log; None for none. An existing file is not replaced.
        planner: a `Profile` in place of the scenario's: one's own law of motion, or a whole planner in it.
        controller: makes the whole-body controller; called with the arguments of `WholeBodyController` by name.
        estimator: makes the state estimator from the walk; see `surefoot.scenarios.run.sensing.Estimator`.
        robot: a description in place of the robot that the scenario names.
        tasks: make tasks for the whole-body QP beside its own; see `surefoot.wbc.tasks.Task`.
        plant: makes what moves the robot, from the walk; see `surefoot.Plant`.

    Attributes:
        scenario: what is simulated.
        walk: what it means.

    Raises:
        ScenarioError: the scenario cannot be found or run.
        SetupError: a part refuses it.
        PartError: a part of others cannot be made.
        LogError: the log exists or cannot be written.
    """

    def __init__(
        self,
        scenario: Scenario | str,
        seed: int | None = None,
        log: str | Path | None = None,
        *,
        planner: Profile | None = None,
        controller: "Callable[..., WholeBodyController] | None" = None,
        estimator: "Callable[[Walk], Estimator] | None" = None,
        robot: "RobotDescription | None" = None,
        tasks: "Sequence[TaskFactory]" = (),
        plant: "PlantMaker | None" = None,
    ) -> None:
        loaded = load_scenario(scenario) if isinstance(scenario, str) else scenario
        self.scenario = loaded if seed is None else loaded.model_copy(update={"seed": seed})
        with refusing():
            self.walk = resolve(self.scenario, robot, planner)
        self._parts = Parts.of(controller=controller, estimator=estimator, tasks=tuple(tasks) or None, plant=plant)
        self._given = {"planner": planner, "robot": robot, **self._parts.given()}
        self._path = None if log is None else Path(log)
        self._writer: LogWriter
        self._loop: ClosedLoop
        self._last: float | None
        self._pushes, self._commands, self._closed = 0, 0, False
        self._threads = one_thread()
        self._token = object()  # what tells its own states from those of others
        self._begin()

    def _begin(self) -> None:
        self._last = None
        if self._path is None:
            self._writer = NoLog()
        else:
            self._writer = open_log(self._path, self.walk)
        try:
            self._loop = closed_loop(self.walk, self._writer, self._parts)
            note_parts(self._writer, self._given)
        except BaseException:
            self._writer.discard()
            raise
        self._end_when_over()

    @property
    def time(self) -> float:
        """Simulated time of the next tick [s]."""
        return self._loop.time

    @property
    def done(self) -> bool:
        """True if there is nothing more to step: the time is over, the robot has fallen, or a fault ended the run."""
        return self._loop.done

    @property
    def fell(self) -> bool:
        """True if the robot has fallen."""
        return self._loop.fell

    @property
    def end(self) -> End:
        """The end of the run, or that which comes if nothing happens."""
        return self._loop.end

    @property
    def log_growth(self) -> float | None:
        """Growth of the log in simulated time while the robot walks; None without one, and at first [B/s].

        With `log.keep` it is the growth of what would be written without.
        """
        return self._writer.growth

    @property
    def planner(self) -> Planner:
        """The walking planner.

        Raises:
            AttributeError: another controller has its seat.
        """
        if self._loop.planning is None:
            raise AttributeError("a controller has the seat of the planner; simulate without the key controller")
        return self._loop.planning.planner

    @property
    def controller(self) -> "WholeBodyController":
        """The whole-body controller.

        Raises:
            AttributeError: a pendulum has none, nor a walk in whose seat is another controller.
        """
        controller = self._loop.walker.controller
        if controller is None and self.walk.seat is not None:
            raise AttributeError("another controller has its seat; simulate without the key controller")
        if controller is None:
            raise AttributeError("a pendulum has no whole-body controller; simulate with fidelity full")
        return controller

    @property
    def seat(self) -> "Seated":
        """The robot under a controller that has the seat of planner and whole-body controller.

        Raises:
            AttributeError: they have it.
        """
        if self.walk.seat is None:
            raise AttributeError("planner and whole-body controller have the seat; simulate with the key controller")
        return cast("Seated", self._loop.walker)

    @property
    def measurement(self) -> Measurement:
        """The last measurement, with the true state; its arrays are overwritten by the next tick.

        Raises:
            AttributeError: a pendulum has none, nor is there one before the first tick.
        """
        found: Measurement = self._loop.walker.measurement  # type: ignore[attr-defined]
        return found

    def sense(self) -> None:
        """Measure the next tick ahead of `step`, which then goes on from there."""
        self._loop.sense()

    def step(self) -> Tick:
        """Go through one control tick.

        Raises:
            RunFault: the run is over; says since when and why. `reset` begins anew.
        """
        self.advance()
        return self.look()

    def advance(self) -> None:
        """Go through one control tick without a look at it, which saves a tenth of the time; RunFault if it is over."""
        self._refuse_when_over()
        loop = self._loop
        time, goes_on = loop.time, loop.step()
        self._end_when_over()
        if not goes_on:
            raise RunFault(f"{loop.end.reason}; reset() begins anew") from loop.fault
        self._last = time

    def _refuse_when_over(self) -> None:
        loop = self._loop
        if loop.done:
            raise RunFault(f"the run is over at {loop.end.time:.3f} s, {loop.end.kind}; reset() begins anew")

    def _end_when_over(self) -> None:
        """Make the log whole once nothing more will happen, whether or not anyone closes the simulation."""
        if self._loop.done:
            write_end(self._writer, self._loop.end)
            self._writer.close()

    def look(self) -> Tick:
        """The last tick.

        Raises:
            RunFault: there is none before the first step.
        """
        if self._last is None:
            raise RunFault("there is no tick to look at yet; step() makes the first one")
        loop, time = self._loop, self._last
        seen, planning = loop.walker.look(), loop.planning
        return Tick(
            time=time,
            com=seen.com,
            com_velocity=seen.com_velocity,
            zmp=seen.zmp,
            phase=loop.phase,
            planned=None if planning is None else (planning.plan, loop.sample),
            fell=loop.fell,
            state=deepcopy(seen.state),
            report=deepcopy(seen.report),
            measurement=deepcopy(seen.measurement),
        )

    def command(
        self,
        v_x: float | Command | None = None,
        v_y: float | None = None,
        yaw_rate: float | None = None,
        *,
        march: bool | None = None,
        single_support: float | None = None,
        double_support: float | None = None,
        swing_height: float | None = None,
    ) -> None:
        """Command the walk, from the next plan on; what is None stays as it is.

        A step that is being swung, or to which the weight is being shifted, is taken as it was planned. A velocity that
        is out of reach is bent to the fastest in its direction that is not; see `orders`.

        Args:
            v_x: forward velocity of the path, held until the next one; 0 if another of the three is given [m/s]. Or all
                of it as a `surefoot.Command`, as `surefoot.Controller.step` takes one; its time is now.
            v_y: velocity to the left, held until the next one; 0 if another of the three is given [m/s].
            yaw_rate: rate of the heading, positive to the left; 0 if another of the three is given [rad/s].
            march: whether it steps in place where the velocity is zero, in place of standing.
            single_support: duration; what is left of the present phase changes in proportion [s].
            double_support: duration; what is left of the present phase changes in proportion [s].
            swing_height: clearance of the steps to come [m].

        Raises:
            RunFault: the run is over.
            ParameterError: a number is out of bounds, the ground has edges, the planner takes no commands, or there is
                more beside a `Command`.
        """
        if isinstance(v_x, Command):
            beside = (v_y, yaw_rate, march, single_support, double_support, swing_height)
            if beside != (None,) * len(beside):
                raise ParameterError(("command",), "numbers beside a Command", "put them into it, by Command.of")
            self._tell(command_keys(v_x))
            return
        velocity = {"v_x": v_x, "v_y": v_y, "yaw_rate": yaw_rate, "march": march}
        gait = {"single_support": single_support, "double_support": double_support, "swing_height": swing_height}
        self._tell({name: value for name, value in {**velocity, **gait}.items() if value is not None})

    def go_to(self, x: float, y: float, yaw: float) -> None:
        """Walk to a place and stand there, from the next plan on.

        Args:
            x: where the middle of the stance shall be, in the world frame [m].
            y: where it shall be along the world's y axis [m].
            yaw: heading there [rad].

        Raises:
            RunFault: the run is over.
            ParameterError: a number is out of bounds, the ground has edges, or the planner takes no commands.
        """
        self._tell({"place": {"x": x, "y": y, "yaw": yaw}})

    def _tell(self, keys: dict[str, Any]) -> None:
        self._refuse_when_over()
        if not keys:
            right = "give a velocity, or what of the gait is to change"
            raise ParameterError(("command",), "a command that says nothing", right)
        try:
            settings = CommandSettings.model_validate({"time": self.time, **keys})
        except ValidationError as error:
            fault = error.errors(include_url=False)[0]
            what = f"a command with {fault['loc'][-1]} {fault['input']!r}"
            raise ParameterError(("command", *map(str, fault["loc"])), what, fault["msg"]) from None
        self._loop.walker.command(command_of(settings), self._loop.time)
        self._commands += 1
        record = json.dumps(settings.model_dump(mode="json", exclude_none=True))
        self._writer.add_metadata(f"{COMMAND_RECORD}{self._commands}", {"command": record})

    @property
    def orders(self) -> Command:
        """Commands that the walk follows, in its last plan.

        Raises:
            ParameterError: the planner takes no commands.
        """
        return self._loop.walker.orders

    def push(self, force: ArrayLike, duration: float = 0.1, body: str | None = None) -> None:
        """Push the robot, from the next tick on.

        Args:
            force: in the world frame, shape (3,) [N].
            duration: how long it acts [s].
            body: on whose CoM it acts; the torso if None, the point mass on a pendulum.

        Raises:
            RunFault: the run is over.
            ParameterError: the force is not finite or not of three numbers, the time is not positive, the body unknown.
        """
        self._refuse_when_over()
        vector = np.array(force, dtype=np.float64)
        if vector.shape != (3,) or not np.isfinite(vector).all():
            raise ParameterError(("force",), f"a push of {force!r} N", "give three finite numbers, in the world frame")
        if not 0.0 < duration < math.inf:
            raise ParameterError(("duration",), f"a push for {duration} s", "give a time of more than 0 s")
        body = body or self.walk.robot.torso_body
        if body not in self.walk.robot.bodies:
            right = nearest(body, self.walk.robot.bodies)
            raise ParameterError(("body",), f"unknown body '{body}' of {self.walk.robot.name}", right)
        push = Push(self.time, float(duration), vector, body)
        self._loop.walker.push(push)
        self._pushes += 1
        self._writer.add_metadata(f"{PUSH_RECORD}{self._pushes}", AskedPush.of(push, live=True).to_metadata())

    def reset(self) -> None:
        """Begin anew, without the pushes and commands that were given from outside.

        Raises:
            LogError: a log is written, which holds one run only.
        """
        if self._path is not None:
            raise LogError(f"{self._path}: a log holds one run; make another Simulation with a file of its own")
        self._pushes, self._commands = 0, 0
        self._begin()

    def save(self) -> State:
        """The whole state between two ticks as a value: physics, sensors, estimator, controller, planner, randomness.

        It stays as it is while the simulation goes on, and can be pickled. `restore` goes on from it, to the bit.

        Raises:
            ParameterError: a part of others holds something of which nobody knows what its state is.
        """
        return State(self._loop, self._identity, self._last, self._token)

    def restore(self, state: State) -> None:
        """Go on from a state that this simulation had, or another one of the same scenario and parts.

        Where that is another one, its models stay: what was changed in them from outside is not in the state.

        Raises:
            ParameterError: the state is of another scenario, of other parts or of another version.
            LogError: a log is written, which holds one run in order.
        """
        if self._path is not None:
            raise LogError(f"{self._path}: a log holds one run in order; restore a Simulation without a log")
        own = self._identity
        for name, value in own.items():
            if state.of.get(name) != value:
                what = f"a state of another {name} than that of {self.walk.name}, seed {self.walk.seed}"
                raise ParameterError(("state",), what, "restore it where the same is simulated")
        if state.is_of(self._token):
            self._loop = state.put_back()
        else:
            state.put_into(self._loop)
        self._last = state.time

    @cached_property
    def _identity(self) -> dict[str, str]:
        """Texts that have to be the same where a state is put back."""
        parts = {name: shown(part) for name, part in self._given.items() if part is not None}
        return {"scenario": self.walk.text, "set of parts": str(parts), "version": str(relevant_versions())}

    def close(self) -> None:
        """End the run, whose log is whole then as it is once the run is over; a second call does nothing."""
        if self._closed:
            return
        self._closed = True
        if not self._loop.done:
            write_end(self._writer, End("interrupted", self.time, STOPPED))
        self._writer.close()
        self._threads.restore_original_limits()

    def __enter__(self) -> Self:
        """Enter ``with Simulation(...) as sim``."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close, whatever has happened."""
        self.close()

    def __repr__(self) -> str:
        """The simulation and its progress, in words."""
        state = f"over: {self.end.kind}" if self.done else "goes on"
        return f"<Simulation of {self.walk.name}, seed {self.walk.seed}, at {self.time:.3f} s, {state}>"
