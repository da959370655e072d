"""Masses, and what carries them."""

import numpy as np
from scipy.spatial.transform import Rotation

from ..description import Body
from .base import Effect


class Payload(Effect):
    """mass: kg more on the flange; mx, my, mz: its first moment in the tool frame, kg·m."""

    name = "payload"

    def alter(self, description):
        more = self.parameters
        moment = description.payload_mass * description.payload_center
        description.payload_mass += more["mass"]
        description.payload_center = (
            moment + np.array([more["mx"], more["my"], more["mz"]])) / description.payload_mass


class LinkMass(Effect):
    """mass: kg more, spread as the link's own; with mx, my, mz (kg·m, link frame) a lump that is
    mounted on it."""

    name = "link_mass"

    def alter(self, description):
        joint = description.joints[self.joint - 1]
        body, mass = joint.body, self.parameters["mass"]
        if "mx" not in self.parameters:
            share = 1 + mass / body.mass
            joint.body = Body(body.mass * share, body.center, body.inertia * share)
            return
        place = np.array([self.parameters[name] for name in ("mx", "my", "mz")]) / mass
        total = body.mass + mass
        arm = place - body.center
        joint.body = Body(total, body.center + mass / total * arm,
                          body.inertia + body.mass * mass / total
                          * (arm @ arm * np.eye(3) - np.outer(arm, arm)))


class GravityCompensator(Effect):
    """A spring balancer: a tendon between a point `far` (m) from the joint's axis on the link
    before and one `near` on the link itself; `stiffness` N/m, `free_length` m. They stand in line
    at the joint angle -zero_angle.

    Its torque is -sin(lean) (stiffness_torque + pull_torque / l), with lean = q + zero_angle and l
    the length in units of `far`; anchor_ratio = near / far."""

    name = "gravity_compensator"

    def __init__(self, joint, far, near, stiffness, free_length, zero_angle):
        super().__init__(joint, stiffness_torque=stiffness * far * near,
                         pull_torque=-stiffness * free_length * near, anchor_ratio=near / far,
                         zero_angle=zero_angle)
        self.anchors = far, near
        self.stiffness, self.free_length = stiffness, free_length

    def build(self, assembly):
        joints = assembly.description.joints
        joint, along = joints[self.joint - 1], joints[self.joint].position
        along = along - joint.axis * (joint.axis @ along)
        along /= np.linalg.norm(along)
        turned = Rotation.from_rotvec(-self.parameters["zero_angle"] * joint.axis).apply(along)
        far, near = self.anchors
        before, link = assembly.links[self.joint - 2], assembly.links[self.joint - 1]
        before.add_site(name="anchor_before", pos=joint.position + far * (joint.rotation @ turned))
        link.add_site(name="anchor_link", pos=near * along)
        balancer = assembly.spec.add_tendon(name="balancer", stiffness=[self.stiffness, 0, 0],
                                            springlength=[self.free_length] * 2)
        balancer.wrap_site("anchor_before")
        balancer.wrap_site("anchor_link")
