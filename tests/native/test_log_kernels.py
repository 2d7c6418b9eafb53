"""Rows of the log: what kernels put into messages against plain Python, beside each other on real walks."""

import numpy as np
import pytest

import surefoot
from surefoot.native.library import VARIABLE
from surefoot.scenarios.log import LogWriter, read
from surefoot.scenarios.log.rows import CompiledRows, RowWriter
from surefoot.scenarios.record.body import Recorder
from surefoot.scenarios.record.estimation import EstimationRecorder
from surefoot.scenarios.record.walk import WalkRecorder

pytestmark = pytest.mark.unit

PUSH = [{"time": 0.6, "duration": 0.1, "force": [200.0, 160.0, 0.0]}]


class Both:
    """Hands on what it is told to each of several recorders."""

    def __init__(self, *recorders):
        self._recorders = recorders

    def __getattr__(self, name):
        def tell(*given):
            for recorder in self._recorders:
                getattr(recorder, name)(*given)

        return tell


@pytest.mark.parametrize(
    ("name", "seconds", "overrides"),
    [
        ("walk-fast", 3.0, {}),
        ("walk", 1.6, {"pushes": PUSH}),
        ("walk", 1.0, {"robot": "talos"}),
        ("walk", 1.2, {"sensing.preset": "cheap"}),
    ],
    ids=["rolling", "pushed", "talos", "sensed"],
)
def test_messages_are_those_of_plain_python(kernels, tmp_path, monkeypatch, name, seconds, overrides):
    made = []
    monkeypatch.setattr(Recorder, "__init__", _noted(Recorder.__init__, made))
    monkeypatch.setattr(WalkRecorder, "__init__", _noted(WalkRecorder.__init__, made))
    monkeypatch.setattr(EstimationRecorder, "__init__", _noted(EstimationRecorder.__init__, made))
    with surefoot.Simulation(surefoot.load(name, overrides)) as simulation:
        loop = simulation._loop
        with LogWriter(tmp_path / "compiled.mcap", {}) as one, LogWriter(tmp_path / "plain.mcap", {}) as other:
            kinds = list(made)
            compiled = [kind(one, *given) for kind, given in kinds]
            monkeypatch.setenv(VARIABLE, "0")
            plain = [kind(other, *given) for kind, given in kinds]
            monkeypatch.delenv(VARIABLE)
            assert {type(rows) for rows in one._rows} == {CompiledRows}
            assert {type(rows) for rows in other._rows} == {RowWriter}
            for (kind, _), *pair in zip(kinds, compiled, plain, strict=True):
                owners = {loop.walker: "_sensed" if kind is EstimationRecorder else "_recorder"}
                if kind is WalkRecorder:
                    owners = {loop: "_recorder", loop.planning: "recorder"}
                for owner, attribute in owners.items():
                    monkeypatch.setattr(owner, attribute, Both(*pair))
            while simulation.time < seconds:
                simulation.advance()
    first, second = read(tmp_path / "compiled.mcap"), read(tmp_path / "plain.mcap")
    assert first.count("/truth") == second.count("/truth") > 400
    for topic in second.numeric:
        if topic == "/process":
            continue
        np.testing.assert_array_equal(first[topic].time_ns, second[topic].time_ns)
        for field in second[topic].fields:
            one, other = (log[topic].field(field.name) for log in (first, second))
            np.testing.assert_allclose(one, other, rtol=1e-11, atol=1e-11, err_msg=f"{topic} {field.name}")


def _noted(init, made):
    def noted(self, writer, *given):
        init(self, writer, *given)
        made.append((type(self), given))

    return noted
