"""What the files of the format `log` hold; with `columns:` they may be of any make."""

from ekfsim.files.logs.formats.groundtruth import GROUNDTRUTH, HEADING, TIME, X, Y
from ekfsim.files.logs.named.files import LANDMARKS, MOTION, READINGS, TRUTH
from ekfsim.files.logs.tables.declared import Column, Format, Table

LOG = Format(
    "log",
    "Files of any make whose columns have names; `columns:` and `units:` of the recording say what "
    "stands where in files of other make.",
    (
        Table(
            "what the robot did",
            MOTION,
            (
                TIME,
                Column("v", "m/s", "speed ahead, held until the next row"),
                Column("omega", "rad/s", "turn rate, counter-clockwise, held until the next row"),
            ),
            told="In place of `v,omega`: `left,right` (ways of the wheels in m since the row "
            "before, or their speeds in m/s), `distance,turn` (m and rad since the row before), "
            "`x,y,theta` (the odometry's pose), or `ax,ay,yaw` (m/s², m/s², rad).",
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
            told="The columns are those of the world's sensors: `range`, `bearing` or both, `x,y` "
            "of a fix, which needs no target, … Several files are several sensors.",
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
            told="Where they are absent, those of the world count.",
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
            told="Or a TUM file: t x y z qx qy qz qw without names.",
            example=GROUNDTRUTH.example.replace("heading", "theta"),
        ),
    ),
)
