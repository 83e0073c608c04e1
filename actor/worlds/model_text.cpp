// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/model_text.h"

#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>

#include "actor/worlds/engine_messages.h"
#include "actor/worlds/model_loading.h"
#include "actor/worlds/newer_mjcf.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

constexpr char kName[] = "model.xml";
constexpr int kErrorBytes = 1000;

// One virtual file. mjVFS has megabytes, so it is on the heap.
class VirtualFile {
 public:
  explicit VirtualFile(const std::string& text) : vfs_(std::make_unique<mjVFS>()) {
    mj_defaultVFS(vfs_.get());
    if (mj_makeEmptyFileVFS(vfs_.get(), kName, static_cast<int>(text.size())) != 0) {
      throw RuntimeError("MuJoCo: no room for a task's model of {} bytes", text.size());
    }
    std::memcpy(vfs_->filedata[0], text.data(), text.size());
  }
  ~VirtualFile() { mj_deleteVFS(vfs_.get()); }
  VirtualFile(const VirtualFile&) = delete;
  VirtualFile& operator=(const VirtualFile&) = delete;

  const mjVFS* get() const { return vfs_.get(); }

 private:
  std::unique_ptr<mjVFS> vfs_;
};

}  // namespace

ModelHandle LoadModelText(const std::string& mjcf, const std::string& user_file) {
  if (!user_file.empty()) return LoadModel("", user_file);
  InstallEngineCallbacks();
  if (mjcf.empty()) throw UsageError("a task's model is empty text");
  char reason[kErrorBytes] = "";
  ModelHandle model(mj_loadXML(kName, VirtualFile(mjcf).get(), reason, kErrorBytes));
  if (model == nullptr) {
    throw UsageError("a task's model does not load: {}", WithNewerMjcf(reason));
  }
  return model;
}

ModelHandle LoadModelFile(const WorldOptions& options, const std::string& file) {
  if (options.ModelOr(file).empty()) throw UsageError("LoadModelFile: no file is named");
  return LoadModel("", options.ModelOr(file));
}

}  // namespace shoal::worlds
