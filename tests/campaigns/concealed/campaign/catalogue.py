"""Which physics is concealed in which kind of recording, at which joints, and how large.

Each entry draws a concealed effect from what the unchanged robot does in the recording (Scale);
`size` multiplies what makes it strong, up to what a real robot would show.
"""

import dataclasses

import numpy as np

from plant.effects import EFFECTS, FOREIGN

LEAST_PERIODS = 3  # of a ripple, in a recording


@dataclasses.dataclass
class Scale:
    """The largest of what each joint of the unchanged robot does in the recordings."""

    kind: str
    description: object
    load: np.ndarray  # (6,) N·m in the spring
    load_range: np.ndarray  # (6, 2) N·m, least and most
    torque: np.ndarray  # (6,) N·m
    speed: np.ndarray  # (6,) rad/s
    span: np.ndarray  # (6,) rad
    force: float  # N
    duration: float  # s
    modes: dict  # joint -> (Hz, direction) of modes in which next to nothing but it winds up

    @property
    def compliance(self):
        return self.description.column("compliance")

    def share_of_rating(self, joint, size, share):
        """N·m: a few percent of what the motor can give times size, share of it at most."""
        rating = self.description.joints[joint - 1].effort
        return rating * min(0.01 * size, share)


@dataclasses.dataclass
class Entry:
    """How an effect is concealed. draw(rng, joint, scale, size) gives the Effect.

    joints: those it may sit at, or a function of the Scale; gravity: needs weight; local: acts only
    now and then; slow: needs slow motion."""

    kinds: tuple
    draw: object
    joints: object = (None,)
    gravity: bool = False
    local: bool = False
    slow: bool = False


def _direction(rng):
    vector = rng.normal(size=3)
    return vector / np.linalg.norm(vector)


def _named(names, values):
    return {name: float(value) for name, value in zip(names, values)}


def _sign(rng):
    return float(rng.choice([-1, 1]))


def _any(scale):
    return (1, 2, 3, 4, 5, 6)


def _loaded(scale):
    """Joints whose wind-up moves the TCP or link encoder by something."""
    return tuple(np.flatnonzero(scale.load * scale.compliance > 1e-4) + 1) or (2,)


def _reversing(scale):
    """Joints whose load goes well to both sides."""
    low, high = scale.load_range.T
    to_both = np.minimum(-low, high) > 0.3 * np.maximum(-low, high)
    strong = scale.load * scale.compliance > 5e-5
    return tuple(np.flatnonzero(to_both & strong) + 1)


def _ringing(scale):
    """The joint of the lowest mode, if nothing else takes part in it."""
    return (min(scale.modes, key=lambda joint: scale.modes[joint][0]),) if scale.modes else ()


def _moving(scale):
    return tuple(np.flatnonzero(scale.span > 0.06) + 1)


def _stiffness(rng, joint, scale, size):
    known = scale.compliance[joint - 1]
    change = min(size * 0.3, 1.0)
    return EFFECTS["joint_stiffness"](joint, compliance_change=known * max(change, -0.6))


def _nonlinear(rng, joint, scale, size):
    known, load = scale.compliance[joint - 1], scale.load[joint - 1]
    # A share of the wind-up under the largest load, hardening or softening.
    share = min(0.12 * size, 0.2) * (-1 if rng.random() < 0.7 else 1)
    return EFFECTS["nonlinear_stiffness"](joint, cubic_compliance=share * known / load**2)


def _backlash(rng, joint, scale, size):
    hold = rng.uniform(0.015, 0.04) * scale.load[joint - 1]
    return EFFECTS["backlash"](joint, gap=min(1.5e-4 * size, 8e-4), hold=hold)


def _hysteresis(rng, joint, scale, size):
    windup = scale.load[joint - 1] * scale.compliance[joint - 1]
    share = min(0.15 * size, 0.4)
    return EFFECTS["hysteresis"](joint, amplitude=share * windup,
                                 slip=rng.uniform(0.1, 0.25) * windup)


def _order(rng, joint, scale, fastest):
    """Periods a turn, enough of them to be seen, not so many that they shake the arm."""
    least = LEAST_PERIODS * 2 * np.pi / scale.span[joint - 1]
    most = max(fastest / max(scale.speed[joint - 1], 1e-6), least)
    return float(np.clip(np.round(rng.uniform(least, min(most, 3 * least))), 2, 320))


def _gear_ripple(rng, joint, scale, size):
    return EFFECTS["transmission_ripple"](joint, amplitude=min(3e-5 * size, 4e-4),
                                          order=_order(rng, joint, scale, 6.0),
                                          phase=rng.uniform(-np.pi, np.pi))


def _torque_ripple(rng, joint, scale, size):
    return EFFECTS["torque_ripple"](joint, amplitude=scale.share_of_rating(joint, size, 0.03),
                                    order=_order(rng, joint, scale, 40.0),
                                    phase=rng.uniform(-np.pi, np.pi))


def _lag(rng, joint, scale, size):
    return EFFECTS["servo_lag"](joint, time_constant=min(8e-3 * size, 0.08))


def _resonance(rng, joint, scale, size):
    frequency, direction = scale.modes[joint]
    return EFFECTS["resonance"](joint, frequency, rng.uniform(0.02, 0.04), 20 * size * direction)


def _base(rng, joint, scale, size):
    shift, turn = 3e-8 * size * rng.uniform(0.5, 1, 3), 4e-8 * size * rng.uniform(0.3, 1, 2)
    return EFFECTS["base_compliance"](None, **_named("xyz", shift), **_named(("rx", "ry"), turn))


def _tool(rng, joint, scale, size):
    return EFFECTS["tool_compliance"](None, **_named("xyz", 1e-7 * size * rng.uniform(0.4, 1, 3)))


def _link(rng, joint, scale, size):
    joint_axis = scale.description.joints[joint - 1].axis
    across = [axis for axis in range(3) if abs(joint_axis[axis]) < 0.5]
    bends = {f"bending_{'xyz'[axis]}": 1e-7 * size * float(rng.uniform(0.4, 1)) for axis in across}
    return EFFECTS["link_flexibility"](joint, **bends)


def _payload(rng, joint, scale, size):
    mass = 0.3 * scale.description.payload_mass * min(size, 4)
    place = scale.description.payload_center + rng.uniform(-0.05, 0.05, 3)
    return EFFECTS["payload"](None, mass=mass, **_named(("mx", "my", "mz"), mass * place))


def _link_mass(rng, joint, scale, size):
    body = scale.description.joints[joint - 1].body
    mass = min(0.15 * size, 0.6) * body.mass
    if rng.random() < 0.5:
        return EFFECTS["link_mass"](joint, mass=mass)
    place = body.center + rng.uniform(-0.15, 0.15, 3)
    return EFFECTS["link_mass"](joint, mass=mass, **_named(("mx", "my", "mz"), mass * place))


def _balancer(rng, joint, scale, size):
    far, near = rng.uniform(0.5, 0.8), rng.uniform(0.2, 0.35)
    free = far - near - rng.uniform(0.0, 0.1)
    stiffness = 0.25 * size * scale.load[joint - 1] / (far * near)
    return EFFECTS["gravity_compensator"](joint, far, near, stiffness, free,
                                          np.pi / 2 + rng.uniform(-0.3, 0.3))


def _offset(rng, joint, scale, size):
    return EFFECTS["joint_offset"](joint, offset=_sign(rng) * min(1e-4 * size, 3e-3))


def _length(rng, joint, scale, size):
    return EFFECTS["link_length"](joint, length=_sign(rng) * min(2e-4 * size, 5e-3))


def _tcp(rng, joint, scale, size):
    return EFFECTS["tcp_offset"](None, **_named("xyz", min(2e-4 * size, 5e-3) * _direction(rng)))


def _drift(rng, joint, scale, size):
    shift = _named("xyz", 3e-5 * size * _direction(rng))
    if rng.random() < 0.4:
        shift = {name: 5 * value for name, value in shift.items()}
        shift["time_constant"] = rng.uniform(0.3, 0.8) * scale.duration
    return EFFECTS["thermal_drift"](None, **shift)


def _wrench_bias(rng, joint, scale, size):
    force = 0.05 * size * scale.force * _direction(rng)
    moment = 0.005 * size * scale.force * _direction(rng)
    return EFFECTS["wrench_bias"](None, **_named(("fx", "fy", "fz"), force),
                                  **_named(("mx", "my", "mz"), moment))


def _wrench_scale(rng, joint, scale, size):
    return EFFECTS["wrench_scale"](None, gain_error=max(_sign(rng) * 0.1 * min(size, 5), -0.5))


def _wrench_frame(rng, joint, scale, size):
    return EFFECTS["wrench_frame"](None, **_named(("rx", "ry", "rz"),
                                                  min(0.1 * size, 0.6) * _direction(rng)))


def _late(rng, joint, scale, size):
    groups = {"circle": ("xyz", "wrench"), "air": ("xyz",), "torque": ("tau",),
              "link": ("q_link", "tau")}
    delay = _sign(rng) * 4e-3 * min(size, 15)
    return EFFECTS["time_offset"](str(rng.choice(groups[scale.kind])), delay)


def _coulomb(rng, joint, scale, size):
    return EFFECTS["coulomb_friction"](joint, torque=scale.share_of_rating(joint, size, 0.06))


def _viscous(rng, joint, scale, size):
    return EFFECTS["viscous_friction"](
        joint, coefficient=scale.share_of_rating(joint, size, 0.08) / scale.speed[joint - 1])


def _stribeck(rng, joint, scale, size):
    return EFFECTS["stribeck_friction"](joint, excess=scale.share_of_rating(joint, size, 0.05),
                                        speed=rng.uniform(0.1, 0.3) * scale.speed[joint - 1])


def _rotor(rng, joint, scale, size):
    return EFFECTS["rotor_inertia"](
        joint, inertia=min(0.5 * size, 3.0) * scale.description.joints[joint - 1].rotor_inertia)


def _torque_offset(rng, joint, scale, size):
    return EFFECTS["torque_offset"](joint,
                                    torque=_sign(rng) * scale.share_of_rating(joint, size, 0.06))


ELASTIC = ("circle", "static", "link", "mixed")
TORQUE = ("torque", "link", "mixed")
SINGLE = {
    "joint_stiffness": Entry(ELASTIC, _stiffness, _loaded),
    "nonlinear_stiffness": Entry(("circle", "static", "link"), _nonlinear, _loaded),
    "backlash": Entry(("circle", "static", "link"), _backlash, _reversing),
    "hysteresis": Entry(("circle", "static", "link"), _hysteresis, _reversing),
    "link_flexibility": Entry(("circle", "static"), _link, (2, 3, 4)),
    "base_compliance": Entry(("circle", "static", "mixed"), _base),
    "tool_compliance": Entry(("circle", "static", "mixed"), _tool),
    "payload": Entry(("torque", "link", "static"), _payload, gravity=True),
    "gravity_compensator": Entry(("torque", "mixed", "static"), _balancer, (2,), gravity=True),
    "joint_offset": Entry(("circle", "air", "link", "static"), _offset, _any),
    "link_length": Entry(("air", "circle", "static"), _length, (2, 3, 4, 5)),
    "transmission_ripple": Entry(("air", "circle", "link", "mixed"), _gear_ripple, _moving),
    "thermal_drift": Entry(("circle", "air"), _drift),
    "servo_lag": Entry(("air", "torque"), _lag, (None, 1, 2, 3, 4, 5, 6)),
    "resonance": Entry(("circle",), _resonance, _ringing),
    "wrench_bias": Entry(("circle", "static"), _wrench_bias),
    "wrench_scale": Entry(("circle", "static", "mixed"), _wrench_scale),
    "wrench_frame": Entry(("circle", "static", "mixed"), _wrench_frame),
    "time_offset": Entry(("circle", "air", "torque", "link"), _late),
    "tcp_offset": Entry(("air", "circle", "static"), _tcp),
    "coulomb_friction": Entry(TORQUE, _coulomb, _any),
    "viscous_friction": Entry(("torque", "link"), _viscous, _any),
    "stribeck_friction": Entry(("torque", "link"), _stribeck, _any, local=True, slow=True),
    "rotor_inertia": Entry(("torque", "link"), _rotor, _any),
    "torque_ripple": Entry(TORQUE, _torque_ripple, _any),
    "link_mass": Entry(("torque", "link", "mixed"), _link_mass, (2, 3, 4), gravity=True),
    "torque_offset": Entry(TORQUE, _torque_offset, _any),
}


def _hose(rng, joint, scale, size):
    return FOREIGN["dress_pack"](4, stiffness=1500 * size, slack=rng.uniform(0.7, 0.9),
                                 friction=60 * size)


def _loose(rng, joint, scale, size):
    return FOREIGN["loose_payload"](None, play=0.03 * size)


def _coupling(rng, joint, scale, size):
    return FOREIGN["wrist_coupling"](6, ratio=_sign(rng) * 3e-3 * size)


def _shaking(rng, joint, scale, size):
    return FOREIGN["floor_vibration"](None, amplitude=6e-5 * size, frequency=rng.uniform(2, 4))


def _jump(rng, joint, scale, size):
    return FOREIGN["tracker_jump"](None, size=1e-4 * size)


def _fluid(rng, joint, scale, size):
    return FOREIGN["cutting_fluid"](None, force=60 * size)


def _saturation(rng, joint, scale, size):
    share = np.clip(1 - 0.25 * size, 0.3, 0.9)
    return FOREIGN["torque_limit"](joint, limit=share * scale.torque[joint - 1])


def _load_friction(rng, joint, scale, size):
    return FOREIGN["load_friction"](joint, share=0.05 * size)


ODD = {
    "dress_pack": Entry(("torque", "link"), _hose),
    "loose_payload": Entry(("torque",), _loose, gravity=True, local=True),
    "wrist_coupling": Entry(("air", "circle", "link"), _coupling, (6,)),
    "floor_vibration": Entry(("air", "circle"), _shaking, local=True),
    "tracker_jump": Entry(("circle", "air", "static"), _jump),
    "cutting_fluid": Entry(("circle",), _fluid, local=True),
    "torque_limit": Entry(("torque",), _saturation, (1, 2, 3), local=True),
    "load_friction": Entry(("torque",), _load_friction, _reversing, gravity=True),
}
