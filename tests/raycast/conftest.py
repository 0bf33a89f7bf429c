import pytest
from ways import WAYS

from ekfsim.twins import taking


@pytest.fixture(params=["plain", *WAYS])
def way(request):
    """The text by itself, and what may stand in for it."""
    with taking(request.param):
        yield
