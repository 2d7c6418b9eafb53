"""Outcomes with chosen metrics, for the rules and tables of the page."""

from surefoot.studies.paper.results import ExperimentResult, Results
from surefoot.studies.paper.studies import Experiment

SOUND = {
    "fell": False,
    "fall_time": None,
    "steps_taken": 5,
    "steps_planned": 5,
    "zmp_inside_fraction": 1.0,
    "zmp_excursion_max": -0.01,
    "zmp_error_rms": [0.003, 0.004],
    "zmp_error_max": [0.01, 0.02],
    "planner_infeasible_fraction": 0.0,
    "planner_time": {"median": 0.001, "p99": 0.002},
    "speed_mean": 0.1,
    "knee_angle_mean": 0.3,
    "knee_torque_rms": 50.0,
    "cost_of_transport": 0.4,
    "torque_ratio_max": 0.5,
}
FALL = {"fell": True, "fall_time": 5.0, "zmp_excursion_max": 0.08}


def outcome(study, profile="default", world="pendulum", seed=0, failure="", **metrics):
    found = {} if failure else {**SOUND, **metrics}
    return ExperimentResult(Experiment(study, profile, world, seed), None, found, failure)


def results(*outcomes):
    return Results(tuple(outcomes))
