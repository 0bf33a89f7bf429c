"""A word that is nearly a known one, or has capitals where that has none, is met with that one."""

import pytest
from program import ekfsim


@pytest.mark.parametrize(
    ("line", "meant"),
    [
        ("run tour --filter EKF", "ekf"),
        ("compare tour --b filter=UKF", "ukf"),
        ("compare tour --b guard=Skip", "skip"),
        ("diff tour --filter ekf --against EKF", "ekf"),
        ("figures Classroom -o out", "classroom"),
        ("figures clasroom -o out", "classroom"),
        ("schema World", "world"),
        ("list Tour", "tour"),
        ("show TOUR", "tour"),
        ("play Tour", "tour"),
        ("play tour --show Text", "text"),
        ("run tour --guard SKIP", "skip"),
        ("run tour --reading Printed", "printed"),
        ("run tour --set Noise.rangeSigmaRatio=1", "noise.rangeSigmaRatio"),
        ("drive FURNISHED-ROOM", "furnished-room"),
        ("new corner.yaml --from Proof-Corner", "proof-corner"),
        ("Play tour", "play"),
    ],
)
def test_it_is_asked_whether_that_was_meant(tmp_path, monkeypatch, line, meant):
    monkeypatch.chdir(tmp_path)
    told = ekfsim(*line.split())
    assert (told.status, told.out) == (2, "")
    assert f"id you mean '{meant}'" in told.err
    assert not list(tmp_path.iterdir())
