"""`flexcomp diagnose` beside PySINDy on the same recording: rows a second."""

import functools
import json
import os
import pathlib
import statistics
import sys
import tempfile

import numpy as np
import pysindy

from ..programs import BIN, SOURCE, on_one_core, run
from ..result import Curve, Figure, Ratio, Topic

CAMPAIGNS = SOURCE / "tests" / "campaigns"
sys.path[:0] = [str(CAMPAIGNS / "concealed"), str(CAMPAIGNS / "diagnosis"), str(CAMPAIGNS)]
from generator import case  # noqa: E402
from rivals import black_box, contest, features, simulation, sindy  # noqa: E402

SEED = 5  # a machine that moves in contact: positions and torques, one concealed effect
ROWS = (1000, 2000, 4000)
FLEXCOMP, SEARCHED, SINGLE = "flexcomp diagnose", "PySINDy, library and threshold chosen", "PySINDy, one fit"


def _processor_time():
    """CPU time of this process and the programs that it ran, s."""
    spent = os.times()
    return spent.user + spent.system + spent.children_user + spent.children_system


def _seconds(work, repetitions):
    times = []
    for _ in range(repetitions):
        begin = _processor_time()
        work()
        times.append(_processor_time() - begin)
    return statistics.median(times)


def _diagnose(model, recording, out):
    run(BIN / "flexcomp", "diagnose", "--model", model, "--recording", recording, "--out", out,
        preexec_fn=on_one_core)


def _search(data):
    """As a rival in the blind proof: a library and a threshold by validation, for each component."""
    sindy.ROWS = len(data.recording.time)
    for channel in data.residual:
        black_box.learnt(sindy.learn, [data], channel)


def _fit_once(data):
    """Without any choice: products of two signals, one threshold, all components of a channel at once."""
    for channel, residual in data.residual.items():
        rows = data.usable[channel].all(axis=1)
        library = pysindy.PolynomialLibrary(degree=2, include_bias=False)
        signals = _standard(features.table(data.recording, channel).matrix[rows])
        functions = _standard(np.asarray(library.fit_transform(signals)))
        pysindy.STLSQ(threshold=0.01, alpha=1.0).fit(functions, _standard(residual[rows]))


def _standard(columns):
    """Mean 0, deviation 1; what does not change stays."""
    return (columns - columns.mean(0)) / np.where(columns.std(0) > 0, columns.std(0), 1)


def _measure_rows(folder, recording, repetitions):
    """{method: s}"""
    simulate = functools.partial(simulation.simulate, BIN / "flexcomp", folder / "robot.yaml")
    data = contest.Data.load(recording, simulate)
    return {FLEXCOMP: _seconds(lambda: _diagnose(folder / "robot.yaml", recording, folder / "out"), repetitions),
            SEARCHED: _seconds(lambda: _search(data), 1),
            SINGLE: _seconds(lambda: _fit_once(data), repetitions)}


def measure(repetitions):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        truth = case.write("single", SEED, folder)
        lines = (folder / truth["recordings"][0]).read_text().splitlines(keepends=True)
        counts = [*ROWS, len(lines) - 1]
        seconds = {}
        for count in counts:
            part = folder / f"part_{count}.csv"
            part.write_text("".join(lines[:count + 1]))
            seconds[count] = _measure_rows(folder, part, repetitions)
        verdict = json.loads((folder / "out" / "diagnosis.json").read_text())
    most = counts[-1]
    concealed, found = truth["effects"][0], verdict["findings"]
    named = f"{found[0]['effect']} at joint {found[0]['joint']}" if found else "nothing"
    return Topic(
        f"Diagnosis of one recording, {most:,} rows",
        [Figure(method, most / took, "rows/s") for method, took in seconds[most].items()],
        [Ratio(f"flexcomp / {other}", seconds[most][other] / seconds[most][FLEXCOMP]) for other in (SEARCHED, SINGLE)],
        [Curve(method, [[count, seconds[count][method]] for count in counts]) for method in seconds[most]],
        ("rows of the recording", "time, s"),
        [f"Concealed was {concealed['effect']} at joint {concealed['joint']}; flexcomp names {named}. PySINDy is "
         "given the residual of the simulation and returns a prediction of it; the time of that simulation, and "
         "of loading its libraries, is not counted. flexcomp's time is that of the whole command, report and "
         "pictures included."])
