"""What a move costs beside its frame, as a ratio: python tests/benchmark.py

Not a test, which must not depend on a machine's speed. Costs are the least of several runs.
"""

import io
import sys
import time
from contextlib import redirect_stdout
from pathlib import Path
from timeit import repeat

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from airtrack import Scene, cost_us, run
from examples import EXAMPLES, NoKeys

FRAMES = 20_000


def frame_us(scene: Scene) -> float:
    """A frame of its film, printed into memory."""
    with redirect_stdout(io.StringIO()):
        costs_s = repeat(lambda: run(scene, False, FRAMES, NoKeys()), number=1, repeat=7,
                         timer=time.process_time)
    return 1e6 / FRAMES * min(costs_s)


def main() -> None:
    ten = Scene(**EXAMPLES[10].settings)
    print(f"example 10: the move takes {cost_us(ten, 10) / 10 / frame_us(ten):.0%} of a frame")


if __name__ == "__main__":
    main()
