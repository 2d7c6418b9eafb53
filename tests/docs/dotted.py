"""Names of code that a page of the documentation gives."""

import importlib


def named(name):
    """The thing that a dotted name below surefoot leads to: a module, or something in one; None when there is none."""
    module, parts = "surefoot", name.removeprefix("surefoot.").split(".")
    while parts:
        try:
            importlib.import_module(f"{module}.{parts[0]}")
        except ModuleNotFoundError:
            break
        module = f"{module}.{parts.pop(0)}"
    thing = importlib.import_module(module)
    for part in parts:
        thing = getattr(thing, part, None)
    return thing
