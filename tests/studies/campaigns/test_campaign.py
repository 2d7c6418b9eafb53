"""A specification is checked whole before anything is run: every fault with its place."""

import os
from itertools import islice

import pytest

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.schema import RobotSettings
from surefoot.scenarios.many.points import Record
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.setup.robot import robots
from surefoot.scenarios.setup.robot.robots import Robots
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.points import cells
from surefoot.studies.campaigns.shipped import shipped

pytestmark = pytest.mark.unit


@pytest.fixture
def campaign(tmp_path):
    def make(text, *overrides, **named):
        path = tmp_path / "c.yaml"
        path.write_text(text)
        return read_campaign(str(path), overrides, **named)

    return make


@pytest.fixture
def refused(campaign):
    def make(text, *overrides):
        with pytest.raises(ScenarioError) as error:
            campaign(text, *overrides)
        return [problem.rpartition("/")[2] for problem in error.value.problems]

    return make


@pytest.mark.parametrize(
    ("text", "place", "what"),
    [
        ("scenario: walk\nset: {gait.stepz: 3}", "c.yaml:2:19", "unknown key 'stepz'; did you mean 'steps'?"),
        ("scenario: walk\ngrid: {gait.steps: []}", "c.yaml:2:20", "give more elements"),
        ("scenario: walk\ngrid: {gait.steps: [3, x]}", "c.yaml:2:24", "gait.steps is 'x'; give a whole number"),
        ("scenario: walk\ngrid: {a: {b: {gait.x: 1}}}", "c.yaml:2:24", "unknown key 'x'"),
        ("scenario: walk\ngrid: {terrain.friction: [1, -1]}", "c.yaml:2:30", "it must be at least 0"),
        ("scenario: walk\nsample: {terrain.friction: {uniform: [2, 1]}}", "c.yaml:2:28", "uniform from 2 to 1 is"),
        ("scenario: walk\nsample: {terrain.friction: {uniform: [-1, 1]}}", "c.yaml:2:28", "is -1.0; it must be at"),
        ("scenario: walk\nsample: {terrain.friction: {uniform: [0, 99]}}", "c.yaml:2:28", "is 99.0; it must be at"),
        ("scenario: walk\nsample: {terrain.friction: {normal: [1, -1]}}", "c.yaml:2:28", "standard deviation of -1"),
        ("scenario: walk\nsample: {terrain.friction: {}}", "c.yaml:2:28", "needs one distribution"),
        ("scenario: walk\nsample: {gait.steps: {choice: [3, x]}}", "c.yaml:2:35", "gait.steps is 'x'"),
        ("scenario: walk\nsample: {gait.steps: {choice: [x, 3]}}", "c.yaml:2:22", "gait.steps is 'x'"),
        ("scenario: walk\nfirst: {gait.com_height: [1, x]}", "c.yaml:2:30", "gait.com_height is 'x'"),
        ("scenario: walk\nbisect: {key: gait.steps, low: 3, high: 2, ratio: 2}", "c.yaml:2:9", "from 3 to 2 is empty"),
        ("scenario: walk\nbisect: {key: seed, low: 3, high: 5}", "c.yaml:2:9", "needs tolerance"),
        ("scenario: walk\nbisect: {key: gait.x, low: 3, high: 5, tolerance: 1}", "c.yaml:2:15", "unknown key 'x'"),
        ("scenario: walk\nbisect: {key: terrain.friction, low: 1, high: 20, ratio: 2}", "c.yaml:2:15", "20"),
        ("scenario: walk\nseeds: 0", "c.yaml:2:8", "seeds is 0"),
        ("scenario: walk\nseedz: 1", "c.yaml:2:1", "unknown key 'seedz'"),
        ("scenario: walk\ngrid: {seed: [1]}", "c.yaml:2:14", "seed is varied by seeds too"),
        ("scenario: walk\ngrid: {gait.turn: [0]}\nsample: {gait.turn: {choice: [0]}}", "c.yaml:2:19", "by sample too"),
        ("seeds: 3", "c.yaml:1:1", "names no scenario"),
        ("[1]", "c.yaml:1:1", "a group of keys"),
        ("", "c.yaml:1:1", "a group of keys"),
        ("scenario: walk\nseeds: 2000\ngrid: {gait.turn: [0, 0.1], gait.steps: [3, 4]}", "", ""),
    ],
)  # fmt: skip
def test_faults_have_their_places(refused, campaign, text, place, what):
    if not place:  # a sound one, as a control
        assert campaign(text).cells == 8000
        return
    (problem,) = refused(text)
    assert problem.startswith(f"{place}: ")
    assert what in problem


def test_a_scenario_that_is_not_there_and_too_many_runs(refused, campaign):
    assert "did you mean 'walk'?" in refused("scenario: walkk")[0]
    assert "at most 1000000 runs" in refused("scenario: walk\nseeds: 1000000\ngrid: {gait.steps: [3, 4]}")[0]


def test_a_range_of_its_own(campaign, refused):
    search = "bisect: {{key: gait.turn, low: 0.1, high: 1, ratio: 2}}"
    text = f"scenario: walk\n{search}\ngrid: {{{{a: {{{{b: {{{{bisect.low: {{}}}}}}}}}}}}}}"
    made = campaign(text.format(0.2))
    ((_, keys),) = made.combinations()
    assert made.bisect(keys).low == 0.2
    assert "from 5 to 1 is empty" in refused(text.format(5))[0]


def test_what_is_set_from_outside_takes_the_place_of_what_varies(campaign, refused):
    text = """
scenario: walk
set: {gait.steps: 3}
grid: {gait.turn: [0, 0.1], pace: {slow: {gait.single_support: 1.0}, 2: {gait.single_support: 0.5}}}
sample: {terrain.friction: {uniform: [0.5, 1]}}
"""
    made = campaign(text, "gait.turn=0.2", "pace=2", "terrain.friction=0.7", seeds=4)
    assert list(made.combinations()) == [
        (
            {"gait.turn": 0.2, "pace": 2},
            {"gait.steps": 3, "terrain.friction": 0.7, "gait.turn": 0.2, "gait.single_support": 0.5},
        )
    ]
    assert made.spec.sample == {}
    assert made.cells == 4
    assert campaign(text).cells == 4
    assert "did you mean 'slow'?" in refused(text, "pace=slo")[0]
    assert "write --set key=value" in refused(text, "pace")[0]
    assert "unknown key 'x'" in refused(text, "gait.x=1")[0]


def test_a_part_of_an_axis_is_kept_in_the_order_of_the_grid(campaign, refused):
    text = "scenario: walk\ngrid: {gait.turn: [0, 0.1, 0.2], pace: {slow: {gait.steps: 3}, fast: {}, slower: {}}}"
    made = campaign(text, "gait.turn=[0.2, 0]", "pace=[slower, slow]")
    chosen = [tuple(labels.values()) for labels, _ in made.combinations()]
    assert chosen == [(0, "slow"), (0, "slower"), (0.2, "slow"), (0.2, "slower")]
    assert "did you mean 'slow'?" in refused(text, "pace=[fast, slo]")[0]
    assert "no such setting" in refused(text, "pace=[]")[0]
    assert "gait.turn is" in refused(text, "gait.turn=[0, 9]")[0]  # no part of the axis: a value, which is none


SEARCHED = (
    "scenario: walk\ngrid: {gait.steps: [3, 4]}\nbisect: {key: gait.turn, low: 0.1, high: 0.2, ratio: 1.1}\nrecords: "
)


def test_published_values_belong_to_the_grid(campaign, refused):
    text = SEARCHED + "[{name: X, value: 1, source: Y, at: {gait.steps: 3}}]"
    assert campaign(text).spec.records[0].at == {"gait.steps": 3}
    assert campaign(text, "gait.steps=4").spec.records == []  # what is written of it can be read again
    assert (
        "a record is at gait.steps: 5" in refused(SEARCHED + "[{name: X, value: 1, source: Y, at: {gait.steps: 5}}]")[0]
    )
    assert "a record is at pace: 5" in refused(SEARCHED + "[{name: X, value: 1, source: Y, at: {pace: 5}}]")[0]
    assert "give bisect" in refused("scenario: walk\nrecords: [{name: X, value: 1, source: Y}]")[0]


@pytest.mark.parametrize("label", ["[a]", "{a: 1}"])
def test_a_published_value_at_no_label_of_a_named_axis(refused, label):
    named = SEARCHED.replace("{gait.steps: [3, 4]}", "{pace: {slow: {gait.steps: 3}}}")
    (told,) = refused(named + f"[{{name: X, value: 1, source: Y, at: {{pace: {label}}}}}]")
    assert "a record is at pace: " in told


def test_a_pipe_or_a_device_is_no_specification(tmp_path):
    os.mkfifo(tmp_path / "pipe.yaml")
    for place in (str(tmp_path / "pipe.yaml"), "/dev/zero"):
        with pytest.raises(ScenarioError, match="no regular file; give a specification"):
            read_campaign(place)


def test_a_scenario_beside_the_specification(tmp_path, campaign):
    (tmp_path / "mine.yaml").write_text("gait: {steps: 2}")
    made = campaign("scenario: mine.yaml")
    assert made.bases["mine.yaml"].written.text == "gait: {steps: 2}"


@pytest.mark.parametrize("name", shipped())
def test_campaigns_that_come_along_can_be_run(name):
    campaign = read_campaign(name)
    assert campaign.spec.about
    assert campaign.spec.name == name
    assert campaign.cells > 1


def accepted(cell):
    """The first run of a cell that is not refused."""
    search = cell.search()
    point = next(search)
    while True:
        try:
            read_scenario(*point.base.written, point.settings)
        except ScenarioError as refusal:
            try:
                point = search.send(Record(point.id, "refused"))
            except StopIteration:
                raise refusal from None
        else:
            return point


@pytest.mark.parametrize("name", shipped())
def test_the_first_runs_of_campaigns_that_come_along_are_accepted(name):
    """Six of them or 24, and of those that follow the first of each choice."""
    campaign = read_campaign(name)
    longest = max([0, *(len(draw.choice or ()) for draw in campaign.spec.sample.values())])
    if campaign.spec.sample:
        campaign = read_campaign(name, seeds=max(12, 5 * longest))
    drawn = {key: set() for key in campaign.spec.sample}
    for number, cell in enumerate(islice(cells(campaign), max(24, 5 * longest) if drawn else 6)):
        settings = next(cell.search()).settings
        if number < 24 or any(settings[key] not in drawn[key] for key in drawn if campaign.spec.sample[key].choice):
            accepted(cell)
            for key, found in drawn.items():
                found.add(settings[key])
    for key, draw in campaign.spec.sample.items():
        assert drawn[key] >= set(draw.choice or ())


@pytest.mark.parametrize(
    ("name", "part"),
    [
        ("push-map", ("direction=[forward, over stance]", "phase=[SS 0.5]", "planner.step_adaptation=none")),
        ("push-map-pendulum", ("pushes.0.direction=[0.0, -1.570796]",)),
        ("random-pushes", ()),
        ("soak", ()),
        pytest.param("recovery-numbers", (), marks=pytest.mark.long),
    ],
)
@pytest.mark.parametrize("robot", [pytest.param("talos", marks=pytest.mark.long), "g1"])
def test_runs_of_campaigns_that_come_along_are_accepted_for_other_robots(name, part, robot):
    campaign = read_campaign(name, (f"robot={robot}", *part))
    chosen = list(islice(cells(campaign), None, None, 1 if part else 96))
    assert chosen and all(accepted(cell) for cell in chosen)


SIZED = """
scenario: walk
sized_for: humanoid100
set: {gait.step_width: 0.25, robot_options.foot_length: 0.2, pushes: [{time: 3, impulse: 0.1, direction: 0}]}
grid:
  gait.initial_stand: [0.4]
  pace: {slow: {gait.step_length: 0.2, bisect.low: 0.14}}
bisect: {key: pushes.0.impulse, low: 0.1, high: 2.0, ratio: 1.1}
"""


def _settings(campaign):
    return next(campaign.combinations())[1]


def test_a_campaign_is_the_same_for_robots_of_all_sizes(campaign):
    full, small = _settings(campaign(SIZED)), _settings(campaign(SIZED, "robot=g1"))
    size = Robots().facts("g1", RobotSettings()).size
    assert full["gait.step_length"] == 0.2
    assert small["gait.step_length"] == pytest.approx(size.length * 0.2)
    assert small["pushes"][0]["impulse"] == pytest.approx(size.factor("m/s") * 0.1)
    # Soles are the robot's own, and what stands in tables means what it says.
    assert "robot_options.foot_length" in full
    assert "robot_options.foot_length" not in small
    assert (small["gait.initial_stand"], small["bisect.low"]) == (0.4, 0.14)


def test_what_is_set_from_outside_is_no_size_of_another_robot(campaign):
    assert _settings(campaign(SIZED, "robot=g1", "gait.step_width=0.25"))["gait.step_width"] == 0.25
    plain = _settings(campaign(SIZED.replace("sized_for: humanoid100", ""), "robot=g1", "robot_options={}"))
    assert plain["gait.step_length"] == 0.2


def test_a_campaign_sized_for_nobody_is_refused(refused):
    assert refused(SIZED.replace("humanoid100", "humanoid10"))[0].startswith(
        "c.yaml:3:12: unknown robot 'humanoid10' in sized_for; did you mean 'humanoid100'"
    )


def test_another_robot_is_looked_at_once_for_all_points(campaign, monkeypatch):
    """Its meshes take a third of a second, and where its knees bend as the other one's another."""
    looked = []
    for name in ("describe", "facts_of"):
        plain = getattr(robots, name)
        monkeypatch.setattr(robots, name, lambda *given, plain=plain, name=name: looked.append(name) or plain(*given))
    text = "scenario: walk\nset: {robot: g1, sized_for: humanoid100}\ngrid: {gait.steps: [%s]}\n"
    counts = []
    for steps in ("4", "4, 5, 6, 7"):
        looked.clear()
        campaign(text % steps)
        counts.append(len(looked))
    assert counts[0] == counts[1] > 0
