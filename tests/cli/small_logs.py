"""A small log of each format, as a folder of files, written by hand."""

STAMP = 1_582_766_482 << 32  # of a pylon log: seconds above, microseconds below
UNIX = 1_248_444_187.156  # s
LOGS = {
    "gnss": {
        "wheelspeeds.csv": "time,vr,vl\n" + "".join(f"{k / 10:.1f},0.5,0.5\n" for k in range(21)),
        "gnss.csv": "t,x,y\n0.5,0.3,0.1\n1,0.45,-0.1\n1.5,0.8,0.05\n",
        "groundtruth.csv": "t,x,y,phi\n"
        + "".join(f"{k / 10:.1f},{k / 20:.2f},0,0\n" for k in range(21)),
    },
    "pylon": {
        "walk.csv": "".join(
            f"5,{5 - k / 100:.2f},-0.3,{STAMP + 100_000 * k},34.1,-117.7,0,0,0,0.1,0,0,\n"
            for k in range(20)
        )
    },
    "mrclam": {
        "Robot1_Odometry.dat": "# t v w\n"
        + "".join(f"{UNIX + k / 10:.3f} 0.5 0\n" for k in range(21)),
        "Robot1_Measurement.dat": f"# t barcode r b\n{UNIX + 0.45:.3f} 63 3.8 "
        f"0.26\n{UNIX + 1:.3f} 63 3.6 0.28\n"
        f"{UNIX + 1:.3f} 5 1 1\n",
        "Robot1_Groundtruth.dat": "# t x y o\n"
        + "".join(f"{UNIX + k / 10:.3f} {k / 20} 0 0\n" for k in range(21)),
        "Barcodes.dat": "# subject barcode\n1 5\n6 63\n",
        "Landmark_Groundtruth.dat": "# subject x y sx sy\n6 4 1 0 0\n",
    },
    "ranges": {
        "odometry.csv": "t,distance,dheading\n"
        + "".join(f"{k / 10:.1f},0.05,0\n" for k in range(1, 21)),
        "ranges.csv": "t,antenna,node,range\n0.5,1,2,4.4\n1,1,3,7.1\n",
        "nodes.csv": "node,x,y\n2,4,1\n3,-6,1\n",
        "groundtruth.csv": "t,x,y,heading\n"
        + "".join(f"{k / 10:.1f},{k / 20},0,0\n" for k in range(21)),
    },
    "pioneer": {
        "odometry.csv": "t,left,right\n0,0,0\n"
        + "".join(f"{k / 10:.1f},0.05,0.05\n" for k in range(1, 21)),
        "ultrasonic.csv": "t,beam,range\n0.5,2,1.02\n1,0,1.49\n1,2,0.99\n",
        "groundtruth.csv": "t,x,y,heading\n"
        + "".join(f"{k / 10:.1f},{k / 20},0,0\n" for k in range(21)),
    },
    "mower": {
        "marker-001-poselog.txt": "".join(
            f"{k} 0 {k / 100} 0.005 0.005 0 0 0 0 {'0 ' * 9}{(k - 1) / 200} 0 0\n"
            for k in range(1, 101)
        ),
        "marker-001-003-angles.txt": "0.495 0 0.27 -0.06\n0.995 1 -0.4 -0.06\n",
        "marker-001-map.txt": "0 4 1\n1 4 -1.5\n",
    },
}

_ROWS = [
    [254 if 9 < row < 50 and 9 < column < 70 else 0 for column in range(80)] for row in range(60)
]
MAP = {  # of ROS: a room of 6 m by 4 m
    "map.yaml": "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
    "map.pgm": "P2\n80 60\n255\n" + "\n".join(" ".join(map(str, row)) for row in _ROWS) + "\n",
}
