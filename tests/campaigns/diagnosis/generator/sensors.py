"""Errors that sensors add to the truth: noise, steps of an encoder, gaps, spikes."""

import dataclasses

import numpy as np


@dataclasses.dataclass
class Quality:
    """Sensors of one robot cell; drawn once a case."""

    position_noise: float  # m, laser tracker, each axis
    torque_noise: float  # share of a joint's largest torque
    force_noise: float  # N
    moment_noise: float  # N·m
    encoder_step: float  # rad at the joint
    link_noise: float  # rad
    missing: float  # share of measured positions that lack
    spikes: float  # share of measured positions that are far off
    uneven: bool
    link_encoders: np.ndarray  # (6,) bool, joints that have one


def draw_quality(rng):
    return Quality(
        position_noise=rng.uniform(10e-6, 30e-6), torque_noise=rng.uniform(0.01, 0.02),
        force_noise=rng.uniform(0.3, 1.5), moment_noise=rng.uniform(0.03, 0.15),
        encoder_step=2 * np.pi / 2 ** rng.integers(24, 28), link_noise=rng.uniform(2e-6, 5e-6),
        missing=rng.uniform(0.005, 0.04) if rng.random() < 0.35 else 0.0,
        spikes=rng.uniform(0.001, 0.005) if rng.random() < 0.3 else 0.0,
        uneven=rng.random() < 0.25,
        link_encoders=rng.random(6) < 0.8 if rng.random() < 0.5 else np.ones(6, bool))


def noise_levels(quality, signals):
    """Standard deviation of the noise of each group, a column each."""
    levels = {}
    if "xyz" in signals:
        levels["xyz"] = np.full(3, quality.position_noise)
    if "tau" in signals:
        peak = np.abs(signals["tau"]).max(0)
        levels["tau"] = quality.torque_noise * np.maximum(peak, 0.01 * peak.max())
    if "q_link" in signals:
        levels["q_link"] = np.full(6, quality.link_noise)
    return levels


def add_noise(rng, quality, signals, levels):
    """The same signals as the sensors show them."""
    shown = dict(signals)
    for group, level in levels.items():
        shown[group] = signals[group] + level * rng.normal(size=signals[group].shape)
    if "wrench" in signals:
        level = np.array([quality.force_noise] * 3 + [quality.moment_noise] * 3)
        shown["wrench"] = signals["wrench"] + level * rng.normal(size=signals["wrench"].shape)
    if "q_meas" in signals:
        shown["q_meas"] = np.round(signals["q_meas"] / quality.encoder_step) * quality.encoder_step
    if "q_link" in signals:
        shown["q_link"][:, ~quality.link_encoders] = np.nan
    if "xyz" in signals:
        shown["xyz"] = _gaps(rng, quality, _spikes(rng, quality, shown["xyz"]))
    return shown


def _spikes(rng, quality, values):
    hit = rng.random(len(values)) < quality.spikes
    far = rng.uniform(0.3e-3, 3e-3, (len(values), 3)) * rng.choice([-1, 1], (len(values), 3))
    return values + hit[:, None] * far


def _gaps(rng, quality, values):
    """Single samples lack, and one stretch in which the beam was broken."""
    if not quality.missing:
        return values
    values = values.copy()
    n = len(values)
    values[rng.random(n) < 0.5 * quality.missing] = np.nan
    length = int(0.5 * quality.missing * n)
    begin = rng.integers(0, n - length)
    values[begin:begin + length] = np.nan
    return values
