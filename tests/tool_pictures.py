"""A tool, no test: it makes the pictures and the worksheet's pages in .github/. Needs matplotlib.

    python tests/tool_pictures.py

The moving pictures are terminals in which a film scrolls. The worksheet's source is
.github/worksheet.txt. Of it the tool makes a PDF of two pages.
"""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure
from matplotlib.font_manager import findfont
from PIL import Image, ImageDraw, ImageFont

HERE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(HERE))

from airtrack import CHART_FPS, METHODS, Point, measured, scene_of  # noqa: E402
from examples import EXAMPLES  # noqa: E402

PAGES = HERE / ".github"
FILMS = {  # as wide as a page has room for: command, frames, and how many rows the terminal has
    "example-10.gif": ("python3 airtrack.py 10 d m_to_px=25 width_px=57", 79, 18),
    "example-17.gif": ("python3 airtrack.py 17 m_to_px=36 width_px=88", 120, 18),
}
LINE_PX, LETTER_PX, EDGE_PX = 20, 10, 8
PAPER, GREY = (24, 24, 27), (190, 190, 196)
INK = {"0": (248, 113, 113), "o": (74, 222, 128)}

def screen(lines: list[str], columns: int, picture_px: int, rows: int) -> Image.Image:
    """The terminal when the last of the lines has just been printed. The marks are coloured."""
    size = columns * LETTER_PX + 2 * EDGE_PX, rows * LINE_PX + 2 * EDGE_PX
    picture = Image.new("RGB", size, PAPER)
    draw = ImageDraw.Draw(picture)
    draw.fontmode = "1"  # no shades between ink and paper: few colours, and each frame the same
    font = ImageFont.truetype(findfont("DejaVu Sans Mono:bold"), 16)
    for row, line in enumerate(lines[-rows:]):
        for column, letter in enumerate(line):
            colour = GREY
            if column < picture_px and not line.startswith("$"):
                colour = INK.get(letter, GREY)
            draw.text((EDGE_PX + column * LETTER_PX, EDGE_PX + row * LINE_PX), letter, colour, font)
    return picture

def moving_picture(file: Path, command: str, count: int, rows: int) -> None:
    words = [*command.split()[1:], "--fast", "--frames", str(count)]
    out = subprocess.run([sys.executable, *words], text=True, check=True, cwd=HERE,
                         capture_output=True).stdout
    lines = [f"$ {command}", "", *out.partition("\n\n")[2].splitlines()[:count]]
    width_px = int(command.partition("width_px=")[2])
    columns = max([len(line) for line in lines])
    frames = [screen(lines[:n], columns, width_px, rows).quantize(9)
              for n in range(rows, len(lines) + 1)]
    frames[0].save(file, save_all=True, append_images=frames[1:], loop=0,
                   duration=[100] * (len(frames) - 1) + [2000], optimize=False)

def chart(number: int, file: Path) -> None:
    """Measure as the program's chart does, and draw the points on two logarithmic scales."""
    scene = scene_of(EXAMPLES[number].settings)
    figure = Figure(figsize=(8, 6), dpi=150, layout="constrained")
    figure.suptitle(f"Speed against accuracy: example {number}", fontsize=9)
    axes = figure.add_subplot(
        xscale="log", yscale="log", xlabel="largest error in ten runs (m): better to the left",
        ylabel="time for a simulated second (\N{MICRO SIGN}s): better upwards")
    axes.invert_yaxis()
    axes.margins(x=0.08)  # room for the labels
    series: dict[str, list[Point]] = {letter: [] for letter in METHODS}
    for fps in CHART_FPS:
        for point in measured(replace(scene, fps_target=fps)):
            series[point.letter].append(point)
    # An error of 0 has no place on a logarithmic scale. So e is drawn at the left edge.
    left_m = max(1e-17, min([point.error_m for point in series["d"]]) / 30)
    for letter, marker in zip(METHODS, "oxD+v", strict=True):
        points = series[letter]
        errors_m = [max(point.error_m, left_m) for point in points]
        costs_us = [point.cost_us for point in points]
        name = " + ".join(METHODS[letter])
        axes.plot(errors_m, costs_us, f"{marker}-", label=f"{letter}: {name}")
        on_the_left = letter in "ac"
        for point, error_m in zip(points, errors_m, strict=True):  # the rates
            axes.annotate(f"{point.fps}  " if on_the_left else f"  {point.fps}",
                          (error_m, point.cost_us), fontsize=6,
                          horizontalalignment="right" if on_the_left else "left")
        print(letter, *[f"{point.fps}: {point.cost_us:.3g} us, {1000 * point.error_m:.2g} mm;"
                        for point in points])
    above_us = 0.8 * series["e"][0].cost_us
    axes.text(left_m, above_us, "e: no error,\nby definition", fontsize=8)
    axes.axvline(scene.column_m(), color="black", linestyle="--", label="a column of the film")
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

def main() -> None:
    for name, (command, count, rows) in FILMS.items():
        moving_picture(PAGES / name, command, count, rows)
    chart(12, PAGES / "chart.png")
    worksheet(PAGES / "worksheet.pdf")

if __name__ == "__main__":
    main()
