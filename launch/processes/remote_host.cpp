// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/remote_host.h"

#include <cstdlib>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/interrupted.h"
#include "common/config/run_files.h"
#include "common/credentials/credentials.h"
#include "common/run_folder/run_file_names.h"
#include "common/wire/process_name.h"
#include "launch/processes/scratch_folder.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kDeadline{30};  // for one command on the host
constexpr char kDdsOverride[] = "SHOAL_DDS_XML";
constexpr char kDdsCopy[] = "dds.xml";    // its copy in the run's folder on the host
constexpr char kSecureCopy[] = "secure";  // the actors' credentials in that folder
constexpr char kActorRole[] = "actor";

// Runs the command through `env`, which searches PATH for the program.
std::vector<std::string> OnPath(std::vector<std::string> command) {
  command.insert(command.begin(), "/usr/bin/env");
  return command;
}

std::vector<std::string> Through(const RemoteHost& host, const std::string& line) {
  std::vector<std::string> command = OnPath(host.ssh);
  command.push_back("exec " + ShellLine({"sh", "-c", line}));  // works with any login shell
  return command;
}

// Runs a command to its end; `what` names the command in errors.
void RunOrThrow(const std::string& what, const std::vector<std::string>& command,
                const fs::path& input, const fs::path& output, const StopQuestion& stop) {
  const ScratchFolder scratch;
  ProcessSpec spec;
  spec.command = command;
  spec.input = input;
  spec.output = output.empty() ? scratch.path() / "output" : output;
  spec.errors = scratch.path() / "errors";
  const auto status = RunToEnd(spec, kDeadline, stop);
  if (!status && stop()) throw Interrupted(what + ": not finished");
  if (!status) throw RuntimeError("{}: took more than {} s", what, kDeadline.count());
  if (status->Clean()) return;
  const std::string line = LastLine(spec.errors);
  throw RuntimeError("{}: {}", what, line.empty() ? status->Describe() : line);
}

// Lines around the output of a remote command. They separate it from the output of the login shell,
// such as a message of the day.
constexpr char kAnswerBegins[] = "shoal: the answer begins",
               kAnswerEnds[] = "shoal: the answer ends";

std::string Ask(const std::string& what, const RemoteHost& host, const std::string& line,
                const fs::path& input, const StopQuestion& stop) {
  const ScratchFolder scratch;
  const fs::path output = scratch.path() / "output";
  const std::string framed =
      fmt::format("printf '\\n%s\\n' '{}' && {{ {}; }} && printf '\\n%s\\n' '{}'", kAnswerBegins,
                  line, kAnswerEnds);
  RunOrThrow(what, Through(host, framed), input, output, stop);
  const std::string said = ReadFile(output);
  const std::string begins = fmt::format("\n{}\n", kAnswerBegins);
  const std::string ends = fmt::format("\n{}\n", kAnswerEnds);
  const size_t begin = said.find(begins), end = said.rfind(ends);
  if (begin == std::string::npos || end == std::string::npos || end < begin + begins.size()) {
    throw RuntimeError("{}: its output is incomplete: received {} bytes", what, said.size());
  }
  return said.substr(begin + begins.size(), end - begin - begins.size());
}

// Removes line breaks at the end.
std::string OneAnswer(std::string answer) {
  while (!answer.empty() && (answer.back() == '\n' || answer.back() == '\r')) answer.pop_back();
  return answer;
}

bool IsPageOf(const fs::path& file, const ActorRange& actors) {
  for (int id = actors.first; id < actors.first + actors.count; ++id) {
    if (file.extension() == ".page" &&
        file.filename().string().starts_with(ProcessName::Actor(static_cast<uint32_t>(id)).Text() +
                                             "-")) {
      return true;
    }
  }
  return false;
}

std::vector<fs::path> PagesIn(const fs::path& made, const ActorRange& actors) {
  std::vector<fs::path> pages;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(made, error)) {
    if (fs::is_regular_file(entry.symlink_status()) && IsPageOf(entry.path(), actors)) {
      pages.push_back(entry.path());
    }
  }
  return pages;
}

const char* DdsOverride() {
  const char* file = std::getenv(kDdsOverride);
  return file == nullptr || *file == '\0' ? nullptr : file;
}

}  // namespace

std::string ShellLine(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

void CheckHost(const RemoteHost& host, const StopQuestion& stop) {
  const std::string program = host.programs / "shoal-actor";
  const std::string version = OneAnswer(Ask(fmt::format("host {}: {}", host.name, program), host,
                                            ShellLine({program, "--version"}), "", stop));
  // The release must be the same; commits may differ.
  if (!version.starts_with(fmt::format("shoal-actor {} ", BuildVersion()))) {
    throw RuntimeError("host {}: {} has version '{}', this program has '{}'", host.name, program,
                       version, BuildVersion());
  }
}

void PushRun(const fs::path& run, const ActorRange& actors, RemoteHost* host,
             const StopQuestion& stop) {
  if (host->shared) return;
  const ScratchFolder scratch;
  const fs::path archive = scratch.path() / "run.tar";
  std::vector<std::string> pack =
      OnPath({"tar", "-c", "-f", archive, "-C", fs::absolute(run), kConfigFile, kClusterFile});
  for (const fs::path& page : PagesIn(run / kMadeFolder, actors)) {
    pack.push_back(fs::path(kMadeFolder) / page.filename());
  }
  if (const char* file = DdsOverride()) {
    WriteFileAtomically(scratch.path() / kDdsCopy, ReadFile(file));
    pack.insert(pack.end(), {"-C", scratch.path(), kDdsCopy});
  }
  if (const std::string secure = ReadClusterAddress(run).secure; !secure.empty()) {
    MakeFolders(scratch.path() / kSecureCopy);
    pack.insert(pack.end(), {"-C", scratch.path(), kSecureCopy});
    for (const fs::path& file : CredentialFiles(secure, kActorRole)) {
      WriteFilePrivately(scratch.path() / kSecureCopy / file.filename(), ReadFile(file));
    }
    host->secure = kSecureCopy;  // in the run's folder on the host
  }
  RunOrThrow("tar of " + run.string(), pack, "", "", stop);
  const std::string folder = ShellLine({host->run});
  const std::string unpack = fmt::format(
      "umask 077 && mkdir -p {0}/{1} && cd {0} && rm -rf {2} {3} {4} {5} && tar -x "
      "--skip-old-files --no-same-owner -f - && pwd",
      folder, kMadeFolder, kConfigFile, kClusterFile, kDdsCopy, kSecureCopy);
  host->run =
      OneAnswer(Ask(fmt::format("host {}: copying the run to '{}'", host->name, host->run.string()),
                    *host, unpack, archive, stop));
  if (!host->secure.empty()) host->secure = host->run / kSecureCopy;
  if (!host->run.is_absolute()) {
    throw RuntimeError("host {}: expected the path of its run folder, got '{}'", host->name,
                       host->run.string());
  }
}

void FetchSequenceLogs(const RemoteHost& host, const ActorRange& actors, const fs::path& run,
                       const StopQuestion& stop) {
  if (host.shared) return;
  const ScratchFolder scratch;
  const fs::path archive = scratch.path() / "made.tar";
  WriteFileAtomically(
      archive,
      Ask(fmt::format("host {}: fetching counter pages of '{}'", host.name, host.run.string()),
          host, "tar -c -f - -C " + ShellLine({host.run}) + " made", "", stop));
  RunOrThrow(fmt::format("host {}: unpacking counter pages", host.name),
             OnPath({"tar", "-x", "--no-same-owner", "-f", archive, "-C", scratch.path()}), "", "",
             stop);
  for (const fs::path& page : PagesIn(scratch.path() / kMadeFolder, actors)) {
    WriteFileAtomically(run / kMadeFolder / page.filename(), ReadFile(page));
  }
}

ProcessSpec RemoteActor(const RemoteHost& host, int id, const fs::path& run) {
  std::vector<std::string> words{"exec", "env", "OMP_NUM_THREADS=1", "OMP_WAIT_POLICY=passive",
                                 "LP_NUM_THREADS=0"};
  if (const char* file = DdsOverride()) {
    const fs::path path = host.shared ? fs::absolute(file) : host.run / kDdsCopy;
    words.push_back(fmt::format("{}={}", kDdsOverride, path.string()));
  }
  const std::vector<std::string> actor{host.programs / "shoal-actor",
                                       "--run",
                                       host.run,
                                       "--id",
                                       std::to_string(id),
                                       "--interface",
                                       host.interface,
                                       "--stop-with-input"};
  words.insert(words.end(), actor.begin(), actor.end());
  if (!host.secure.empty()) words.insert(words.end(), {"--secure", host.secure});
  ProcessSpec spec;
  spec.role = ProcessName::Actor(0).role;
  spec.id = id;
  spec.command = Through(host, ShellLine(words));
  spec.output = LogFile(run, spec.Name());
  spec.holds_input = true;
  spec.elsewhere = true;
  return spec;
}

}  // namespace shoal::launch
