# SPDX-License-Identifier: MIT
"""test_page.py PAGE: what the page shows runs, from top to bottom."""
import re
import sys

try:
    import scipy.sparse
except ImportError:
    print("skipped: this Python has no SciPy, which the page shows")
    sys.exit(77)

with open(sys.argv[1]) as page:
    blocks = re.findall(r"^```python\n(.*?)^```", page.read(), re.M | re.S)
assert len(blocks) > 4, len(blocks)
shared = {}
for number, block in enumerate(blocks):
    exec(compile(block, f"block {number + 1}", "exec"), shared)
print(f"{len(blocks)} blocks run")
