// SPDX-License-Identifier: Apache-2.0
// Files that torch.load reads: an ordered dictionary of f32 tensors by name, as torch.save writes a
// state_dict.
//
//   archive/data.pkl   the dictionary, pickled: of each tensor its storage's number, shape, strides
//   archive/version    "3"
//   archive/byteorder  "little"
//   archive/data/I     storage I: the tensor's numbers, row-major
//
// in a zip archive. The pickle is of protocol 2 and names what torch's own ones do, so that
// torch.load(weights_only=True) takes it.
//
// Source: pytorch/pytorch, torch/serialization.py, torch/_utils.py (_rebuild_tensor_v2); opcodes:
// python/cpython, Lib/pickletools.py.
#pragma once

#include <string>

#include "common/nn/safetensors.h"

namespace shoal::launch {

// CHECKs that all are F32.
std::string WriteTorchFile(const nn::TensorMap& tensors);

}  // namespace shoal::launch
