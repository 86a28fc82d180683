"""Sphinx: renders Markdown as it stands, executes notebooks and the gallery, and takes references from docstrings and Doxygen.
It reads a staged copy of the repository (stage.py), because a build writes beside what it reads."""
import os
import warnings
from pathlib import Path

import matplotlib

matplotlib.use("agg")
here = Path(__file__).resolve().parent

project = "Skiagraph"
author = "the authors of Skiagraph"
copyright = author
version = release = os.environ["SKG_SITE_VERSION"]

extensions = ["myst_nb", "sphinx.ext.autodoc", "breathe", "sphinx_gallery.gen_gallery", "sphinxcontrib.video"]
exclude_patterns = ["gallery/*.ipynb", "gallery/*.py", "docs/site", "gallery-scripts", "**/.ipynb_checkpoints"]
source_suffix = {".rst": "restructuredtext", ".md": "myst-nb", ".ipynb": "myst-nb"}
nitpicky = False

# Markdown as GitHub shows it: headings are the targets of links.
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence", "attrs_inline"]
nb_execution_mode = "cache"
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_execution_cache_path = os.environ["SKG_SITE_CACHE"]
# PyTorch takes gigabytes: its notebook is shown with the pictures that it was stored with.
nb_execution_excludepatterns = ["*.md", "*_torch.ipynb"]

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
add_module_names = False

breathe_projects = {"skiagraph": os.environ["SKG_SITE_XML"]}
breathe_default_project = "skiagraph"
breathe_domain_by_extension = {"h": "c"}
breathe_show_include = False

sphinx_gallery_conf = {
    "examples_dirs": ["gallery-scripts"],
    "gallery_dirs": ["gallery"],
    "filename_pattern": "/plot_",
    "ignore_pattern": r"figure\.py",
    "download_all_examples": False,
    "thumbnail_size": (320, 320),
    "within_subsection_order": "FileNameSortKey",
    "show_signature": False,
    "capture_repr": (),
    "min_reported_time": 1e9,
    "abort_on_example_error": True,
    "matplotlib_animations": (True, "mp4"),
    "write_computation_times": False,
    "remove_config_comments": True,
}
warnings.filterwarnings("ignore")

html_theme = "furo"
html_title = "Skiagraph"
html_logo = str(here / "static/logo.svg")
html_favicon = html_logo
#: The colour of the logo; lighter on a dark ground.
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#c2410c", "color-brand-content": "#c2410c"},
    "dark_css_variables": {"color-brand-primary": "#fb923c", "color-brand-content": "#fb923c"},
}
html_static_path = [str(here / "static")]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
# Nothing is loaded from elsewhere: formulas are text, so that no page asks for this script.
html_math_renderer = "mathjax"
mathjax_path = "absent.js"
html_extra_path = [os.environ["SKG_SITE_EXTRA"]]
suppress_warnings = ["misc.highlighting_failure", "config.cache"]
