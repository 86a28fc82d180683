"""Stands for skiagraph.gvxr where the package skiagraph-gvxr is not installed, and says what to install. Private."""
raise ModuleNotFoundError("skiagraph.gvxr is a package of its own: pip install skiagraph-gvxr, or in the folder of the project "
                          "pip install ./python/gvxr", name="skiagraph.gvxr")
