// SPDX-License-Identifier: Apache-2.0
// Two hosts on one machine: the machine itself (near) and a network namespace (far), connected by a
// veth pair. The far host has its own addresses, ports and loopback, so it can be reached only over
// the link.
#pragma once

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace shoal {

class JoinedNamespaces {
 public:
  JoinedNamespaces() {
    const int id = getpid() % 60'000;
    far_ = fmt::format("shoal-{}", id);
    near_link_ = fmt::format("shoal{}a", id);
    far_link_ = fmt::format("shoal{}b", id);
    subnet_ = fmt::format("10.213.{}.{{}}", 1 + id % 250);
    made_ = Ip("netns add " + far_) &&
            Ip("link add " + near_link_ + " type veth peer name " + far_link_ + " netns " + far_) &&
            Ip("addr add " + near_address() + "/24 dev " + near_link_) &&
            Ip("link set " + near_link_ + " up") &&
            Ip("-n " + far_ + " addr add " + Address(2) + "/24 dev " + far_link_) &&
            Ip("-n " + far_ + " link set lo up") && Join();
  }
  ~JoinedNamespaces() {
    Ip("link del " + near_link_);
    Ip("netns del " + far_);
  }
  JoinedNamespaces(const JoinedNamespaces&) = delete;
  JoinedNamespaces& operator=(const JoinedNamespaces&) = delete;

  // False if the namespace could not be made: not root, no `ip`, no namespaces.
  bool made() const { return made_; }

  std::string near_address() const { return Address(1); }
  // Command that executes a shell command on the far host. The shell command is one further word.
  std::vector<std::string> Shell() const { return {"ip", "netns", "exec", far_, "sh", "-c"}; }

  // Disconnects the far end of the link.
  bool Cut() const { return Ip("-n " + far_ + " link set " + far_link_ + " down"); }
  bool Join() const { return Ip("-n " + far_ + " link set " + far_link_ + " up"); }

 private:
  std::string Address(int host) const { return fmt::format(fmt::runtime(subnet_), host); }
  static bool Ip(const std::string& arguments) {
    return std::system(("ip " + arguments + " >/dev/null 2>&1").c_str()) == 0;
  }

  std::string far_, near_link_, far_link_, subnet_;
  bool made_ = false;
};

}  // namespace shoal
