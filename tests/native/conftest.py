import pytest
from needs import KERNELS

from surefoot.native.library import Library, library


@pytest.fixture(scope="session")
def kernels() -> Library:
    """The compiled kernels."""
    KERNELS.or_skip()
    found = library()
    assert found is not None
    return found
