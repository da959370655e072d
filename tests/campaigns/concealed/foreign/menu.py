"""Which foreign physics sits in which kind of recording, where, and how large; and what stands beside
it.

Kinds are those of `campaign.kinds`, and `poses`: a load test that goes through a wide region.
"""

import dataclasses

import numpy as np

from campaign import catalogue
from campaign.catalogue import Entry

from . import drives, sensors, stand, unseen

MOVING = 0.2  # rad, of a joint that drives a law
LONGEST_LEVER = 3.0  # m, about what such robots reach


@dataclasses.dataclass
class Scale(catalogue.Scale):
    """What the unchanged robot does while it is trained, and along which angles."""

    q: np.ndarray = None  # (n, 6) rad
    place: np.ndarray = None  # (n, 3) m, TCP
    moment: float = 0.0  # N·m, the largest

    def torque_unit(self, joint):
        """N·m: some hundredths of what the drive gives."""
        effort = self.description.joints[joint - 1].effort
        return 0.05 * max(self.torque[joint - 1], 0.08 * effort)


def _another(rng, scale, joint, moving=True):
    """A joint that drives a law at another one."""
    able = [number for number in range(1, 7) if number != joint
            and (not moving or scale.span[number - 1] > MOVING)]
    return int(rng.choice(able or [number for number in range(1, 7) if number != joint]))


def _within(rng, values, low, high):
    """An angle that a share of the rows is below, drawn between two shares."""
    return float(np.quantile(values, rng.uniform(low, high)))


def _sign(rng):
    return float(rng.choice([-1, 1]))


def _hose(rng, joint, scale, size):
    driver = _another(rng, scale, joint)
    return drives.Hose(joint, driver=driver, torque=_sign(rng) * size * scale.torque_unit(joint),
                       rest=_within(rng, scale.q[:, driver - 1], 0.2, 0.8))


def _cogging(rng, joint, scale, size):
    driver = _another(rng, scale, joint)
    least = 3 * 2 * np.pi / scale.span[joint - 1]
    return drives.CoupledCogging(
        joint, driver=driver, torque=size * scale.torque_unit(joint),
        order=round(float(rng.uniform(least, 2 * least))), phase=rng.uniform(-np.pi, np.pi),
        middle=_within(rng, scale.q[:, driver - 1], 0.2, 0.8))


def _windage(rng, joint, scale, size):
    driver = _another(rng, scale, joint)
    return drives.Windage(joint, driver=driver, drag=_sign(rng) * size * scale.torque_unit(joint)
                          / scale.speed[driver - 1] ** 2)


def _detent(rng, joint, scale, size):
    return drives.Detent(joint, torque=size * scale.torque_unit(joint),
                         angle=_within(rng, scale.q[:, joint - 1], 0.3, 0.7),
                         width=scale.span[joint - 1] * rng.uniform(0.06, 0.15))


def _stop(rng, joint, scale, size):
    side, angles = _sign(rng), scale.q[:, joint - 1]
    share = (0.6, 0.8) if side > 0 else (0.2, 0.4)
    return drives.SoftStop(joint, side=side, angle=_within(rng, angles, *share),
                           stiffness=5 * size * scale.torque_unit(joint) / scale.span[joint - 1])


def _worn(rng, joint, scale, size):
    return drives.WornStretch(joint, torque=size * scale.torque_unit(joint),
                              angle=_within(rng, scale.q[:, joint - 1], 0.3, 0.7),
                              width=scale.span[joint - 1] * rng.uniform(0.1, 0.2))


def _driving(rng, joint, scale, size):
    return drives.DrivingFriction(joint, torque=size * scale.torque_unit(joint))


def _neighbour(rng, joint, scale, size):
    driver = int(rng.choice([number for number in (2, 3) if number != joint]))
    return drives.NeighbourFriction(joint, driver=driver, share=size * scale.torque_unit(joint)
                                    / scale.load[driver - 1])


def _hot(rng, joint, scale, size):
    return sensors.HotDrive(joint, loss=0.1 * size, rated=scale.torque[joint - 1],
                            time=scale.duration * rng.uniform(0.1, 0.4))


def _by_load(rng, joint, scale, size):
    strongest = scale.load * scale.compliance
    able = [number for number in range(1, 7)
            if number != joint and strongest[number - 1] > 0.2 * strongest.max()]
    driver = int(rng.choice(able)) if able else _another(rng, scale, joint, False)
    return stand.ZeroByLoad(joint, driver=driver,
                            shift=_sign(rng) * 2e-4 * size / scale.load[driver - 1])


def _eccentric(rng, joint, scale, size):
    first, second = 1e-4 * size * rng.uniform(0.4, 1, 2)
    return stand.EccentricEncoder(joint, first=first, first_phase=rng.uniform(-np.pi, np.pi),
                                  second=second, second_phase=rng.uniform(-np.pi, np.pi))


def _creep(rng, joint, scale, size):
    return stand.Creep(joint, compliance=min(0.3 * size, 0.8) * scale.compliance[joint - 1],
                       time=rng.uniform(1.5, 5.0))


def _rail(rng, joint, scale, size):
    along, axis = int(rng.integers(2)), int(rng.integers(3))
    s = scale.place[:, along]
    half = max(np.ptp(s) / 2, 0.05)
    return stand.BentRail(None, along=along, axis=axis, middle=_within(rng, s, 0.2, 0.8),
                          bow=2e-4 * size * _sign(rng) / half**2,
                          skew=3e-5 * size * _sign(rng) / half**3)


def _floor(rng, joint, scale, size):
    turned = _within(rng, scale.q[:, 0], 0.3, 0.7) + _sign(rng) * np.pi / 2
    return stand.SoftFloor(None, axis=float(rng.integers(2)), side=turned,
                           tilt=3e-4 * size * _sign(rng))


def _saturation(rng, joint, scale, size):
    return sensors.ForceSaturation(None, axis=float(rng.integers(3)),
                                   limit=scale.force / np.clip(0.7 * np.sqrt(size), 0.2, 2.5))


def _crosstalk(rng, joint, scale, size):
    return sensors.ForceCrosstalk(
        None, force=float(rng.integers(3)), moment=float(rng.integers(3)),
        share=_sign(rng) * 0.2 * min(size, 4) * scale.force / max(scale.moment, 1e-9))


def _hum(rng, joint, scale, size):
    return unseen.FloorHum(None, axis=float(rng.integers(3)), amplitude=6e-5 * size,
                           frequency=rng.uniform(0.8, 3.0))


def _slip(rng, joint, scale, size):
    return unseen.SlippedPart(joint, angle=_sign(rng) * 2e-4 * size / LONGEST_LEVER)


def _moving(scale):
    return tuple(np.flatnonzero(scale.span > MOVING) + 1)


def _wound(scale):
    windup = scale.load * scale.compliance
    return tuple(np.flatnonzero(windup > 0.1 * windup.max()) + 1)


ALL = (1, 2, 3, 4, 5, 6)
CARRYING = (2, 3)  # whose torque is mostly not friction
MENU = {
    "hose": Entry(("torque",), _hose, ALL),
    "coupled_cogging": Entry(("torque",), _cogging, _moving),
    "windage": Entry(("torque",), _windage, ALL),
    "detent": Entry(("torque",), _detent, _moving, local=True),
    "soft_stop": Entry(("torque",), _stop, _moving, local=True),
    "worn_stretch": Entry(("torque",), _worn, _moving, local=True),
    "driving_friction": Entry(("torque",), _driving, ALL),
    "neighbour_friction": Entry(("torque",), _neighbour, (3, 4, 5, 6), gravity=True),
    "hot_drive": Entry(("torque",), _hot, CARRYING, gravity=True),
    "zero_by_load": Entry(("poses", "link"), _by_load, ALL),
    "eccentric_encoder": Entry(("poses", "link"), _eccentric, (1, 2, 3, 4, 5)),
    "creep": Entry(("circle", "mixed"), _creep, _wound),
    "bent_rail": Entry(("poses",), _rail),
    "soft_floor": Entry(("poses",), _floor),
    "force_saturation": Entry(("poses", "circle"), _saturation),
    "force_crosstalk": Entry(("poses",), _crosstalk),
    "floor_hum": Entry(("air", "circle"), _hum),
    "slipped_part": Entry(("air", "circle"), _slip, (1, 2, 3)),
}

# Effects of the catalogue that stand beside them, by the kind of recording: those that are numbers of
# the robot or what a sensor sees.
BESIDE = {
    "torque": ("coulomb_friction", "viscous_friction", "rotor_inertia", "torque_offset", "payload",
               "link_mass"),
    "link": ("coulomb_friction", "viscous_friction", "joint_stiffness", "torque_offset"),
    "poses": ("joint_stiffness", "joint_offset", "link_length", "tcp_offset", "wrench_bias"),
    "circle": ("joint_stiffness", "joint_offset", "wrench_scale"),
    "air": ("tcp_offset", "joint_offset"),
    "mixed": ("joint_stiffness", "coulomb_friction", "torque_offset"),
}
