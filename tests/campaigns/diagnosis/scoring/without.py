"""One effect is left out of the catalogue: how well laws make up for it."""

import dataclasses
import json
import multiprocessing
import shutil
import subprocess

from generator import case

from . import trial

WORSE = 2.0  # times the held-out error with the effect, up to which a law makes up for it
LAW_SECONDS = "40"
SHARE = 0.7  # of the cases in which it shall


@dataclasses.dataclass
class Pair:
    """A case's held-out errors over the noise with the effect in the catalogue and without it."""

    seed: int
    kind: str
    place: str
    with_it: float
    without_it: float
    laws: list  # "joint_torque 5: a*q4"
    is_placed: bool  # some law is at the joint of what is concealed, or that has none

    @property
    def is_made_up_for(self):
        return self.without_it <= WORSE * self.with_it


def seeds(effect, first, count):
    """The first seeds whose single cases conceal the effect."""
    found, seed = [], first
    while len(found) < count:
        if case.SINGLES[seed * 29 % len(case.SINGLES)][0] == effect:
            found.append(seed)
        seed += 1
    return found


def _answer(task, truth, out, words):
    shutil.rmtree(out, ignore_errors=True)
    command = trial.command(task.tool, task.folder, truth, out) + words
    done = subprocess.run(command, capture_output=True, text=True, timeout=task.limit,
                          stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise RuntimeError(f"seed {task.seed}: {done.stderr.strip()}")
    return json.loads((out / "diagnosis.json").read_text())


def _error(answer, truth):
    return max(answer["final"][channel]["holdout_rms"] / noise
               for channel, noise in truth["noise_rms"].items() if channel in answer["final"])


def compare(task):
    """Pair of a trial and the effect's name, or None where its seed gives no case of it."""
    own, effect = task
    try:
        truth = trial.prepare("single", own.seed, own.folder, own.digest)
    except case.NoCase:
        return None
    concealed = truth["effects"][0]
    if concealed["effect"] != effect:
        return None
    whole = _answer(own, truth, own.folder / "with", [])
    less = _answer(own, truth, own.folder / "without", ["--without", effect, "--law-seconds", LAW_SECONDS])
    laws = [finding for finding in less["findings"] if finding["effect"] == "law"]
    return Pair(own.seed, truth["kind"], f"{effect} {concealed['joint'] or ''}".strip(),
                _error(whole, truth), _error(less, truth),
                [f"{law['place']} {law['joint'] or law.get('axis') or ''}: {law['formula']}"
                 for law in laws],
                any(concealed["joint"] in (None, law["joint"]) for law in laws))


def score(options, folder):
    """Prints a row a case; exit code 1 where laws make up for too few."""
    digest = trial.generator_digest()
    tasks = [(trial.Trial(options.tool.resolve(), "single", seed, folder / f"without-{seed}", digest,
                          options.limit, True), options.without)
             for seed in seeds(options.without, options.seed, options.single)]
    with multiprocessing.Pool(options.jobs) as pool:
        pairs = [pair for pair in pool.imap(compare, tasks) if pair]
    for pair in pairs:
        print(f"{pair.seed:8} {pair.kind:7} {pair.place:22} {pair.with_it:7.2f} {pair.without_it:7.2f}  "
              + ("; ".join(pair.laws) or "no law"))
    made_up = sum(pair.is_made_up_for for pair in pairs)
    print(f"\nheld-out error at most {WORSE:g} times as large: {made_up} of {len(pairs)}; a law at the "
          f"right joint: {sum(pair.is_placed for pair in pairs)} of {len(pairs)}")
    return 0 if made_up >= SHARE * len(pairs) else 1
