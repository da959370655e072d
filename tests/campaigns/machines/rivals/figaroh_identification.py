"""FIGAROH, as its documentation says: a subclass of BaseIdentification and a configuration, with friction,
actuator inertias and offsets, weighted least squares, and a held-out trajectory for its verification."""

import pathlib
import tempfile

import numpy as np
import yaml
from figaroh.data.trajectory import TrajectoryData
from figaroh.identification.base_identification import BaseIdentification
from figaroh.tools.robot import load_robot

from .motion import EDGE, ORDER

TRAINING, HELD_OUT = "training", "held out"


class Identification(BaseIdentification):
    def __init__(self, robot, config, motions):
        self.motions = motions
        super().__init__(robot, str(config))
        names = self.identif_config["active_joints"]
        joints = [robot.model.joints[robot.model.getJointId(name)] for name in names]
        self.identif_config["act_Jid"] = [robot.model.getJointId(name) for name in names]
        self.identif_config["act_J"] = joints
        self.identif_config["act_idxq"] = [joint.idx_q for joint in joints]
        self.identif_config["act_idxv"] = [joint.idx_v for joint in joints]

    def load_trajectory_data(self, data_source=None):
        """Recordings one after the other; seams and ends are masked, as its filter runs over them."""
        time, angle, torque, inner = [], [], [], []
        for motion in self.motions[data_source or TRAINING]:
            even = motion.even  # its filter takes samples for evenly spaced
            time.append(even - even[0] + (time[-1][-1] + 1 / motion.rate if time else 0))
            angle.append(motion.at(even, motion.raw))
            torque.append(motion.at(even, motion.torque))
            inner.append((even > even[0] + EDGE) & (even < even[-1] - EDGE))
        torque = np.vstack(torque)
        joints = self.identif_config["act_J"]
        slides = [joint.shortname().startswith("JointModelP") for joint in joints]
        return TrajectoryData(
            t=np.concatenate(time), joint_names=self.identif_config["active_joints"], q=np.vstack(angle),
            effort=np.nan_to_num(torque), mask=np.concatenate(inner) & np.isfinite(torque).all(axis=1),
            effort_kind=["joint_force" if each else "joint_torque" for each in slides],
            effort_unit=["N" if each else "N·m" for each in slides])


def _configuration(names, rate, cutoff):
    zeros = [0.0] * len(names)
    return {
        "robot": {"name": "robot", "properties": {
            "joints": {"active_joints": names},
            "mechanics": {"reduction_ratios": [1.0] * len(names), "actuator_inertias": zeros,
                          "joint_offsets": zeros,
                          "friction_coefficients": {"viscous": zeros, "static": zeros}},
            "coupling": {"has_coupled_wrist": False}}},
        "tasks": {"identification": {
            "enabled": True,
            "problem": {"use_joint_torques": True, "model_components": {
                "friction": True, "joint_offset": True, "actuator_inertia": True}},
            "signal_processing": {"sampling_frequency": rate, "cutoff_frequency": cutoff,
                                  "filter_order": ORDER},
            "data": {"validation_data_file": HELD_OUT}}}}


def predict(nominal, training, held_out):
    """As `regression.predict`."""
    robot = load_robot(str(nominal.urdf))
    robot.model.gravity.linear = np.array(nominal.gravity)
    names = list(robot.model.names)[1:]
    with tempfile.TemporaryDirectory() as folder:
        config = pathlib.Path(folder) / "config.yaml"
        config.write_text(yaml.safe_dump(_configuration(names, held_out.rate, held_out.cutoff)))
        work = Identification(robot, config, {TRAINING: training, HELD_OUT: [held_out]})
        work.initialize()
        work.solve(decimate=False, plotting=False, wls=True)
        verdict = work.verify()
    series = verdict.series["fitted"]
    found = np.column_stack([np.interp(held_out.time, held_out.even, series[name])
                             for name in verdict.series["joint_names"]])
    return found, "; ".join(verdict.insights)
