"""A cache folder of the tests' own."""

import pytest


@pytest.fixture(scope="session")
def shared_cache(tmp_path_factory):
    """Descriptions of this session."""
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(scope="module", autouse=True)
def no_cache_of_the_user(shared_cache):
    """Nothing is read from the user's cache folder, nor written there."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(shared_cache))
        yield
