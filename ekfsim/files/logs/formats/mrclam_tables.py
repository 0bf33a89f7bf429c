"""What the files of the UTIAS multi-robot data (MRCLAM) hold."""

from ekfsim.files.logs.formats.groundtruth import GROUNDTRUTH, HEADING, TIME, X, Y
from ekfsim.files.logs.tables.angles import BEYOND_A_TURN
from ekfsim.files.logs.tables.declared import Column, Format, Table

ODOMETRY = Table(
    "the odometry",
    ("Robot*_Odometry.dat",),
    (
        TIME,
        Column("speed", "m/s", "forwards, commanded, held until the next row"),
        Column("turn rate", "rad/s", "counter-clockwise, held until the next row", most=10.0),
    ),
    named=False,
    widths=range(3, 4),
    example="""\
1248444187.156 0.086 -0.398
1248444187.186 0.086 -0.398
1248444187.197 0.086 -0.398
1248444187.207 0.086 -0.398
1248444187.228 0.086 -0.398
""",
)
MEASUREMENT = Table(
    "the measurements",
    ("Robot*_Measurement.dat",),
    (
        TIME,
        Column("barcode", "", "that was seen, a whole number"),
        Column("range", "m", "how far it is", positive=True),
        Column("bearing", "rad", "from straight ahead, to the left positive", most=BEYOND_A_TURN),
    ),
    named=False,
    widths=range(4, 5),
    told="Of the same robot as the odometry. Several rows may share a time.",
    example="""\
1248444187.160 63 1.012 1.650
1248444187.160 81 0.917 1.661
1248444187.190 63 1.010 1.655
1248444187.200 7 0.801 1.508
1248444187.210 81 0.915 1.660
""",
)
TRUTH = GROUNDTRUTH.but(
    files=("Robot*_Groundtruth.dat",),
    columns=(TIME, X, Y, HEADING.but(name="orientation", also=())),
    named=False,
    widths=range(4, 5),
    example="""\
1248444187.150 1.41269700 -3.89079920 2.27210000
1248444187.172 1.41268740 -3.89080650 2.27200000
1248444187.194 1.41267110 -3.89081900 2.27200000
1248444187.206 1.41267260 -3.89082970 2.27190000
1248444187.238 1.41268550 -3.89083500 2.27190000
""",
)
SUBJECT = Column("subject", "", "1 to 5 are robots, others landmarks")
BARCODES = Table(
    "the barcodes",
    ("Barcodes.dat",),
    (SUBJECT, Column("barcode", "", "that it wears")),
    named=False,
    widths=range(2, 3),
    example="""\
1 5
2 14
6 63
7 81
8 7
""",
)
LANDMARKS = Table(
    "the landmarks",
    ("Landmark_Groundtruth.dat",),
    (SUBJECT, X, Y),
    named=False,
    widths=range(3, 6),
    told="Deviations of x and y may follow. Where the numbers are barcodes, it is told.",
    example="""\
6 0.58831396 -4.28264845 0.00004570 0.00027395
7 0.68214396 -4.44595833 0.00005198 0.00026762
8 0.85910813 -4.46878303 0.00003736 0.00027854
9 2.81076194 -4.40720161 0.00005263 0.00020794
10 2.94839205 -4.28874675 0.00006585 0.00023314
""",
)
MRCLAM = Format(
    "mrclam",
    "Commanded speeds, and landmarks that a camera sees: the UTIAS multi-robot data. White space "
    "between the columns, # before comments, no names.",
    (ODOMETRY, MEASUREMENT, BARCODES, LANDMARKS, TRUTH),
)
