from browsing import browser, opened, pages  # noqa: F401 (fixtures, for all who ask)
from hypothesis import settings

settings.register_profile("steady", deadline=None, derandomize=True, max_examples=60)
settings.register_profile("search", deadline=None, max_examples=3000)
settings.load_profile("steady")
