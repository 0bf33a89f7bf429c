"""Small bags, written by the package rosbags."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

rosbags = pytest.importorskip("rosbags")

from rosbags.rosbag1 import Writer as Writer1  # noqa: E402
from rosbags.rosbag2 import StoragePlugin  # noqa: E402
from rosbags.rosbag2 import Writer as Writer2  # noqa: E402
from rosbags.typesys import Stores, get_typestore  # noqa: E402

KINDS = ("bag", "db3", "mcap")
LAT, LON = 48.137, 11.575  # where the fixes are


class Messages:
    """Messages of ROS 1 or 2."""

    def __init__(self, kind):
        self.store = get_typestore(Stores.ROS1_NOETIC if kind == "bag" else Stores.ROS2_HUMBLE)
        self.kind = kind

    def make(self, name, **fields):
        return self.store.types[name](**fields)

    def header(self, t, frame="odom"):
        ns = round(t * 1e9)
        stamp = self.make("builtin_interfaces/msg/Time", sec=ns // 10**9, nanosec=ns % 10**9)
        more = {"seq": 0} if self.kind == "bag" else {}
        return self.make("std_msgs/msg/Header", stamp=stamp, frame_id=frame, **more)

    def pose(self, x, y, θ):
        point = self.make("geometry_msgs/msg/Point", x=float(x), y=float(y), z=0.0)
        turn = self.make(
            "geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=math.sin(θ / 2), w=math.cos(θ / 2)
        )
        return self.make("geometry_msgs/msg/Pose", position=point, orientation=turn)

    def odometry(self, t, x=0.0, y=0.0, θ=0.0, v=0.0, ω=0.0):
        zero = np.zeros(36)
        vector = [
            self.make("geometry_msgs/msg/Vector3", x=a, y=0.0, z=b) for a, b in ((v, 0.0), (0.0, ω))
        ]
        twist = self.make("geometry_msgs/msg/Twist", linear=vector[0], angular=vector[1])
        return self.make(
            "nav_msgs/msg/Odometry",
            header=self.header(t),
            child_frame_id="base",
            pose=self.make(
                "geometry_msgs/msg/PoseWithCovariance", pose=self.pose(x, y, θ), covariance=zero
            ),
            twist=self.make("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=zero),
        )

    def stamped(self, t, x, y, θ):
        return self.make(
            "geometry_msgs/msg/PoseStamped", header=self.header(t), pose=self.pose(x, y, θ)
        )

    def fix(self, t, lat, lon, variances=(0.04, 0.09), type=2, status=0):
        covariance = np.diag([*variances, 1.0]).ravel()
        return self.make(
            "sensor_msgs/msg/NavSatFix",
            header=self.header(t, "gps"),
            status=self.make("sensor_msgs/msg/NavSatStatus", status=status, service=1),
            latitude=lat, longitude=lon, altitude=500.0,
            position_covariance=covariance, position_covariance_type=type,
        )  # fmt: skip

    def scan(self, t, ranges, first=-math.pi / 2, step=math.pi / 180, near=0.1, far=10.0):
        return self.make(
            "sensor_msgs/msg/LaserScan",
            header=self.header(t, "laser"),
            angle_min=first, angle_max=first + step * len(ranges), angle_increment=step,
            time_increment=0.0, scan_time=0.1, range_min=near, range_max=far,
            ranges=np.array(ranges, np.float32), intensities=np.zeros(0, np.float32),
        )  # fmt: skip


def written(kind, path, topics):
    """A bag of a kind. topics : (topic, when it was received in s, message)"""
    store = Messages(kind).store
    if kind == "bag":
        place, writer = path.with_suffix(".bag"), Writer1(path.with_suffix(".bag"))
    else:
        plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
        place, writer = path, Writer2(path, version=9, storage_plugin=plugin)
    with writer:
        known = {}
        for topic, t, message in topics:
            name = message.__msgtype__
            if topic not in known:
                known[topic] = writer.add_connection(topic, name, typestore=store)
            raw = (
                store.serialize_ros1(message, name)
                if kind == "bag"
                else store.serialize_cdr(message, name)
            )
            writer.write(known[topic], round(t * 1e9), raw)
    return place


def namespace(**held):
    """What a message of a type looks like that rosbags does not bring along."""
    return SimpleNamespace(**held)
