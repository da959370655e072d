"""Plain regression: every inertial parameter of every link, and each joint's friction, rotor and offset."""

import numpy as np
import pinocchio

from . import motion

CUTOFFS = (5.0, 8.0, 12.0, 20.0, 40.0, 80.0)  # Hz
LARGEST_SHARE = 1 / 3  # of the rate, that a cut-off may be
CHECKED_PART = 0.25  # of each recording, the last of it, to choose one by


def _model(nominal):
    model = pinocchio.buildModelFromUrdf(str(nominal.urdf))
    model.gravity.linear = np.array(nominal.gravity)
    return model


def _rows(model, moved):
    """(n · joints, parameters), a block a sample."""
    data, joints = model.createData(), np.eye(model.nv)
    samples = zip(moved.angle, moved.speed, moved.acceleration)
    return np.vstack([
        np.hstack([np.atleast_2d(pinocchio.computeJointTorqueRegressor(model, data, *sample)),
                   np.diag(sample[2]), np.diag(np.sign(sample[1])), np.diag(sample[1]), joints])
        for sample in samples])


def predict(nominal, training, held_out):
    """Torques (n, joints) of the held-out motion, and what was said of what is missing."""
    model, inner = _model(nominal), [moved.rows(moved.inner) for moved in training]
    rows = np.vstack([_rows(model, moved) for moved in inner])
    torque = np.concatenate([moved.torque.ravel() for moved in inner])
    is_known = np.isfinite(torque)
    parameters = np.linalg.lstsq(rows[is_known], torque[is_known], rcond=1e-9)[0]
    return (_rows(model, held_out) @ parameters).reshape(held_out.torque.shape), ""


def best_cutoff(nominal, paths):
    """Of CUTOFFS the one with which regression predicts best the last part of what it may learn from."""
    rate = min(motion.read(path, CUTOFFS[0]).rate for path in paths)
    usable = [cutoff for cutoff in CUTOFFS if cutoff < LARGEST_SHARE * rate]
    return min(usable, key=lambda cutoff: _error(nominal, paths, cutoff))


def _error(nominal, paths, cutoff):
    training, checked = [], []
    for path in paths:
        moved = motion.read(path, cutoff)
        moved = moved.rows(slice(None, None, max(1, len(moved.time) // 1500)))
        is_last = moved.time > moved.time[-1] - CHECKED_PART * (moved.time[-1] - moved.time[0])
        training.append(moved.rows(~is_last))
        checked.append(moved.rows(is_last & moved.inner))
    found = [predict(nominal, training, each)[0] - each.torque for each in checked]
    return np.nanmean(np.square(np.vstack(found)))
