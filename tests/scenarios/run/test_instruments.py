"""Instruments: read from the truth at their own pace, with faults in time; the run is the same with them as without."""

import math

import numpy as np
import pytest

import surefoot
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.registries import INSTRUMENTS
from surefoot.scenarios.file.schema import InstrumentSettings, RobotSettings
from surefoot.scenarios.log import FieldSpec, read
from surefoot.scenarios.run.altimeter import ALTIMETER, AltimeterSettings
from surefoot.scenarios.run.instruments import Instrument
from surefoot.scenarios.setup.groups.instruments import Pace
from surefoot.scenarios.setup.load import Written, for_robot
from surefoot.scenarios.setup.robot.robots import Robots
from surefoot.scenarios.show.differences import WALL_CLOCK
from surefoot.sim.measurement import Measurement

pytestmark = pytest.mark.unit

NOISY = {"name": "altimeter", "period": "6 ms", "noise": "1 mm", "bias": "1 cm"}
FAULTS = [
    {"kind": "freeze", "time": 0.05, "duration": 0.04},
    {"kind": "jump", "time": 0.08, "duration": 0.07, "size": "50 cm"},
    {"kind": "drop", "time": 0.2, "duration": 0.05},
]
BRIEF = {"duration": 0.3, "criteria": {"fell": False}}


def ran(folder, *instruments, **more):
    return read(
        surefoot.run(surefoot.load("walk-level", {**BRIEF, "instruments": [*instruments], **more}), out=folder).log
    )


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """A run without instruments, one with, and one in which they fail in time."""
    folder = tmp_path_factory.mktemp("instruments")
    plain = {"name": "altimeter", "label": "plain"}
    return (
        ran(folder / "none"),
        ran(folder / "sound", NOISY, plain),
        ran(folder / "faulty", plain, {**NOISY, "faults": FAULTS}),
    )


def content(log):
    """Bytes of every field by topic; numbers of channels depend on which there are."""
    topics = [topic for topic in log.numeric if topic not in WALL_CLOCK]
    return {topic: [log[topic].field(one.name).tobytes() for one in log.fields(topic)] for topic in topics}


def test_a_run_is_the_same_to_the_bit_with_instruments_as_without(logs):
    without, sound, faulty = map(content, logs)
    assert set(sound) - set(without) == {"/instrument/altimeter", "/instrument/plain"}
    for log in (sound, faulty):
        assert {topic: log[topic] for topic in without} == without


def test_one_without_errors_says_the_truth_at_every_tick(logs):
    found, truth = logs[1]["/instrument/plain"], logs[1]["/truth"]
    assert found.time_ns.tolist() == truth.time_ns.tolist()
    assert found.field("height").tolist() == truth.field("q")[:, 2].tolist()


def test_faults_act_on_readings_in_time_and_move_nothing_else(logs):
    """Neither what is said before and after, nor what another instrument says, nor by its place in the list."""
    sound, faulty = (log["/instrument/altimeter"] for log in logs[1:])
    assert np.diff(sound.time_ns).tolist() == [6_000_000] * (len(sound.time_ns) - 1)
    time, said = sound.time_ns / 1e9, sound.field("height")
    frozen, jumped, dropped = ((time >= f["time"]) & (time < f["time"] + f["duration"] - 1e-9) for f in FAULTS)
    expected = said + 0.5 * jumped
    expected[frozen] = said[np.flatnonzero(frozen)[0] - 1]
    assert faulty.time_ns.tolist() == sound.time_ns[~dropped].tolist()
    np.testing.assert_array_equal(faulty.field("height"), expected[~dropped])
    assert min(frozen.sum(), (jumped & ~frozen).sum(), dropped.sum()) >= 6
    assert content(logs[1])["/instrument/plain"] == content(logs[2])["/instrument/plain"]


def test_its_log_runs_again_to_the_bit(logs, tmp_path):
    again = read(surefoot.run(surefoot.load(str(logs[2].path)), out=tmp_path).log)
    assert content(again) == content(logs[2])


def test_its_random_numbers_follow_from_the_seed_and_the_label(logs, tmp_path):
    """Two of a kind err apart from each other."""
    twice = ran(tmp_path / "twice", NOISY, {**NOISY, "label": "second"})
    other = ran(tmp_path / "other", NOISY, seed=5)
    first, second = (twice[f"/instrument/{label}"].field("height") for label in ("altimeter", "second"))
    assert first.tolist() == logs[1]["/instrument/altimeter"].field("height").tolist()
    truth, others = (log["/truth"].field("q")[::3, 2] for log in (twice, other))
    errors = np.array([first - truth, second - truth, other["/instrument/altimeter"].field("height") - others])
    assert (np.abs(np.diff(errors, axis=0)).max(axis=1) > 1e-3).all()
    assert (errors.std(axis=1) < 2e-3).all()


def measured(height):
    q = np.zeros(8)
    q[2] = height
    return Measurement.of_state(0.0, q, np.zeros(7))


def test_noise_and_bias_of_the_altimeter_are_standard_deviations():
    """The noise is white, the bias is drawn once."""

    def errors(seed, count, **keys):
        begun = ALTIMETER.begin(None, AltimeterSettings(name="altimeter", **keys), np.random.default_rng(seed))
        return np.array([begun(measured(2.0))[0] - 2.0 for _ in range(count)])

    noisy = errors(1, 20_000, noise=0.05)
    assert noisy.std() == pytest.approx(0.05, rel=0.03) and abs(noisy.mean()) < 2e-3
    assert abs(np.corrcoef(noisy[1:], noisy[:-1])[0, 1]) < 0.03
    biases = np.array([errors(seed, 2, bias=0.05) for seed in range(2000)])
    assert np.ptp(biases, axis=1).max() < 1e-12
    assert biases[:, 0].std() == pytest.approx(0.05, rel=0.06)
    assert errors(1, 5).tolist() == [0.0] * 5


@pytest.mark.parametrize("period", [None, 0.002, 0.003, 0.005, 0.02, 1 / 30, 0.0177, 0.25])
def test_a_reading_is_made_at_the_first_tick_that_is_not_before_a_multiple_of_the_period(period):
    pace, rate = Pace.of(period, 500), 500
    due, made = 0, []
    for tick in range(1000):
        if tick >= due:
            made.append(tick)
            due = pace.first(tick + 1)
    every = 1 / rate if period is None else period
    wanted = [math.ceil(number * every * rate - 1e-6) for number in range(int(2.0 / every) + 2)]
    assert made == [tick for tick in wanted if tick < 1000]
    assert [pace.first(tick) for tick in range(900)] == [min(w for w in wanted if w >= tick) for tick in range(900)]


FAULT = {"kind": "jump", "time": 0.1, "size": 0.1}
REFUSED = {
    "instruments.0.noise is '3 s', a time; give a length": {"noise": "3 s"},
    "instruments.0.noise is -0.1; it must be at least 0.0 m": {"noise": -0.1},
    "unknown key 'nois'; did you mean 'noise'?": {"nois": 0.1},
    "instruments.0.name is 'altimetr'; it must be 'altimeter'": {"name": "altimetr"},
    "instruments.0.label is 'a b'; use letters, digits": {"label": "a b"},
    "instruments.0.period 0.001 s is less than a control tick; use at least 0.002 s": {"period": "1 ms"},
    "instruments.0.noise 1e-30 is too small to change anything": {"noise": 1e-30},
    "instruments.0.faults.0.kind is 'stuck'; it must be 'freeze', 'drop' or 'jump'": {"faults": [{"kind": "stuck"}]},
    "unknown key 'siz'; did you mean 'size'?": {"faults": [{"kind": "jump", "siz": 1}]},
    "instruments.0.faults.0.size is '1 s', a time; give a length": {"faults": [{**FAULT, "size": "1 s"}]},
    "instruments.0.faults.0 is a jump without a size; give its size": {"faults": [{"kind": "jump"}]},
    "instruments.0.faults.0 is a drop with a size; leave it out": {"faults": [{"kind": "drop", "size": 1.0}]},
    "instruments.0.faults.0.size 0 is no jump": {"faults": [{**FAULT, "size": 0}]},
    "instruments.0.faults.1 acts on no reading": {"faults": [FAULT, {**FAULT, "time": 0.4}]},
    "instruments.0.faults.0 acts on no reading": {"period": 0.25, "faults": [{**FAULT, "duration": 0.1}]},
    "instruments.0.faults.0 would last until 0.6 s, and the end of the run at 0.3 s cuts it off; give it at most 0.2": {
        "faults": [{**FAULT, "duration": 0.5}]
    },
}


@pytest.mark.parametrize("sentence", REFUSED)
def test_what_cannot_be_or_does_nothing_is_refused_in_a_sentence(sentence):
    with pytest.raises(ScenarioError) as refused:
        surefoot.load("walk-level", {**BRIEF, "instruments": [{"name": "altimeter", **REFUSED[sentence]}]})
    assert len([problem for problem in refused.value.problems if sentence in problem]) == 1, refused.value.problems


def test_two_of_one_label_are_refused():
    with pytest.raises(
        ScenarioError, match=r"instruments.1 has the channel /instrument/altimeter, as instruments.0 has"
    ):
        surefoot.load("walk-level", {**BRIEF, "instruments": [NOISY, NOISY]})


def test_a_fault_that_would_do_nothing_but_for_its_first_reading_is_refused():
    """An instrument that freezes before it has said anything says its first reading for ever after."""
    with pytest.raises(ScenarioError, match="acts on no reading"):
        surefoot.load(
            "walk-level", {**BRIEF, "instruments": [{**NOISY, "faults": [{"kind": "freeze", "duration": 0.004}]}]}
        )


def test_lengths_of_its_keys_grow_with_the_robot():
    length, time = (getattr(Robots().facts("g1", RobotSettings()).size, name) for name in ("length", "time"))
    one = {"name": "altimeter", "noise": "10 mm", "period": 0.02, "faults": [{"kind": "jump", "size": 1}]}
    written = Written("instruments: []\n", "f.yaml", "f")
    (found,) = for_robot(written, {"instruments": [one]}, "humanoid100", "g1", Robots())["instruments"]
    assert found["noise"] == pytest.approx(0.01 * length)
    assert found["period"] == pytest.approx(0.02 * time)
    assert found["faults"][0]["size"] == pytest.approx(length)


def test_on_a_pendulum_a_note_says_that_they_have_no_effect(tmp_path):
    scenario = surefoot.load("walk-level", {**BRIEF, "fidelity": "pendulum", "instruments": [NOISY]})
    result = surefoot.run(scenario, out=tmp_path)
    assert "instruments has no effect on a pendulum" in result.verdict.notes
    assert "/instrument/altimeter" not in read(result.log).topics


class Bad(Instrument):
    """One that begins and reads as it is told to."""

    name = "bad"
    settings = InstrumentSettings

    def __init__(self, begun):
        self.begun = begun

    def fields(self, walk):
        return FieldSpec("pair", (2,), "m"), FieldSpec("count", (), "-", kind="int")

    def begin(self, walk, keys, rng):
        return self.begun


@pytest.fixture
def bad():
    yield lambda begun: INSTRUMENTS.add("bad", Bad(begun))
    INSTRUMENTS.discard("bad")


@pytest.mark.parametrize(
    ("begun", "words"),
    [
        (lambda measurement: 1 / 0, "ZeroDivisionError: division by zero"),
        (lambda measurement: (np.zeros(2),), "which is no list of 2 values, one of each field"),
        (lambda measurement: (np.zeros(3), 0), r"gave pair of shape (3,), which should be (2,)"),
        (None, "begins with None, which is no function of a measurement"),
    ],
)
def test_one_of_others_that_fails_ends_the_run_as_a_fault_that_names_it(bad, begun, words, tmp_path):
    bad(begun)
    scenario = surefoot.load("walk-level", {**BRIEF, "instruments": [{"name": "bad"}]})
    try:
        result = surefoot.run(scenario, out=tmp_path)
    except surefoot.PartError as refusal:  # as it is made
        reason = str(refusal)
    else:
        assert not result.verdict.passed
        reason = "\n".join(result.verdict.reasons)
    assert "instrument 'bad' of this program" in reason and words in reason


def test_one_may_read_vectors_and_whole_numbers_and_say_that_it_knows_nothing(bad, tmp_path):
    """Its arrays may be those of the measurement, which the next tick overwrites; a frozen one says copies."""
    bad(lambda measurement: (measurement.q[1:3] if measurement.time > 0.1 else [np.nan, np.nan], 3))
    log = ran(
        tmp_path, {"name": "bad", "faults": [{"kind": "freeze", "time": 0.2}, {"kind": "jump", "time": 0.2, "size": 2}]}
    )
    found, truth = log["/instrument/bad"], log["/truth"].field("q")[:, 1:3]
    assert np.isnan(found.field("pair")[:51]).all()
    np.testing.assert_array_equal(found.field("pair")[51:100], truth[51:100])
    assert {tuple(pair) for pair in found.field("pair")[100:]} == {tuple(truth[99])}
    assert found.field("count").tolist() == [3] * 150


class Listed(Instrument):
    """One that keeps what it says, with random numbers."""

    name = "listed"

    def __init__(self):
        self.said = []

    def fields(self, walk):
        return (FieldSpec("number"),)

    def begin(self, walk, keys, rng):
        def read(measurement):
            self.said.append((measurement.time, rng.random()))
            return (self.said[-1][1],)

        return read


def test_a_saved_simulation_goes_on_with_the_same_readings():
    listed = INSTRUMENTS.add("listed", Listed())
    try:
        instruments = [{"name": "listed", "period": "14 ms"}]
        with surefoot.Simulation(surefoot.load("walk-level", {**BRIEF, "instruments": instruments})) as sim:
            for _ in range(20):
                sim.step()
            state = sim.save()
            for _ in range(30):
                sim.step()
            once = list(listed.said)
            sim.restore(state)
            for _ in range(30):
                sim.step()
            assert len(listed.said) == 8 and len({number for _, number in once}) == 8
            assert listed.said == once
    finally:
        INSTRUMENTS.discard("listed")
