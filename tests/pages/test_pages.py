"""Every page's links lead somewhere, the commands that it shows exist, and the tutorial runs as it stands."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import generated
import pages

SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
BUILD = pathlib.Path(os.environ["FLEXCOMP_BUILD"])
PROGRAMS = pathlib.Path(os.environ["FLEXCOMP_BIN"])
PAGES = pages.all_pages(SOURCE)
NAMED_FILE = re.compile(r"`((?:firmware|host|include|tests|tools)/[\w./-]+)`")
COMMAND = re.compile(r"(?:^|[\s`(>])(flexcomp\.convert|flexcompd?)((?: [a-z][a-z-]*)*)([^`|&>\n]*(?:\\\n[^`|&>\n]*)*)")
MODULE = "flexcomp.convert"
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
README_LINES = 150
TUTORIAL = SOURCE / "host" / "README.md"


def help_of(*words):
    program = [PROGRAMS / words[0]]
    if words[0] == MODULE:
        program = [SOURCE / "build" / "third_party" / "python" / "bin" / "python", "-m", MODULE]
    return subprocess.run([*program, *words[1:], "--help"], capture_output=True, text=True, check=False,
                          env=os.environ | {"PYTHONPATH": str(BUILD / "python")}).stdout


class Commands:
    """Commands and options, as the programs' own help lists them."""

    def __init__(self):
        self.helps = {}

    def help(self, words):
        if words not in self.helps:
            self.helps[words] = help_of(*words)
        return self.helps[words]

    def unknown(self, text):
        """Commands and options that a text names and the programs do not have."""
        unknown = set()
        for program, words, rest in COMMAND.findall(text.replace("\\\n", " ")):
            command = (program,)
            for word in words.split():
                if not re.search(rf"^  {word}\b", self.help(command), re.MULTILINE):
                    break
                command += (word,)
            if program == "flexcomp" and words and command == ("flexcomp",):
                unknown.add(f"{program}{words}")
            unknown |= {f"{' '.join(command)} {option}" for option in OPTION.findall(rest)
                        if option not in self.help(command)}
        return unknown


class Everywhere(unittest.TestCase):
    def test_links_lead_somewhere(self):
        dead = {str(page.path.relative_to(SOURCE)): found for page in PAGES
                if (found := pages.dead_links(page, SOURCE))}
        self.assertEqual({}, dead)

    def test_files_and_folders_that_are_named_exist(self):
        missing = {str(page.path.relative_to(SOURCE)): found for page in PAGES
                   if (found := [name for name in NAMED_FILE.findall(page.text) if not (SOURCE / name).exists()])}
        self.assertEqual({}, missing)

    def test_commands_and_options_that_are_named_exist(self):
        commands = Commands()
        unknown = {str(page.path.relative_to(SOURCE)): found for page in PAGES
                   if (found := commands.unknown(page.code()))}
        self.assertEqual({}, unknown)

    def test_options_of_tools_that_are_named_exist(self):
        unknown = {f"{page.path.relative_to(SOURCE)}: tools/{tool} {option}" for page in PAGES
                   for tool, rest in re.findall(r"\btools/([a-z][a-z-]*)((?: [^\n|&>]*)?)", page.code())
                   if (SOURCE / "tools" / tool).is_file() for option in OPTION.findall(rest)
                   if option not in (SOURCE / "tools" / tool).read_text()}
        self.assertEqual(set(), unknown)

    def test_this_sees_what_it_looks_for(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.md"
            page.write_text("# One part\n[a](#one-part) [b](#two) [c](none.md) [d](page.md#one-part) `[e](f)`\n")
            self.assertEqual(["#two", "none.md"], pages.dead_links(pages.Page(page), pathlib.Path(folder)))
        self.assertEqual({"flexcomp fly", "flexcomp table --tolerant"},
                         Commands().unknown("flexcomp fly\nflexcomp table --tolerant 3 --tolerance 3\n"))
        self.assertTrue(pages.is_printed("a 1.00\n…\nc\n", "a 1.01\nb\nc\nd\n"))
        self.assertFalse(pages.is_printed("a 1.00\n…\nc\n", "a 1.3\nb\nc\n"))
        self.assertFalse(pages.is_printed("a\nc\n", "a\nb\nc\n"))


class Readme(unittest.TestCase):
    def test_it_is_short(self):
        self.assertLessEqual((SOURCE / "README.md").read_text().count("\n"), README_LINES)

    def test_every_page_can_be_reached_from_it(self):
        reached, new = set(), {(SOURCE / "README.md").resolve()}
        while new:
            reached |= new
            new = {(path.parent / link.partition("#")[0]).resolve() for path in new
                   for link in pages.Page(path).links() if ".md" in link and "://" not in link} - reached
        self.assertEqual(set(), {page.path.resolve() for page in PAGES} - reached)


class Reference(unittest.TestCase):
    def test_every_key_of_the_robots_file_is_described(self):
        reader = (SOURCE / "host/model/robot_reader.cpp").read_text()
        keys = set(re.findall(r'"([a-z_]+)"', " ".join(re.findall(r"allow_only\(\{([^}]*)\}", reader))))
        described = (SOURCE / "host/README.md").read_text()
        self.assertGreater(len(keys), 15)
        self.assertEqual(set(), {key for key in keys if not re.search(rf"`{key}`|{key}:", described)})

    def test_every_command_is_described(self):
        commands = set(re.findall(r"^  ([a-z-]+) {2,}", help_of("flexcomp").split("Subcommands:")[1], re.MULTILINE))
        described = (SOURCE / "host/README.md").read_text()
        self.assertEqual(set(), {name for name in commands if f"`{name}" not in described})

    def test_every_name_of_a_check_is_described(self):
        sources = "".join(path.read_text() for path in (SOURCE / "host/check").glob("*.cpp"))
        names = set(re.findall(r'"((?:column|compliance|config|encoder|frame|gravity|joint|model|motion|path|payload|'
                               r'process|samples|table|time|tool|torque|units|wrench)\.[a-z]+)"', sources))
        described = (SOURCE / "host/README.md").read_text()
        self.assertEqual(set(), {name for name in names if f"`{name}`" not in described})

    def test_the_options_of_the_daemon_are_those_of_its_help(self):
        _, shown, _ = generated.between_markers((SOURCE / "firmware/README.md").read_text(), "options")
        self.assertEqual(generated.options_table(PROGRAMS), shown)
        offered = set(re.findall(r"^  --([a-z0-9-]+)", help_of("flexcompd"), re.MULTILINE)) - {"version", "config"}
        self.assertEqual(offered, set(re.findall(r"^\| `([a-z0-9-]+)`", shown, re.MULTILINE)))

    def test_the_page_on_effects_shows_the_files_that_are_tested(self):
        shown = [content for words, content in pages.Page(SOURCE / "host/effects/README.md").blocks() if words == ["cpp"]]
        tested = SOURCE / "tests/effects/extra"
        self.assertEqual([(tested / name).read_text() for name in ("law.cpp", "search.cpp")], shown)

    def test_every_effect_is_in_the_catalogue_of_the_page(self):
        effects = set(re.findall(r"^FLEXCOMP_EFFECT\((\w+)\)", (SOURCE / "host/effects/catalogue.inc").read_text(),
                                 re.MULTILINE))
        described = (SOURCE / "host/diagnosis/README.md").read_text()
        self.assertEqual(set(), {name for name in effects if f"`{name}`" not in described})


class Errors(unittest.TestCase):
    """The indexes of errors quote the programs: what they show is in the sources."""

    def test_every_text_is_one_of_the_programs(self):
        said = "\n".join(literals())
        for page, part in (("host/README.md", "# Errors by their text"), ("firmware/README.md", "## Messages by their text")):
            table = (SOURCE / page).read_text().split(part + "\n")[1]
            texts = [text for row in re.findall(r"^\|(.*?)(?<!\\)\|", table, re.MULTILINE)
                     for text in re.findall(r"`([^`]*)`", row) if " " in text and not text.startswith("flexcomp")]
            self.assertGreater(len(texts), 10)
            missing = [piece for text in texts for piece in re.split("…|'…'", text)
                       if piece.strip(" :;,.'") and piece.strip(" ") not in said]
            self.assertEqual([], missing, page)


def literals():
    """The programs' texts, with those that continue on the next line put together, and `…` for what is filled in."""
    for folder in ("host", "firmware", "tools"):
        for path in (SOURCE / folder).rglob("*"):
            if path.suffix in (".cpp", ".hpp") or path.parent.name == "tools" and path.is_file():
                for found in re.findall(r'(?:"(?:[^"\\\n]|\\.)*"\s*)+', path.read_text()):
                    yield "".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', found))


class AsItStands(unittest.TestCase):
    def follow(self, page, **options):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        workplace = pages.Workplace(scratch.name, SOURCE, BUILD, PROGRAMS, **options)
        workplace.follow(page)
        return workplace

    def test_the_tutorial_runs(self):
        workplace = self.follow(pages.Page(TUTORIAL))
        learnt = (workplace.folder / "diagnosis/updated_model.yaml").read_text()
        spring = float(re.search(r"a3:\n +compliance: (\S+)", learnt).group(1))
        self.assertAlmostEqual(9e-7, spring, delta=1e-8)

    def test_the_commands_of_every_other_page_run(self):
        others = [page for page in PAGES if page.path != TUTORIAL and ["sh"] in [words for words, _ in page.blocks()]]
        self.assertGreater(len(others), 3)
        for page in others:
            with self.subTest(page=page.path):
                self.follow(page, with_sources=True)

    def test_a_command_that_fails_or_prints_something_else_is_seen(self):
        with tempfile.TemporaryDirectory() as name:
            page = pathlib.Path(name) / "page.md"
            for shown in ("```sh\nfalse\n```\n", "```sh\necho 1\n```\n```text\n2\n```\n"):
                page.write_text(shown)
                with self.assertRaises(pages.Failed):
                    self.follow(pages.Page(page))


if __name__ == "__main__":
    unittest.main()
