"""A tool, no test: it makes what the pages show, and a chart of any scene. Needs matplotlib.

    python tests/tool_pictures.py                                        all that is in .github/
    python tests/tool_pictures.py chart [EXAMPLE] [NAME=VALUE ...] FILE  a .png, .svg or .pdf

The moving picture is a terminal in which a film scrolls. The worksheet's source is
.github/worksheet.txt. Of it the tool makes a PDF of two pages.
"""

import subprocess
import sys
import textwrap
from pathlib import Path

from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure
from matplotlib.font_manager import findfont
from PIL import Image, ImageDraw, ImageFont

HERE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(HERE))

from airtrack import (  # noqa: E402
    METHODS,
    compared_by,
    make_parser,
    method_text,
    print_table,
    track_text,
    wanted_by,
)

PAGES = HERE / ".github"
COLUMNS, FRAMES, ROWS = 88, 120, 18  # as wide as a page has room for
COMMAND = f"python airtrack.py 17 m_to_px=36 width_px={COLUMNS}"
LINE_PX, LETTER_PX, EDGE_PX = 20, 10, 8
PAPER, GREY = (24, 24, 27), (190, 190, 196)
INK = {"0": (248, 113, 113), "o": (74, 222, 128), "*": (250, 204, 21)}

def screen(lines: list[str]) -> Image.Image:
    """The terminal when the last of the lines after the command has just been printed."""
    size = COLUMNS * LETTER_PX + 2 * EDGE_PX, ROWS * LINE_PX + 2 * EDGE_PX
    picture = Image.new("RGB", size, PAPER)
    draw = ImageDraw.Draw(picture)
    draw.fontmode = "1"  # no shades between ink and paper: few colours, and each frame the same
    font = ImageFont.truetype(findfont("DejaVu Sans Mono:bold"), 16)
    for row, line in enumerate([f"$ {COMMAND}", "", *lines][-ROWS:]):
        for column, letter in enumerate(line):
            colour = GREY if line.startswith("$") else INK.get(letter, GREY)
            draw.text((EDGE_PX + column * LETTER_PX, EDGE_PX + row * LINE_PX), letter, colour, font)
    return picture

def moving_picture(file: Path) -> None:
    words = [*COMMAND.split()[1:], "--fast", "--frames", str(FRAMES)]
    out = subprocess.run([sys.executable, *words], text=True, check=True, cwd=HERE,
                         capture_output=True).stdout
    lines = out.partition("\n\n")[2].splitlines()[:FRAMES]
    frames = [screen(lines[:n]).quantize(9) for n in range(ROWS - 2, FRAMES + 1)]
    frames[0].save(file, save_all=True, append_images=frames[1:], loop=0,
                   duration=[100] * (len(frames) - 1) + [2000], optimize=False)

def chart(words: list[str], file: Path) -> None:
    """Measure as the program's chart does, and draw the points on two logarithmic scales."""
    wanted = wanted_by(make_parser().parse_args(["chart", *words]), [])
    scene = compared_by(wanted)
    figure = Figure(figsize=(8, 6), dpi=150, layout="constrained")
    heading = f"Example {wanted.number}: {track_text(scene)}"
    figure.suptitle(f"Speed against accuracy\n{textwrap.fill(heading, 110)}", fontsize=9)
    axes = figure.add_subplot(
        xscale="log", yscale="log", xlabel="largest error in ten runs (m): better to the left",
        ylabel="time for a simulated second (\N{MICRO SIGN}s): better upwards")
    axes.invert_yaxis()
    axes.margins(x=0.08)  # room for the labels
    points = print_table(scene)
    # An error of 0 has no place on a logarithmic scale. So it is drawn at the left edge.
    left_m = max(1e-17, min(point.error_m for point in points["d"]) / 30)
    for (letter, series), marker in zip(points.items(), "oxD+v", strict=True):
        errors_m = [max(point.error_m, left_m) for point in series]
        costs_us = [point.cost_us for point in series]
        label = f"{letter}: {method_text(*METHODS[letter])}"
        axes.plot(errors_m, costs_us, f"{marker}-", label=label)
        if letter in "bd":  # the rates, once on either side
            for point, error_m in zip(series, errors_m, strict=True):
                axes.annotate(f"  {point.fps}", (error_m, point.cost_us), fontsize=7)
    axes.text(left_m, min(point.cost_us for point in points["e"]) / 1.3, "e has no error",
              fontsize=8, horizontalalignment="left")
    axes.axvline(1 / scene.m_to_px, color="black", linestyle="--", label="a column of the film")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, -0.28), ncols=3, fontsize=8)
    figure.savefig(file)

A4_INCHES = 8.27, 11.69

def worksheet(file: Path) -> None:
    """The worksheet as two pages of A4. A form feed parts the pages of its source."""
    text = (PAGES / "worksheet.txt").read_text(encoding="utf-8")
    with PdfPages(file, metadata={"CreationDate": None}) as pages:
        for page in text.split("\f"):
            figure = Figure(figsize=A4_INCHES)
            figure.text(0.11, 0.95, page, family="DejaVu Sans Mono", fontsize=9, linespacing=1.2,
                        verticalalignment="top")
            pages.savefig(figure)

def main(words: list[str]) -> None:
    if words:
        chart(words[1:-1], Path(words[-1]))
        return
    moving_picture(PAGES / "example-17.gif")
    chart([], PAGES / "chart.png")
    worksheet(PAGES / "worksheet.pdf")

if __name__ == "__main__":
    main(sys.argv[1:])
