# SPDX-License-Identifier: Apache-2.0
"""Numbers that both sides of a comparison compute for themselves, so that recordings need not hold
them. tests/support/shared_numbers.h has the same."""

import math

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


def bytes_of(name, shape):
    """Numbers in 0..255."""
    numbers = np.floor(256 * uniform(name, int(np.prod(shape))))
    return torch.from_numpy(numbers.astype(np.uint8).reshape(shape))


def mix(z):
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return z ^ (z >> 31)


class Random:
    """Shoal's generator (common/base/random.h)."""

    GOLDEN = 0x9E3779B97F4A7C15
    LEARNER_UPDATE = 7

    def __init__(self, *words):
        """Of the stream that these words name."""
        key = self.GOLDEN
        for word in words:
            key = mix((key + self.GOLDEN + mix((word + self.GOLDEN) & MASK)) & MASK)
        self.state = []
        for _ in range(4):
            key = (key + self.GOLDEN) & MASK
            self.state.append(mix(key))

    def next(self):
        def rotl(x, k):
            return ((x << k) | (x >> (64 - k))) & MASK

        s = self.state
        result = (rotl((s[0] + s[3]) & MASK, 23) + s[0]) & MASK
        t = (s[1] << 17) & MASK
        s[2] ^= s[0]
        s[3] ^= s[1]
        s[1] ^= s[2]
        s[0] ^= s[3]
        s[2] ^= t
        s[3] = rotl(s[3], 45)
        return result

    def uniform(self):
        return (self.next() >> 11) * 2.0**-53

    def normal(self, shape):
        numbers = []
        for _ in range(int(np.prod(shape))):
            radius = math.sqrt(-2 * math.log(1 - self.uniform()))
            numbers.append(radius * math.cos(2 * math.pi * self.uniform()))
        return torch.from_numpy(np.array(numbers, np.float32).reshape(shape))
