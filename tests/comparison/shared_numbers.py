"""Numbers that both sides of a comparison compute for themselves, so that recordings need not hold
them. tests/support/shared_numbers.h has the same."""

import numpy as np
import torch

MASK = (1 << 64) - 1


def fnv1a(text):
    value = 0xCBF29CE484222325
    for byte in text.encode():
        value = ((value ^ byte) * 0x100000001B3) & MASK
    return value


def uniform(name, count):
    """Numbers in [0, 1), exact in double: splitmix64 of fnv1a(name) + index."""
    with np.errstate(over="ignore"):
        x = np.uint64(fnv1a(name)) + np.arange(count, dtype=np.uint64)
        x = x * np.uint64(0x9E3779B97F4A7C15)
        x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        x = x ^ (x >> np.uint64(31))
    return (x >> np.uint64(11)).astype(np.float64) * 2.0**-53


def symmetric(name, shape, scale):
    """Numbers in [-scale, scale), rounded to f32 once."""
    numbers = (2 * uniform(name, int(np.prod(shape))) - 1) * scale
    return torch.from_numpy(numbers.astype(np.float32).reshape(shape))
