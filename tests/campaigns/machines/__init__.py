"""Public recordings of real machines, and `flexcomp diagnose` on them.

Each machine is a folder: `reader` turns the published files into a robot and recordings as the
command takes them, `goals` judges its answer, `pictures` shows it, README.md is its page.
"""
