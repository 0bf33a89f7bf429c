from ekfsim.geometry.soa import soa_zeros


def test_they_are_zeros_in_the_shape_asked_for():
    made = soa_zeros((4, 5), 3, 2)
    assert made.shape == (4, 5, 3, 2)
    assert (made == 0).all()
    assert made.strides == (40, 8, 320, 160)
