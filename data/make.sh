#!/bin/sh
# Make the sample clouds and their analytic skeletons: data/make.sh [path of tiskel]
set -eu
cd "$(dirname "$0")"
tiskel=${1:-tiskel}
case $tiskel in
    /*) ;;
    */*) tiskel=$OLDPWD/$tiskel ;;
esac
for name in banana hand torus; do
    "$tiskel" shape "$name" -n 4096 --seed 1 -o "$name.ply" --skeleton "$name.skeleton.json" --quiet
done
"$tiskel" shape quadruped -n 4096 --seed 1 --noise 0.05 --missing 0.05 --uneven 3 \
    -o quadruped-scan.ply --skeleton quadruped-scan.skeleton.json --quiet
