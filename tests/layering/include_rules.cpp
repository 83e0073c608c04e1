// SPDX-License-Identifier: Apache-2.0
#include "tests/layering/include_rules.h"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <string_view>

namespace shoal {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kTopFolders = {"common",  "actor",  "replay_server",
                                              "learner", "launch", "tests"};

// Start of an include path -> the folder that wraps the library.
const std::map<std::string, std::string> kHomes = {
    {"dds/", "common/dds"},
    {"dnnl", "common/nn"},
    {"oneapi/", "common/nn"},
    {"Eigen/", "common/nn"},
    {"mujoco/", "actor/worlds"},
    {"GL/", "actor/worlds"},
    {"spdlog/", "common/base"},
    {"png.h", "common/image"},
    {"openssl/", "common/credentials"},
    {"libav", "launch/tools/film"},
    {"libsw", "launch/tools/film"},
    {"cairo", "launch/tools/film"},
    {"httplib", "launch/tools/web"},
    {"pybind11/", "launch/tools/python"},
    {"hdf5", "launch/tools/dataset"},
    {"cublas", "learner/device"},
    {"cudnn", "learner/device"},
};

// Represents a third-party program, which uses only what the documentation describes.
const std::string kStranger = "tests/stock_client";

// Tasks as users write them: their physics halves include the engine.
const std::vector<std::string> kUsersTasks = {"tests/integration/crashing_point/",
                                              "tests/own_task/troubled/"};

const std::set<std::string> kEmptyNames = {"utils", "util",    "helpers", "helper",
                                           "misc",  "manager", "common"};

// Rooms of a top folder in their order: each may use the rooms before it. Files in the top folder
// itself connect the rooms and may use all of them. A header of the top folder is listed if a room
// implements it.
const std::map<std::string, std::vector<std::string>> kRooms = {
    {"actor", {"worlds", "hosted", "acting", "sending", "loop", "evaluation"}},
    {"replay_server", {"core", "service"}},
    {"learner", {"engine", "agent", "device", "batch_stream.h", "rollouts"}},
    {"launch",
     {"record", "processes", "watch", "run", "client", "check", "commands", "tools/film",
      "tools/experiment", "tools/report", "tools/export", "tools/dataset", "tools/observability",
      "tools/project", "tools/web", "tools/commands", "tools/manual", "tools/python"}},
};

// A folder, or one header, that a room may not include; files that begin with a word of `except`
// may.
struct Ban {
  std::string room, start, why;
  std::vector<std::string> except = {};
};

const std::vector<Ban> kBans = [] {
  std::vector<Ban> bans = {
      {"replay_server/core", "replay_server/service/", "the core knows nothing of its service"}};
  for (const char* files :
       {"common/base/descriptor.h", "common/base/file_lock.h", "common/base/files.h",
        "common/base/shared_memory.h", "common/checkpoint/", "common/config/config_io.h",
        "common/config/run_files.h", "common/run_folder/", "cstdio", "fcntl.h", "filesystem",
        "fstream", "stdio.h", "sys/mman.h", "sys/stat.h", "unistd.h"}) {
    bans.push_back({"learner/agent", files, "an agent is in memory: checkpoints are kept for it"});
    bans.push_back({"learner/engine", files, "an engine computes"});
  }
  bans.push_back(
      {"learner/agent", "common/nn/host_memory.h", "an algorithm does not look into arrays"});
  bans.push_back({"learner/agent",
                  "common/nn/team.h",
                  "its threads are those of replicas",
                  {"learner/agent/replicated_agent.cpp"}});
  // Roles depend on the link; only their programs choose its implementation.
  for (const char* room : {"actor/acting", "actor/sending", "actor/loop", "actor/evaluation",
                           "replay_server/service", "learner", "learner/rollouts"}) {
    bans.push_back(
        {room,
         "common/dds/",
         "a role knows the link alone (common/link)",
         {"learner/main.cpp", "learner/command_line.", "replay_server/service/command_line."}});
  }
  bans.push_back({"launch/client",
                  "common/dds/",
                  "a client knows the link alone (common/link)",
                  {"launch/client/run_connection."}});
  // A simulation runs these rooms on its own clock and threads (common/base/scheduler.h).
  for (const char* room :
       {"actor/acting", "actor/sending", "actor/loop", "actor/evaluation", "common/intake",
        "common/link", "common/wire", "launch/client", "launch/processes", "launch/record",
        "launch/run", "launch/watch", "learner", "learner/rollouts", "replay_server/service"}) {
    for (const char* header : {"condition_variable", "mutex", "thread"}) {
      bans.push_back({room, header, "waits and threads are those of common/base (scheduler.h)"});
    }
  }
  // Plain classes of one thread, whose results depend on their arguments alone.
  for (const std::string room : {"replay_server/core", "learner/engine", "learner/agent"}) {
    for (const char* transport : {"common/dds/", "common/link/"}) {
      bans.push_back({room, transport, "no transport here"});
    }
    for (const char* clock : {"common/base/clock.h", "chrono", "ctime", "sys/time.h", "time.h"}) {
      bans.push_back({room, clock, "no clock here"});
    }
    for (const char* lock : {"common/base/mutex.h", "common/base/watchdog.h", "condition_variable",
                             "mutex", "pthread.h", "shared_mutex", "thread"}) {
      bans.push_back({room, lock, "no threads here"});
    }
  }
  return bans;
}();

std::vector<fs::path> Sources(const fs::path& root) {
  static const std::set<std::string> kExtensions = {".h", ".cpp", ".cc", ".c"};
  std::vector<fs::path> sources;
  for (const std::string& folder : kTopFolders) {
    if (!fs::is_directory(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.is_regular_file() && kExtensions.contains(entry.path().extension().string())) {
        sources.push_back(entry.path().lexically_relative(root));
      }
    }
  }
  std::ranges::sort(sources);
  return sources;
}

// First two folders of a path: "common/dds"; "launch" where there is only one. The rooms of the
// tools lie one level deeper: "launch/tools/web".
std::string Room(const fs::path& path) {
  std::vector<std::string> parts;
  for (const auto& part : path.parent_path()) parts.push_back(part.string());
  if (parts.empty()) return "";
  if (parts.size() == 1) return parts[0];
  const std::string room = parts[0] + "/" + parts[1];
  return room == "launch/tools" && parts.size() > 2 ? room + "/" + parts[2] : room;
}

std::string Top(const fs::path& path) { return path.begin()->string(); }

// Removes white space and then `start` from the front; false when something else is there.
bool Skip(std::string_view start, std::string_view* text) {
  text->remove_prefix(std::min(text->find_first_not_of(" \t"), text->size()));
  if (!text->starts_with(start)) return false;
  text->remove_prefix(start.size());
  return true;
}

// The path that a line includes; empty if it is no #include.
std::string IncludedPath(std::string_view line) {
  if (!Skip("#", &line) || !Skip("include", &line)) return "";
  if (!Skip("<", &line) && !Skip("\"", &line)) return "";
  return std::string(line.substr(0, line.find_first_of(">\"")));
}

// Folders of common in the order of its CMakeLists.txt.
std::vector<std::string> CommonOrder(const fs::path& root) {
  std::vector<std::string> order;
  std::ifstream file(root / "common/CMakeLists.txt");
  for (std::string line; std::getline(file, line);) {
    std::string_view rest = line;
    if (!Skip("add_subdirectory(", &rest)) continue;
    order.push_back("common/" + std::string(rest.substr(0, rest.find(')'))));
  }
  return order;
}

// Whether a file may use another one of the same top folder.
bool MayUseRoom(const fs::path& file, const fs::path& included) {
  const auto rooms = kRooms.find(Top(file));
  if (rooms == kRooms.end()) return true;
  const auto& order = rooms->second;
  const auto place = [&](const fs::path& path) {
    const auto own = std::ranges::find(order, path.filename().string());
    if (own != order.end()) return own;
    return std::ranges::find(order, fs::path(Room(path)).lexically_relative(Top(path)).string());
  };
  // A room that is not in the list may not be used before it is given its place there.
  const auto from = place(file), to = place(included);
  if (from == order.end()) return Room(file) == Top(file) || Room(file) == Room(included);
  return to < from || (to == from && to != order.end());
}

bool MayUseFolder(const fs::path& file, const fs::path& included,
                  const std::vector<std::string>& common_order) {
  static const std::map<std::string, int> kRank = {{"common", 0},        {"actor", 1},
                                                   {"replay_server", 1}, {"learner", 1},
                                                   {"launch", 2},        {"tests", 3}};
  const std::string from = Top(file), to = Top(included);
  if (from != to) return kRank.at(from) > kRank.at(to);
  if (from != "common") return MayUseRoom(file, included);
  if (Room(file) == Room(included)) return true;
  const auto from_place = std::ranges::find(common_order, Room(file));
  const auto to_place = std::ranges::find(common_order, Room(included));
  return from_place != common_order.end() && to_place < from_place;
}

// The fault of including `included` in `file`; empty if there is none.
std::string IncludeFault(const fs::path& file, const std::string& included,
                         const std::vector<std::string>& common_order) {
  const auto begins = [&](const std::string& word) { return file.string().starts_with(word); };
  for (const auto& [room, start, why, except] : kBans) {
    const bool hit = start.ends_with('/') ? included.starts_with(start) : included == start;
    if (!hit || Room(file) != room || std::ranges::any_of(except, begins)) continue;
    return fmt::format("{} may not use {}: {}", room, included, why);
  }
  if (std::ranges::find(kTopFolders, Top(included)) != kTopFolders.end()) {
    if (MayUseFolder(file, included, common_order)) return "";
    return fmt::format("{} may not use {}", Room(file), included);
  }
  for (const auto& [start, home] : kHomes) {
    if (!included.starts_with(start) || Room(file) == home) continue;
    if (file.string().starts_with("tests/" + home + "/")) continue;
    if (Room(file) == kStranger) continue;
    const auto holds = [&](const std::string& task) { return file.string().starts_with(task); };
    if (start == "mujoco/" && std::ranges::any_of(kUsersTasks, holds)) continue;
    return fmt::format("<{}> belongs to {} alone", included, home);
  }
  return "";
}

std::string NameFault(const fs::path& file) {
  for (const auto& part : file.lexically_relative(Top(file))) {
    if (kEmptyNames.contains(part.stem().string()) && part != "common") {
      return fmt::format("\"{}\" says nothing", part.string());
    }
  }
  return "";
}

void CheckFile(const fs::path& root, const fs::path& file,
               const std::vector<std::string>& common_order, std::vector<std::string>* breaches) {
  std::ifstream stream(root / file);
  bool once = false;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    once = once || line == "#pragma once";
    const std::string included = IncludedPath(line);
    if (included.empty()) continue;
    const std::string fault = IncludeFault(file, included, common_order);
    if (!fault.empty()) breaches->push_back(fmt::format("{}:{}: {}", file.string(), number, fault));
  }
  if (file.extension() == ".h" && !once) {
    breaches->push_back(fmt::format("{}:1: no #pragma once", file.string()));
  }
  const std::string fault = NameFault(file);
  if (!fault.empty()) breaches->push_back(fmt::format("{}:1: {}", file.string(), fault));
}

}  // namespace

std::vector<std::string> FindBreaches(const fs::path& root) {
  const std::vector<std::string> common_order = CommonOrder(root);
  std::vector<std::string> breaches;
  for (const fs::path& file : Sources(root)) CheckFile(root, file, common_order, &breaches);
  return breaches;
}

size_t CountSources(const fs::path& root) { return Sources(root).size(); }

}  // namespace shoal
