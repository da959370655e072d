"""Gradient boosting of regression trees on the residual (scikit-learn's histogram version)."""

import numpy as np
from sklearn.ensemble import HistGradientBoostingRegressor

from .features import thinned, validation_rows

ROWS = 4000
MOST_TREES = 150
LEAVES = (6, 20)  # of a tree; the number of trees is chosen along with it


def _trees(count, leaves, samples):
    return HistGradientBoostingRegressor(
        max_iter=count, max_leaf_nodes=leaves, learning_rate=0.1, l2_regularization=1.0,
        min_samples_leaf=min(20, max(3, samples // 20)), early_stopping=False, random_state=0)


def learn(table, target):
    """target (n,) -> function of a Table: its prediction (n,)."""
    rows = thinned(np.arange(len(target)), ROWS)
    inputs, target, stretch = table.matrix[rows], target[rows], table.stretch[rows]
    scale = target.std() or 1.0
    held = validation_rows(stretch)
    best = None
    for leaves in LEAVES:
        model = _trees(MOST_TREES, leaves, len(rows)).fit(inputs[~held], target[~held] / scale)
        errors = [np.mean((target[held] / scale - predicted) ** 2)
                  for predicted in model.staged_predict(inputs[held])]
        count = int(np.argmin(errors)) + 1
        if best is None or errors[count - 1] < best[0]:
            best = errors[count - 1], leaves, count
    _, leaves, count = best
    model = _trees(count, leaves, len(rows)).fit(inputs, target / scale)
    return lambda other: scale * model.predict(other.matrix)
