"""An altimeter: the height of the base over the world's zero."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surefoot.scenarios.file.group import Many, key
from surefoot.scenarios.file.schema import InstrumentFault, InstrumentSettings
from surefoot.scenarios.file.units import METRE
from surefoot.scenarios.file.values import Length
from surefoot.scenarios.log import FieldSpec
from surefoot.scenarios.run.instruments import Instrument, Read
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Measurement

_Deviation = Annotated[float, Field(ge=0, le=1e3), METRE]


class HeightFault(InstrumentFault):
    """A fault of an altimeter."""

    size: Length | None = key(None, "of a jump")


class AltimeterSettings(InstrumentSettings):
    """An altimeter; noise and bias are standard deviations."""

    noise: _Deviation = key(0.0, "of each reading, white")
    bias: _Deviation = key(0.0, "of its bias, drawn once and constant in a run")
    faults: Many[HeightFault] = key((), "faults of its readings, in time")


class Altimeter(Instrument):
    """The height of the base over the world's zero."""

    name = "altimeter"
    doc = "Height that an altimeter in the base says, whenever it is read; only of a run that has one."
    settings = AltimeterSettings

    def fields(self, walk: Walk) -> tuple[FieldSpec, ...]:
        """See `Instrument`."""
        return (FieldSpec("height", (), "m", "world", "of the base over the world's zero"),)

    def begin(self, walk: Walk, keys: AltimeterSettings, rng: np.random.Generator) -> Read:
        """See `Instrument`."""
        bias = keys.bias * float(rng.standard_normal())

        def read(measurement: Measurement) -> tuple[float]:
            return (measurement.q.item(2) + bias + keys.noise * float(rng.standard_normal()),)

        return read


ALTIMETER = Altimeter()
