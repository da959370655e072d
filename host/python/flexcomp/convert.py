r"""Recordings from where other programs keep them: ROS 2 and ROS 1 bags, MCAP, Parquet (LeRobot).

    python3 -m flexcomp.convert run.mcap --joints a1,a2,a3,a4,a5,a6 --out run.csv
    python3 -m flexcomp.convert bag/ --joints a1,a2,a3,a4,a5,a6 --wrench /ft --out run.csv
    python3 -m flexcomp.convert episode.parquet --map t=timestamp --map 'q_meas_*=observation.state[*]:deg' \
      --out run.csv

Tables of text are read by the command: flexcomp convert --help."""

import argparse
import pathlib
import sys

from . import bags, commands, parquet
from .foreign import Unusable

_PARQUET = ".parquet"


def _arguments():
    parser = argparse.ArgumentParser(prog="python3 -m flexcomp.convert", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("input", type=pathlib.Path, help="a bag (folder, .bag, .mcap) or a .parquet")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="recording to write, .csv")
    bag = parser.add_argument_group("bags and MCAP")
    bag.add_argument("--joints", help="names of the robot's joints, base to tip, with commas between")
    for topic in bags.TOPICS:
        bag.add_argument(f"--{topic.option}", metavar="TOPIC", help=topic.help)
    table = parser.add_argument_group("Parquet")
    table.add_argument("--map", action="append", default=[], metavar="COLUMN=NAME:UNIT",
                       help="as of flexcomp convert; items of a list are called NAME[0], NAME[1], …")
    table.add_argument("--episode", type=int, help="its number, where the file has several")
    return parser.parse_args()


def _convert(options):
    if options.input.suffix == _PARQUET:
        return parquet.convert(options.input, options.out, options.map, options.episode)
    topics = {topic.option: getattr(options, topic.option.replace("-", "_")) for topic in bags.TOPICS}
    joints = options.joints.split(",") if options.joints else None
    return bags.convert(options.input, options.out, joints, topics)


def main():
    try:
        print(_convert(_arguments()))
    except (Unusable, commands.CommandError, OSError, ValueError) as error:
        print(f"flexcomp.convert: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
