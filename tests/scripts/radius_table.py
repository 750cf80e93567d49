from tiskel import skeletonize

skeleton = skeletonize("scan.ply")
table = skeleton.to_pandas()
table[table["radius_source"] == "measured"].to_csv("radii.csv", index=False)
print(skeleton.to_pandas("branches")[["kind", "length", "radius_mean"]].round(2))
