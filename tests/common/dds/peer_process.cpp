// SPDX-License-Identifier: Apache-2.0
#include "tests/common/dds/peer_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <sstream>
#include <vector>

#include "common/base/check.h"
#include "tests/support/paths.h"

extern char** environ;

namespace shoal::dds {
namespace {

// Removes and returns the first line of `lines`, without its end; empty when there is none.
std::string PopLine(std::string* lines) {
  const size_t end = lines->find('\n');
  if (end == std::string::npos) return "";
  std::string line = lines->substr(0, end);
  lines->erase(0, end + 1);
  return line;
}

}  // namespace

PeerProcess::PeerProcess(const std::string& role, const ClusterAddress& address)
    : address_(address) {
  std::vector<std::string> words{role, std::to_string(address.domain), address.tag};
  if (!address.secure.empty()) words.push_back(address.secure);
  Spawn(std::move(words));
  EXPECT_EQ(Answer(), "joined") << role;
}

PeerProcess::PeerProcess(const std::string& secure) {
  address_.secure = secure;
  Spawn(secure.empty() ? std::vector<std::string>{"claim"}
                       : std::vector<std::string>{"claim", secure});
  std::istringstream answer(Answer());
  std::string word;
  answer >> word >> address_.domain >> address_.tag;
  EXPECT_EQ(word, "joined");
}

void PeerProcess::Spawn(std::vector<std::string> words) {
  std::signal(SIGPIPE, SIG_IGN);  // a command to a peer that died fails the test, not kills it
  int down[2], up[2];
  CHECK(pipe2(down, O_CLOEXEC) == 0 && pipe2(up, O_CLOEXEC) == 0);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, down[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, up[1], STDOUT_FILENO);
  words.insert(words.begin(), ProgramPath("dds_peer"));
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int result = posix_spawn(&pid_, arguments[0], &actions, nullptr, arguments.data(), environ);
  CHECK(result == 0) << arguments[0];
  posix_spawn_file_actions_destroy(&actions);
  close(down[0]);
  close(up[1]);
  to_child_ = down[1];
  from_child_ = up[0];
}

PeerProcess::~PeerProcess() {
  Kill();
  close(to_child_);
  close(from_child_);
}

void PeerProcess::Kill() {
  if (pid_ < 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

void PeerProcess::Quit() {
  if (pid_ < 0) return;
  Send("quit");
  int status = 0;
  waitpid(pid_, &status, 0);
  EXPECT_EQ(status, 0);
  pid_ = -1;
}

void PeerProcess::Send(const std::string& command) {
  const std::string line = command + "\n";
  EXPECT_EQ(write(to_child_, line.data(), line.size()), static_cast<ssize_t>(line.size()));
}

std::string PeerProcess::Ask(const std::string& command, std::chrono::milliseconds deadline) {
  Send(command);
  return Answer(deadline);
}

std::string PeerProcess::Answer(std::chrono::milliseconds deadline) {
  return NextLine(false, deadline);
}

std::string PeerProcess::NextGot(std::chrono::milliseconds deadline) {
  return NextLine(true, deadline);
}

std::string PeerProcess::NextLine(bool want_got, std::chrono::milliseconds deadline) {
  std::string& wanted = want_got ? pending_got_ : pending_answers_;
  std::string& other = want_got ? pending_answers_ : pending_got_;
  std::string line = PopLine(&wanted);
  const auto end = std::chrono::steady_clock::now() + deadline;
  while (line.empty()) {
    const std::string next = ReadLine(end);
    if (next.empty()) break;
    if (next.starts_with("got ") == want_got) {
      line = next;
    } else {
      other += next + "\n";
    }
  }
  return line;
}

std::string PeerProcess::ReadLine(std::chrono::steady_clock::time_point end) {
  while (buffer_.find('\n') == std::string::npos) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    pollfd poll_fd{.fd = from_child_, .events = POLLIN, .revents = 0};
    if (left.count() <= 0 || poll(&poll_fd, 1, static_cast<int>(left.count())) <= 0) return "";
    char bytes[4096];
    const ssize_t size = read(from_child_, bytes, sizeof(bytes));
    if (size <= 0) return "";
    buffer_.append(bytes, static_cast<size_t>(size));
  }
  return PopLine(&buffer_);
}

}  // namespace shoal::dds
