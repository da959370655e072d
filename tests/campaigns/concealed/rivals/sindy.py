"""PySINDy on the residual: sparse regression by sequentially thresholded least squares (STLSQ).

S. Brunton, J. Proctor, J. N. Kutz: Discovering governing equations from data by sparse
identification of nonlinear dynamical systems, PNAS 113 (2016); the library's own classes are used
as its documentation suggests: polynomials of standardised signals, a Fourier library of the joint
angles, signs of velocities as a custom library for dry friction, products of angle functions and
loads as a tensor library, columns standardised. Library, threshold, and whether the last step does
without the ridge, are chosen by validation: of all that come near the best there, the one with the
fewest terms.
"""

import itertools
import warnings

import numpy as np
import pysindy

from .features import thinned, validation_rows

ROWS = 1500
THRESHOLDS = (0.01, 0.03, 0.1, 0.3)  # of the residual's deviation, for a column of deviation 1
RIDGE = 1.0
NEAR = 1.02  # times the least squared error in validation
LOADS = ("wrench", "tau")


def _sign(velocity):
    return np.sign(velocity)  # the library wants a plain function


class _Library:
    """Candidate functions of a table, the same for training and prediction."""

    def __init__(self, table, degree, products):
        self._mean = {name: values.mean(0) for name, values in table.columns.items()}
        self._deviation = {name: np.where(values.std(0) > 0, values.std(0), 1.0)
                           for name, values in table.columns.items()}
        self._degree = degree
        self._products = products
        self._centre = self._spread = None
        raw = self._functions(table)
        self._centre, self._spread = raw.mean(0), raw.std(0)
        self._changes = self._spread > 1e-9

    def _standard(self, table, name):
        return (table.columns[name] - self._mean[name]) / self._deviation[name]

    def _functions(self, table):
        names = [name for name in table.columns if name != "acceleration"]
        standard = np.concatenate([self._standard(table, name) for name in names], axis=1)
        polynomials = pysindy.PolynomialLibrary(degree=self._degree, include_bias=False)
        fourier = pysindy.FourierLibrary(n_frequencies=2)
        found = [polynomials.fit_transform(standard), fourier.fit_transform(table.columns["angle"])]
        if "acceleration" in table.columns:
            found.append(self._standard(table, "acceleration"))
        if "velocity" in table.columns:
            signs = pysindy.CustomLibrary([_sign])
            found.append(signs.fit_transform(table.columns["velocity"]))
        loads = [self._standard(table, name) for name in LOADS if name in table.columns]
        if self._products and loads:
            found.append(self._angle_by_load(table.columns["angle"], np.concatenate(loads, axis=1)))
        return np.concatenate([np.asarray(each) for each in found], axis=1)

    @staticmethod
    def _angle_by_load(angle, loads):
        """Products of sines and cosines of angles with loads."""
        both = np.concatenate([angle, loads], axis=1)
        first, second = range(angle.shape[1]), range(angle.shape[1], both.shape[1])
        library = pysindy.GeneralizedLibrary(
            [pysindy.FourierLibrary(n_frequencies=1), pysindy.IdentityLibrary()],
            tensor_array=[[1, 1]], inputs_per_library=[list(first), list(second)])
        return library.fit_transform(both)

    def __call__(self, table):
        return ((self._functions(table) - self._centre) / np.where(self._changes, self._spread, 1.0)
                )[:, self._changes]


def _fit(functions, target, threshold, unbias):
    """Coefficients of the standardised functions (n, k)."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that a threshold leaves nothing is an answer too
        optimizer = pysindy.STLSQ(threshold=threshold, alpha=RIDGE, unbias=unbias)
        optimizer.fit(functions, target[:, None])
    return optimizer.coef_[0]


def learn(table, target):
    """target (n,) -> function of a Table: its prediction (n,)."""
    rows = thinned(np.arange(len(target)), ROWS)
    table, target = table.take(rows), target[rows]
    mean, scale = target.mean(), target.std() or 1.0
    target = (target - mean) / scale
    held = validation_rows(table.stretch)
    tried = []  # (squared error, terms, library, functions, strength)
    for degree, products in ((1, False), (2, True)):
        library = _Library(table, degree, products)
        functions = library(table)
        for strength in itertools.product(THRESHOLDS, (False, True)):
            weights = _fit(functions[~held], target[~held], *strength)
            error = np.mean((target[held] - functions[held] @ weights) ** 2)
            tried.append((error, np.count_nonzero(weights), library, functions, strength))
    least = min(entry[0] for entry in tried)
    near = [entry for entry in tried if entry[0] <= NEAR * least]
    *_, library, functions, strength = min(near, key=lambda entry: entry[1])
    weights = _fit(functions, target, *strength)
    return lambda other: mean + scale * (library(other) @ weights)
