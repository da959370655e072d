"""The project's pages: their links, the commands that they show, and the files and outputs beside these."""

import os
import pathlib
import re
import subprocess

FENCE = re.compile(r"^```(.*)\n((?:.*\n)*?)```$", re.MULTILINE)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
INLINE_CODE = re.compile(r"`[^`\n]+`")
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
ANYTHING = "…"  # a line of an output that stands for any lines
TIMES_OFF, OFF = 0.1, 2e-3  # by which a number that is printed may differ from the page's
FOLDERS = ("firmware", "host", "include", "tests", "tools")


class Page:
    def __init__(self, path):
        self.path = path
        self.text = path.read_text()

    def blocks(self):
        """(words after the fence, content) of every fenced block, in order."""
        return [(info.split(), content) for info, content in FENCE.findall(self.text)]

    def prose(self):
        """The page without its fenced blocks."""
        return FENCE.sub("", self.text)

    def code(self):
        """All that it shows as code: blocks, indented lines and words between backticks, each on a line."""
        prose = self.prose()
        indented = re.findall(r"^ {4}(.*)$", prose, re.MULTILINE)
        return "\n".join([content for _, content in self.blocks()] + indented +
                         [code.strip("`") for code in INLINE_CODE.findall(prose)])

    def links(self):
        return LINK.findall(INLINE_CODE.sub("", self.prose()))

    def anchors(self):
        """Its headings' anchors, as GitHub makes them."""
        headings = re.findall(r"^#+ (.*)$", self.prose(), re.MULTILINE)
        return {anchor(heading) for heading in headings}


def anchor(heading):
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def all_pages(source):
    """Every page of the project, but what was built."""
    return [Page(path) for path in sorted(source.rglob("*.md"))
            if path.relative_to(source).parts[0] not in ("build", "third_party") and ".git" not in path.parts]


def dead_links(page, source):
    """Links of a page that lead nowhere within the project."""
    dead = []
    for link in page.links():
        if link.startswith(("http://", "https://")):
            continue
        file, _, part = link.partition("#")
        target = (page.path.parent / file).resolve() if file else page.path
        is_there = target.exists() and source.resolve() in (target.resolve(), *target.resolve().parents)
        if not is_there or part and part not in Page(target).anchors():
            dead.append(link)
    return dead


class Failed(AssertionError):
    pass


class Workplace:
    """A folder in which the commands of a page run: empty, or with the project's folders in it."""

    def __init__(self, folder, source, build, programs, with_sources=False):
        self.folder = pathlib.Path(folder)
        self.environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}", LC_ALL="C.UTF-8")
        if with_sources:
            for name in FOLDERS:
                (self.folder / name).symlink_to(source / name)
            (self.folder / "build").mkdir()
            (self.folder / "build" / "release").symlink_to(build)
            (self.folder / "build" / "third_party").symlink_to(source / "build" / "third_party")

    def follow(self, page, kinds=((),)):
        """Saves the files and runs the commands that a page shows, in its order, and compares what they print.

        A block `sh` is run if the words after are among `kinds`; one with a file's name is saved under that
        name; one of `text` is what the commands before it print."""
        printed = ""
        for words, content in page.blocks():
            if words[:1] == ["sh"]:
                printed = self.run(content) if tuple(words[1:]) in kinds else None
            elif words[:1] == ["text"]:
                if printed is not None and not is_printed(content, printed):
                    raise Failed(f"{page.path} shows\n{content}\nbut the commands print\n{printed}")
            elif len(words) == 2:
                (self.folder / words[1]).write_text(content)

    def run(self, commands):
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", commands], cwd=self.folder, text=True,
                              env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if done.returncode != 0:
            raise Failed(f"exit code {done.returncode} of\n{commands}\n{done.stdout}")
        return done.stdout


def is_printed(shown, printed):
    """Are the lines of a page those of an output? Numbers may be a little off: machines round otherwise."""
    lines = printed.splitlines()
    place, skips = 0, False
    for line in shown.splitlines():
        if line == ANYTHING:
            skips = True
            continue
        here = range(place, len(lines) if skips else min(place + 1, len(lines)))
        found = next((i for i in here if is_alike(line, lines[i])), None)
        if found is None:
            return False
        place, skips = found + 1, False
    return True


def is_alike(shown, printed):
    if NUMBER.sub("#", shown) != NUMBER.sub("#", printed):
        return False
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed))
    return all(abs(float(a) - float(b)) <= max(TIMES_OFF * abs(float(a)), OFF) for a, b in pairs)
