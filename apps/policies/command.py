"""``surefoot policy``: the contract of a learned controller, begun from its network, and checked."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from surefoot.scenarios.show.options import MISSED, AsJson, Replace

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription
    from surefoot.scenarios.policy.check import Checked, Tried
    from surefoot.scenarios.policy.trial import Trial

app = typer.Typer(help="Write and check the contract of a learned controller.", no_args_is_help=True)

CHECKED_ON = "g1"
"""Robot of a policy that names none."""

_Robot = Annotated[str | None, typer.Option(help="Robot that it is for, over the one that its contract names.")]


@app.command()
def new(
    model: Annotated[Path, typer.Argument(help="The network, an ONNX file.")],
    out: Annotated[Path | None, typer.Option(help="File of the contract; contract.yaml beside the network.")] = None,
    robot: _Robot = None,
    force: Replace = False,
) -> None:
    """Begin the contract of a network: what its file tells, and comments for the rest."""
    from surefoot.errors import ParameterError
    from surefoot.scenarios.errors import ScenarioError
    from surefoot.scenarios.policy.derived import write

    place = out or model.with_name("contract.yaml")
    try:
        write(model, place, None if robot is None else _described(robot), force)
    except ParameterError as refusal:
        raise ScenarioError([str(refusal)]) from None
    typer.echo(f"{place}\nnext: complete the lines that say `to do`, and then: surefoot policy check {place}")


@app.command()
def check(
    policy: Annotated[Path, typer.Argument(metavar="FILE", help="Contract or folder of a policy.")],
    robot: _Robot = None,
    as_json: AsJson = False,
) -> None:
    """Stand and walk a policy as its contract says; name what is wrong with it.

    Where it does not walk, one thing after another is mended alone, and each tried.
    """
    from surefoot.errors import ParameterError
    from surefoot.scenarios.errors import ScenarioError
    from surefoot.scenarios.policy.check import check as check_contract
    from surefoot.scenarios.policy.files import named_robot, read
    from surefoot.scenarios.policy.network import Network

    try:
        on = _described(robot or named_robot(policy) or CHECKED_ON)
        files = read(policy, on.joint_names)
        Network(files.network)
        found = check_contract(files.contract, files.network, on, lambda _: None if as_json else _dot())
    except ParameterError as refusal:
        raise ScenarioError([str(refusal)]) from None
    if as_json:
        typer.echo(json.dumps(to_json(found), allow_nan=False))
    else:
        typer.echo("\n".join(lines(found)))
    raise typer.Exit(0 if found.given.sound else MISSED)


@app.command()
def schema() -> None:
    """Print the JSON Schema of contracts, for editors."""
    from surefoot.scenarios.policy.contract import schema as contract_schema

    typer.echo(json.dumps(contract_schema(), indent=2))


def _dot() -> None:
    typer.echo(".", nl=False, err=True)


def _described(name: str) -> "RobotDescription":
    """A robot by its name or file.

    Raises:
        ScenarioError: there is none, or it cannot be used.
    """
    from surefoot.errors import ParameterError
    from surefoot.scenarios.errors import ScenarioError
    from surefoot.scenarios.file.schema import RobotSettings
    from surefoot.scenarios.setup.robot.robots import describe

    try:
        return describe(name, RobotSettings())
    except (ParameterError, KeyError) as refusal:
        raise ScenarioError([str(refusal)]) from None


def lines(found: "Checked") -> list[str]:
    """The findings of a check, for a person."""
    said = ["", f"as given: {_line(found.given)}"]
    if found.asymmetry is not None:
        said.append(f"left and right are treated unlike by {100 * found.asymmetry:.0f} % (the network mirrored)")
    if found.given.sound:
        return [*said, "it walks: nothing is wrong with the contract that a walk would show"]
    if found.given.fault:
        said.append(f"it ended: {found.given.fault}")
    said.append("mended alone:")
    best: dict[str, Tried] = {}
    for one in found.tried:
        if one.fault.name not in best or one.trial.cost < best[one.fault.name].trial.cost:
            best[one.fault.name] = one
    said += [f"  {name}: {one.change}: {_line(one.trial)}" for name, one in best.items()]
    if found.cause is None:
        return [*said, "cause: none of these alone lets it walk; more than one thing may be wrong"]
    return [*said, f"cause: {found.cause.fault.name}; {found.cause.fault.sign} ({found.cause.change})"]


def _line(trial: "Trial") -> str:
    word = "walks" if trial.sound else f"up for {trial.stood:.2f} of {trial.lasted:.2f} s"
    if trial.astray < 1e6:
        word += f", velocity off by {100 * trial.astray:.0f} %"
    return f"{word}, targets change by {trial.jumped:.3f} rad a decision" if trial.jumped < 1e6 else word


def to_json(found: "Checked") -> dict[str, Any]:
    """The same as one JSON object."""
    cause = found.cause
    return {
        "walks": found.given.sound,
        "given": _numbers(found.given),
        "asymmetry": found.asymmetry,
        "cause": None if cause is None else {"fault": cause.fault.name, "mend": cause.change},
        "tried": [{"fault": one.fault.name, "mend": one.change, **_numbers(one.trial)} for one in found.tried],
    }


def _numbers(trial: "Trial") -> dict[str, Any]:
    values = {name: getattr(trial, name) for name in ("stood", "lasted", "astray", "leaned", "jumped")}
    finite = {name: value if abs(value) < 1e9 else None for name, value in values.items()}
    return {**finite, "sound": trial.sound, "fault": trial.fault}
