"""The normal of a wall for one beam, in plain floats, which the twins of one robot call."""

from ekfsim.raycast.walls import Walls


def normal_one(walls: Walls, wall: int, x: float, y: float) -> tuple[float, float]:
    """Twin of `Walls.normal_at`: of a wall that is met at (x, y) m."""
    if wall < 0:
        return 0.0, 0.0
    if wall < len(walls.segments):
        nx, ny = walls.normals[wall].tolist()
        return nx, ny
    assert walls.round is not None
    cx, cy, radius = walls.round.plain[wall - len(walls.segments)]
    return (x - cx) / radius, (y - cy) / radius
