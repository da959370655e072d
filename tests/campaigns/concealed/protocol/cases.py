"""A campaign's cases on disk: recordings and nominal models under names that say nothing."""

import hashlib
import importlib
import multiprocessing
import pathlib
import random
import shutil
import signal

RECORDINGS = ("train.csv", "train_2.csv", "holdout.csv", "untrained.csv")


class Unfit(Exception):
    """A case's folder holds something that must not be there, or not what must."""


def name(number):
    return f"{number:03d}"


def trainings(folder):
    return sorted(folder.glob("train*.csv"))


def files(folder):
    """{path within the folder: SHA-256} of all files of a case."""
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def _check(found):
    """Only what a case consists of; a note of the truth left behind would be found here."""
    for path in map(pathlib.PurePath, found):
        in_model = path.parent.name == "model" and path.suffix in (".yaml", ".urdf")
        if str(path) not in RECORDINGS and not in_model:
            raise Unfit(f"{path} does not belong into a case's folder")
    for needed in ("model/robot.yaml", "train.csv", "holdout.csv", "untrained.csv"):
        if needed not in found:
            raise Unfit(f"a case lacks {needed}")


def _write(task):
    drawn, folder = task
    folder.mkdir(parents=True)
    campaign = importlib.import_module("campaign")
    try:
        truth = campaign.write_case(drawn, folder)
    except campaign.case.Unsuitable:
        shutil.rmtree(folder)
        return None
    found = files(folder)
    _check(found)
    return {"files": found, "truth": truth}


def leave_signals_to_the_parent():
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # with which the pool ends them


def drawn(seed, count):
    """{name: case of the campaign}, in an order that only the seed tells."""
    order = importlib.import_module("campaign").draw(seed, count)
    random.Random(f"order of {seed}").shuffle(order)
    return {name(number): each for number, each in enumerate(order)}


def write(seed, count, folder, jobs, progress):
    """Draws the campaign and writes its cases into folder/000, 001, .... Returns {name of a case:
    {"files": …, "truth": …}}, without those of which no draw gave a fair case. The processes that
    wrote them, and with them all that knows a truth but the caller, have ended when this returns."""
    tasks = [(each, folder / label) for label, each in drawn(seed, count).items()]
    written = {}
    with multiprocessing.Pool(jobs, leave_signals_to_the_parent) as pool:
        for number, entry in enumerate(pool.imap(_write, tasks)):
            if entry:
                written[name(number)] = entry
            progress(number + 1, len(tasks))
    return written
