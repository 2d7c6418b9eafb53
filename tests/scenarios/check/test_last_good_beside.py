"""A run beside the one before: pictures by one camera, and the channels that part first, by a cause that is known."""

from dataclasses import replace

import matplotlib.image
import numpy as np
import pytest
from needs import OPENGL

from surefoot.scenarios.check.beside import MOST_CHANNELS, SIZE, Beside, beside, parting_first
from surefoot.scenarios.check.check import cases, run_case
from surefoot.scenarios.check.pictures import Gallery
from surefoot.scenarios.log import read
from surefoot.scenarios.log.thinned import write_thinned
from surefoot.sim.gl import RenderingUnavailableError

pytestmark = pytest.mark.unit

STAND = """
gait: {steps: 0}
duration: 0.4
criteria: {fell: false}
"""


@pytest.fixture(scope="module")
def checked(tmp_path_factory):
    """A robot that stands, and one that is pushed from 0.2 s on."""
    folder = tmp_path_factory.mktemp("stand")
    (folder / "stand.yaml").write_text(STAND)
    pushed = cases([str(folder / "stand.yaml")], overrides=["pushes=[{time: 0.2, duration: 0.1, force: [120, 0, 0]}]"])
    return [run_case(case, folder / "runs") for case in (*cases([str(folder / "stand.yaml")]), *pushed)]


@pytest.fixture(scope="module")
def logs(checked, tmp_path_factory):
    """Thinned copies of both logs."""
    folder, found = tmp_path_factory.mktemp("logs"), []
    for number, one in enumerate(checked):
        write_thinned(read(one.log), folder / f"{number}.mcap", 25, frozenset(("/plan", "/timing", "/process")))
        found.append(read(folder / f"{number}.mcap"))
    return found


def test_a_thinned_copy_has_the_messages_of_the_log_at_its_rate(checked, logs):
    whole, thin = read(checked[0].log), logs[0]
    assert thin.size < 0.5 * whole.size
    time = thin["/truth"].time_ns
    assert np.all(np.diff(time) >= 40_000_000)
    rows = np.searchsorted(whole["/truth"].time_ns, time)
    for topic in ("/truth", "/wbc", "/torque"):
        for field in thin.fields(topic):
            kept, there = thin[topic].field(field.name), whole[topic].field(field.name)
            np.testing.assert_array_equal(kept, there[rows])
    assert (thin.metadata, thin.attachments) == (whole.metadata, whole.attachments)
    assert "/plan" not in thin and not thin.losses() and not thin.lacks()


def test_what_parts_first_begins_with_the_push_and_a_run_parts_from_itself_in_nothing(logs):
    found = parting_first(*logs)
    assert len(found) == MOST_CHANNELS
    assert all(one.tolerated.time >= 0.2 for one in found)
    assert found[0].topic in ("/measurement", "/truth")
    assert parting_first(logs[0], logs[0]) == []


@OPENGL.mark
def test_two_pictures_by_one_camera_differ_where_the_runs_do(checked, logs, tmp_path):
    partings = checked[0].now.trace.partings(checked[1].now.trace)
    found = beside(*logs, partings, tmp_path, "stand", "abc")
    assert found.note == "" and 0.2 < found.time <= 0.4
    pictures = [matplotlib.image.imread(tmp_path / name) for name in found.pictures]
    assert [one.shape[:2] for one in pictures] == [SIZE[::-1]] * 2
    apart = np.abs(pictures[0] - pictures[1]).max(axis=2) > 0.1
    assert 0.001 < apart.mean() < 0.3  # the ground is where it was
    same = beside(logs[0], logs[0], (), tmp_path, "same", "abc")
    np.testing.assert_array_equal(*(matplotlib.image.imread(tmp_path / name) for name in same.pictures))


def test_without_opengl_a_line_stands_in_their_place(logs, tmp_path):
    def refuse(*_, **__):
        raise RenderingUnavailableError("no off-screen OpenGL was found")

    found = beside(*logs, (), tmp_path, "stand", "abc", refuse)
    assert (found.pictures, found.note) == ((), "no pictures: no off-screen OpenGL was found")
    assert len(found.channels) == MOST_CHANNELS


def test_the_markdown_has_both_pictures_at_the_address_or_beside_it(checked, tmp_path):
    held = Beside("abcdef0123456789", 0.4, ("/truth com[0] at 0.240 s: 0 -> 1",), ("pictures/a.png", "pictures/b.png"))
    red = replace(checked[1], status="moved", beside=held)
    way = Gallery.of(tmp_path / "past", tmp_path / "reports" / "check.md", None)
    assert way.address == "../past"
    there = Gallery.of(tmp_path / "past", tmp_path / "check.md", "https://example.com/raw/")
    text = "\n".join(there.markdown(red))
    assert '<img src="https://example.com/raw/pictures/a.png" alt="stand before" width="360">' in text
    assert "last good: abcdef01" in text and "1. `/truth com[0]` at 0.240 s: 0 -> 1" in text
    assert there.markdown(replace(red, status="same")) == []
    assert Gallery().markdown(red) == []
