"""Makes the pages' pictures, and a chart of any scene. Needs matplotlib, of the test extra.

    python tests/make_pictures.py                                        those in .github/
    python tests/make_pictures.py sheet                                  prints the worksheet
    python tests/make_pictures.py chart [EXAMPLE] [NAME=VALUE ...] FILE  a .png, .svg or .pdf

The moving picture is a terminal in which a film scrolls. The worksheet is example 8 on one page of
A4, without the answer, and the tasks on a second page. It is kept in .github/worksheet.txt.
"""

import subprocess
import sys
import textwrap
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.font_manager import findfont
from PIL import Image, ImageDraw, ImageFont

HERE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(HERE))

from airtrack import (  # noqa: E402
    METHODS,
    make_parser,
    measure,
    method_text,
    read_command_line,
    render_track,
    scene_of,
    scene_wanted,
    start_text,
    step,
)
from examples import EXAMPLES  # noqa: E402

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


def chart(words: list[str], file: str) -> None:
    """Measure as the program's chart does, and draw the points on two logarithmic scales."""
    wanted = read_command_line(make_parser(), ["chart", *words])
    scene = scene_wanted(wanted)
    figure = Figure(figsize=(8, 6), dpi=150, layout="constrained")
    heading = f"Example {wanted.number}: {start_text(scene)}"
    figure.suptitle(f"Speed against accuracy\n{textwrap.fill(heading, 110)}", fontsize=9)
    axes = figure.add_subplot(
        xscale="log", yscale="log", xlabel="largest error in ten runs (m): better to the left",
        ylabel="time for a simulated second (\N{MICRO SIGN}s): better upwards")
    axes.invert_yaxis()
    axes.margins(x=0.08)  # room for the labels
    for (letter, series), marker in zip(measure(scene).items(), "oxD+v", strict=True):
        errors_m = [max(point.error_m, 1e-16) for point in series]  # 0 has no logarithm
        costs_us = [point.cost_us for point in series]
        label = f"{letter}: {method_text(*METHODS[letter])}"
        axes.plot(errors_m, costs_us, f"{marker}-", label=label)
        for end in (0, -1):  # the lowest and the highest rate
            axes.annotate(f" {series[end].fps} FPS", (errors_m[end], costs_us[end]), fontsize=7)
    axes.axvline(1 / scene.m_to_px, color="black", linestyle="--", label="one drawn pixel")
    figure.legend(loc="outside lower center", ncols=3)
    figure.savefig(file)


SHEET_FRAMES = 53  # up to the second return
SHEET_COLUMNS = 67  # up to the right wall


TASKS = """
Tasks

A 0 shows where a step ended, beyond the wall. The * in the same line
shows where the program put the car. The car starts at t = 0 on the
dots. The first line is at t = 0.1 s.

1. In which two lines is the car found beyond the wall? At what time?

   first bounce: line ______, ______ s
   second bounce: line ______, ______ s

2. Mark the two places where the car turns at the right. How many
   columns is it from the * to the dots at 2 m? (Count the column of the
   dots, but not that of the *.) A column is 3.3 cm.

   first turn: ______ columns = ______ cm
   second turn: ______ columns = ______ cm

3. The first 0 is 7 cm beyond the wall, and the second 0 is 19 cm beyond
   it. (You cannot read this so exactly in the picture.) The program
   puts the car equally far in front of the wall. So it lifts the car up
   the track. By how much?

   first bounce: 7 + ______ = ______ cm
   second bounce: 19 + ______ = ______ cm

4. From the start to the first turn there are 26 steps, and 26 more to
   the second turn. A car that is 1 cm higher on the track at the same
   speed has 0.02 J/kg more energy. So we count energy in cm. Each step
   loses 1 cm. Each bounce gains its lift, because the car is put higher
   and keeps its speed. How many cm higher (+) or lower (-) is each
   turn?

   first turn, from the start: ______ - 26 = ______ cm
   second turn, from the first turn: ______ - 26 = ______ cm
   second turn, from the start: ______ + ______ = ______ cm

   Compare with your cm in task 2. (1 or 2 cm do not matter.)

5. For quick pairs. Until its first bounce the true car is at
   x = 2 - t^2 (x in m, t in s). Where is it at t = 1.0 s? Mark it. How
   many columns is the * from it?
"""


def worksheet() -> str:
    """Example 8 for pupils: 58 lines of at most 72 columns, with scales, and the tasks."""
    scene = scene_of(EXAMPLES[8].settings | {"m_to_px": 30.0, "width_px": SHEET_COLUMNS})
    dt_s = 1 / scene.fps_target
    marked = {round(x_m * scene.m_to_px): str(x_m) for x_m in (0.5, 1.0, 1.5, 2.0)}
    axis = list("x (m)".ljust(SHEET_COLUMNS) + "t (s)")
    for column, text in marked.items():
        axis[column - 1:column + 2] = text
    lines = [
        "Example 8: Elastic, large steps                    Name:",
        "No speed is lost in a bounce. How near to its start, the dots at 2 m,",
        "does the car * come back? Walls: |. A step ended beyond a wall: 0.",
        "A column is 3.3 cm, a line is 0.1 s. a = -2 m/s^2, walls at 0.25, 2.2 m.",
        "".join(axis)]
    x_m, v_mps = scene.x_m, scene.v_mps
    for frame in range(1, SHEET_FRAMES + 1):
        x_m, v_mps, found_m = step(scene, x_m, v_mps, dt_s)
        line = list(render_track(scene, {"*": x_m}, found_m))
        if frame == 1 or frame % 5 == 0:
            for column in marked:
                if line[column] == " ":
                    line[column] = "."
            line.append(f"{frame * dt_s:5.1f}")
        lines.append("".join(line).rstrip())
    return "\n".join(lines) + "\n" + TASKS


def main(words: list[str]) -> None:
    if words == ["sheet"]:
        print(worksheet(), end="")
    elif words:
        chart(words[1:-1], words[-1])
    else:
        moving_picture(HERE / ".github/example-17.gif")
        chart([], str(HERE / ".github/chart.png"))
        (HERE / ".github/worksheet.txt").write_text(worksheet())


if __name__ == "__main__":
    main(sys.argv[1:])
