"""What the files of the format `log` hold; with `columns:` they may be of any make."""

from ekfsim.files.logs.formats.groundtruth import GROUNDTRUTH, HEADING, TIME, X, Y
from ekfsim.files.logs.named.files import LANDMARKS, MOTION, READINGS, TRUTH
from ekfsim.files.logs.tables.declared import Column, Format, Table

MAPS = (
    (
        "One table of a car, stamps in ns, satellite fixes in degrees, headings as quaternions",
        """\
recording:
  format: log
  path: drive
  columns: {t: time_ns}
  motion: {file: car.csv, columns: {v: forward_speed, omega: gyro_z}}
  readings: [{file: car.csv, sensor: gnss, columns: {latitude: lat, longitude: lon, sigma: acc}}]
  truth: {file: reference.csv, columns: {x: east, y: north, qz: qz, qw: qw}}
""",
    ),
    (
        "A column of ranges for each radio",
        """\
recording:
  format: log
  path: hall
  motion: {file: run.csv, wheels: ways, width: 0.32}
  readings:
    - {file: run.csv, target: A1, columns: {range: r1}}
    - {file: run.csv, target: A2, columns: {range: r2}}
""",
    ),
    (
        "Rows without names: time, pose of the odometry (2 to 4), true pose (7 to 9), how many "
        "landmarks were seen (10), and then number, bearing, range of each",
        """\
recording:
  format: log
  path: lab
  motion: {file: so.txt, columns: {t: 1, x: 2, y: 3, theta: 4}}
  readings: [{file: so.txt, columns: {t: 1, target: 11, bearing: 12, range: 13}, every: 3}]
  landmarks: {file: map.txt, columns: {id: 1, x: 2, y: 3}}
  truth: {file: so.txt, columns: {t: 1, x: 7, y: 8, theta: 9}}
""",
    ),
    (
        "Rows of several kinds, without times: `ODOMETRY turn way turn`, `SENSOR id range bearing`",
        """\
recording:
  format: log
  path: field
  motion: {file: data.txt, rows: ODOMETRY, columns: {turnBefore: 2, distance: 3, turn: 4}}
  readings: [{file: data.txt, rows: SENSOR, columns: {target: 2, range: 3, bearing: 4}}]
  landmarks: {file: world.txt, columns: {id: 1, x: 2, y: 3}}
""",
    ),
)

LOG = Format(
    "log",
    "Tables of any make whose columns have names, in a folder or in one file. A unit may stand in "
    "a name: `t_ms`, `bearing [deg]`. `ekfsim record` writes it of every robot that drives, with "
    "the units in the names, one `readings.csv` for all sensors, and a `world.yaml` of what the "
    "filter is told. Files of other make are told of in the recording: `columns: {t: time_ns, x: "
    "3}` (a name of theirs, or a number from 1), `units: {t: ns}`, for all tables or for one of "
    "`motion:`, `readings:`, `landmarks:`, `truth:`, each with its `file:`, and `rows:` with the "
    "word that begins its rows where one file holds several kinds. Stamps may be dates "
    "(`2011-09-26 13:02:25.96`), places `latitude,longitude` in degrees, headings quaternions "
    "`qx,qy,qz,qw`. A `world.yaml` in the folder is the world where none is named; else one is "
    "made of the columns.",
    (
        Table(
            "what the robot did",
            MOTION,
            (
                TIME,
                Column("v", "m/s", "speed ahead, held until the next row"),
                Column("omega", "rad/s", "turn rate, counter-clockwise, held until the next row"),
            ),
            told="In place of `v,omega`: `left,right` (speeds of the wheels in m/s since the row "
            "before, or, where the unit is m as in `left [m]` or `motion: {wheels: ways}` says "
            "so, their ways; with `omega` where a gyro tells the turn), `distance,turn` (m and "
            "rad since the row before; with `turn_before` an odometry that tells turn, way and "
            "turn), `x,y,theta` (the odometry's pose in any frame: what lies between two rows was "
            "driven), or `ax,ay,yaw` (m/s², m/s², rad; system pylon). Any of the first four "
            "drives the robot of any other system. Where ways of the first row are 0 it is the "
            "start, else they began a usual step before. `holds: next` or `before` says over "
            "which time speeds hold, `width` how far apart the wheels are. Ways and poses may "
            "come without `t`: rows then go by their order, and readings of the same file come "
            "after the motion above them.",
            example="""\
t,v,omega
0.0,0.5,0.0
0.1,0.5,0.1
0.2,0.5,0.1
0.3,0.5,0.0
0.4,0.5,0.0
""",
        ),
        Table(
            "what sensors told",
            (f"{READINGS}*.csv",),
            (
                TIME,
                Column("target", "", "what was seen: a landmark's id, or a beam's number"),
                Column("range", "m", "how far it is"),
                Column("bearing", "rad", "from straight ahead, to the left positive"),
            ),
            told="The columns are what the world's sensors read: `range`, `bearing` or both "
            "(rangeBearing, range, bearing), `x,y` of a fix (gnss), `yaw` (compass, gyro), "
            "`azimuth,elevation` (markers), `right,ahead` (lidar), `range` and `target` or "
            "`bearing` of a beam among walls (ultrasonic; empty or `inf` is no echo). Rows of "
            "several sensors may share a table: a column `sensor` names each by its name or kind, "
            "and fields of others stay empty. `sigma`, `sigma_x`, `sigma_range` … or `variance`, "
            "`variance_x` … tell how sure a reading is and win over the sensor's own; 0 is "
            "unknown. A fix that is held until the next is taken once. A landmark goes by its id "
            "or its name. Of a file with a column for each landmark, name that file once for "
            "each, with `target: A1`; of rows that tell several readings, name the columns of the "
            "first and say with `every: 3` how many columns further on the next begins. What a "
            "sensor's `mount` and `delay` are, the world says.",
            example="""\
t,target,range,bearing
0.05,1,2.91,0.335
0.15,2,2.78,-0.372
0.25,1,2.84,0.340
0.35,2,2.70,-0.380
0.35,1,2.80,0.351
""",
        ),
        Table(
            "the landmarks",
            LANDMARKS,
            (Column("id", "", "its number"), X, Y),
            needed=False,
            told="Where they are absent, those of the world count. An id may be a name; rows may "
            "repeat.",
            example="""\
id,x,y
1,3.0,1.0
2,3.0,-1.0
3,5.0,2.0
4,5.0,-2.0
5,7.0,0.0
""",
        ),
        GROUNDTRUTH.but(
            files=TRUTH,
            columns=(TIME, X, Y, HEADING.but(name="theta", also=())),
            told="Or a TUM file: t x y z qx qy qz qw without names. Without `theta` the heading is "
            "the course, half a turn from it in reverse, and told.",
            example=GROUNDTRUTH.example.replace("heading", "theta"),
        ),
    ),
    maps=MAPS,
)
