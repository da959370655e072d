"""Bags of ROS 2 and ROS 1, and MCAP, as recordings.

A row is a joint state, at the time of its header or, where that is zero, of its arrival. What other topics
say is interpolated between its neighbours. Where a topic comes more rarely than rows do, only the row nearest
to each of its messages has a value, so that no sample counts several times. Gaps stay missing."""

import collections

import numpy
import pandas

from . import messages_of
from .foreign import Unusable
from .recording import Recording

Topic = collections.namedtuple("Topic", "option columns types help")
_JOINT_STATE = "sensor_msgs/msg/JointState"
_CONTROLLER_STATE = "control_msgs/msg/JointTrajectoryControllerState"
TOPICS = (
    Topic("joint-states", None, (_JOINT_STATE,), "measured angles and torques (JointState); the only one of its kind"
          " if left out"),
    Topic("commands", None, (_JOINT_STATE, _CONTROLLER_STATE), "commanded angles (JointState,"
          " JointTrajectoryControllerState)"),
    Topic("wrench", ("fx", "fy", "fz", "mx", "my", "mz"), ("geometry_msgs/msg/WrenchStamped",),
          "force and moment on the tool, at the TCP, base frame (WrenchStamped)"),
    Topic("position", ("x", "y", "z"), ("geometry_msgs/msg/PointStamped", "geometry_msgs/msg/PoseStamped"),
          "measured TCP, base frame (PointStamped, PoseStamped)"),
)
_NANO = 1_000_000_000
_LONGEST_GAP = 3  # of a topic's usual periods: what lies in a longer one is missing
_RARE = 1.5  # of the rows' period


def convert(source, out, joints, topics):
    """Writes a recording, and returns what there is to say of it. `joints`: names, base to tip; `topics`: names by
    the options of TOPICS, or nothing. Raises Unusable."""
    there = messages_of.topics(source)
    chosen = _chosen(source, there, topics)
    logs = collections.defaultdict(list)
    for name, stamp, message in messages_of.read(source, set(chosen.values())):
        logs[name].append((_stamp_of(message, stamp), message))
    states = logs[chosen["joint-states"]]
    _refuse_unknown_joints(source, states, joints)
    time, frame = _rows(source, states, joints)
    frame |= _others(source, chosen, logs, joints, time)
    table = pandas.DataFrame({"t": (time - time[0]) / _NANO} | frame)
    Recording(table, str(out)).write(out)
    return _told(out, table, len(states), chosen, there, logs)


def _chosen(source, there, topics):
    """Topics by option, whose types are as they should be."""
    chosen = {option: name for option, name in topics.items() if name}
    if "joint-states" not in chosen:
        candidates = [name for name, kind in there.items() if kind == _JOINT_STATE]
        if len(candidates) != 1:
            raise Unusable(f"{source}: which topic has the joint states? Say --joint-states; there are "
                           f"{_listed(there)}")
        chosen["joint-states"] = candidates[0]
    for topic in TOPICS:
        name = chosen.get(topic.option)
        if name is not None and there.get(name) not in topic.types:
            found = f"'{name}' is {there[name]}" if name in there else f"there is no topic '{name}'"
            raise Unusable(f"{source}: {found}; --{topic.option} expects {' or '.join(topic.types)}; there are "
                           f"{_listed(there)}")
    return chosen


def _listed(there):
    return ", ".join(f"{name} ({kind})" for name, kind in sorted(there.items())) or "none"


def _stamp_of(message, arrival):
    """ns since the epoch."""
    stamp = message.header.stamp
    return (stamp.sec * _NANO + stamp.nanosec) or arrival


def _refuse_unknown_joints(source, states, joints):
    names = sorted({name for _, message in states for name in message.name})
    if joints is None:
        raise Unusable(f"{source}: which joints, base to tip? Say --joints; there are {', '.join(names)}")
    for joint in joints:
        if joint not in names:
            raise Unusable(f"{source}: there is no joint '{joint}'; there are {', '.join(names) or 'none'}")


def _of_joints(names, values, joints):
    """Values in the joints' order; nothing where the message does not have them all."""
    if len(values) != len(names):
        return None
    by_name = dict(zip(names, values))
    return [by_name[joint] for joint in joints] if all(joint in by_name for joint in joints) else None


def _sorted(samples):
    """[(ns, values)] -> times (n,) that increase, and values (n, k); of equal times the first."""
    time = numpy.array([stamp for stamp, _ in samples], dtype=numpy.int64)
    time, first = numpy.unique(time, return_index=True)
    return time, numpy.array([samples[index][1] for index in first], dtype=float)


def _numbered(group, values):
    return {f"{group}_{number}": column for number, column in enumerate(values.T, 1)}


def _rows(source, states, joints):
    """Times (n,) in ns and columns of angles and torques."""
    samples = []
    for stamp, message in states:
        angles = _of_joints(message.name, message.position, joints)
        if angles is not None:
            torques = _of_joints(message.name, message.effort, joints)
            samples.append((stamp, angles + (torques or [numpy.nan] * len(joints))))
    if not samples:
        raise Unusable(f"{source}: no joint state has the angles of {', '.join(joints)}")
    time, values = _sorted(samples)
    angles, torques = numpy.hsplit(values, 2)
    has_torques = numpy.isfinite(torques).any()
    return time, _numbered("q_meas", angles) | (_numbered("tau", torques) if has_torques else {})


def _others(source, chosen, logs, joints, time):
    """Columns of the other topics, at the rows."""
    columns = {}
    for topic in TOPICS[1:]:
        if topic.option not in chosen:
            continue
        samples = [(stamp, values) for stamp, message in logs[chosen[topic.option]]
                   if (values := _values_of(topic, message, joints)) is not None]
        if not samples:
            raise Unusable(f"{source}: no message of '{chosen[topic.option]}' has what --{topic.option} needs")
        at_rows = _at(time, *_sorted(samples))
        columns |= dict(zip(topic.columns, at_rows.T)) if topic.columns else _numbered("q_cmd", at_rows)
    return columns


def _values_of(topic, message, joints):
    if topic.option == "wrench":
        force, moment = message.wrench.force, message.wrench.torque
        return [force.x, force.y, force.z, moment.x, moment.y, moment.z]
    if topic.option == "position":
        point = message.pose.position if hasattr(message, "pose") else message.point
        return [point.x, point.y, point.z]
    if hasattr(message, "joint_names"):
        wanted = message.reference if hasattr(message, "reference") else message.desired
        return _of_joints(message.joint_names, wanted.positions, joints)
    return _of_joints(message.name, message.position, joints)


def _at(rows, time, values):
    """Values (n, k) of a topic at the rows' times (ns)."""
    at = (rows - rows[0]) / _NANO
    own = (time - rows[0]) / _NANO
    found = numpy.column_stack([numpy.interp(at, own, column, left=numpy.nan, right=numpy.nan) for column in values.T])
    after = numpy.clip(numpy.searchsorted(own, at), 1, max(1, len(own) - 1))
    if len(own) > 1:
        period = numpy.median(numpy.diff(own))
        exact = numpy.isin(rows, time)
        found[(own[after] - own[after - 1] > _LONGEST_GAP * period) & ~exact] = numpy.nan
        if len(rows) > 1 and period > _RARE * numpy.median(numpy.diff(at)):
            found[~_nearest(at, own)] = numpy.nan
    return found


def _nearest(at, own):
    """Which rows lie nearest to a message."""
    after = numpy.clip(numpy.searchsorted(at, own), 1, len(at) - 1)
    nearest = numpy.where(own - at[after - 1] <= at[after] - own, after - 1, after)
    mask = numpy.zeros(len(at), dtype=bool)
    mask[nearest] = True
    return mask


def _told(out, table, count, chosen, there, logs):
    lines = [f"{out}: {len(table)} rows"]
    if count > len(table):
        lines.append(f"{count - len(table)} joint states left out: of other joints, or of a time that is there already")
    for option in ("wrench", "position"):
        if option in chosen:
            frame = logs[chosen[option]][0][1].header.frame_id
            lines.append(f"{chosen[option]} is in frame '{frame}', and was taken as it is: "
                         "flexcomp wants the base frame")
    others = sorted(set(there) - set(chosen.values()))
    if others:
        lines.append(f"left out: {', '.join(others)}")
    return "\n".join(lines)
