"""A Gymnasium environment of any scenario and robot, which observes and acts by the contract of a policy."""

import shutil
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Literal

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.models import RobotOptions, describe
from surefoot.planner.types import PhaseKind, Twist
from surefoot.scenarios.file.registries import CONTROLLERS
from surefoot.scenarios.judge.verdict import judge
from surefoot.scenarios.log import read
from surefoot.scenarios.policy.connection import Connection
from surefoot.scenarios.policy.contract import Contract, contract_of
from surefoot.scenarios.policy.files import read as read_policy
from surefoot.scenarios.run.planning import RunFault
from surefoot.scenarios.run.simulation import Simulation
from surefoot.scenarios.setup.load import load
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.points import draw_value
from surefoot.studies.campaigns.spec import Draw, Spec
from surefoot.studies.training.learner import NAME, Learner
from surefoot.studies.training.reward import Transition, upright_and_on_course

Observation = NDArray[np.float32] | dict[str, NDArray[np.float32]]

STIFF, DAMPED = 4.0, 0.15
"""Gains over the largest torque of a joint where no contract is given [1/rad, s/rad]."""


def first_contract(robot: str) -> dict[str, Any]:
    """Plain values of a contract to begin with: all joints about the robot's posture at rest, and what most observe."""
    found = describe(robot, RobotOptions())
    limit = np.asarray(found.torque_limit)
    return {
        "network": "policy.onnx",
        "rate": 50,
        "joints": list(found.joint_names),
        "default": np.asarray(found.nominal_joint_positions).tolist(),
        "stiffness": (STIFF * limit).tolist(),
        "damping": (DAMPED * limit).tolist(),
        "action": {"scale": 0.25, "clip": [-10, 10]},
        "observations": [
            {"term": "angular_velocity", "scale": 0.2},
            {"term": "gravity"},
            {"term": "command"},
            {"term": "joint_position"},
            {"term": "joint_velocity", "scale": 0.05},
            {"term": "last_action"},
        ],
    }


class WalkEnv(gymnasium.Env[Observation, NDArray[np.float32]]):
    """A walk, one decision of a policy a step.

        env = gymnasium.make("Surefoot-v0", scenario="walk", robot="g1", contract="contract.yaml")

    Args:
        scenario: whatever `surefoot.load` takes to find one.
        robot: in place of the scenario's.
        contract: of a policy, a file or a folder, whose network need not be there; `first_contract` if None.
        settings: values of keys of the scenario, by dotted name.
        sample: what is drawn at each reset, as ``sample`` of a campaign; or a campaign, whose ``set`` holds as well.
        reward: of what came of an action, a `surefoot.gym.Transition`.
        driver: ``agent``, or ``built-in``: Surefoot's own controller walks, and actions are not heard.
        verdict: whether each episode is logged and judged at its end.
        log: folder that keeps these logs; None keeps none.
        render_mode: None; see `surefoot replay`.

    Raises:
        ScenarioError: the scenario cannot be found or run.
        ParameterError: contract and robot do not fit together.
    """

    def __init__(
        self,
        scenario: str = "walk",
        robot: str | None = None,
        contract: str | Path | None = None,
        settings: Mapping[str, Any] | None = None,
        sample: Mapping[str, Any] | str | None = None,
        reward: Callable[[Transition], float] = upright_and_on_course,
        driver: Literal["agent", "built-in"] = "agent",
        verdict: bool = True,
        log: str | Path | None = None,
        render_mode: str | None = None,
    ) -> None:
        if driver not in ("agent", "built-in"):
            raise ParameterError(("driver",), f"driver {driver!r}", "give agent or built-in")
        self._scenario, self._reward = scenario, reward
        self._agent, self._judged = driver == "agent", verdict
        if self._agent:
            CONTROLLERS.add(NAME, Learner)
        self.render_mode = render_mode
        draws, own = Spec(), dict[str, Any]()
        if isinstance(sample, str):
            draws = read_campaign(sample).spec
            own = draws.set
        elif sample is not None:
            draws = Spec.model_validate({"sample": dict(sample)})
        self._draws: Mapping[str, Draw] = draws.sample
        self._drawn_by = draws.seed
        self._settings = {**own, **({} if robot is None else {"robot": robot}), **(settings or {})}
        self._contract = self._contract_of(contract)
        self._simulation: Simulation | None = None
        self._folder, self._keeps = None if log is None else Path(log), log is not None
        self._episode = 0
        with self._simulated({"seed": 0}, None) as first:
            connection = Connection(first.walk, self._contract)
        boxes: dict[str, Any] = {name: _unbounded(size) for name, (size, _) in connection.sizes().items()}
        space: Any = next(iter(boxes.values())) if len(boxes) == 1 else spaces.Dict(boxes)
        self.observation_space = space
        low, high = self._contract.action.clip or (-np.inf, np.inf)
        self.action_space = spaces.Box(low, high, (len(connection.moved),), np.float32)

    def _contract_of(self, contract: str | Path | None) -> Contract:
        robot = load(self._scenario, self._settings).robot
        if contract is None:
            return contract_of(first_contract(robot), "the first contract")
        return read_policy(Path(contract), describe(robot, RobotOptions()).joint_names).contract

    def _simulated(self, drawn: Mapping[str, Any], log: Path | None) -> Simulation:
        keys = {**self._settings, **drawn}
        if self._agent:
            keys["controller.name"] = NAME
            keys["controller.options"] = {"contract": self._contract.model_dump(mode="json", exclude_none=True)}
        return Simulation(load(self._scenario, keys), log=log)

    @property
    def simulation(self) -> Simulation:
        """The episode's simulation, to be pushed or commanded; after a reset another one.

        Raises:
            RunFault: there is none before the first reset.
        """
        if self._simulation is None:
            raise RunFault("there is no episode yet; reset() begins one")
        return self._simulation

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: of this run, as that of `surefoot run`; those that follow are drawn by it.
            options: values of keys of the scenario for this episode, over those that are drawn.

        Returns:
            the first observation, and the run's seed with what was drawn.
        """
        super().reset(seed=seed)
        own = int(self.np_random.integers(2**31)) if seed is None else seed
        drawn = {key: draw_value(draw, self._drawn_by, key, own) for key, draw in self._draws.items()}
        drawn = {**drawn, **(options or {}), "seed": own}
        self._end_episode()
        self._simulation = sim = self._simulated(drawn, self._next_log())
        if not self._agent:
            self._connection, self._due = Connection(sim.walk, self._contract), -np.inf
            sim.advance()
        return self._as_space(self._seen()), {"seed": own, "settings": drawn}

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Decide, and go on until the next decision is due; see `gymnasium.Env.step`."""
        sim, output = self.simulation, np.asarray(action, dtype=np.float64)
        if sim.done:
            raise RunFault("the episode is over; reset() begins another one")
        if self._agent:
            self._mind.decide(output)
        self._go_on(sim)
        fell = sim.fell or sim.end.kind == "fault"
        over = fell or sim.done
        reward = self._reward(Transition(sim, self._followed(), output, fell))
        info: dict[str, Any] = {"time": sim.time}
        observed = self._seen() if not sim.done else self._last
        if over:
            info |= self._judge(sim)
        return self._as_space(observed), float(reward), fell, over and not fell, info

    def close(self) -> None:
        """End the episode; see `gymnasium.Env.close`."""
        self._end_episode()
        if not self._keeps and self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)
            self._folder = None

    @property
    def _mind(self) -> Learner:
        mind: Any = self.simulation.seat.mind
        return mind  # type: ignore[no-any-return]

    def _followed(self) -> Twist:
        """The velocity that is to be followed."""
        sim = self.simulation
        if self._agent:
            return self._mind.followed
        orders = sim.orders
        return orders.followed or orders.twist or Twist()

    def _go_on(self, sim: Simulation) -> None:
        """Simulate until a decision is due, or the robot has fallen, or the run is over."""
        is_due: Callable[[float], bool] = self._mind.is_due if self._agent else lambda time: time >= self._due
        while True:
            try:
                sim.advance()
            except RunFault:
                return
            if sim.done or sim.fell:
                return
            if is_due(sim.time):
                return

    def _seen(self) -> dict[str, NDArray[np.float64]]:
        """Observation before the next decision."""
        sim = self.simulation
        if self._agent:
            sim.sense()
            self._last = self._mind.observe(*sim.seat.sees(sim.time))
            return self._last
        tick = sim.look()
        assert tick.state is not None
        self._connection.follow(self._followed(), tick.phase.kind is not PhaseKind.STAND)
        self._due = self._connection.due(sim.time)
        self._last = self._connection.observe(tick.time, tick.state)
        return self._last

    def _as_space(self, observed: Mapping[str, NDArray[np.float64]]) -> Observation:
        found = {name: values.astype(np.float32) for name, values in observed.items()}
        return found if isinstance(self.observation_space, spaces.Dict) else next(iter(found.values()))

    def _next_log(self) -> Path | None:
        if not self._judged and not self._keeps:
            return None
        if self._folder is None:
            self._folder = Path(tempfile.mkdtemp(prefix="surefoot-"))
        self._folder.mkdir(parents=True, exist_ok=True)
        self._episode += 1
        return self._folder / f"episode-{self._episode:06d}.mcap"

    def _judge(self, sim: Simulation) -> dict[str, Any]:
        """Findings at the end of an episode, for which a robot that has fallen goes on falling."""
        while not sim.done:
            try:
                sim.advance()
            except RunFault:
                break
        sim.close()
        found: dict[str, Any] = {"end": sim.end.kind}
        if self._judged and self._folder is not None:
            log = self._folder / f"episode-{self._episode:06d}.mcap"
            verdict = judge(read(log))
            found |= {
                "verdict": "pass" if verdict.passed else "fail",
                "reasons": list(verdict.reasons),
                "metrics": dict(verdict.metrics),
            }
            if self._keeps:
                found["log"] = str(log)
            else:
                log.unlink()
        return found

    def _end_episode(self) -> None:
        if self._simulation is not None:
            self._simulation.close()
            self._simulation = None


def _unbounded(size: int) -> spaces.Box:
    return spaces.Box(-np.inf, np.inf, (size,), np.float32)
