// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/access.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "common/base/error.h"
#include "common/base/random_bytes.h"

namespace shoal::launch {

std::string MakeToken() {
  std::array<uint8_t, 16> random{};
  FillWithRandomBytes(std::as_writable_bytes(std::span(random)));
  std::string token;
  for (const uint8_t byte : random) token += fmt::format("{:02x}", byte);
  return token;
}

bool EqualInConstantTime(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned>(static_cast<uint8_t>(a[i]) ^ static_cast<uint8_t>(b[i]));
  }
  return difference == 0;
}

std::string_view CookieValue(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    std::string_view pair = header.substr(0, header.find(';'));
    header.remove_prefix(std::min(header.size(), pair.size() + 1));
    pair.remove_prefix(std::min(pair.find_first_not_of(' '), pair.size()));
    if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=') {
      return pair.substr(name.size() + 1);
    }
  }
  return {};
}

Access Gate::Decide(const Caller& caller) const {
  const bool loopback = listen_.Loopback();
  if (loopback && !OwnName(caller.host)) return Access::kForeign;
  if (caller.acts) {
    if (!caller.origin.empty() && caller.origin != "http://" + caller.host) {
      return Access::kForeign;
    }
    if (!caller.fetch_site.empty() && caller.fetch_site != "same-origin" &&
        caller.fetch_site != "none") {
      return Access::kForeign;
    }
    return EqualInConstantTime(caller.header_token, token_) ? Access::kAllowed : Access::kNoToken;
  }
  bool known = false;
  for (const std::string& shown : {caller.header_token, caller.cookie_token, caller.query_token}) {
    known = EqualInConstantTime(shown, token_) || known;
  }
  return loopback || known ? Access::kAllowed : Access::kNoToken;
}

// The port is not compared, because behind `ssh -L` it differs.
bool Gate::OwnName(std::string_view host) const {
  const std::string_view name = host.substr(0, host.rfind(':'));
  return name == "localhost" || name == listen_.address || name == "127.0.0.1";
}

}  // namespace shoal::launch
