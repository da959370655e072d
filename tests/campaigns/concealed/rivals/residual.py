"""The residual of a simulation, and how large it is."""

import numpy as np

STRETCHES = 20
OUTLIER = 8.0  # times the robust deviation from the neighbours
DEVIATION_OF_MEDIAN = 1.4826  # standard deviation / median absolute one, normal distribution


def residuals(measured, simulated):
    """{channel: (n, columns)}: measured − simulated, where both are."""
    return {channel: values - simulated[channel] for channel, values in measured.items()
            if channel in simulated}


def outliers(values):
    """Which samples (n, columns) stand alone, far from the two before and the two after them that
    are there. Steps and slow changes do not: they have neighbours."""
    found = np.zeros(values.shape, bool)
    for column, alone in zip(values.T, found.T):
        rows = np.flatnonzero(np.isfinite(column))
        if len(rows) < 5:
            continue
        padded = np.pad(column[rows], 2, mode="reflect")
        around = np.lib.stride_tricks.sliding_window_view(padded, 5)
        distance = np.abs(column[rows] - np.median(around, axis=1))
        typical = DEVIATION_OF_MEDIAN * np.median(distance)
        alone[rows] = distance > OUTLIER * max(typical, np.finfo(float).tiny)
    return found


def usable(values, is_static):
    """The samples that count: there, and no outliers. Rows of a load test have no neighbours."""
    there = np.isfinite(values)
    return there if is_static else there & ~outliers(values)


def rms(values, chosen):
    """Over the chosen samples, all components taken as scalars; None where there are none."""
    samples = values[chosen]
    return float(np.sqrt(np.mean(samples**2))) if samples.size else None


def rms_by_stretch(values, chosen):
    """rms of each twentieth of the rows, for what is chance in a comparison; without empty ones."""
    stretches = [rms(*both) for both in zip(np.array_split(values, STRETCHES),
                                            np.array_split(chosen, STRETCHES))]
    return [each for each in stretches if each is not None]
