"""Tables and the compensator: the core itself, in this process."""

import dataclasses
import pathlib
import struct
import tomllib

from ._core import FlexcompError, Aligned, check, ffi, lib, six, state_name, status_words

_TRAILER = 24  # bytes behind a signed table, which begin with this
_TRAILER_MAGIC = b"FCS1"
_SIZE_PLACE = 8  # of the table's own size in its header


@dataclasses.dataclass(frozen=True)
class TableInfo:
    """What the header of a table says; SI units."""

    model_hash: int
    is_path: bool
    node_count: int
    size: int
    force_bound: float
    moment_bound: float
    position_error: float
    orientation_error: float
    largest_gain: float


class Table:
    """A table of `flexcomp table`, checked. Raises FlexcompError for one that is damaged."""

    def __init__(self, data, name="table"):
        self._room = Aligned("unsigned char", max(1, len(data)))
        ffi.memmove(self._room.pointer, data, len(data))
        self._view = ffi.new("flexcomp_table_t *")
        check(lib.flexcomp_table_open(self._room.pointer, _own_size(data), self._view), name)

    @classmethod
    def read(cls, file):
        """From a file, signed or not; a signature is left unchecked. Raises FlexcompError, and OSError for a file
        that cannot be read."""
        return cls(pathlib.Path(file).read_bytes(), str(file))

    @property
    def info(self):
        """What its header says: a TableInfo."""
        info = ffi.new("flexcomp_table_info_t *")
        check(lib.flexcomp_table_describe(self._view, info))
        return TableInfo(*(getattr(info, field.name) for field in dataclasses.fields(TableInfo)))


def _own_size(data):
    """Without the signature behind it."""
    before = len(data) - _TRAILER
    if before < _SIZE_PLACE + 4 or data[before:before + 4] != _TRAILER_MAGIC:
        return len(data)
    return before if struct.unpack_from("<I", data, _SIZE_PLACE)[0] == before else len(data)


def _six(value, name):
    return six(value if hasattr(value, "__iter__") else (value,) * 6, name)


@dataclasses.dataclass
class Config:
    """Numbers of a compensator, with the defaults of flexcompd; flexcomp.h says what each is. SI units; of
    what a joint has, one for all or six."""

    model_hash: int
    period: float = 0.004
    gain: float = 1.0
    filter_cutoff: float = 20.0
    force_range: float = 6000.0
    moment_range: float = 600.0
    setpoint_age_limit: float = 0.02
    wrench_age_limit: float = 0.02
    joint_speed: float | tuple = 1.5
    correction_limit: float | tuple = 0.01
    correction_rate: float | tuple = 0.1
    correction_acceleration: float | tuple = 5.0
    deflection_limit: float = 0.005
    chart_margin: float = 0.02
    hold_time: float = 0.05
    fade_time: float = 0.5
    ready_ticks: int = 10

    @classmethod
    def read(cls, file):
        """From a configuration of flexcompd; what only the process needs is left out."""
        with open(file, "rb") as stream:
            values = tomllib.load(stream)
        known = {field.name for field in dataclasses.fields(cls)}
        taken = {name.replace("-", "_"): value for name, value in values.items() if name.replace("-", "_") in known}
        return cls(**taken | {"model_hash": int(values["model-hash"], 16)})

    def to_c(self):
        """As the C API takes it: a flexcomp_config_t. Raises ValueError where a joint's numbers are not six."""
        config = ffi.new("flexcomp_config_t *")
        limits = zip(*(_six(getattr(self, name), name)
                       for name in ("correction_limit", "correction_rate", "correction_acceleration")))
        config.joint_speed = _six(self.joint_speed, "joint_speed")
        config.limits = list(limits)
        for field in dataclasses.fields(self):
            if not field.name.startswith(("joint_", "correction_")):
                setattr(config, field.name, getattr(self, field.name))
        return config


@dataclasses.dataclass(frozen=True)
class Output:
    """Result of a tick: rad; the deflection in m and rad. `setpoint` is for the drives, in every state."""

    setpoint: tuple
    correction: tuple
    deflection: tuple
    status: int
    latched_faults: int
    state: int

    @property
    def state_name(self):
        """The state in words."""
        return state_name(self.state)

    @property
    def remarks(self):
        """The bits of the status, each in words."""
        return status_words(self.status)


class Compensator:
    """The core, tick by tick. Raises FlexcompError where it refuses a configuration, a table or to arm."""

    def __init__(self, config, table=None):
        self._object = Aligned("flexcomp_compensator_t")
        self._table = None
        check(lib.flexcomp_compensator_init(self._object.pointer, config.to_c()), "configuration")
        if table is not None:
            self.set_table(table)

    def set_table(self, table):
        """Also while correcting: the correction moves to the new table's within its limits. Raises FlexcompError."""
        check(lib.flexcomp_compensator_set_table(self._object.pointer, table._view), "table")
        self._table = table  # its memory is read in every tick

    def arm(self):
        """Starts to correct, after `ready_ticks` good ticks; raises FlexcompError before."""
        check(lib.flexcomp_compensator_arm(self._object.pointer), "not armed")

    def disarm(self):
        """Fades out: tick on until the state is off. Does nothing when off or latched."""
        lib.flexcomp_compensator_disarm(self._object.pointer)

    def reset(self):
        """From latched to off, after a fault. Raises FlexcompError in any other state."""
        check(lib.flexcomp_compensator_reset(self._object.pointer), "not reset")

    def tick(self, setpoint, wrench, setpoint_age=0.0, wrench_age=0.0, external_fault=False):
        """One period: setpoint (rad), wrench on the tool at the TCP in the base frame (N, N·m), ages (s).

        Returns an Output. Bad numbers, also such as are not finite, are no exception: they are faults in its
        `status`, and hold the correction. Raises ValueError where setpoint or wrench are not six numbers."""
        given = ffi.new("flexcomp_input_t *", {
            "setpoint": six(setpoint, "setpoint"), "setpoint_age": setpoint_age, "wrench": six(wrench, "wrench"),
            "wrench_age": wrench_age, "external_fault": external_fault})
        made = ffi.new("flexcomp_output_t *")
        check(lib.flexcomp_compensator_tick(self._object.pointer, given, made))
        return Output(tuple(made.setpoint), tuple(made.correction), tuple(made.deflection), made.status,
                      made.latched_faults, made.state)


__all__ = ["Compensator", "Config", "FlexcompError", "Output", "Table", "TableInfo"]
