"""Stands for skiagraph.gvxr where the package skiagraph-gvxr is not installed, and says what to install. Private."""
raise ModuleNotFoundError("skiagraph.gvxr is a package of its own, skiagraph-gvxr: pip install ./python/gvxr in the folder of the project",
                          name="skiagraph.gvxr")
