#!/usr/bin/env bash
# Guess:     two libraries that choose the UTM zone of a place by themselves choose the same one, so that a robot's fixes
#            by the one lie in the map by the other.
# Behaviour: at Bergen the package utm takes zone 32, which the grid widens there, to the west, for Norway; geopandas'
#            (and osmnx's, which asks it) estimate takes zone 31, the place's six degrees. The fixes lie 331 km west of
#            the map; moved onto it, they are turned by 5.2 degrees, 0.9 m in 10 m, which looks like a bad compass.
#            Spitsbergen alike: 33 and 32. Elsewhere they agree to a millimetre. Right: give both the zone.
# Version:   utm 0.9.0, geopandas 1.2.0, pyproj 3.7.2 (PyPI)
# Source:    run below; utm.latlon_to_zone_number has the exceptions, EPSG:32631's area of use has not
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q utm==0.9.0 geopandas==1.2.0 pyproj==3.7.2 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import geopandas
import numpy as np
import utm

NORTH = 0.001
PLACES = {
    "Karlsruhe": (49.01, 8.40, "32", "32"),
    "Oslo": (59.91, 10.75, "32", "32"),
    "Bergen": (60.39, 5.32, "32", "31"),
    "Ny-Ålesund": (78.92, 11.93, "33", "32"),
}


def by_utm(latitude, longitude):
    """Zone, and east and north (m) of the place and of one a little to the north."""
    east, north, zone, _ = utm.from_latlon(np.array([latitude, latitude + NORTH]), np.array([longitude, longitude]))
    return str(zone), np.column_stack([east, north])


def by_geopandas(latitude, longitude):
    places = geopandas.GeoSeries.from_xy([longitude] * 2, [latitude, latitude + NORTH], crs="EPSG:4326")
    grid = places.estimate_utm_crs()
    projected = places.to_crs(grid)
    return grid.utm_zone[:-1], np.column_stack([projected.x, projected.y])


def true_north(pair):
    return np.degrees(np.arctan2(*(pair[1] - pair[0])))


agrees = []
print("place         zone by utm   by geopandas    apart (km)    turned (degrees)")
for name, (latitude, longitude, *expected) in PLACES.items():
    (zone, fixes), (other, map_) = by_utm(latitude, longitude), by_geopandas(latitude, longitude)
    apart, turned = np.linalg.norm(fixes[0] - map_[0]), true_north(fixes) - true_north(map_)
    print(f"{name:14s}{zone:>11s}{other:>15s}{apart / 1000:14.3f}{turned:20.2f}")
    agrees.append([zone, other] == expected)
    agrees.append(apart < 0.001 and abs(turned) < 0.001 if zone == other else apart > 1e5 and abs(turned) > 5)
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON
