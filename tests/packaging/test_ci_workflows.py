"""`surefoot new --ci` writes workflows whose steps do what they say, in a clone with a server's environment alone."""

import sys
from pathlib import Path

import pytest
import yaml
from workflows import Origin

from surefoot.apps.package.ci import WORKFLOWS, add_ci
from surefoot.scenarios.errors import ScenarioError

PENDULUM = """
fidelity: pendulum
gait: {steps: 2, step_length: 0.2, single_support: 0.5, double_support: 0.1, initial_stand: 0.2}
duration: 2.2
rates: {control: 100}
criteria: {fell: false}
requirements: [REQ-1]
"""


@pytest.fixture
def origin(tmp_path):
    """A server's repository in which nothing is."""
    return Origin(tmp_path / "server", Path(sys.executable).parent)


def begin(origin, kind):
    """The first commit: a workflow, a scenario and its baseline."""
    (origin.work / "walks").mkdir()
    (origin.work / "walks" / "first-walk.yaml").write_text(PENDULUM)
    origin.surefoot("new", "--ci", kind)
    origin.surefoot("check", "walks", "--update")
    (origin.work / ".gitignore").write_text("runs/\n")
    origin.commit("First walk")


def longer(origin):
    """A pull request that changes the walk."""
    walk = origin.work / "walks" / "first-walk.yaml"
    walk.write_text(walk.read_text().replace("step_length: 0.2", "step_length: 0.25"))
    origin.commit("Longer steps", "change")


@pytest.mark.unit
def test_githubs_is_green_keeps_the_history_and_is_red_in_a_pull_request_that_moves_the_walk(origin):
    begin(origin, "github")
    job, place = origin.github("push")
    assert not job.failed, job.output
    assert "first-walk: same" in job.output
    history = origin.files("surefoot-history")
    assert {name.partition("/")[0] for name in history} == {"checks", "logs", "runs"}
    assert "surefoot check: 1 scenario: 1 same" in (place / "summary.md").read_text()
    assert "| REQ-1 | ✅ pass | first-walk (same) |" in (place / "summary.md").read_text()
    assert (place / "history.html").stat().st_size > 1000
    assert "pip install -c walks/constraints.txt surefoot==" in "\n".join(origin.called())

    longer(origin)
    job, place = origin.github("pull_request", "change")
    assert job.failed
    assert [name for name, code in job.steps.items() if code] == ["Check"]
    summary = (place / "summary.md").read_text()
    assert "gait.step_length is 0.25, the default in the baseline" in summary
    assert "Channels that part first" in summary and "`/footsteps next" in summary
    assert "::error file=walks/first-walk.yaml," in job.output
    assert origin.called()[-1] == "gh pr comment 7 --body-file check.md --edit-last --create-if-none"
    assert origin.files("surefoot-history") == history  # of a pull request only pictures are kept

    (origin.work / "README.md").write_text("Walks.\n")
    origin.git("checkout", "-q", "HEAD~1", "--", "walks")
    origin.commit("Words")
    assert not origin.github("push")[0].failed
    assert len([name for name in origin.files("surefoot-history") if name.startswith("checks/")]) == 2


@pytest.mark.unit
def test_gitlabs_is_green_keeps_the_history_and_is_red_in_a_merge_request_that_moves_the_walk(origin):
    begin(origin, "gitlab")
    job, place = origin.gitlab()
    assert not job.failed, job.output
    assert job.steps == {"script": 0, "after_script": 0}, job.output
    assert {name.partition("/")[0] for name in origin.files("surefoot-history")} == {"checks", "logs", "runs"}
    longer(origin)
    job, place = origin.gitlab("change", SUREFOOT_TOKEN="token")
    assert job.failed and job.steps["after_script"] == 0, job.output
    assert "first-walk: other scenario" in job.output
    assert (place / "check.xml").exists() and (place / "history.html").exists()
    assert origin.called()[-1].endswith(
        "--form body=<../check.md https://gitlab.com/api/v4/projects/9/merge_requests/3/notes"
    )


@pytest.mark.unit
@pytest.mark.parametrize("kind", WORKFLOWS)
def test_nothing_is_written_over_and_versions_are_those_of_here(kind, tmp_path):
    written = add_ci(kind, tmp_path)
    assert [path.name for path in written] == [Path(WORKFLOWS[kind]).name, "constraints.txt", "first-walk.yaml"]
    assert all(
        "@" not in path.read_text().replace("@v", "").replace("@localhost", "").replace("@$CI", "") for path in written
    )
    import numpy

    assert f"numpy=={numpy.__version__}\n" in written[1].read_text()
    with pytest.raises(ScenarioError, match="is there already; remove it"):
        add_ci(kind, tmp_path)
    written[0].unlink()
    written[1].write_text("mine")
    assert add_ci(kind, tmp_path) == (written[0],)
    assert written[1].read_text() == "mine"


@pytest.mark.unit
def test_a_package_gets_one_too(at_hand, tmp_path):
    answer = at_hand("new", "ski-jump", "--ci", "github", "--out", str(tmp_path))
    assert (answer.code, answer.err) == (0, "")
    text = (tmp_path / "ski-jump" / ".github" / "workflows" / "walks.yml").read_text()
    assert yaml.safe_load(text)["env"]["SUREFOOT"] == "-e ."
    assert answer.out.splitlines()[-1].endswith("&& surefoot check walks --update && git add --all")
    assert at_hand("new").code == 2
