from tiskel import compare, make_shape, skeletonize

cloud, true = make_shape("banana", 1000)
found = compare(true, skeletonize(cloud))
if found.there and found.back:
    print(found.there.mean, found.back.largest, found.lengths, found.ends, found.loops)
