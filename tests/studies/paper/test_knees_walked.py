"""The paper's claims on knees, judged on walks in full physics."""

import pytest
from paper_samples import outcome, results

import surefoot
from surefoot.studies.paper.claims import claims
from surefoot.studies.paper.studies import GAITS, KNEES, Experiment, knee_study

pytestmark = pytest.mark.physics


def walked(gait, knee):
    experiment = Experiment(knee_study(gait, knee), "default", "full")
    return surefoot.run(surefoot.load("walk-level", experiment.overrides)).verdict.metrics


def test_stretched_knees_spare_torque_and_energy_at_the_same_speed_with_the_same_feet():
    found = {(gait, knee): walked(gait, knee) for gait in GAITS for knee in KNEES}
    outcomes = [outcome(knee_study(*pair), "default", "full", **metrics) for pair, metrics in found.items()]
    verdicts = {claim.name: claim.judge(results(*outcomes)).verdict for claim in claims()}
    assert verdicts["claim-stretched"] == verdicts["claim-torque"] == verdicts["claim-energy"] == "holds"
    for gait in GAITS:
        stretched, bent = (found[gait, knee] for knee in ("stretched", "bent"))
        assert stretched["heel_strike_pitch"] > 0.1 < bent["heel_strike_pitch"]
        assert stretched["knee_torque_rms"] < 0.6 * bent["knee_torque_rms"]
