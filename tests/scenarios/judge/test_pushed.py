"""The judge compares the impulse of each push in the log with what was asked for; what was not measured is no pass."""

import threading
from dataclasses import replace

import numpy as np
import pytest

import surefoot
from surefoot.apps.bridge.host import Care, Host
from surefoot.apps.bridge.line import Disturbance
from surefoot.apps.bridge.remote import Remote
from surefoot.apps.bridge.serve import Server
from surefoot.apps.bridge.shadow import walk_in_shadow
from surefoot.apps.bridge.walk import walk_on
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.verdict import judge
from surefoot.scenarios.record.provenance import BEGUN_RECORD, PUSH_RECORD, AskedPush, asked_pushes
from surefoot.scenarios.run import pendulum
from surefoot.scenarios.setup.walk import resolve
from surefoot.sim import World

pytestmark = pytest.mark.unit

TURNED = np.array([[1.0, 0.0], [0.1, 1.0]])
POINT = {"fidelity": "pendulum", "gait.steps": 2, "criteria": {"fell": False}}
STANDING = {"gait.steps": 0, "duration": 0.3, "sensing.source": "truth", "criteria": {"fell": False}}
TIMED = {"time": 0.1, "duration": 0.051, "force": [20.0, 5.0, 0.0]}
POINTED = {"step": 1, "phase": "single", "fraction": 0.3, "force": [0.0, 8.0, 0.0]}
OVERLAPPING = [{"time": 0.5, "force": [9.0, 0.0, 0.0]}, {"time": 0.55, "force": [-9.0, 0.0, 0.0]}]


@pytest.fixture(name="acts")
def acts_fixture(monkeypatch):
    """Let other forces act on the pendulum than were asked for: a function of the mean force, which may come late."""

    def change(how, late=0.0):
        asked = pendulum.mean_force
        monkeypatch.setattr(
            pendulum, "mean_force", lambda pushes, time, period: how(asked(pushes, time - late, period))
        )

    return change


def point(tmp_path, *pushes, **keys):
    """Reasons of a walk of the point mass under pushes."""
    return surefoot.run(surefoot.load("walk-level", {**POINT, "pushes": pushes, **keys}), out=tmp_path).verdict.reasons


@pytest.mark.parametrize("pushes", [[TIMED], [POINTED], OVERLAPPING, [TIMED, POINTED]])
def test_pushes_that_act_pass_and_those_that_do_not_fail(tmp_path, acts, pushes):
    assert point(tmp_path, *pushes) == ()
    acts(lambda force: 0.0 * force)
    found = point(tmp_path, *pushes)
    assert found and all(reason.startswith("0 of ") and "N·s acted of the" in reason for reason in found)


@pytest.mark.parametrize(
    ("how", "words"),
    [
        (lambda force: 0.5 * force, "0.4 of 0.8 N·s acted of the push at"),
        (lambda force: 0.98 * force, "0.784 of 0.8 N·s"),
        (lambda force: 1.5 * force, "1.2 of 0.8 N·s"),
        (lambda force: -force, "-0.8 of 0.8 N·s"),
        (lambda force: force[::-1], "0 of 0.8 N·s"),
        (lambda force: force @ TURNED, "0.8 of 0.8 N·s acted of the push at"),
    ],
)
def test_an_impulse_that_is_another_is_no_pass(tmp_path, acts, how, words):
    acts(how)
    (reason, *_) = [reason for reason in point(tmp_path, POINTED) if "push" in reason]
    assert words in reason
    assert ("in another direction" in reason) == ("0.8 of 0.8" in reason and "-" not in reason)


@pytest.mark.parametrize(("late", "passes"), [(0.001, True), (0.05, False)])
def test_a_push_may_be_late_by_a_step_of_the_plant_and_no_more(tmp_path, acts, late, passes):
    acts(lambda force: force, late)
    assert (point(tmp_path, POINTED) == ()) == passes


def test_pushes_that_cancel_one_another_for_a_while_do_not_make_up_for_one_another(tmp_path, acts):
    acts(lambda force: 0.0 * force)
    assert point(tmp_path, *OVERLAPPING) == ("0 of 0.9 N·s acted of the 2 pushes from 0.5 s on",)


def test_a_push_that_nothing_can_show_is_no_pass(tmp_path):
    """Forces on two bodies that add up to nothing turn the robot, and their sum, which is measured, shows none."""
    couple = [TIMED, {**TIMED, "force": [-20.0, -5.0, 0.0], "body": "pelvis"}]
    scenario = surefoot.load("walk-level", {**STANDING, "pushes": couple})
    found = surefoot.run(scenario, out=tmp_path).verdict.reasons
    assert len(found) == 2 and all("the sum of forces was to be zero" in reason for reason in found)
    last = {"time": 0.2985, "duration": 0.0015, "force": [20.0, 0.0, 0.0]}
    scenario = surefoot.load("walk-level", {**STANDING, "pushes": [last]})
    (reason,) = surefoot.run(scenario, out=tmp_path).verdict.reasons
    assert "the log has no tick of that time" in reason


def test_a_fall_cuts_off_what_is_asked(tmp_path):
    """Asked for is the integral over the time that the run has lasted."""
    push = {"time": 0.5, "duration": 3.0, "force": [300.0, 0.0, 0.0]}
    assert point(tmp_path, push, criteria={"fell": True}) == ()


def test_a_push_by_hand_is_compared_too_and_again_in_the_run_of_its_log(tmp_path, acts):
    def driven(name):
        with surefoot.Simulation(surefoot.load("walk-level", {**POINT, "duration": 0.6}), log=tmp_path / name) as sim:
            while not sim.done:
                if sim.time == 0.3:
                    sim.push((10.0, 0.0, 0.0), 0.1)
                if sim.time == 0.55:  # of which the end of the run cuts off half
                    sim.push((0.0, 10.0, 0.0), 0.1)
                sim.advance()
        return tmp_path / name

    log = driven("sound.mcap")
    assert judge(surefoot.read(log)).passed
    assert surefoot.run(str(log), out=tmp_path).verdict.passed
    acts(lambda force: 0.5 * force)
    halved = ("0.5 of 1 N·s acted of the push at 0.3 s", "0.25 of 0.5 N·s acted of the push at 0.55 s")
    assert judge(surefoot.read(driven("halved.mcap"))).reasons == halved
    assert surefoot.run(str(log), out=tmp_path).verdict.reasons == halved


def test_a_log_tells_what_was_asked_of_the_plant(tmp_path):
    scenario = surefoot.load("walk-level", {**POINT, "pushes": [TIMED, POINTED]})
    log = surefoot.read(surefoot.run(scenario, out=tmp_path).log)
    timed, pointed = asked_pushes(log.metadata, "a.mcap")
    torso = resolve(scenario).robot.torso_body
    assert timed == AskedPush(0.1, 0.051, (20.0, 5.0, 0.0), torso)
    assert pointed.time > 0.1 and pointed == AskedPush(pointed.time, 0.1, (0.0, 8.0, 0.0), torso)
    del log.metadata[f"{BEGUN_RECORD}1"]
    log.metadata[f"{PUSH_RECORD}1"] = AskedPush(0.05, 0.1, (1.0, 0.0, 0.0)).to_metadata()
    assert [push.live for push in asked_pushes(log.metadata, "a.mcap")] == [True, False]
    for wrong in ('{"time": NaN, "duration": 1, "force": [0, 0, 1]}', '{"time": 1}', "[[", '{"time": 1e999}'):
        log.metadata[f"{PUSH_RECORD}1"] = {"push": wrong}
        with pytest.raises(LogError, match=r"a\.mcap: "):
            asked_pushes(log.metadata, "a.mcap")


def test_a_push_at_the_end_of_all_times_is_no_fault_of_the_judge(tmp_path):
    log = surefoot.read(surefoot.run(surefoot.load("walk-level", POINT), out=tmp_path).log)
    for number, (time, lasts) in enumerate([(1e300, 1.0), (0.0, 1e300), (-1e300, 1e301)]):
        log.metadata[f"{PUSH_RECORD}{number}"] = AskedPush(time, lasts, (1.0, 0.0, 0.0)).to_metadata()
    assert any("N·s acted of the" in reason for reason in judge(log).reasons)


class Own:
    """A plant of one's own that applies a share of each push, and tells of it or not."""

    def __init__(self, walk, share, tells):
        self.world = World(walk.true_robot, walk.ground.true_terrain, walk.rates.physics, (), walk.size)
        self.share, self.tells = share, tells
        self.reset, self.act = self.world.reset, self.world.act

    def measure(self):
        seen = self.world.measure()
        return seen if self.tells else surefoot.Measurement.of_state(seen.time, seen.q, seen.v)

    def push(self, push):
        if self.share:
            self.world.push(replace(push, force=self.share * push.force))


@pytest.mark.parametrize(
    ("share", "tells", "words"),
    [
        (1.0, True, ""),
        (0.0, True, "0 of 1.05 N·s acted of the push at 0.1 s"),
        (0.5, True, "0.526 of 1.05 N·s acted of the push at 0.1 s"),
        (1.0, False, "the push at 0.1 s cannot be shown to have acted: the plant does not measure the external force"),
    ],
)
def test_a_plant_of_ones_own_is_judged_by_what_it_says_that_acted(tmp_path, share, tells, words):
    parts = surefoot.Parts(plant=lambda walk: Own(walk, share, tells))
    pushed = surefoot.load("walk-level", {**STANDING, "pushes": [TIMED]})
    assert "; ".join(surefoot.run(pushed, out=tmp_path, parts=parts).verdict.reasons) == words
    assert surefoot.run(surefoot.load("walk-level", STANDING), out=tmp_path, parts=parts).verdict.passed


def bridged(tmp_path, scenario, pushed=lambda asked: asked, **line):
    """The verdict of a walk on a plant that is served over a line and takes another push than it is asked for."""

    class Pushed(Host):
        def push(self, asked):
            if (push := pushed(asked)) is not None:
                super().push(push)

    plant = Pushed(resolve(surefoot.load("walk-level", STANDING)), Care(Disturbance(**line)))
    server = Server(plant, "127.0.0.1", 0, lambda said: None)
    serving = threading.Thread(target=server.run, args=(lambda: False,))
    serving.start()
    verdict = walk_on(Remote(server.address, {}), scenario, tmp_path).verdict
    serving.join(10.0)
    return verdict


def test_a_push_that_gets_lost_over_the_bridge_is_no_pass(tmp_path):
    scenario = surefoot.load("walk-level", {**STANDING, "pushes": [TIMED]})
    assert bridged(tmp_path, scenario).passed
    halved = bridged(tmp_path, scenario, lambda asked: replace(asked, force=0.5 * asked.force))
    assert halved.reasons == ("0.526 of 1.05 N·s acted of the push at 0.1 s",)
    assert bridged(tmp_path, scenario, lambda _: None).reasons == ("0 of 1.05 N·s acted of the push at 0.1 s",)


def test_over_a_line_that_is_late_or_loses_states_no_push_is_blamed_for_it(tmp_path):
    scenario = surefoot.load("walk-level", {**STANDING, "pushes": [TIMED]})
    assert bridged(tmp_path, scenario, delay=0.01).passed
    (reason,) = bridged(tmp_path, scenario, drop=0.2).reasons
    assert reason.startswith("the ticks of the log are not 2 ms apart")
    assert bridged(tmp_path, scenario, lambda asked: replace(asked, time=asked.time + 0.05), delay=0.01).passed

    def lost(_):
        return None

    assert "0 of 1.05 N·s acted of the push at 0.1 s" in bridged(tmp_path, scenario, lost, delay=0.01).reasons
    unshown = "the push at 0.1 s cannot be shown to have acted: ticks of that time are not in the log"
    assert unshown in bridged(tmp_path, scenario, lost, drop=0.2).reasons


def test_in_a_shadow_that_acted_which_is_in_its_log(tmp_path):
    pushed = surefoot.load("walk-level", {**STANDING, "pushes": [TIMED]})
    log, other = (surefoot.run(one, out=tmp_path).log for one in (pushed, surefoot.load("walk-level", STANDING)))
    assert walk_in_shadow(log, pushed, tmp_path / "same").verdict.passed
    assert walk_in_shadow(other, pushed, tmp_path / "other").verdict.reasons == (
        "0 of 1.05 N·s acted of the push at 0.1 s",
    )
