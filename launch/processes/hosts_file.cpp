// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/hosts_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/process_plan.h"

namespace shoal::launch {
namespace {

using nlohmann::json;

constexpr int kMostActors = 1024;

// One JSON object of the file; reports unknown keys.
class Block {
 public:
  Block(const json& object, std::string path, std::string file)
      : object_(object), path_(std::move(path)), file_(std::move(file)) {
    if (!object.is_object()) throw UsageError("{}: '{}': expected an object", file_, path_);
  }

  bool Has(const char* key) const { return object_.contains(key); }

  const json& At(const char* key) {
    asked_.insert(key);
    if (!Has(key)) throw UsageError("{}: '{}' is missing", file_, Path(key));
    return object_.at(key);
  }
  std::string Text(const char* key) {
    const json& value = At(key);
    if (!value.is_string() || value.get<std::string>().empty()) {
      Refuse(key, "a string that is not empty");
    }
    return value.get<std::string>();
  }
  std::string Text(const char* key, const std::string& otherwise) {
    return Has(key) ? Text(key) : otherwise;
  }
  int Count(const char* key, int least) {
    const json& value = At(key);
    if (!value.is_number_integer() || value.get<int64_t>() < least ||
        value.get<int64_t>() > kMostActors) {
      Refuse(key, fmt::format("an integer from {} to {}", least, kMostActors));
    }
    return value.get<int>();
  }
  bool Flag(const char* key, bool otherwise) {
    if (!Has(key)) return otherwise;
    if (!At(key).is_boolean()) Refuse(key, "true or false");
    return At(key).get<bool>();
  }
  std::vector<std::string> Words(const char* key) {
    const json& value = At(key);
    const auto is_word = [](const json& word) {
      return word.is_string() && !word.get<std::string>().empty();
    };
    if (!value.is_array() || value.empty() || !std::ranges::all_of(value, is_word)) {
      Refuse(key, "a list of words");
    }
    return value.get<std::vector<std::string>>();
  }
  void RefuseOthers() const {
    for (const auto& [key, value] : object_.items()) {
      if (!asked_.contains(key)) throw UsageError("{}: unknown key '{}'", file_, Path(key));
    }
  }
  [[noreturn]] void Refuse(const char* key, const std::string& expected) const {
    throw UsageError("{}: '{}' = {}: expected {}", file_, Path(key), object_.at(key).dump(),
                     expected);
  }
  std::string Path(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

 private:
  const json& object_;
  const std::string path_, file_;
  std::set<std::string> asked_;
};

RemoteHost ParseHost(Block& block) {
  RemoteHost host;
  host.name = block.Text("name");
  host.actors = block.Count("actors", 1);
  host.ssh = block.Has("ssh")
                 ? block.Words("ssh")
                 : std::vector<std::string>{
                       "ssh", "-o", "BatchMode=yes", "-o", "ServerAliveInterval=5", host.name};
  host.programs = block.Text("programs", ProgramFolder());
  if (!host.programs.is_absolute()) block.Refuse("programs", "an absolute path");
  host.folder = block.Text("folder", ".shoal");
  host.interface = block.Text("interface", "auto");
  host.shared = block.Flag("shared", false);
  host.run = block.Text("run", "");
  block.RefuseOthers();
  return host;
}

}  // namespace

int Hosts::RemoteActors() const {
  int sum = 0;
  for (const RemoteHost& host : hosts) sum += host.actors;
  return sum;
}

Hosts ReadHostsFile(const std::filesystem::path& file) {
  const json object = ParseStrictJson(ReadFile(file), file);
  Block top(object, "", file);
  if (top.Text("schema") != kHostsSchema) top.Refuse("schema", fmt::format("\"{}\"", kHostsSchema));
  Hosts result;
  Block servers(top.At("servers"), "servers", file);
  result.address = servers.Text("address");
  result.interface = servers.Text("interface", "");
  if (servers.Has("actors")) result.actors_here = servers.Count("actors", 0);
  servers.RefuseOthers();
  const json& list = top.At("hosts");
  if (!list.is_array() || list.empty()) top.Refuse("hosts", "a list of hosts");
  top.RefuseOthers();
  std::set<std::string> names;
  for (size_t i = 0; i < list.size(); ++i) {
    Block block(list[i], fmt::format("hosts[{}]", i), file);
    result.hosts.push_back(ParseHost(block));
    if (!names.insert(result.hosts.back().name).second) {
      block.Refuse("name", "a name of its own: another host has it");
    }
  }
  return result;
}

void WriteHostsFile(const std::filesystem::path& file, const Hosts& hosts) {
  nlohmann::ordered_json servers{{"address", hosts.address}};
  if (!hosts.interface.empty()) servers["interface"] = hosts.interface;
  if (hosts.actors_here >= 0) servers["actors"] = hosts.actors_here;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const RemoteHost& host : hosts.hosts) {
    nlohmann::ordered_json entry{{"name", host.name},
                                 {"actors", host.actors},
                                 {"ssh", host.ssh},
                                 {"programs", host.programs.string()},
                                 {"folder", host.folder.string()},
                                 {"interface", host.interface},
                                 {"shared", host.shared}};
    if (!host.run.empty()) entry["run"] = host.run.string();
    list.push_back(std::move(entry));
  }
  const nlohmann::ordered_json object{
      {"schema", kHostsSchema}, {"servers", servers}, {"hosts", list}};
  WriteFileAtomically(file, object.dump(2) + "\n");
}

}  // namespace shoal::launch
