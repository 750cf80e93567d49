from tiskel import evaluate, make_shape, skeletonize

cloud, _ = make_shape("y", 1000, noise=0.05)
skeleton = skeletonize(cloud)
skeleton.plot("y.png", title="my scan", up="z", unit="m")
skeleton.view(evaluate(skeleton)).save("y.html")
