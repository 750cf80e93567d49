"""Data-parallel Taichi kernels: plain arrays in, explicit output arrays, nothing else."""

import os

from .folders import name_cache_home

# Taichi reads these while it is imported: no banner on stdout, no look-up of newer versions, and no word in notebooks
# that it has wrapped their stdout for the prints of kernels; ours print nothing.
os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")
os.environ.setdefault("TI_SKIP_VERSION_CHECK", "ON")
os.environ.setdefault("TI_ENABLE_PYBUF", "0")
name_cache_home()
