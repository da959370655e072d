"""The reference circles as one finds them with SciPy and circle-fit."""

import circle_fit
import numpy as np
from scipy import optimize


def _distances(points, center):
    return np.hypot(points[:, 0] - center[0], points[:, 1] - center[1])


def _about(points, center):
    return np.ptp(_distances(points, center))


def _simplex(points, scale, objective):
    """Least value by Nelder and Mead (1965) from the centre of gravity."""
    middle = points.mean(0)
    start = middle + scale * np.array([[0, 0], [1, 0], [0, 1]])
    found = optimize.minimize(lambda center: objective(_distances(points, center)), middle, method="Nelder-Mead",
                              options={"initial_simplex": start, "xatol": 1e-12, "fatol": 1e-14, "maxiter": 1000})
    return found.fun


def least_squares(points):
    """Form error, m."""
    def error(center):
        distance = _distances(points, center)
        return distance - distance.mean()

    def slope(center):
        outward = (center - points) / _distances(points, center)[:, None]
        return outward - outward.mean(0)
    found = optimize.least_squares(error, points.mean(0), slope, method="lm", xtol=1e-14, ftol=1e-14, gtol=1e-14)
    return _about(points, found.x)


def least_squares_by_circle_fit(points):
    x, y, *_ = circle_fit.standardLSQ(points)
    return _about(points, (x, y))


SCALE = 1e-5  # m, of the first simplex


def minimum_zone(points):
    return _simplex(points, SCALE, np.ptp)


def inscribed(points):
    return -_simplex(points, SCALE, lambda distance: -distance.min())


def circumscribed(points):
    return _simplex(points, SCALE, np.max)
