"""Recordings of flexible robots with concealed physics, drawn from a seed.

Independent of the host's code: kinematics, dynamics and every effect are written here from first
principles, so that `flexcomp diagnose` is judged by physics that it does not share.
"""
