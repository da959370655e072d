"""python3 -m generator FAMILY SEED FOLDER: writes one case, for a closer look."""

import pathlib
import sys

from . import case


def main():
    if len(sys.argv) != 4 or sys.argv[1] not in case.FAMILIES:
        sys.exit(f"usage: python3 -m generator {{{','.join(case.FAMILIES)}}} SEED FOLDER")
    folder = pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True)
    truth = case.write(sys.argv[1], int(sys.argv[2]), folder)
    print(truth["kind"], truth["foreign"] or [(entry["effect"], entry["joint"])
                                              for entry in truth["effects"]])


if __name__ == "__main__":
    main()
