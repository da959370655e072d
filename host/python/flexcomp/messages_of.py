"""Messages of bags and MCAP files, by the packages of those who made the formats."""

import contextlib
import sqlite3

from .foreign import Unusable, package

_MCAP, _SQLITE, _ROS1 = ".mcap", ".db3", ".bag"


def topics(source):
    """{name: type}, types as ROS 2 names them. Raises Unusable."""
    with _opened(source) as bag:
        return bag.topics()


def read(source, names):
    """Yields topic, time of arrival (ns since the epoch) and message. Raises Unusable."""
    with _opened(source) as bag:
        yield from bag.read(names)


@contextlib.contextmanager
def _opened(source):
    if not source.exists():
        raise Unusable(f"{source}: no such file")
    try:
        with _reader_of(source)(source) as bag:
            yield bag
    except Unusable:
        raise
    except Exception as error:  # of a damaged file the packages raise whatever happens to them
        raise Unusable(f"{source}: {' '.join(str(error).split()) or type(error).__name__}") from error


def _reader_of(source):
    """Files of a bag are often handed on without the rest of it."""
    is_alone = source.is_file() and not (source.parent / "metadata.yaml").is_file()
    return {_MCAP: _Mcap, _SQLITE: _Sqlite}.get(source.suffix, _Bag) if is_alone else _Bag


class _Mcap:
    """A file of its own, without the metadata of a bag."""

    def __init__(self, source):
        self._reader = package("mcap.reader", "mcap", source)
        self._decoder = package("mcap_ros2.decoder", "mcap-ros2-support", source)
        self._source = source

    def __enter__(self):
        self._stream = self._source.open("rb")
        try:
            self._mcap = self._reader.make_reader(self._stream, decoder_factories=[self._decoder.DecoderFactory()])
        except BaseException:
            self._stream.close()
            raise
        return self

    def __exit__(self, *_):
        self._stream.close()

    def topics(self):
        summary = self._mcap.get_summary()
        if summary is None:
            raise Unusable(f"{self._source}: has no summary, as after a crash; `mcap recover` makes one")
        return {channel.topic: summary.schemas[channel.schema_id].name for channel in summary.channels.values()
                if channel.schema_id in summary.schemas}

    def read(self, names):
        for _, channel, message, decoded in self._mcap.iter_decoded_messages(topics=sorted(names)):
            yield channel.topic, message.log_time, decoded


class _Bag:
    """A folder of ROS 2 (SQLite or MCAP), or a .bag of ROS 1."""

    def __init__(self, source):
        highlevel = package("rosbags.highlevel", "rosbags", source)
        types = package("rosbags.typesys", "rosbags", source)
        path = source if source.is_dir() or source.suffix == _ROS1 else source.parent
        # Bags before ROS 2 Iron do not say what their messages look like.
        self._make = lambda: highlevel.AnyReader(
            [path], default_typestore=types.get_typestore(types.Stores.ROS2_HUMBLE))

    def __enter__(self):
        self._bag = self._make()
        self._bag.open()
        return self

    def __exit__(self, *_):
        self._bag.close()

    def topics(self):
        return {name: topic.msgtype for name, topic in self._bag.topics.items()}

    def read(self, names):
        connections = [each for each in self._bag.connections if each.topic in names]
        for connection, arrival, data in self._bag.messages(connections=connections):
            yield connection.topic, arrival, self._bag.deserialize(data, connection.msgtype)


class _Sqlite:
    """A file of its own: https://github.com/ros2/rosbag2, rosbag2_storage_sqlite3, has its tables. What the messages
    look like is taken from ROS 2 Humble; those of joints and wrenches are the same in all."""

    def __init__(self, source):
        types = package("rosbags.typesys", "rosbags", source)
        self._types = types.get_typestore(types.Stores.ROS2_HUMBLE)
        self._source = source

    def __enter__(self):
        self._file = sqlite3.connect(f"{self._source.resolve().as_uri()}?mode=ro", uri=True)
        return self

    def __exit__(self, *_):
        self._file.close()

    def topics(self):
        return dict(self._file.execute("SELECT name, type FROM topics"))

    def read(self, names):
        kinds = self.topics()
        rows = self._file.execute("SELECT topics.name, timestamp, data FROM messages"
                                  " JOIN topics ON topics.id = topic_id ORDER BY timestamp")
        for topic, arrival, data in rows:
            if topic in names:
                yield topic, arrival, self._types.deserialize_cdr(data, kinds[topic])
