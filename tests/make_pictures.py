"""Makes the README's moving pictures from the program's own output: python tests/make_pictures.py

Each is a full terminal in which a film scrolls, as an animated GIF in .github/. Needs matplotlib
(of the test extra), for its Pillow and its monospaced font.
"""

import subprocess
import sys
from pathlib import Path

from matplotlib.font_manager import findfont
from PIL import Image, ImageDraw, ImageFont

HERE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(HERE))

from airtrack import INKS  # noqa: E402

COLUMNS = 88  # what a README's width has room for
COMMANDS = {number: f"python airtrack.py {number} m_to_px=36 width_px={COLUMNS}"
            for number in (16, 21)}
FRAMES, ROWS, LINE_PX, LETTER_PX, EDGE_PX = 120, 18, 20, 10, 8
PAPER, GREY = (24, 24, 27), (190, 190, 196)
SHADES = {31: (248, 113, 113), 32: (74, 222, 128), 33: (250, 204, 21), 34: (96, 165, 250),
          35: (216, 140, 255), 36: (34, 211, 238)}  # as a dark terminal shows these colours
INK = {mark: SHADES[ink] for marks, (ink, _) in INKS.items() for mark in marks}
FONT = ImageFont.truetype(findfont("DejaVu Sans Mono:bold"), 16)


def film(command: str) -> list[str]:
    """Its frames."""
    words = [*command.split(), "--fast", "--frames", str(FRAMES)]
    out = subprocess.run([sys.executable, *words[1:]], text=True, check=True, cwd=HERE,
                         capture_output=True).stdout
    return out.partition("\n\n")[2].splitlines()[:FRAMES]


def screen(command: str, lines: list[str]) -> Image.Image:
    """The terminal when the last of the lines after the command has just been printed."""
    size = COLUMNS * LETTER_PX + 2 * EDGE_PX, ROWS * LINE_PX + 2 * EDGE_PX
    picture = Image.new("RGB", size, PAPER)
    draw = ImageDraw.Draw(picture)
    draw.fontmode = "1"  # no shades between ink and paper: few colours, and each frame the same
    for row, line in enumerate([f"$ {command}", "", *lines][-ROWS:]):
        for column, letter in enumerate(line):
            colour = GREY if line.startswith("$") else INK.get(letter, GREY)
            draw.text((EDGE_PX + column * LETTER_PX, EDGE_PX + row * LINE_PX), letter, colour, FONT)
    return picture


def main() -> None:
    for number, command in COMMANDS.items():
        lines = film(command)
        frames = [screen(command, lines[:n]).quantize(9) for n in range(ROWS - 2, FRAMES + 1)]
        file = HERE / ".github" / f"example-{number}.gif"
        frames[0].save(file, save_all=True, append_images=frames[1:], loop=0,
                       duration=[100] * (len(frames) - 1) + [2000], optimize=False)
        print(f"{file.relative_to(HERE)}: {len(frames)} frames, {file.stat().st_size // 1000} kB")


if __name__ == "__main__":
    main()
