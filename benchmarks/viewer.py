"""The viewer's page: how large it is, how long it takes to write, and when a browser shows the first picture.

    python benchmarks/viewer.py [COUNT...]

The browser is Chromium on this machine's processor, without a graphics chip: the time that a picture takes there is an
upper bound. Clouds are of the banana, with its true curve. Times are seconds, the best of three.
"""

import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from reference.browser import Browser, browser
from tiskel import ShapeParams, make_shape, shape_graph, view

COUNTS = (10_000, 100_000, 1_000_000)
ROUNDS = 3
STATE = "document.querySelector('.tiskel-viewer').dataset.milliseconds"
TURN = """(async () => { const w = document.querySelector('.tiskel-viewer').viewer.world;
const g = w.renderer.getContext(), start = performance.now();
for (let i = 0; i < 10; i++) { w.turn(0.05, 0); w.draw(performance.now());
g.readPixels(0, 0, 1, 1, g.RGBA, g.UNSIGNED_BYTE, new Uint8Array(4)); }
return (performance.now() - start) / 10; })()"""


def row(count: int, tab: Browser, folder: Path) -> tuple[int, int, float, float, float]:
    """Return points, bytes, seconds to write, seconds to the first picture, and milliseconds of every further one."""
    true = make_shape(shape_graph("banana"), ShapeParams(count=count))[1]
    page, written, shown, drawn = folder / f"{count}.html", [], [], []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        view(true).save(page)
        written.append(time.perf_counter() - start)
        tab.open(page.as_uri())
        shown.append(float(tab.value(STATE)) / 1000)
        drawn.append(float(tab.value(TURN)))
    return count, page.stat().st_size, min(written), min(shown), min(drawn)


def main(counts: list[int]) -> None:
    """Print the table."""
    print("| points | page, kB | written, s | first picture, s | further pictures, ms |")
    print("|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder, browser() as tab:
        for count in counts:
            points, size, written, shown, drawn = row(count, tab, Path(folder))
            print(f"| {points} | {size / 1000:.0f} | {written:.2f} | {shown:.2f} | {drawn:.0f} |", flush=True)


if __name__ == "__main__":
    main([int(word) for word in sys.argv[1:]] or list(COUNTS))
