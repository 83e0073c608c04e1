// SPDX-License-Identifier: Apache-2.0
// Writer of files for torch.load: an ordered dictionary of f32 tensors by name, in the format in
// which torch.save writes a state_dict. The file is a zip archive of
//
//   archive/data.pkl   pickled dictionary: storage number, shape and strides of each tensor
//   archive/version    "3"
//   archive/byteorder  "little"
//   archive/data/I     storage I: the tensor's numbers, row-major
//
// The pickle has protocol 2 and uses only the names that torch itself uses, so that
// torch.load(weights_only=True) accepts the file.
//
// Source: pytorch/pytorch, torch/serialization.py, torch/_utils.py (_rebuild_tensor_v2); opcodes:
// python/cpython, Lib/pickletools.py.
#pragma once

#include <string>

#include "common/nn/safetensors.h"

namespace shoal::launch {

// CHECK: all tensors are F32.
std::string WriteTorchFile(const nn::TensorMap& tensors);

}  // namespace shoal::launch
