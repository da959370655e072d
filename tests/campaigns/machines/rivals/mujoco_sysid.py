"""mujoco.sysid, as its documentation says: parameters with modifiers, sequences, a residual, Gauss-Newton.

Its own rollout drives the model with torques and compares angles, which run away from a recording within a
second. Torques along a measured motion are MuJoCo's inverse dynamics, in the custom rollout that the package
has for such cases."""

import mujoco
import numpy as np
from mujoco import sysid

ROWS = 400  # of each recording, or the fits take hours
MOST_ITERATIONS = 15
LEAST_RADIUS = 0.03  # m, of gyration: it takes no points for bodies


def _spec(nominal):
    spec = mujoco.MjSpec.from_file(str(nominal.urdf))
    spec.option.gravity = nominal.gravity
    _give_bodies_a_size(spec)
    for joint, rotor in zip(spec.joints, nominal.rotor):
        joint.armature = rotor
        actuator = spec.add_actuator(name=f"{joint.name}_motor", target=joint.name)
        actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
        sensor = spec.add_sensor(name=f"{joint.name}_torque", objname=joint.name)
        sensor.type, sensor.objtype = mujoco.mjtSensor.mjSENS_JOINTACTFRC, mujoco.mjtObj.mjOBJ_JOINT
    return spec


def _give_bodies_a_size(spec):
    for body in spec.bodies[1:]:
        xx, yy, zz, xy, xz, yz = body.fullinertia if body.explicitinertial else np.zeros(6)
        moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        body.explicitinertial, body.mass = True, max(body.mass, 1e-3)
        least = body.mass * LEAST_RADIUS**2
        if moments[0] < 1e-3 * least:
            body.fullinertia = [xx + least, yy + least, zz + least, xy, xz, yz]


def _of_joint(name, joint, nominal, largest):
    def modify(spec, parameter):
        value = parameter.value[0]
        # Damping is a polynomial of speed; this is its linear part.
        setattr(spec.joint(joint), name, [value, 0, 0] if name == "damping" else value)
    return sysid.Parameter(f"{joint}_{name}", nominal, 0.0, largest, modifier=modify)


def _of_body(spec, model, name):
    def modify(spec, parameter):
        sysid.apply_body_inertia(spec, name, parameter)
        spec.body(name).iquat = [1, 0, 0, 0]  # version 4.0.0 leaves no number, which does not compile
    return sysid.body_inertia_param(spec, model, name, sysid.InertiaType.Pseudo, modifier=modify)


def _parameters(spec, nominal, torque):
    """Every family that the package offers for an arm: inertia of bodies, damping, friction, armature;
    and a bias of each torque."""
    parameters, model = sysid.ParameterDict(), spec.compile()
    for joint, rotor, size in zip(spec.joints, nominal.rotor, np.nanstd(torque, axis=0)):
        parameters.add(_of_joint("damping", joint.name, 0.01 * size, 10 * size))
        parameters.add(_of_joint("frictionloss", joint.name, 0.01 * size, 2 * size))
        parameters.add(_of_joint("armature", joint.name, max(rotor, 1e-3), max(10 * rotor, size)))
        parameters.add(sysid.Parameter(f"{joint.name}_bias", 0.0, -size, size))
    for body in spec.bodies[1:]:
        parameters.add(_of_body(spec, model, body.name))
    return parameters


def _torques(model, data, motion):
    """(n, joints) by inverse dynamics."""
    found = np.empty_like(motion.torque)
    for row, state in enumerate(zip(motion.angle, motion.speed, motion.acceleration)):
        data.qpos, data.qvel, data.qacc = state
        mujoco.mj_inverse(model, data)
        found[row] = data.qfrc_inverse
    return found


class _AlongMotion:
    """A custom rollout, and the residual of its torques with biases. One for each motion: sequences that
    share a residual must be of one length."""

    def __init__(self, spec, motion):
        self.motion = motion
        model = spec.compile()
        self.sequences = [sysid.ModelSequences(
            name="robot", spec=spec, sequence_name=["motion"],
            initial_state=[sysid.create_initial_state(model, motion.angle[0], motion.speed[0])],
            control=[sysid.TimeSeries.from_control_names(motion.time, motion.torque, model)],
            sensordata=[sysid.TimeSeries.from_names(motion.time, motion.torque, model)])]

    def rollout(self, models, datas, control_signal, initial_states, **_):
        trajectories, motion = [], self.motion
        for index, model in enumerate(models):
            torque = _torques(model, mujoco.MjData(model), motion)
            state = np.column_stack([motion.time, motion.angle, motion.speed])
            trajectories.append(sysid.SystemTrajectory(
                model=model, control=control_signal[index],
                sensordata=sysid.TimeSeries.from_names(motion.time, torque, model),
                initial_state=initial_states[index], state=sysid.TimeSeries(motion.time, state)))
        return trajectories


def _residual(spec, motions, parameters):
    """A function of a parameter vector: what is left along every motion, one after the other."""
    transform = _transform(spec, parameters)
    each_motion = []
    for motion in motions:
        along = _AlongMotion(spec, motion)
        each_motion.append(sysid.build_residual_fn(
            models_sequences=along.sequences, custom_rollout=along.rollout,
            modify_residual=transform.apply))

    def residual(vector, of, **options):
        parts = [each(vector, of, **options) for each in each_motion]
        return tuple(sum((list(part) for part in lists), []) for lists in zip(*parts))
    return residual


def _transform(spec, parameters):
    transform = sysid.SignalTransform()
    for joint in spec.joints:
        transform.bias(f"{joint.name}_torque", parameters[f"{joint.name}_bias"], target="predicted")
    return transform


def predict(nominal, training, held_out):
    """As `regression.predict`."""
    spec = _spec(nominal)
    inner = [motion.rows(motion.inner) for motion in training]
    motions = [motion.rows(slice(None, None, max(1, len(motion.time) // ROWS))) for motion in inner]
    parameters = _parameters(spec, nominal, np.vstack([motion.torque for motion in motions]))
    found, _ = sysid.optimize(parameters, _residual(spec, motions, parameters), optimizer="mujoco",
                              max_iters=MOST_ITERATIONS, verbose=False)
    model = sysid.apply_param_modifiers(found, _spec(nominal))
    bias = [found[f"{joint.name}_bias"].value[0] for joint in spec.joints]
    return _torques(model, mujoco.MjData(model), held_out) + bias, ""
