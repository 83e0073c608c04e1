// E environments stepped together: reset, act, step, and one record each time.
//
// Borrows everything it is built from. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "actor/action_selector.h"
#include "actor/chunk_window.h"
#include "actor/episode_log.h"
#include "actor/frame_stack.h"
#include "actor/made_page.h"
#include "actor/rollout_state.h"
#include "actor/worlds/environment.h"
#include "common/base/clock.h"

namespace shoal::actor {

// Seconds spent since the start, by stage.
struct StageSeconds {
  double physics = 0;  // and all else that an environment does but rendering
  double rendering = 0;
  double inference = 0;
};

class Rollout {
 public:
  Rollout(const Config& config, const ObservationSpec& spec,
          std::vector<std::unique_ptr<worlds::Environment>> environments, uint32_t first_env,
          MadePage& made, ChunkWindow& window, ActionSelector& selector);

  // One step of every environment, episodes beginning where the last ended. False, and nothing
  // done, while the window has no room for its records.
  bool TryStep();

  // Where it is, without session and count of records, which are others'.
  RolloutState State() const;
  // Goes on where another process was, before the first step: plays the running episodes again by
  // their actions, publishing nothing. Throws Error when the state is of other environments.
  void Restore(const RolloutState& state);

  uint64_t env_steps() const { return env_steps_; }
  const EpisodeLog& episodes() const { return episodes_; }
  StageSeconds seconds() const;

 private:
  struct Slot {
    std::unique_ptr<worlds::Environment> environment;
    FrameStack stack;
    EpisodeFigures figures;
    uint32_t episode = 0;
    bool running = false;
    std::vector<float> actions;  // of the running episode
  };

  void BeginEpisode(int e);
  void StepOne(int e);
  void PlayAgain(int e, const EpisodeState& state);
  void FillHeader(int e, RecordKind kind, RecordHeader* header) const;
  void Publish(uint8_t* record);

  const uint64_t seed_;
  const RecordLayout layout_;
  const uint32_t first_env_;
  MadePage& made_;
  ChunkWindow& window_;
  ActionSelector& selector_;
  std::vector<Slot> slots_;
  EpisodeLog episodes_;
  double environment_seconds_ = 0, inference_seconds_ = 0;
  uint64_t env_steps_ = 0;
};

}  // namespace shoal::actor
