"""A Gaussian process on the residual: squared-exponential kernel, a length for each input, noise.

C. E. Rasmussen, C. K. I. Williams: Gaussian Processes for Machine Learning (2006), ch. 5: the
lengths by marginal likelihood on few rows, the prediction from more.
"""

import warnings

import numpy as np
from scipy.optimize import minimize
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

from .features import thinned

ROWS_FOR_LENGTHS, ROWS = 200, 600
ITERATIONS = 25
PREDICTED_AT_A_TIME = 1000


def _descend(objective, start, bounds):
    found = minimize(objective, start, jac=True, bounds=bounds, method="L-BFGS-B",
                     options={"maxiter": ITERATIONS})
    return found.x, found.fun


def _fit(kernel, inputs, target, optimizer):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a length at its bound means an input that does not matter
        return GaussianProcessRegressor(kernel, optimizer=optimizer).fit(inputs, target)


def learn(table, target):
    """target (n,) -> function of a Table: its prediction (n,)."""
    mean, spread = table.matrix.mean(0), table.matrix.std(0)
    changes = spread > 1e-12
    zero, scale = target.mean(), target.std() or 1.0

    def standard(other, rows=slice(None)):
        return ((other.matrix[rows] - mean)[:, changes]) / spread[changes]

    kernel = (ConstantKernel(1.0, (1e-3, 1e3)) * RBF(np.full(changes.sum(), 3.0), (0.1, 1e3))
              + WhiteKernel(0.1, (1e-5, 2.0)))
    few, many = (thinned(np.arange(len(target)), most) for most in (ROWS_FOR_LENGTHS, ROWS))
    kernel = _fit(kernel, standard(table, few), (target[few] - zero) / scale, _descend).kernel_
    model = _fit(kernel, standard(table, many), (target[many] - zero) / scale, None)

    def predict(other):
        inputs = standard(other)
        pieces = [model.predict(inputs[k:k + PREDICTED_AT_A_TIME])
                  for k in range(0, len(inputs), PREDICTED_AT_A_TIME)]
        return zero + scale * np.concatenate(pieces)
    return predict
