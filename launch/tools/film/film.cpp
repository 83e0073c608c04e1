// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/film.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <future>

#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/config/run_files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/actor_program.h"
#include "launch/processes/scratch_folder.h"
#include "launch/tools/film/reel.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

// Reads a stream from a named pipe on a separate thread, because the stream is too large to store.
class PipeReading {
 public:
  PipeReading(const fs::path& path, const std::function<void(const fs::path&)>& read)
      : path_(path) {
    if (mkfifo(path.c_str(), 0600) != 0) Fail();
    // The descriptor stays open for writing, so the reader sees no end before EndStream closes it.
    held_ = Descriptor(open(path.c_str(), O_RDWR | O_CLOEXEC));
    if (held_.get() < 0) Fail();
    done_ = std::async(std::launch::async, [path, read] { read(path); });
  }
  ~PipeReading() { EndStream(); }
  PipeReading(const PipeReading&) = delete;
  PipeReading& operator=(const PipeReading&) = delete;

  // True if the reader has ended before its stream, with an error that Finish throws.
  bool broken() const {
    return done_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
  // Waits until the whole stream has been read. Call it once, after all other writers have closed
  // the pipe.
  void Finish() {
    EndStream();
    done_.get();
  }

 private:
  [[noreturn]] void Fail() const {
    throw RuntimeError("cannot make the pipe '{}': {}", path_.string(), std::strerror(errno));
  }
  void EndStream() {
    held_.Close();
    // Otherwise a reader that opens the pipe only now would wait for a writer.
    while (done_.valid() &&
           done_.wait_for(std::chrono::milliseconds(10)) != std::future_status::ready) {
      const Descriptor writer(open(path_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
    }
  }

  const fs::path path_;
  Descriptor held_;
  std::future<void> done_;
};

// "best, 11297 updates, 181764 env steps"
std::string LabelOf(const fs::path& checkpoint, const CheckpointState& state) {
  return fmt::format("{}, {} updates, {} env steps", checkpoint.filename().string(), state.updates,
                     state.env_steps);
}

// Films the episodes of one checkpoint. Returns false if `stop` ended it.
bool FilmCheckpoint(const FilmOrder& order, const fs::path& checkpoint, const std::string& label,
                    FilmReel* reel, FilmStrip* strip, const std::function<bool()>& stop) {
  const ScratchFolder scratch;
  const fs::path stream = scratch.path() / "frames";
  PipeReading reading(stream, [&](const fs::path& path) {
    reel->Add(path, label, static_cast<uint32_t>(order.episodes), strip);
  });
  try {
    const auto played =
        EvaluateByActor({.run = order.run,
                         .checkpoint = checkpoint,
                         .episodes = order.episodes,
                         .seed = order.seed,
                         .frames = {.stream = stream, .side = kFilmView, .quality = order.quality}},
                        [&] { return reading.broken() || stop(); });
    if (!played && stop()) return false;
  } catch (const Error&) {
    // The side that failed first has the reason: without a reader the actor fails too, and without
    // an actor there is nothing to read.
    if (reading.broken()) reading.Finish();
    throw;
  }
  reading.Finish();
  return true;
}

}  // namespace

fs::path FilmPath(const fs::path& run, const std::string& name) {
  return run / kVideoFolder / (name + ".mp4");
}

void CheckFilmOutput(const fs::path& run, const fs::path& output) {
  if (output.extension() != ".mp4") {
    throw UsageError("--output {}: a film is an .mp4 file", output.string());
  }
  // The run's own film folder is made later. If it does not exist yet, check that it can be made.
  const fs::path films = FilmPath(run, "").parent_path();
  CheckWritable(output.parent_path() == films && !fs::exists(films) ? films : output);
}

std::optional<FilmMade> MakeFilm(const FilmOrder& order, const std::function<bool()>& stop,
                                 const std::function<void(const std::string&)>& say) {
  const RunConfig run = ReadRunConfig(order.run);
  FilmReel reel(run.spec, order.output);
  std::vector<CheckpointStrip> strips;
  for (const fs::path& checkpoint : order.checkpoints) {
    const CheckpointState state = ReadPolicyFiles(checkpoint).state;
    const std::string label = LabelOf(checkpoint, state);
    say(fmt::format("filming {} episodes of {}", order.episodes, label));
    FilmStrip strip;
    if (!FilmCheckpoint(order, checkpoint, label, &reel, order.strips ? &strip : nullptr, stop)) {
      return std::nullopt;
    }
    if (order.strips) strips.push_back({state.env_steps, strip.Image()});
  }
  reel.Finish();
  return FilmMade{reel.frames(), reel.seconds(), fs::file_size(order.output), std::move(strips)};
}

}  // namespace shoal::launch
