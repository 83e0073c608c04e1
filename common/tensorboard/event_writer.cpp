#include "common/tensorboard/event_writer.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/log.h"
#include "common/tensorboard/event.pb.h"
#include "common/tensorboard/tf_record.h"

namespace shoal::tensorboard {
namespace {

constexpr size_t kPendingBytes = 64 * 1024;

std::string FileName() {
  // Tells apart the files that one process makes within one second.
  static std::atomic<int> files{0};
  char host[256] = "unknown";
  gethostname(host, sizeof host - 1);
  return fmt::format("events.out.tfevents.{:010}.{}.{}.{}", WallTimeNs() / 1'000'000'000, host,
                     getpid(), files++);
}

void AppendEvent(const proto::Event& event, std::string* out) {
  AppendTfRecord(event.SerializeAsString(), out);
}

}  // namespace

EventWriter::EventWriter(const std::filesystem::path& folder) : path_(folder / FileName()) {
  MakeFolders(folder);
  fd_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (fd_ < 0) throw RuntimeError("cannot create '{}': {}", path_.string(), std::strerror(errno));
  proto::Event event;
  event.set_wall_time(WallTimeSeconds());
  event.set_file_version("brain.Event:2");
  AppendEvent(event, &pending_);
}

EventWriter::~EventWriter() {
  try {
    Flush();
  } catch (const Error& e) {
    log::Failure("{}", e.what());
  }
  close(fd_);
}

void EventWriter::Scalar(const std::string& tag, int64_t step, double value) {
  proto::Event event;
  event.set_wall_time(WallTimeSeconds());
  event.set_step(step);
  proto::Summary::Value* point = event.mutable_summary()->add_value();
  point->set_tag(tag);
  point->set_simple_value(static_cast<float>(value));
  AppendEvent(event, &pending_);
  if (pending_.size() >= kPendingBytes) Flush();
}

void EventWriter::Flush() {
  size_t done = 0;
  while (done < pending_.size()) {
    const ssize_t n = write(fd_, pending_.data() + done, pending_.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int error = errno;
      pending_.erase(0, done);
      throw RuntimeError("cannot write '{}': {}", path_.string(), std::strerror(error));
    }
    done += static_cast<size_t>(n);
  }
  pending_.clear();
}

}  // namespace shoal::tensorboard
