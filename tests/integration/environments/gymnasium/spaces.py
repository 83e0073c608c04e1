# SPDX-License-Identifier: Apache-2.0
import numpy


class Space:
    pass


class Box(Space):
    def __init__(self, low, high, shape=None, dtype=numpy.float32):
        shape = numpy.shape(low) if shape is None else shape
        self.low = numpy.full(shape, low, dtype) if numpy.ndim(low) == 0 else numpy.asarray(low, dtype)
        self.high = numpy.full(shape, high, dtype) if numpy.ndim(high) == 0 else numpy.asarray(high, dtype)
        self.shape, self.dtype = tuple(shape), numpy.dtype(dtype)


class Dict(Space):
    def __init__(self, spaces):
        self.spaces = dict(spaces)


class Discrete(Space):
    def __init__(self, n):
        self.n = n
