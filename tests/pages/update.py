"""Writes what is generated in the pages; run by tools/docs --update."""

import json
import pathlib
import re
import tempfile

import generated
import pages

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = SOURCE / "build" / "release"
PROGRAMS = BUILD / "bin"
CIRCLE = """
robot=host/robots/kr270/robot.yaml
flexcomp plan circle --model $robot --center 1.6,0,1.2 --plane xz --out path.csv
flexcomp table --model $robot --path path.csv --tolerance 1e-6 --out t.fct
flexcomp compensate --model $robot --table t.fct --path path.csv --out corrected.csv
flexcomp simulate --model $robot --path path.csv --out before.csv
flexcomp simulate --model $robot --path corrected.csv --out after.csv
flexcomp report --model $robot --columns x,z --recording uncorrected=before.csv --recording corrected=after.csv \\
  --out report.html
"""


def save_first_picture(html, file):
    picture = re.search(r"<svg.*?</svg>", html.read_text(), re.DOTALL).group(0)
    file.parent.mkdir(exist_ok=True)
    file.write_text(re.sub(r"[ \t]+$", "", picture, flags=re.MULTILINE) + "\n")
    print(file.relative_to(SOURCE))


def write_between_markers(page, name, content):
    page.write_text(generated.replaced(page.read_text(), name, content))
    print(f"{page.relative_to(SOURCE)}: {name}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        pages.Workplace(folder, SOURCE, BUILD, PROGRAMS, with_sources=True).run(CIRCLE)
        save_first_picture(pathlib.Path(folder) / "report.html", SOURCE / "host/report/pictures/circle.svg")
    with tempfile.TemporaryDirectory() as folder:
        pages.Workplace(folder, SOURCE, BUILD, PROGRAMS).follow(pages.Page(SOURCE / "host/README.md"))
        answer = pathlib.Path(folder) / "diagnosis"
        save_first_picture(answer / "report.html", SOURCE / "host/diagnosis/pictures/residual.svg")
        write_between_markers(SOURCE / "host/diagnosis/README.md", "diagnosis",
                              generated.example_of(json.loads((answer / "diagnosis.json").read_text())))
    write_between_markers(SOURCE / "firmware/README.md", "options", generated.options_table(PROGRAMS))


if __name__ == "__main__":
    main()
