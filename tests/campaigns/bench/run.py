"""Usage: tools/bench [--only TOPIC]... [--json FILE] [--repetitions N] [--pictures FOLDER] [--update-readme]

Measures flexcomp beside other libraries, in one run, and prints the ratios. Machines are noisy: the
medians of several repetitions are compared, never times with times of another day.
"""

import argparse
import json
import pathlib
import sys

from suite import comparison, machine, picture, programs, readme, result, topics


def show(topic):
    print(f"\n{topic.title}", flush=True)
    width = max(len(entry.name) for entry in [*topic.figures, *topic.ratios])
    for figure in topic.figures:
        print(f"  {figure.name:{width}}  {figure.text()}")
    for ratio in topic.ratios:
        goal = f"   goal {ratio.goal_text()}: {ratio.verdict()}" if ratio.goal is not None else ""
        print(f"  {ratio.name:{width}}  {result.digits(ratio.value)}{goal}")
    for note in topic.notes:
        print(f"  {note}")
    sys.stdout.flush()


def summarise(measured):
    goals = [(name, ratio) for name, topic in measured.items() for ratio in topic.ratios if ratio.goal is not None]
    missed = [f"{name}: {ratio.name} {result.digits(ratio.value)}, goal {ratio.goal_text()}"
              for name, ratio in goals if not ratio.reached()]
    if goals:
        print(f"\n{len(goals) - len(missed)} of {len(goals)} goals are reached.")
    for line in missed:
        print(f"  not reached: {line}")


def compare(measured):
    written = comparison.figures_of(readme.FIGURES.read_text())
    sentences = [f"  {name}: {sentence}" for name, topic in measured.items()
                 for sentence in comparison.worse(written.get(name, {}), topic)]
    print("\nWorse than written in tests/campaigns/bench/README.md:" if sentences
          else "\nNo count and no ratio with a goal is worse than written in tests/campaigns/bench/README.md.")
    print("\n".join(sentences), end="\n" if sentences else "")


def main():
    arguments = argparse.ArgumentParser(usage=__doc__)
    arguments.add_argument("--only", action="append", choices=topics.NAMES, metavar="TOPIC")
    arguments.add_argument("--json", type=pathlib.Path)
    arguments.add_argument("--repetitions", type=int, default=5)
    arguments.add_argument("--pictures", type=pathlib.Path, default=programs.SOURCE / "build" / "bench" / "pictures")
    arguments.add_argument("--update-readme", action="store_true")
    options = arguments.parse_args()
    if options.repetitions < 1:
        arguments.error("--repetitions: expected at least 1")
    if options.update_readme and options.only:
        arguments.error("--update-readme needs all topics of one run")
    options.pictures.mkdir(parents=True, exist_ok=True)
    measured = {}
    for name in options.only or topics.NAMES:
        try:
            measured[name] = topics.measure(name, options.repetitions)
        except programs.Failed as failure:
            sys.exit(f"bench: {name}: {failure}")
        show(measured[name])
        picture.draw(measured[name], options.pictures / f"{name}.png")
    summarise(measured)
    compare(measured)
    found = {"machine": machine.describe(), "topics": {name: topic.as_json() for name, topic in measured.items()}}
    if options.json:
        options.json.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n")
    if options.update_readme:
        readme.update(found["machine"], measured)


if __name__ == "__main__":
    main()
