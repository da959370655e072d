"""One blind campaign from its seed to its report: `tools/concealed`."""

import concurrent.futures
import dataclasses
import hashlib
import json
import shlex
import signal
import sys

from scoring import figures

from . import (arguments, cases, goals, judging, loops, report, sandbox, seal, trial, watch,
               wording, workers)

OURS = (arguments.TOLD, "cases", "answers", seal.SEALED, seal.HASH, seal.OPENED, seal.KEY,
        "report.html", "scores.json")


class Void(Exception):
    """The campaign proves nothing; says why."""


def _tell(folder, words):
    (folder / arguments.TOLD).write_text(words + "\n")


def _watched(path):
    """(Watch or None, why there is none)."""
    try:
        return watch.Watch(path), ""
    except watch.Unwatchable as error:
        return None, str(error)


def _check_untouched(watcher, running):
    seen = watcher.seen() if watcher else []
    if seen:
        raise Void(f"the sealed truth was {', '.join(seen)} while diagnoses ran"
                   + (f" (among them case {', '.join(sorted(running))})" if running else ""))


def _run_all(options, way, names, watcher):
    """Every case, before the truth is known. Raises Void once somebody touches the sealed file."""
    progress = workers.Progress("diagnosed")
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        waiting = {pool.submit(trial.run, way, options.out / "cases" / name,
                               options.out / "answers" / name): name for name in names}
        try:
            for number, done in enumerate(concurrent.futures.as_completed(waiting), 1):
                done.result()
                _check_untouched(watcher, [waiting[done]])
                progress(number, len(waiting))
            _check_untouched(watcher, [])
        except BaseException:
            way.sandbox.stop()
            pool.shutdown(wait=True, cancel_futures=True)
            raise


def check_contests(answers, names):
    """The rivals must have run, or what they would have said is missing without a word."""
    silent = {}
    for name in names:
        contest = json.loads((answers / name / "contest.json").read_text())
        if contest["code"] != 0:
            silent[name] = contest["last_words"] or "not done in time"
    if len(silent) == len(names):
        raise Void(f"the rivals ran in no case: {silent[names[0]]}")
    for name, words in silent.items():
        print(f"Case {name} has no rivals: {words}")


def _check_files(truths, folder):
    for name, entry in truths.items():
        if cases.files(folder / name) != entry["files"]:
            raise Void(f"the files of case {name} were altered")


def _command(options):
    words = ["tools/concealed", "--seed", str(options.seed), "--cases", str(options.cases)]
    words += ["--no-rivals"] * options.no_rivals + ["--no-loop"] * options.no_loop
    words += ["--toolboxes"] * options.toolboxes
    return shlex.join(words)


def _as_json(thing):
    if isinstance(thing, figures.Rate):
        return thing.as_json()
    if dataclasses.is_dataclass(thing):
        return dataclasses.asdict(thing)
    raise TypeError(type(thing))


def _write(options, scored, found, facts):
    goal_rows = [{"goal": goal.figure, "limit": goal.limit, "at_least": goal.at_least, "met": met}
                 for goal, _, met in goals.judged(found)]
    text = {"campaign": facts, "goals": goal_rows, "figures": found, "cases": scored}
    (options.out / "scores.json").write_text(json.dumps(text, indent=1, default=_as_json) + "\n")
    page = report.html(scored, found, facts, options.out / "answers")
    (options.out / "report.html").write_text(page)


def _print(options, scored, found):
    words = {True: "holds", False: "MISSED", None: "-"}
    print()
    for goal, figure, met in goals.judged(found):
        print(f"{words[met]:<7} {goal.figure} {wording.limit_text(goal)}: "
              f"{wording.figure_text(figure)}")
    wrong = [each for each in scored if report.is_wrong(each)]
    if wrong:
        print("\nNot right:")
    for each in wrong:
        print(f"  {each.case}  {each.result.truth} ({each.result.kind}): "
              f"{each.result.named or 'nothing named'}, {each.result.verdict}")
    print(f"\n{wording.headline(found)}\nReport: {options.out / 'report.html'}")


def _close_loops(options, truths, scored):
    drawn = cases.drawn(options.seed, options.cases)
    closed = loops.close(options.tool, drawn, truths, options.out, options.jobs,
                         workers.Progress("closed the loop"))
    for each in scored:
        each.loop = closed.get(each.case)


def _prove(options):
    """The whole campaign; the exit code. Raises Void, seal.Altered, KeyboardInterrupt."""
    workers.clear(options.out, OURS)
    _tell(options.out, "drawing; nothing is sealed yet")
    truths = cases.write(options.seed, options.cases, options.out / "cases", options.jobs,
                         workers.Progress("recorded"))
    names = sorted(truths)
    if not names:
        raise Void("no case could be drawn")
    sealed = seal.SealedTruth(truths, options.out)
    del truths
    if len(names) < options.cases:
        print(f"{options.cases - len(names)} cases could not be drawn and are left out.")
    print(f"Truth of {len(names)} cases sealed. SHA-256: {sealed.sha256}", flush=True)
    _tell(options.out, "sealed; diagnoses run")

    box = sandbox.Sandbox(trial.needed_to_read(options.tool), [
        options.out, arguments.SOURCE / "tests/campaigns/diagnosis", trial.PACKAGES / "campaign"])
    if not box.isolated:
        print(f"No sandbox: {box.why_not}. The truth is protected by its seal and the watch only.")
    watcher, why_not_watched = _watched(sealed.path)
    if not watcher:
        print(f"The sealed truth cannot be watched: {why_not_watched}.")
    tool_sha256 = hashlib.sha256(options.tool.read_bytes()).hexdigest()
    way = trial.Way(options.tool, box, options.limit, not options.no_rivals, options.rival_limit)
    _run_all(options, way, names, watcher)
    if watcher:
        watcher.close()
    if way.rivals:
        check_contests(options.out / "answers", names)

    truths = sealed.open()
    _check_files(truths, options.out / "cases")
    print(f"Seal opened. SHA-256: {sealed.sha256}, as sealed.")
    _tell(options.out, "opened")
    scored = [judging.score(name, truths[name]["truth"], options.out / "answers" / name)
              for name in names]
    if not options.no_loop:
        _close_loops(options, truths, scored)
    found = goals.figures(scored)
    facts = {"seed": options.seed, "cases": len(names), "sha256": sealed.sha256,
             "tool_sha256": tool_sha256, "isolated": box.isolated, "why_not_isolated": box.why_not,
             "watched": bool(watcher), "why_not_watched": why_not_watched,
             "command": _command(options)}
    _write(options, scored, found, facts)
    _print(options, scored, found)
    _tell(options.out, "scored")
    return 1 if any(met is False for *_, met in goals.judged(found)) else 0


def main(words=None):
    options = arguments.parse(words)
    try:
        return _prove(options)
    except (Void, seal.Altered, cases.Unfit) as error:
        words = f"void: {error}; nothing is scored"
        code = 1
    except KeyboardInterrupt:
        words, code = "interrupted; nothing is scored", 130
    _tell(options.out, words)
    print(f"\ntools/concealed: {words}", file=sys.stderr)
    return code


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C: nothing is left running
    sys.exit(main())
