"""The environment of those who train is the same run under the same judge."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fake_walks import same_content_fixture

import surefoot

gymnasium = pytest.importorskip("gymnasium")

import surefoot.gym  # noqa: E402  needs what the line above looks for
from surefoot.scenarios.file.registries import CONTROLLERS  # noqa: E402
from surefoot.studies.training.learner import NAME  # noqa: E402

pytestmark = pytest.mark.physics

same_content = same_content_fixture

STANDS = {"duration": 0.6, "gait.steps": 0, "criteria": {"fell": False}}
DRAWN = {
    "pushes": {"choice": [[{"time": 0.2, "duration": 0.05, "force": [40.0, 0.0, 0.0]}], []]},
    "terrain.friction": {"uniform": [0.6, 1.0]},
    "start.x": {"normal": [0.0, 0.1]},
}


@pytest.fixture(autouse=True)
def _no_learner_is_left():
    """Environments register the learner in the running process."""
    yield
    CONTROLLERS.discard(NAME)


def made(**more):
    given = {"scenario": "stand", "robot": "g1", "settings": STANDS, "verdict": False, **more}
    return gymnasium.make("Surefoot-v0", disable_env_checker=True, **given)


def episode(env, act=None, **reset):
    """Observations, rewards, and the last info."""
    observed, _ = env.reset(**reset)
    seen, rewards = [observed], []
    while True:
        action = np.zeros(env.action_space.shape, np.float32) if act is None else act(observed)
        observed, reward, terminated, truncated, info = env.step(action)
        seen.append(observed)
        rewards.append(reward)
        if terminated or truncated:
            return np.array(seen), np.array(rewards), {**info, "terminated": terminated}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("driver", ["agent", "built-in"])
def test_it_passes_the_checker(driver):
    from gymnasium.utils.env_checker import check_env

    env = made(driver=driver, sample=DRAWN)
    check_env(env.unwrapped, skip_render_check=True)
    env.close()


@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
def test_under_the_built_in_controller_it_is_the_run_to_the_bit(robot, tmp_path, same_content):
    settings = {"duration": 1.4, "gait.initial_stand": 0.2, "pushes": [{"time": 0.9, "duration": 0.1, "impulse": 0.1}]}
    env = made(
        scenario="walk-level", robot=robot, settings=settings, driver="built-in", verdict=True, log=tmp_path / "logs"
    )
    *_, info = episode(env, seed=4)
    env.close()
    keys = {**settings, "robot": robot}
    result = surefoot.run(surefoot.load("walk-level", keys), seed=4, out=tmp_path / "runs")
    assert same_content(info["log"], result.log) == []
    assert info["verdict"] == ("pass" if result.verdict.passed else "fail")
    same = {name for name, value in result.verdict.metrics.items() if info["metrics"][name] == value}
    assert len(same) > 30 and "foot_slip_max" in same


def test_a_network_here_is_the_policy_that_runs(tmp_path):
    """States are the same to the bit by noisy sensors, under a command, with its history."""
    import policies
    from needs import POLICY

    POLICY.or_skip()
    from surefoot.scenarios.policy.network import Network

    file = policies.framed(tmp_path / "framed")
    network = Network(file.with_name("policy.onnx"))
    settings = {
        **STANDS, "sensing.preset": "good", "commands": [{"time": 0.3, "v_x": 0.2}],
        "pushes": [{"time": 0.3, "duration": 0.05, "force": [30.0, 0.0, 0.0]}],
    }  # fmt: skip
    env = made(contract=file, settings=settings, log=tmp_path / "logs", verdict=True)

    def act(observed):
        return network.run({"obs": observed.reshape(1, -1)})["actions"].ravel()

    *_, info = episode(env, act, seed=5)
    env.close()
    scenario = surefoot.load("stand", {**settings, "robot": "g1", "controller.policy": str(file)})
    result = surefoot.run(scenario, seed=5, out=tmp_path / "runs")
    ours, theirs = surefoot.read(info["log"]), surefoot.read(result.log)
    assert ours["/truth"].field("q").tobytes() == theirs["/truth"].field("q").tobytes()
    for name in ("observation", "action"):
        np.testing.assert_array_equal(ours["/controller"].field(name), theirs["/controller"].field(name))
    assert len(ours["/controller"]) == 30


CLOCKS = [
    {"term": "moving"},
    *({"term": "phase", "options": {"period": 10.0, "clock": clock}} for clock in ("walking", "anew")),
]
BOUTS = [{"time": 0.1, "march": True}, {"time": 0.2, "v_x": 0.0}, {"time": 0.3, "v_x": 0.2}, {"time": 0.4, "v_x": 0.0}]
STEPS = {"duration": 1.4, "gait.initial_stand": 0.2}


@pytest.mark.parametrize(
    ("scenario", "driver", "settings", "moves"),
    [
        ("stand", "agent", {**STANDS, "commands": BOUTS}, [False, True, False, True, False]),
        ("walk-level", "built-in", STEPS, [False, True]),
        ("stand", "built-in", STANDS, [False]),
    ],
)
def test_clocks_count_the_decisions_at_which_it_walks(scenario, driver, settings, moves, tmp_path):
    import policies

    robot = policies.robot_of("g1")
    file = policies.write(tmp_path, policies.contract(robot, robot.joint_names, observations=CLOCKS))
    env = made(scenario=scenario, driver=driver, contract=file, settings=settings)
    found = [episode(env, seed=3)[0][:-1].astype(float) for _ in range(2)]
    env.close()
    assert found[0].tobytes() == found[1].tobytes() and len(found[0]) > 25
    moving, *waves = found[0].T
    bouts = [moving[0], *moving[1:][np.diff(moving) != 0.0]]
    assert bouts == moves
    walked, since = (np.arctan2(sin, cos) / (2.0 * np.pi) * 10.0 for sin, cos in (waves[:2], waves[2:]))
    np.testing.assert_allclose(walked, 0.02 * np.cumsum(moving), atol=1e-5)
    rested = np.maximum.accumulate(np.where(moving == 0.0, np.cumsum(moving), 0.0))
    np.testing.assert_allclose(since, 0.02 * (np.cumsum(moving) - rested), atol=1e-5)


def test_an_episode_is_that_of_its_seed_and_draws_are_made_at_each_reset():
    env = made(sample=DRAWN)
    first, rewards, _ = episode(env, seed=1)
    _, told = env.reset()
    assert set(told["settings"]) == {*DRAWN, "seed"} and told["seed"] not in (0, 1)
    _, other = env.reset()
    assert other["settings"]["start.x"] != told["settings"]["start.x"]
    again, same, _ = episode(env, seed=1)
    assert first.tobytes() == again.tobytes() and (rewards == same).all()
    env.reset(seed=1)
    assert env.reset()[1] == {"seed": told["seed"], "settings": told["settings"]}
    _, chosen = env.reset(seed=2, options={"terrain.friction": 0.7})
    assert chosen["settings"]["terrain.friction"] == 0.7
    env.close()


def test_a_campaign_draws_as_its_runs_are_drawn(tmp_path):
    from surefoot.studies.campaigns.points import draw_value
    from surefoot.studies.campaigns.spec import Draw

    (tmp_path / "rough.yaml").write_text(
        "scenario: stand\nset: {gait.steps: 0, duration: 0.4}\n"
        "sample: {terrain.friction: {uniform: [0.5, 1.0]}}\nseed: 9\n"
    )
    env = made(settings={"criteria": {"fell": False}}, sample=str(tmp_path / "rough.yaml"))
    _, told = env.reset(seed=6)
    assert told["settings"]["terrain.friction"] == draw_value(Draw(uniform=[0.5, 1.0]), 9, "terrain.friction", 6)
    assert env.unwrapped.simulation.scenario.duration == 0.4
    env.close()


def test_the_page_is_followed_as_it_stands(tmp_path):
    page = Path(__file__).parents[3] / "docs"
    (tmp_path / "contract.yaml").write_text((page / "policies" / "homie.yaml").read_text())
    programs = re.findall(r"```python\n(.*?)```", (page / "training.md").read_text(), re.DOTALL)
    assert len(programs) == 2
    for program in programs:
        asked = [sys.executable, "-c", program]
        done = subprocess.run(asked, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr


def test_two_processes_do_what_one_does():
    kwargs = {"scenario": "stand", "robot": "g1", "settings": STANDS, "sample": DRAWN, "verdict": False}
    found = {}
    for kind in ("async", "sync"):
        envs = gymnasium.make_vec(
            "Surefoot-v0", num_envs=2, vectorization_mode=kind, **kwargs,
            vector_kwargs={"context": "spawn"} if kind == "async" else {},
        )  # fmt: skip
        rows = [envs.reset(seed=[1, 2])[0]]
        rows += [envs.step(np.zeros(envs.action_space.shape, np.float32))[0] for _ in range(6)]
        envs.close()
        found[kind] = np.array(rows)
    assert found["async"].tobytes() == found["sync"].tobytes()
    assert found["sync"].shape == (7, 2, 96) and not np.array_equal(found["sync"][:, 0], found["sync"][:, 1])


def test_a_fall_ends_it_and_the_reward_is_ones_own():
    env = made(settings={**STANDS, "duration": 3.0}, verdict=True, reward=lambda step: -1.0 if step.fell else 0.5)
    seen, rewards, info = episode(env, lambda _: np.full(env.action_space.shape, 10.0, np.float32), seed=0)
    assert info["terminated"] and (info["end"], info["verdict"], info["metrics"]["fell"]) == ("fall", "fail", True)
    assert rewards[-1] == -1.0 and (rewards[:-1] == 0.5).all() and np.isfinite(seen).all()
    with pytest.raises(surefoot.RunFault, match="reset"):
        env.unwrapped.step(np.zeros(env.action_space.shape, np.float32))
    env.close()


@pytest.mark.parametrize(
    "given, said",
    [
        ({"scenario": "wlak"}, "wlak"),
        ({"contract": "none.yaml"}, "no such contract"),
        ({"driver": "me"}, "agent or built-in"),
        ({"sample": {"terrain.friction": {"uniform": [2.0, 1.0]}}}, "least first"),
        ({"settings": {"gait.stesp": 1}}, "gait.stesp"),
    ],
)
def test_what_cannot_be_is_refused(given, said):
    with pytest.raises((ValueError, surefoot.ScenarioError), match=said):
        made(**given)


def test_without_the_extra_it_is_said_in_a_sentence(tmp_path):
    (tmp_path / "gymnasium.py").write_text("raise ImportError('not here')")
    program = "import surefoot.gym\ntry:\n    surefoot.gym.WalkEnv\nexcept Exception as e:\n    print(e)"
    done = subprocess.run(
        [sys.executable, "-c", program], env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, check=False
    )
    assert "an environment needs the package gymnasium; install it with" in done.stdout, done.stderr
    assert done.stdout.count("\n") == 1
