"""The values that keys may have: ranges and units of numbers, and what names look like."""

from typing import Annotated

from pydantic import BeforeValidator, Field

from surefoot.scenarios.file.group import WHOLE, as_tuple
from surefoot.scenarios.file.units import METRE, RADIAN, SECOND, Unit

LONGEST_RUN = 86_400.0
"""Bound on the simulated time [s]."""

NonNegative = Annotated[float, Field(ge=0, le=1e9)]
Positive = Annotated[float, Field(gt=0, le=1e9)]
FootSize = Annotated[float, Field(ge=0.01, le=0.5), METRE]
Angle = Annotated[float, Field(ge=-6.3, le=6.3), RADIAN]
Tilt = Annotated[float, Field(ge=-0.1, le=0.1), RADIAN]
Place = Annotated[float, Field(ge=-1e6, le=1e6), METRE]
Length = Annotated[float, Field(ge=-1e3, le=1e3), METRE]
Size = Annotated[float, Field(gt=0, le=1e3), METRE]
Height = Annotated[float, Field(ge=0, le=1e3), METRE]
Support = Annotated[float, Field(gt=0, le=60), SECOND]
Span = Annotated[float, Field(gt=0, le=LONGEST_RUN), SECOND]
Instant = Annotated[float, Field(ge=0, le=LONGEST_RUN), SECOND]
Apex = Annotated[float, Field(gt=0, le=0.5), METRE]
Turns = Annotated[float, Field(ge=-1e3, le=1e3), RADIAN]
Velocity = Annotated[float, Field(ge=-10, le=10), Unit("m/s")]
YawRate = Annotated[float, Field(ge=-10, le=10), Unit("rad/s")]
Mass = Annotated[float, Field(ge=0, le=1000), Unit("kg")]
Noise = Annotated[float, Field(ge=0, le=0.1)]
NAME = r"^[A-Za-z0-9][A-Za-z0-9._-]*$"
Rate = Annotated[int, Field(ge=1, le=100_000), WHOLE, Unit("Hz")]
Newtons = Annotated[float, Field(ge=-1e6, le=1e6), Unit("N")]
Force = Annotated[tuple[Newtons, Newtons, Newtons], BeforeValidator(as_tuple)]
Offset = Annotated[float, Field(ge=-0.5, le=0.5), METRE]
Impulse = Annotated[float, Field(ge=0, le=100), Unit("N·s/kg")]
Requirement = Annotated[str, Field(min_length=1, max_length=100, pattern=NAME)]
Live = Annotated[bool, Field(description="given by hand while a run went on, so that it need not act for a pass")]
