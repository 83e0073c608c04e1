// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/model_loading.h"

#include <mujoco/mujoco.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "actor/worlds/engine_messages.h"
#include "actor/worlds/model_files.h"
#include "actor/worlds/newer_mjcf.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/random.h"

namespace shoal::worlds {
namespace {

constexpr int kErrorBytes = 1000;

// Files in memory. The engine finds them by name, in whatever folder it looks.
class VirtualFolder {
 public:
  VirtualFolder() : vfs_(std::make_unique<mjVFS>()) { mj_defaultVFS(vfs_.get()); }
  ~VirtualFolder() { mj_deleteVFS(vfs_.get()); }
  VirtualFolder(const VirtualFolder&) = delete;
  VirtualFolder& operator=(const VirtualFolder&) = delete;

  void Add(const std::string& name, std::string_view text) {
    CHECK(mj_makeEmptyFileVFS(vfs_.get(), name.c_str(), static_cast<int>(text.size())) == 0)
        << name;
    const int index = mj_findFileVFS(vfs_.get(), name.c_str());
    CHECK(index >= 0) << name;
    std::memcpy(vfs_->filedata[index], text.data(), text.size());
  }

  const mjVFS* get() const { return vfs_.get(); }

 private:
  std::unique_ptr<mjVFS> vfs_;  // megabytes, so not on the stack
};

}  // namespace

void ModelDeleter::operator()(mjModel_* model) const { mj_deleteModel(model); }
void DataDeleter::operator()(mjData_* data) const { mj_deleteData(data); }

namespace {

ModelHandle Compile(const std::string& name, const std::string& user_file,
                    const std::string& addition) {
  // The engine draws the stars of a procedural sky from the C library's generator, which nothing
  // else uses here. The fixed seed gives every process the same sky.
  std::srand(1);
  if (!user_file.empty() && !std::filesystem::is_regular_file(user_file)) {
    throw UsageError("model file '{}' does not exist", user_file);
  }
  VirtualFolder folder;
  if (user_file.empty()) {
    for (const ModelFile& file : EmbeddedModelFiles())
      folder.Add(std::string(file.name), file.text);
  }
  std::filesystem::path root = user_file.empty() ? name : user_file;
  if (!addition.empty()) {
    // The engine looks for includes and meshes beside the root. So a root in the same folder
    // includes the model's root and adds to it.
    constexpr const char* kRoot = "shoal_model_with_addition.xml";
    folder.Add(kRoot, fmt::format("<mujoco><include file=\"{}\"/>{}</mujoco>",
                                  root.filename().string(), addition));
    root.replace_filename(kRoot);
  }
  char reason[kErrorBytes] = "";
  ModelHandle model(mj_loadXML(root.c_str(), folder.get(), reason, kErrorBytes));
  CHECK(model != nullptr || !user_file.empty()) << name << ": " << reason;
  if (model == nullptr) {
    throw RuntimeError("model file '{}' does not load: {}", user_file, WithNewerMjcf(reason));
  }
  return model;
}

}  // namespace

ModelHandle LoadModel(const std::string& name, const std::string& user_file,
                      const std::string& addition) {
  InstallEngineCallbacks();
  if (!user_file.empty()) return Compile(name, user_file, addition);
  static std::mutex mutex;
  static std::map<std::pair<std::string, std::string>, ModelHandle> compiled;
  const std::lock_guard lock(mutex);
  ModelHandle& original = compiled[{name, addition}];
  if (original == nullptr) original = Compile(name, "", addition);
  ModelHandle copy(mj_copyModel(nullptr, original.get()));
  if (copy == nullptr) throw RuntimeError("MuJoCo: no memory for a copy of model '{}'", name);
  return copy;
}

DataHandle MakeData(const mjModel_& model) {
  DataHandle data(mj_makeData(&model));
  if (data == nullptr) throw RuntimeError("MuJoCo: no memory for the state of a model");
  return data;
}

std::string ModelFingerprint(const mjModel_& model) {
  std::vector<unsigned char> bytes(static_cast<size_t>(mj_sizeModel(&model)));
  mj_saveModel(&model, nullptr, bytes.data(), static_cast<int>(bytes.size()));
  const uint64_t hash =
      HashWords({HashBytes(bytes.data(), bytes.size()), static_cast<uint64_t>(mj_version())});
  return fmt::format("{:016x}", hash);
}

}  // namespace shoal::worlds
