"""A flexible robot as a plant, simulated by MuJoCo, with physics that its model may lack.

Nothing here is shared with flexcomp: kinematics, dynamics, springs, friction and play are the
engine's.
"""
