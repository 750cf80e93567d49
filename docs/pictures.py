"""Every picture of the documentation, from shapes that tiskel makes: python docs/pictures.py [NAME...]

They are drawn by the program's own commands, so they show what a user gets; a palette makes the files a third as large.
The picture of the default method is drawn by :mod:`robust`, beside this file.
"""

import io
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from PIL import Image

HERE = Path(__file__).parent
FOLDER = HERE / "pictures"
PROGRAM = Path(sys.executable).with_name("tiskel")
COLOURS = 64  # of a picture; antialiased lines on white and one colour map need no more
WIDEST = 1100  # pixels; a page shows 800
MADE = (
    "shape hand -n 6000 --noise 0.05 --seed 3 -o scan.ply",
    "contract scan.ply --history -o c.ply",
    "skeleton c.ply -o curve.ply",
    "slice curve.ply -o surface.json --mesh body.ply",
    "roll surface.json --model body --omega 1,0,0 --sphere 0.06 --start-at 0,-0.2,-0.7 --duration 25 -o path.csv"
    " --plot roll.png",
)
DRAWN = {
    "contract": "contract scan.ply -o again.ply --plot contract.png",
    "skeleton": "skeleton c.ply -o again.ply --plot skeleton.png",
    "metrics": "metrics curve.ply --json --plot metrics.png",
    "stability": "stability c.ply --json --plot stability.png",
    "slice": "slice curve.ply -o again.json --branch 0 --no-body --plot slice.png",
    "roll": "",
    "first": "view body.ply curve.ply path.csv --title hand -o first.png",
    "tree": "",
}
TREE = (
    "shape tree -n 12000 --seed 2 -o t.ply",
    "contract t.ply -o tc.ply",
    "skeleton tc.ply -o ts.ply --plot tree.png",
)


def run(line: str, folder: Path) -> None:
    """Run one command of the program."""
    subprocess.run([PROGRAM, *line.split(), "--quiet"], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def small(data: bytes) -> bytes:
    """Return a PNG with a palette, no wider than a page can show."""
    picture = Image.open(io.BytesIO(data)).convert("RGB")
    if picture.width > WIDEST:
        picture = picture.resize((WIDEST, round(picture.height * WIDEST / picture.width)), Image.Resampling.LANCZOS)
    out = io.BytesIO()
    picture.quantize(COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(out, "PNG", optimize=True)
    return out.getvalue()


def robust() -> bytes:
    """Return the picture of the default method."""
    sys.path.insert(0, str(HERE))
    import robust as page

    return page.picture()


def main(names: list[str]) -> None:
    """Draw the pictures that are named, or all."""
    wanted = names or [*DRAWN, "robust"]
    keep: Callable[[str, bytes], int] = lambda name, data: (FOLDER / f"{name}.png").write_bytes(small(data))  # noqa: E731
    FOLDER.mkdir(exist_ok=True)
    if "robust" in wanted:
        keep("robust", robust())
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        for line in MADE if set(wanted) - {"tree", "robust"} else ():
            run(line, folder)
        for name in set(wanted) & set(DRAWN):
            for line in TREE if name == "tree" else [DRAWN[name]] * bool(DRAWN[name]):
                run(line, folder)
            keep(name, (folder / f"{name}.png").read_bytes())


if __name__ == "__main__":
    main(sys.argv[1:])
