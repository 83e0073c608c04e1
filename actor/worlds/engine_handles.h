// SPDX-License-Identifier: Apache-2.0
// Ownership of MuJoCo's objects without MuJoCo's headers.
#pragma once

#include <memory>

struct mjModel_;
struct mjData_;

namespace shoal::worlds {

struct ModelDeleter {
  void operator()(mjModel_* model) const;
};
struct DataDeleter {
  void operator()(mjData_* data) const;
};

using ModelHandle = std::unique_ptr<mjModel_, ModelDeleter>;
using DataHandle = std::unique_ptr<mjData_, DataDeleter>;

}  // namespace shoal::worlds
