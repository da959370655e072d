"""Machines with many small causes at once: every link frame a little off, or friction on every axis.

`robots` writes nominal models, `frames` and `friction` conceal and record, `frame_refit` and
`friction_refit` are what flexcomp is measured against, `judge` measures. Nothing here knows how
flexcomp works: the plant is MuJoCo's, the refits are NumPy's.
"""
