# SPDX-License-Identifier: Apache-2.0
"""Names of the arrays of an observation, as Shoal's blocks and cameras have them."""


def array_name(keys):
    """The name of the array that `keys` lead to: letters, digits, '_', and dots between the keys. An
    observation that is a single array has the name 'observation'."""
    letters = [
        "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in str(key)) for key in keys
    ]
    name = ".".join(letters) or "observation"
    return name if not name[0].isdigit() else "_" + name
