// SPDX-License-Identifier: Apache-2.0
// Immutable bytes with shared ownership of their memory: a string that was moved in, or mapped
// memory. Copies may be used on different threads.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace shoal {

class SharedBytes {
 public:
  SharedBytes() = default;
  SharedBytes(std::string bytes)
      : SharedBytes(std::make_shared<const std::string>(std::move(bytes))) {}
  // `bytes` must stay valid as long as `owner` lives.
  SharedBytes(std::shared_ptr<const void> owner, std::string_view bytes)
      : owner_(std::move(owner)), bytes_(bytes) {}

  std::string_view view() const { return bytes_; }
  size_t size() const { return bytes_.size(); }

 private:
  explicit SharedBytes(const std::shared_ptr<const std::string>& owner)
      : owner_(owner), bytes_(*owner) {}

  std::shared_ptr<const void> owner_;
  std::string_view bytes_;
};

}  // namespace shoal
