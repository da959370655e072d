"""The engine's model of a robot: rigid, or with motor and link side of each joint apart."""

import dataclasses

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

STEP = 5e-4  # s
MATERIAL_DAMPING = 0.02  # of critical, of each joint's spring and what it carries
TINY_MASS = 1e-6  # kg: what only joins two joints
HINGE, SLIDE = mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE


def quaternion(rotation):
    """(w, x, y, z) of a matrix (3, 3)."""
    return Rotation.from_matrix(rotation).as_quat(scalar_first=True)


def stiff_friction(torque):
    """Dry friction as the engine has it, hard enough to stand still below `torque` (N·m)."""
    return {"frictionloss": torque, "solref_friction": [1.2e-3, 1],
            "solimp_friction": [0.9999, 0.9999, 1e-3, 0.5, 2]}


def set_lump(body, mass, moment):
    """A body with a mass (kg) at its origin and the same moment of inertia (kg·m²) all round."""
    body.explicitinertial = True
    body.mass = mass
    body.ipos = [0, 0, 0]  # left out, the engine would take the body's own position
    body.iquat = [1, 0, 0, 0]
    body.inertia = [moment] * 3


def _set_inertia(body, inertial):
    body.explicitinertial = True
    body.mass = inertial.mass
    body.ipos = inertial.center
    moments, frame = np.linalg.eigh(inertial.inertia)
    if np.linalg.det(frame) < 0:
        frame[:, 0] *= -1
    body.inertia = moments
    body.iquat = quaternion(frame)


def new_spec(description):
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.option.timestep = STEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.gravity = description.gravity
    spec.option.tolerance = 1e-12
    spec.option.iterations = 50
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    return spec


@dataclasses.dataclass
class Assembly:
    """A plant before it is compiled, to which effects may add. Lists have one entry a revolute joint."""

    spec: mujoco.MjSpec
    description: object
    base: object = None  # body between floor and robot
    motors: list = dataclasses.field(default_factory=list)  # motor-side bodies
    links: list = dataclasses.field(default_factory=list)  # link-side bodies
    tool: object = None  # body of the tool frame
    turning: list = dataclasses.field(default_factory=list)  # names of what turns about each axis

    def spring(self, joint):
        """The elastic hinge of joint 1 to 6."""
        return self.spec.joint(f"spring_{joint}")

    def motor(self, joint):
        return self.spec.joint(f"motor_{joint}")


def _add_payload(tool, description):
    """A small body, which is nearly a point mass."""
    body = tool.add_body(name="payload", pos=description.payload_center)
    set_lump(body, description.payload_mass, 1e-4 * description.payload_mass)


def _add_tool(parent, description, spec):
    parent.name = "tool"
    parent.add_site(name="tcp")
    if description.payload_mass > 0:
        _add_payload(parent, description)
    spec.worldbody.add_site(name="world")


def rigid(description):
    """A compiled model with six hinges, motor_1 to motor_6, and the site tcp."""
    spec = new_spec(description)
    body = spec.worldbody.add_body(name="base")
    number = 0
    for joint in description.chain:
        body = body.add_body(pos=joint.position, quat=quaternion(joint.rotation))
        if joint.body is not None:
            _set_inertia(body, joint.body)
        if joint.axis is not None:
            number += 1
            body.add_joint(name=f"motor_{number}", type=HINGE, axis=joint.axis)
    _add_tool(body, description, spec)
    return spec.compile()


def flexible(description):
    """The Assembly of the robot with a motor side and a link side of each joint."""
    spec = new_spec(description)
    assembly = Assembly(spec, description)
    body = assembly.base = spec.worldbody.add_body(name="base")
    for joint in description.chain:
        if joint.axis is None:
            body = body.add_body(pos=joint.position, quat=quaternion(joint.rotation))
        else:
            number = len(assembly.links) + 1
            motor = body.add_body(name=f"motor_{number}", pos=joint.position,
                                  quat=quaternion(joint.rotation))
            set_lump(motor, TINY_MASS, 1e-3 * TINY_MASS)
            hinge = motor.add_joint(name=f"motor_{number}", type=HINGE, axis=joint.axis,
                                    armature=joint.rotor_inertia, damping=[joint.viscous, 0, 0])
            if joint.coulomb > 0:
                for name, value in stiff_friction(joint.coulomb).items():
                    setattr(hinge, name, value)
            body = motor.add_body(name=f"link_{number}")
            body.add_joint(name=f"spring_{number}", type=HINGE, axis=joint.axis,
                           stiffness=[1 / joint.compliance, 0, 0])
            assembly.motors.append(motor)
            assembly.links.append(body)
            assembly.turning.append([f"motor_{number}", f"spring_{number}"])
        if joint.body is not None:
            _set_inertia(body, joint.body)
    assembly.tool = body
    _add_tool(body, description, spec)
    _add_actuators(spec)
    return assembly


def _add_actuators(spec):
    """Six motors (N·m), then force (N) and moment (N·m) on the tool at the TCP, base frame."""
    for number in range(1, 7):
        actuator = spec.add_actuator(name=f"motor_{number}", target=f"motor_{number}",
                                     trntype=mujoco.mjtTrn.mjTRN_JOINT)
        actuator.set_to_motor()
    for index, name in enumerate(("fx", "fy", "fz", "mx", "my", "mz")):
        actuator = spec.add_actuator(name=name, target="tcp", refsite="world",
                                     trntype=mujoco.mjtTrn.mjTRN_SITE, gear=np.eye(6)[index])
        actuator.set_to_motor()


def compile_with_damping(assembly, posture, ratio=MATERIAL_DAMPING):
    """The compiled model; springs without damping of their own get `ratio` of critical, by the
    inertia that they carry at a posture (6,) of the motors."""
    model = assembly.spec.compile()
    data = mujoco.MjData(model)
    for number in range(6):
        data.qpos[model.joint(f"motor_{number + 1}").qposadr[0]] = posture[number]
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    for joint in range(model.njnt):
        dof = model.jnt_dofadr[joint]
        stiffness = model.jnt_stiffness[joint]
        if stiffness > 0 and model.dof_damping[dof] == 0:
            model.dof_damping[dof] = 2 * ratio * np.sqrt(stiffness * full[dof, dof])
    return model
