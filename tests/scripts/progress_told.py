from tiskel import Progress, skeletonize


def tell(progress: Progress) -> None:
    print(f"{progress.stage} {progress.share:.0%} {progress.part}")


skeletonize("scan.ply", progress=tell)
