import numpy as np
import pytest

from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.filters.ukf import UKF
from ekfsim.filters.variants.by_reading import NoiseByReading
from ekfsim.filters.variants.listing import ListingEKF
from ekfsim.systems import CLASSROOM, SYSTEMS, system_of
from ekfsim.systems.document import READINGS

FIRST = Beginning(Gaussian(np.zeros(3), np.eye(3)))
LISTED = {("mower", "coded"), ("gnss", "coded")}


@pytest.mark.parametrize("name", ["classroom", *SYSTEMS])
@pytest.mark.parametrize("reading", READINGS)
def test_the_code_of_two_documents_has_a_filter_of_its_own(name, reading):
    system, listed = system_of(name), (name, reading) in LISTED
    assert type(system.filter("ekf", reading, FIRST)) is (ListingEKF if listed else EKF)
    assert type(system.filter("ukf", reading, FIRST)) is UKF
    assert system.by_listing("ekf", reading) == listed
    assert not system.by_listing("ukf", reading)


@pytest.mark.parametrize("name", ["classroom", *SYSTEMS])
@pytest.mark.parametrize("reading", READINGS)
def test_all_but_one_are_given_what_happened(name, reading):
    happened = ()
    given = system_of(name).entries(happened, reading)
    assert (given is happened) == ((name, reading) != ("gnss", "coded"))


def test_what_is_no_document_s_is_watched_as_it_stands():
    assert system_of("classroom") is CLASSROOM
    told = Beginning(FIRST.first, tuning=Tuning(range_variance="reading"))
    made = CLASSROOM.filter("ukf", "corrected", told)
    assert isinstance(made, NoiseByReading)
    assert isinstance(made.filter, UKF)
