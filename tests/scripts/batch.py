from pathlib import Path

from tiskel import TiskelError, skeletonize

for path in sorted(Path("scans").glob("*.ply")):
    try:
        skeletonize(path, method="lbc", max_steps=5).save(path.with_suffix(".swc"))
    except TiskelError as error:
        print(path.name, error)
