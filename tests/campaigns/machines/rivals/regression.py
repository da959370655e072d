"""Plain regression: every inertial parameter of every link, and each joint's friction, rotor and offset."""

import numpy as np
import pinocchio

REQUIRES = "pinocchio"


def _model(nominal):
    model = pinocchio.buildModelFromUrdf(str(nominal.urdf))
    model.gravity.linear = np.array(nominal.gravity)
    return model


def _rows(model, motion):
    """(n · joints, parameters), a block a sample."""
    data, joints = model.createData(), np.eye(model.nv)
    return np.vstack([
        np.hstack([pinocchio.computeJointTorqueRegressor(model, data, angle, speed, acceleration),
                   np.diag(acceleration), np.diag(np.sign(speed)), np.diag(speed), joints])
        for angle, speed, acceleration in zip(motion.angle, motion.speed, motion.acceleration)])


def predict(nominal, training, held_out):
    """Torques (n, joints) of the held-out motion, and what there is to say of what is missing."""
    model = _model(nominal)
    rows = np.vstack([_rows(model, motion) for motion in training])
    torque = np.concatenate([motion.torque.ravel() for motion in training])
    is_known = np.isfinite(torque)
    parameters = np.linalg.lstsq(rows[is_known], torque[is_known], rcond=1e-9)[0]
    return (_rows(model, held_out) @ parameters).reshape(held_out.torque.shape), ""
