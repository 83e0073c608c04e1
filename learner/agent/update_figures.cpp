// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/update_figures.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::learner {

std::string Figure::Tag() const {
  if (known_as.empty()) return "train/" + std::string(name);
  const bool whole = known_as.find('/') != std::string_view::npos;
  return (whole ? "" : "train/") + std::string(known_as);
}

// Compares names, because a constant of a header may have several addresses.
UpdateFigures::Entry* UpdateFigures::Find(const Figure& figure) {
  const auto at = std::ranges::find_if(
      entries_, [&](const Entry& entry) { return entry.figure->name == figure.name; });
  return at == entries_.end() ? nullptr : &*at;
}

void UpdateFigures::Set(const Figure& figure, double value) {
  CHECK(Find(figure) == nullptr) << figure.name << " is given twice";
  entries_.push_back({&figure, value});
}

void UpdateFigures::Replace(const Figure& figure, double value) {
  if (Entry* entry = Find(figure)) {
    entry->value = value;
  } else {
    entries_.push_back({&figure, value});
  }
}

std::optional<double> UpdateFigures::Get(const Figure& figure) const {
  for (const Entry& entry : entries_) {
    if (entry.figure->name == figure.name) return entry.value;
  }
  return std::nullopt;
}

}  // namespace shoal::learner
