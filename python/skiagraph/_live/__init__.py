"""The scene under one's hands in a notebook: the page of `skiagraph live`, served over the kernel's own channel. Private."""
