"""What previewing the changing dynamics is worth: ZMP error over riser height, profile by profile."""

from matplotlib.figure import Figure

from scenarios.paper.results import Results
from scenarios.paper.studies import STAIRS, WALK
from scenarios.paper.tables import error_norms
from scenarios.report.figures.style import BLUE, GREEN, PURPLE, VERMILLION, canvas, in_style

RISERS = (0.0, 0.10, 0.15, 0.18)
_SHOWN = {"lti": VERMILLION, "preview": PURPLE, "repaired": GREEN, "default": BLUE}


def preview_chart(results: Results) -> Figure:
    """Draw it; a profile without results has no line."""
    with in_style():
        figure, (area,) = canvas(7.0, (2.8,))
        axes = area.subplots()
        for profile, color in _SHOWN.items():
            rows = [(riser, error_norms(results.sample(study, profile, "pendulum")))
                    for riser, study in zip(RISERS, (WALK, *STAIRS), strict=True)]  # fmt: skip
            drawn = [(riser, sorted(values)) for riser, values in rows if values]
            x = [riser for riser, _ in drawn]
            middle = [1e3 * values[len(values) // 2] for _, values in drawn]
            low = [m - 1e3 * values[0] for m, (_, values) in zip(middle, drawn, strict=True)]
            high = [1e3 * values[-1] - m for m, (_, values) in zip(middle, drawn, strict=True)]
            axes.errorbar(x, middle, (low, high), color=color, label=profile, marker="o", markersize=3.5, capsize=2)
        axes.set_xlabel("riser height [m]; 0: flat ground")
        axes.set_ylabel("ZMP error RMS, norm of x and y [mm]")
        axes.set_xlim(-0.01, 0.19)
        axes.set_ylim(bottom=0.0)
        axes.legend(loc="upper left")
    return figure
