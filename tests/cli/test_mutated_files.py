"""Random changes to the files that flexcomp and flexcompd read, each to what the file is made of: a value,
a key, a row, an element. Whatever comes of it ends in exit code 0, or in 2 with one printable line and
nothing written. `--each N` tries so many a reader, `--seed S` others, `--reader R` one reader alone."""

import argparse
import json
import os
import random
import re
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree as ElementTree

from command import FLEXCOMP, ROBOTS, Command

FLEXCOMPD = FLEXCOMP.parent / "flexcompd"
SECONDS = 60
UNPRINTABLE = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069]")

VALUES = ["", " ", "0", "-0", "-1", "1e-30", "1e30", "-1e30", "1e308", "1e999", "-1e999", "1e-999", "nan", "-nan",
          ".nan", "inf", "-.inf", "1,5", "1.5.0", "0x1p3", "0b1", "1e", "--1", "+-1", "+1", "1 2", "12 kg", "1;2",
          "1'000", "9" * 400, "0." + "3" * 400, "½", "１２", "−1", "true", "null", "~", "[1, 2]", "[]", "{}",
          "{a: 1}", "*a", "&a 1", "!!binary aGk=", "!!float x", "%s%n", "$(reboot)", "../../etc/passwd", "x" * 5000,
          "\x1b[2J", "\x07", "\x9b31m", "\u202e1", "\u2028", "\ufeff1", "'", '"', "\\", "#", "<", "&", "&amp;", "]]>",
          "66.5", "-0.5e-6", "3.6e6"]


def changed_value(chance, value):
    """Another value in its place, or the same number in a slightly different dress."""
    if chance.random() < 0.6:
        return chance.choice(VALUES)
    return chance.choice([value + "x", "x" + value, value.replace(".", ","), value + " ", value + value, "-" + value,
                          value + "e5", value + "e-5", value.upper(), value[::-1], f'"{value}"', value + "\t1",
                          value[:len(value) // 2]])


def changed_word(chance, word):
    """A name as people mistype it."""
    at = chance.randrange(max(len(word), 1))
    return chance.choice([word.upper(), word + "s", word[:at] + word[at + 1:], word[:at] + "_" + word[at:],
                          word[:at] + word[at:at + 1] * 2 + word[at + 1:], "", "\x1b[1m" + word, word + "\u202e", "é"])


def changed_text(chance, text):
    """Mutations of any text file."""
    at = chance.randrange(len(text))
    to = min(len(text), at + chance.randrange(200))
    return chance.choice([
        text[:at], text[at:], text[:at] + text[to:], text[:at] + text[at:to] * 2 + text[to:], "\ufeff" + text,
        text.replace("\n", "\r\n"), text.replace("\n", "\r"), text.replace(" ", "\t"), text + text,
        text[:at] + chance.choice(VALUES) + text[at:], text + "\x00", text.replace("\n", "", 3)])


def changed_lines(chance, lines):
    """Lines dropped, doubled, swapped or moved in or out."""
    lines = list(lines)
    one, other = chance.randrange(len(lines)), chance.randrange(len(lines))
    kind = chance.randrange(5)
    if kind == 0:
        del lines[one]
    elif kind == 1:
        lines.insert(other, lines[one])
    elif kind == 2:
        lines[one], lines[other] = lines[other], lines[one]
    elif kind == 3:
        lines[one] = "  " + lines[one]
    else:
        lines[one] = lines[one].lstrip()
    return lines


def mutated_urdf(chance, text):
    root = ElementTree.fromstring(text)
    parents = {child: parent for parent in root.iter() for child in parent}
    element = chance.choice(list(parents))
    attributed = chance.choice([each for each in root.iter() if each.attrib])
    name = chance.choice(list(attributed.attrib))
    kind = chance.randrange(12)
    if kind < 4:
        words = attributed.attrib[name].split(" ")
        at = chance.randrange(len(words))
        words[at] = changed_value(chance, words[at])
        attributed.attrib[name] = " ".join(words)
    elif kind == 4:
        del attributed.attrib[name]
    elif kind == 5:
        attributed.attrib[re.sub(r"\W", "q", changed_word(chance, name)) or "q"] = attributed.attrib.pop(name)
    elif kind == 6:
        parents[element].remove(element)
    elif kind == 7:
        parents[element].append(element)
    elif kind == 8:
        parents[element].remove(element)
        target = chance.choice([each for each in root.iter() if each not in set(element.iter())])
        target.append(element)
    elif kind == 9:
        element.tag = re.sub(r"\W", "q", changed_word(chance, element.tag)) or "q"
    elif kind == 10:
        element.text = chance.choice(VALUES)
    else:
        attributed.attrib[name] = attributed.attrib[name].replace(" ", chance.choice(["", ",", "  ", ";", "\t", "\n"]))
    # ElementTree writes what XML forbids, as a careless program would.
    return ElementTree.tostring(root, encoding="unicode")


def mutated_keys(chance, text):
    """YAML and TOML: keys, values, lists and lines."""
    lines = text.splitlines()
    full = [i for i, line in enumerate(lines) if re.search(r"\w", line) and not line.lstrip().startswith("#")]
    at = chance.choice(full)
    tokens = list(re.finditer(r"[^\s\[\]{},:=#\"']+", lines[at].split(" #")[0]))
    token = chance.choice(tokens) if tokens else None
    kind = chance.randrange(10)
    if kind < 5 and token:
        lines[at] = lines[at][:token.start()] + changed_value(chance, token[0]) + lines[at][token.end():]
    elif kind < 7 and token:
        lines[at] = lines[at][:token.start()] + changed_word(chance, token[0]) + lines[at][token.end():]
    elif kind == 7:
        lines[at] = re.sub(r"[\[\]{},:=\"]", lambda _: chance.choice(list("[]{},:=\" ") + [""]), lines[at], count=2)
    elif kind == 8:
        lines.insert(at, chance.choice(["---", "...", "<<: *a", "? x", "[section]", "[[twice]]", "a.b = 1", "- 1", "%TAG",
                                        "x: &a [*a]", "\t", "=", ": ", "'''", '"""']))
    else:
        lines = changed_lines(chance, lines)
    return "\n".join(lines) + "\n"


def mutated_csv(chance, text):
    rows = [line.split(",") for line in text.splitlines()]
    at = chance.randrange(1, len(rows))
    column = chance.randrange(len(rows[0]))
    kind = chance.randrange(12)
    if kind < 4:
        rows[at][column] = changed_value(chance, rows[at][column])
    elif kind == 4:
        rows[0][column] = changed_word(chance, rows[0][column])
    elif kind == 5:
        for row in rows:
            del row[column]
    elif kind == 6:
        for row in rows:
            row.insert(chance.choice([0, len(row)]), row[column])
    elif kind == 7:
        other = chance.randrange(len(rows[0]))
        rows[0][column], rows[0][other] = rows[0][other], rows[0][column]
    elif kind == 8:
        factor = chance.choice([57.2958, 1e3, 1e-3, -1, 0, 1e20, 1e160, 1e-200])
        for row in rows[1:]:
            row[column] = repr(factor * float(row[column]))
    elif kind == 9:
        for row in rows[1:]:
            row[column] = chance.choice(["", rows[1][column]])
    elif kind == 10:
        rows = rows[:1] + changed_lines(chance, [",".join(row) for row in rows[1:]])
        rows = [row if isinstance(row, list) else row.split(",") for row in rows]
    else:
        separator = chance.choice([";", "\t", ", ", " ", ",,", "|"])
        return "\n".join(separator.join(row) for row in rows) + "\n"
    return "\n".join(",".join(row) for row in rows) + "\n"


class MutatedFiles(Command):
    each = 6 if os.environ.get("FLEXCOMP_SANITIZED") == "ON" else 40
    seed = 20261124
    only = None

    def setUp(self):
        super().setUp()
        self.given = self.folder / "given"
        shutil.copytree(ROBOTS / "kr270", self.given)
        yaml = self.given / "robot.yaml"
        yaml.write_text(yaml.read_text().replace("gravity: [0, 0, 0]", "gravity: [0, 0, -9.81]")
                        + "base_compliance: [1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9]\n"
                        "payload: {mass: 120, com: [0, 0, 0.15]}\n")
        self.path = self.given / "path.csv"
        self.run_well("plan", "circle", "--model", yaml, "--center", "1.6,0,1.2", "--plane", "xz", "--points", "16",
                      "--out", self.path)
        self.measured = self.given / "measured.csv"
        self.run_well("simulate", "--model", yaml, "--path", self.path, "--out", self.measured)
        self.table = self.given / "t.fct"
        self.run_well("table", "--model", yaml, "--path", self.path, "--tolerance", "1e-5", "--out", self.table)
        self.toml = self.given / "node.toml"
        self.run_well("configure", "--model", yaml, "--out", self.toml)
        yaml.write_text(yaml.read_text() + "effects:\n  - {effect: joint_offset, joint: 3, offset: 2e-3}\n")
        self.toml.write_text(self.toml.read_text() + 'filter-cutoff = 20\ncorrection-limit = [0.01, 0.01, 0.01, 0.01, 0.01, 0.01]\n'
                             'trigger = "setpoint"\ngain = 0.8\nready-ticks = 10\npriority = 0\nwithout-identity = true\n')

    def commands_of(self, chance, folder, out):
        """Commands that read the files in `folder`; the slow ones seldom."""
        yaml, path, measured = folder / "robot.yaml", folder / "path.csv", folder / "measured.csv"
        common = ["--model", yaml, "--path", path, "--out", out]
        several = [[FLEXCOMP, "simulate", *common], [FLEXCOMP, "table", *common, "--tolerance", "1e-5"],
                   [FLEXCOMP, "compensate", *common, "--table", self.table]]
        if chance.random() < 0.1:
            several = [[FLEXCOMP, "diagnose", "--model", yaml, "--recording", measured, "--out", out],
                       [FLEXCOMP, "map", "--model", yaml, "--step", "0.4", "--out", out]]
        return several

    def judge(self, name, text, command, out):
        before = sorted(each for each in self.folder.rglob("*"))
        try:
            done = subprocess.run([str(part) for part in command], capture_output=True, timeout=SECONDS,
                                  stdin=subprocess.DEVNULL, cwd=self.folder)
        except subprocess.TimeoutExpired:
            return "does not end"
        told = done.stderr.decode("utf-8", "replace")
        written = [each for each in sorted(self.folder.rglob("*")) if each not in before]
        if done.returncode == 0:
            return None if out is None or out.exists() else "says it is done and wrote nothing"
        if done.returncode != 2:
            return f"exit code {done.returncode}: {told[-500:]}"
        if not re.fullmatch(r"flexcompd?: [^\n]+\n", told) or UNPRINTABLE.search(told) or "\ufffd" in told:
            return f"not one printable line: {told!r}"
        if name == "toml" and not re.match(r"flexcompd: [^\n]*node\.toml(:\d+)?: |flexcompd: --model-hash is required", told):
            return f"does not say where: {told!r}"
        if written or done.stdout:
            return f"left {[str(each) for each in written]} {done.stdout[:80]}"
        return None

    def campaign(self, reader, file, mutate, commands):
        if self.only not in (None, reader):
            self.skipTest("another reader is asked for")
        chance = random.Random(f"{self.seed} {reader}")
        given = file.read_text()
        tried = self.folder / "tried"
        refused = 0
        for number in range(self.each):
            text = given
            for _ in range(chance.choice([1, 1, 1, 2, 3])):
                try:
                    text = (changed_text if chance.random() < 0.1 else mutate)(chance, text)
                except (ElementTree.ParseError, ValueError, IndexError):
                    break  # a change before has left nothing of that structure
                if not text:
                    break
            shutil.copytree(self.given, tried)
            (tried / file.name).write_bytes(text.encode("utf-8", "surrogatepass"))
            out = self.folder / "out"
            command = chance.choice(commands(chance, tried, out))
            fault = self.judge(reader, text, command, out)
            refused += not out.exists()
            with self.subTest(reader=reader, number=number, command=command[1]):
                if fault:
                    changed = [line for line in text.splitlines() if line not in given.splitlines()]
                    self.fail(f"{fault}\n{[line[:300] for line in changed[:5]]}")
            shutil.rmtree(tried)
            shutil.rmtree(out) if out.is_dir() else out.unlink(missing_ok=True)
        self.assertGreater(refused, self.each / 10)  # else the changes change nothing

    def test_a_urdf_ends_well(self):
        self.campaign("urdf", self.given / "kr270.urdf", mutated_urdf, self.commands_of)

    def test_a_robot_ends_well(self):
        self.campaign("yaml", self.given / "robot.yaml", mutated_keys, self.commands_of)

    def test_a_recording_ends_well(self):
        self.campaign("csv", self.path, mutated_csv, lambda chance, folder, out: [
            command for command in self.commands_of(chance, folder, out) if command[1] not in ("map", "diagnose")]
            or [[FLEXCOMP, "diagnose", "--model", folder / "robot.yaml", "--recording", folder / "path.csv", "--out",
                 out]])

    def test_measured_positions_end_well(self):
        self.campaign("positions", self.measured, mutated_csv, lambda _, folder, out: [
            [FLEXCOMP, "simulate", "--model", folder / "robot.yaml", "--recording", folder / "measured.csv", "--out",
             out]])

    def test_a_configuration_ends_well(self):
        self.campaign("toml", self.toml, mutated_keys, lambda _, folder, out: [
            [FLEXCOMPD, "--config", folder / "node.toml", "--settings-out", out]])


class Circularity(MutatedFiles):
    def judge(self, name, text, command, out):
        done = subprocess.run([str(part) for part in command], capture_output=True, timeout=SECONDS)
        if done.returncode == 0:
            out.touch()
            try:
                json.loads(done.stdout, parse_constant=lambda constant: self.fail(constant))
            except ValueError:
                return f"no JSON: {done.stdout[:200]}"
            return None
        return super().judge(name, text, command, out)

    def test_measured_positions_end_well(self):
        self.campaign("circularity", self.measured, mutated_csv, lambda *_: [
            [FLEXCOMP, "circularity", self.folder / "tried" / "measured.csv", "--columns", "x,z", "--json"]])

    test_a_urdf_ends_well = test_a_robot_ends_well = test_a_recording_ends_well = None
    test_a_configuration_ends_well = None


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--each", type=int, default=MutatedFiles.each, help="changes a reader")
    parser.add_argument("--seed", type=int, default=MutatedFiles.seed)
    parser.add_argument("--reader", choices=["urdf", "yaml", "csv", "positions", "circularity", "toml"])
    arguments, rest = parser.parse_known_args()
    MutatedFiles.each, MutatedFiles.seed, MutatedFiles.only = arguments.each, arguments.seed, arguments.reader
    unittest.main(argv=[sys.argv[0], *rest])
