// SPDX-License-Identifier: Apache-2.0
// Makes a folder unreadable for this process until destruction, even if tests run as root.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

namespace shoal {

class WithoutRights {
 public:
  // Removes all permissions of `folder` and makes its parent readable for all users. If the process
  // runs as root, it also becomes an unprivileged user.
  explicit WithoutRights(std::filesystem::path folder)
      : folder_(std::move(folder)),
        above_(folder_.parent_path()),
        before_(std::filesystem::status(above_).permissions()),
        user_(geteuid()) {
    std::filesystem::permissions(folder_, std::filesystem::perms::none);
    std::filesystem::permissions(above_, before_ | std::filesystem::perms(0055));
    if (user_ == 0) {
      EXPECT_EQ(seteuid(kNobody), 0);
    }
  }
  ~WithoutRights() {
    EXPECT_EQ(seteuid(user_), 0);
    std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
    std::filesystem::permissions(above_, before_);
  }
  WithoutRights(const WithoutRights&) = delete;
  WithoutRights& operator=(const WithoutRights&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;

  const std::filesystem::path folder_, above_;
  const std::filesystem::perms before_;
  const uid_t user_;
};

}  // namespace shoal
