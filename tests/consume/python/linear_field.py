# SPDX-License-Identifier: MIT
"""linear_field.py PREFIX: the package lies below PREFIX, so does the library it loads, and it computes
the gradient of a linear field."""
import os
import sys

try:
    import numpy as np
except ImportError:
    print("skipped: this Python has no NumPy")
    sys.exit(77)
import sphgrad

prefix = os.path.realpath(sys.argv[1])
loaded = [os.path.realpath(path) for path in (sphgrad.__file__, sphgrad._c.functions._name)]
assert all(path.startswith(prefix + os.sep) for path in loaded), loaded

x = np.stack(np.meshgrid(*[np.arange(6.0)] * 3, indexing="ij"), -1).reshape(-1, 3)
found = sphgrad.gradient(sphgrad.Neighbors(x, 2.0), 3 * x[:, 0] - x[:, 2], 1)
error = abs(found - [3, 0, -1]).max()
assert error < 1e-12, error
