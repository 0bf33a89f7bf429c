"""What the topics of a bag tell, for refusals and the docs."""

from ekfsim.files.logs.bags.topics import TYPES
from ekfsim.files.logs.tables.declared import Format

_ROWS = (
    (
        "motion",
        "pose: the way and the turn from each message to the next; or twist: linear.x, m/s, and "
        "angular.z, rad/s, held until the next, of messages without a pose and of an Odometry "
        "whose pose never changes",
    ),
    (
        "fix",
        "latitude, longitude, degrees; status; position_covariance, m², which counts for each "
        "fix where its type is not 0",
    ),
    (
        "scan",
        "angle_min, angle_increment, rad; ranges, range_min, range_max, m: the beam nearest to "
        "each of the sensor's bearings, along its own; time_increment, s",
    ),
    (
        "landmarks",
        "any message with `markers`, `detections`, `tags` or `transforms`, or with `marker_ids` "
        "and `poses`: an id and a place, m, in the frame of the camera",
    ),
    ("truth", "position, m; the heading of its quaternion"),
)


def _types(role: str) -> str:
    return ", ".join(type.replace("/msg/", "/") for type in TYPES.get(role, ())) or "any"


BAGS = Format(
    "bag",
    "A ROS 1 bag (`.bag`), a bag of ROS 2 (a folder with its `metadata.yaml`, or a `.db3`) or an "
    "MCAP file, compressed or not, read by the package rosbags: `pip install 'ekfsim[bags]'`.",
    (),
    alone=True,
    example="""\
recording:
  format: bag
  path: ../logs/drive.mcap
  topics: {motion: /odom, fix: /gps/fix, scan: /scan, truth: /ground_truth}
  origin: {latitude: 48.137, longitude: 11.575}
""",
    notes=(
        "`topics` says which topic tells what; where it is silent, the only nav_msgs/Odometry, "
        "NavSatFix and LaserScan are taken, and told.",
        "| topic | types | what is read |\n|---|---|---|\n"
        + "\n".join(f"| `{role}` | {_types(role)} | {told} |" for role, told in _ROWS),
        "Where the world has several sensors that a topic could be of, or the bag several "
        "scanners or receivers, each is named: "
        "`scan: [{topic: /scan_front, sensor: front}, {topic: /scan_rear, sensor: rear}]`. Scans "
        "are for the world's `ultrasonic` (`bearings: [-90, 0, 90]`, `nearest`, `range`), fixes "
        "for its `gnss`, landmarks for its `rangeBearing`, `range` or `bearing`. Where a sensor "
        "sits and which way it looks, its `mount` in the world says; transforms (`/tf`) are not "
        "read. Without a world one is made, with a receiver where there are fixes.",
        "Messages count at their header's stamp, in its order, whenever they were received; one "
        "without a stamp counts when it was received, which is told. A pose that jumps is an "
        "odometry that began anew.",
        "Fixes are laid on a plane that touches the earth at `origin`, or at the first fix: x to "
        "the east, y to **true** north, which is not a map grid's north (UTM turns it by up to "
        "3°); headings count counter-clockwise from x, so 90° is true north, and a compass's "
        "0° clockwise from north is 90° here. No fix (status −1), 0° 0° and numbers that are none "
        "are left out and told.",
        "A fix that repeats the one before is left out where many do, which is told: "
        "`fix: {topic: /gps/fix, held: false}` says otherwise. A range is "
        "no echo where it is inf, beyond range_max or beyond the `range` of the sensor; "
        "−inf, nan and those below range_min tell nothing.",
    ),
)
