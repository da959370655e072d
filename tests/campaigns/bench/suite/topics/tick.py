"""The look-up and the guarded tick beside the same deflection computed from the model."""

from ..programs import google_benchmark
from ..result import Curve, Figure, Ratio, Topic

FIGURES = {
    "floor: 6×6 matrix times vector, from cache": "floor_of_all<float>",
    "look-up with deflection and correction": "look_up<float>/6",
    "look-up in double": "look_up<double>/6",
    "look-up, the table in no near cache": "look_up_cold",
    "full guarded tick": "tick<float>",
    "full guarded tick in double": "tick<double>",
    "flexcomp, from the model": "direct<float>",
    "flexcomp, from the model in double": "direct<double>",
    "Pinocchio, from the model in double": "pinocchio_direct",
    "Orocos KDL, from the model in double": "kdl_direct",
}


def measure(repetitions):
    found = google_benchmark("bench_tick", 3 * repetitions, seconds=0.03)
    seconds = {name: entry["s"] for name, entry in found.items()}
    floor, look_up, tick = seconds["floor_of_all<float>"], seconds["look_up<float>/6"], seconds["tick<float>"]
    pinocchio, kdl = seconds["pinocchio_direct"], seconds["kdl_direct"]
    return Topic(
        "A control tick: KR 270 milling a circle, 3,142 setpoints in turn, one call",
        [Figure(name, seconds[key], "s") for name, key in FIGURES.items()],
        [Ratio("Pinocchio's time / a look-up's", pinocchio / look_up, 15),
         Ratio("Pinocchio's time / a guarded tick's", pinocchio / tick, 5),
         Ratio("KDL's time / a look-up's", kdl / look_up),
         Ratio("KDL's time / a guarded tick's", kdl / tick),
         Ratio("a look-up's time / the floor's", look_up / floor)],
        [Curve("path table, by nodes",
               [[found[f"look_up<float>/{k}"]["nodes"], seconds[f"look_up<float>/{k}"]] for k in range(4, 8)]),
         Curve("grid table of 1 to 4 axes, by nodes",
               [[found[f"grid_look_up/{k}"]["nodes"], seconds[f"grid_look_up/{k}"]] for k in range(1, 5)])],
        ("nodes of the table", "a look-up, s"))
