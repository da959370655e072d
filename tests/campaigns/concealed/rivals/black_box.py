"""The common part of all black boxes: a regression for each component of a channel's residual."""

import numpy as np

from . import features


def _nothing(table):
    return np.zeros(len(table.stretch))


def learnt(learn, trainings, channel):
    """learn: (Table, target (n,)) -> function of a Table; trainings: of contest.Data. Returns a
    function of a Recording: the predicted residual (n, components of the channel)."""
    table = features.join([features.table(data.recording, channel) for data in trainings])
    target = np.concatenate([data.residual[channel] for data in trainings])
    usable = np.concatenate([data.usable[channel] for data in trainings])
    components = []
    for values, good in zip(target.T, usable.T):
        rows = np.flatnonzero(good)
        enough = len(rows) >= features.STRETCHES
        components.append(learn(table.take(rows), values[rows]) if enough else _nothing)

    def predict(recording):
        other = features.table(recording, channel).only(table.columns)
        return np.column_stack([each(other) for each in components])
    return predict
