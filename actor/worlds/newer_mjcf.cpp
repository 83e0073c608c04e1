// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/newer_mjcf.h"

#include <fmt/core.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <string_view>

#include "common/base/one_line.h"

namespace shoal::worlds {
namespace {

// Source: MuJoCo's changelog (doc/changelog.rst) up to 3.12.0.
struct NewerWord {
  std::string_view word;     // an attribute, a keyword, or an element
  std::string_view element;  // if other elements have the attribute, too; empty = any
  std::string_view since;
  std::string_view instead = "";
};
constexpr NewerWord kWords[] = {
    {"actearly", "", "3.0.0"},
    {"actuatorfrcrange", "", "2.3.7", "forcerange of the actuators"},
    {"actuatorfrclimited", "", "2.3.7", "forcelimited of the actuators"},
    {"actuatorgravcomp", "", "3.1.4"},
    {"alignfree", "", "3.2.3"},
    {"armature", "spatial", "3.3.1"},
    {"armature", "fixed", "3.3.1"},
    {"assetdir", "", "2.3.0", "meshdir and texturedir"},
    {"attach", "", "3.2.0", "<include>"},
    {"autoreset", "", "3.2.1"},
    {"bulbradius", "", "3.1.5"},
    {"bvactive", "", "3.1.2"},
    {"cable", "", "2.3.0"},
    {"cameraid", "", "3.3.4"},
    {"colorspace", "", "3.3.3"},
    {"conflict", "compiler", "3.10.0"},
    {"contact", "", "3.3.5", "sensor touch"},
    {"content_type", "", "2.3.7"},
    {"dampratio", "", "3.1.6"},
    {"deformable", "", "3.0.0"},
    {"ellipsoidinertia", "", "2.3.4"},
    {"eulerdamp", "", "3.0.0"},
    {"extension", "", "2.3.0"},
    {"filterexact", "", "3.0.0", "dyntype filter"},
    {"flex", "", "3.0.0"},
    {"flexcomp", "", "3.0.0"},
    {"focal", "", "3.0.0"},
    {"focalpixel", "", "3.0.0"},
    {"frame", "", "3.1.0", "<body>, or the pose written into each element"},
    {"gravcomp", "", "2.3.1"},
    {"implicitfast", "", "2.3.3", "integrator implicit or Euler"},
    {"inertia", "mesh", "3.3.0"},
    {"inheritrange", "", "3.1.3", "ctrlrange"},
    {"invdiscrete", "", "3.0.0"},
    {"island", "", "3.0.0"},
    {"kinetic", "", "3.3.0"},
    {"kv", "position", "3.1.0", "damping of the joint"},
    {"ls_iterations", "", "3.0.0"},
    {"ls_tolerance", "", "3.0.0"},
    {"maxhullvert", "", "3.2.0"},
    {"model", "", "3.2.0", "<include>"},
    {"nativeccd", "", "3.2.3"},
    {"orthographic", "", "3.2.0"},
    {"plugin", "", "2.3.0"},
    {"potential", "", "3.3.0"},
    {"principal", "", "3.0.0"},
    {"principalpixel", "", "3.0.0"},
    {"projection", "", "3.5.0"},
    {"replicate", "", "3.1.5", "the elements written out"},
    {"resolution", "camera", "3.0.0"},
    {"sensorsize", "", "3.0.0"},
    {"site1", "", "3.2.3", "body1 and body2"},
    {"site2", "", "3.2.3", "body1 and body2"},
    {"sleep", "", "3.4.0"},
    {"sleep_tolerance", "", "3.4.0"},
    {"solreffriction", "", "2.3.6"},
    {"timeconst", "position", "3.1.6"},
    {"type", "light", "3.3.3", "directional=\"true\""},
};

// The text between the quotes that follow `label`, or empty if `label` is absent.
std::string_view Quoted(std::string_view reason, std::string_view label) {
  const size_t at = reason.find(label);
  if (at == std::string_view::npos) return {};
  const size_t begin = reason.find('\'', at + label.size());
  if (begin == std::string_view::npos) return {};
  const size_t end = reason.find('\'', begin + 1);
  return end == std::string_view::npos ? std::string_view()
                                       : reason.substr(begin + 1, end - begin - 1);
}

}  // namespace

std::string WithNewerMjcf(const std::string& reason) {
  std::string line;  // the reason with runs of blanks reduced to one
  for (const char c : OneLine(reason)) {
    if (c != ' ' || (!line.empty() && line.back() != ' ')) line += c;
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  const std::string_view element = Quoted(reason, "Element ");
  std::string_view word = Quoted(reason, "unrecognized attribute");
  const bool attribute = !word.empty();
  if (word.empty()) word = Quoted(reason, "invalid keyword");
  if (word.empty() && reason.find("unrecognized element") != std::string::npos) word = element;
  if (word.empty()) return line;
  const auto newer = std::ranges::find_if(kWords, [&](const NewerWord& known) {
    return known.word == word && (known.element.empty() || (attribute && known.element == element));
  });
  if (newer == std::end(kWords)) return line;
  return fmt::format("{}: MuJoCo has '{}' since {}, Shoal's engine is {}{}{}", line, word,
                     newer->since, mj_versionString(),
                     newer->instead.empty() ? "" : "; instead: ", newer->instead);
}

}  // namespace shoal::worlds
