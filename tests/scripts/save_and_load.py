from tiskel import Skeleton, fit_surface, roll, skeletonize

skeletonize("scan.ply").save("skeleton.ply")
skeleton = Skeleton.load("skeleton.ply")
skeleton.save("skeleton.obj")
run = roll(fit_surface(skeleton, interval=0.05).named(None), omega=(0, 1, 0), duration=1)
print(skeleton, run.status.value)
