from concurrent.futures import ThreadPoolExecutor

from tiskel import make_shape, skeletonize

clouds = [make_shape(name, 500)[0] for name in ("y", "banana")]
with ThreadPoolExecutor(2) as pool:
    print([skeleton.ends for skeleton in pool.map(skeletonize, clouds)])
