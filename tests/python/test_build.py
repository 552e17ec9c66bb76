"""The two compiled kernels: there, and each in its precision."""

import numpy as np
import pytest

from isomortar import _extended, _kernel


@pytest.mark.parametrize(("kernel", "digits", "spacing"), [(_kernel, 15, 2.0**-52), (_extended, 33, 2.0**-112)])
def test_kernel_computes_in_its_precision(kernel, digits, spacing):
    assert kernel.working_precision() == (digits, spacing)


def test_double_is_the_double_of_numpy():
    assert _kernel.working_precision() == (np.finfo(np.float64).precision, np.finfo(np.float64).eps)
