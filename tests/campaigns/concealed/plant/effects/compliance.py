"""Springs off the joints' axes."""

import numpy as np

from ..assembly import HINGE, SLIDE, set_lump
from .base import Effect

AXES = "xyz"


def _add_springs(body, prefix, compliances, kind):
    for axis, compliance in compliances.items():
        body.add_joint(name=f"{prefix}_{axis}", type=kind, axis=np.eye(3)[AXES.index(axis)],
                       stiffness=[1 / compliance, 0, 0])


class BaseCompliance(Effect):
    """x, y, z: m/N, rx, ry: rad/(N·m), in the base frame at its origin."""

    name = "base_compliance"
    PLATE = 50.0, 20.0  # kg, kg·m²: what stands on the springs besides the robot; weightless

    def build(self, assembly):
        set_lump(assembly.base, *self.PLATE)
        assembly.base.gravcomp = 1
        turns = {name[1]: value for name, value in self.parameters.items() if name[0] == "r"}
        moves = {name: value for name, value in self.parameters.items() if name[0] != "r"}
        _add_springs(assembly.base, "base_shift", moves, SLIDE)
        _add_springs(assembly.base, "base_turn", turns, HINGE)


class ToolCompliance(Effect):
    """x, y, z: m/N, in the tool frame; what the robot carries is beyond the spring."""

    name = "tool_compliance"

    def build(self, assembly):
        _add_springs(assembly.tool, "tool_shift", self.parameters, SLIDE)


class LinkFlexibility(Effect):
    """bending_x, bending_y, bending_z: rad/(N·m) off the joint's axis, at the link's root and in
    its frame."""

    name = "link_flexibility"

    def build(self, assembly):
        bends = {name[-1]: value for name, value in self.parameters.items()}
        _add_springs(assembly.links[self.joint - 1], f"bend_{self.joint}", bends, HINGE)
