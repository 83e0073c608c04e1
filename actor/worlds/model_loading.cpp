#include "actor/worlds/model_loading.h"

#include <mujoco/mujoco.h>

#include <cstring>
#include <filesystem>
#include <vector>

#include "actor/worlds/engine_messages.h"
#include "actor/worlds/model_files.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/random.h"

namespace shoal::worlds {
namespace {

constexpr int kErrorBytes = 1000;

// The embedded files as the engine's virtual files.
class EmbeddedFolder {
 public:
  EmbeddedFolder() : vfs_(std::make_unique<mjVFS>()) {
    mj_defaultVFS(vfs_.get());
    for (const ModelFile& file : EmbeddedModelFiles()) {
      const std::string name(file.name);
      const int size = static_cast<int>(file.text.size());
      CHECK(mj_makeEmptyFileVFS(vfs_.get(), name.c_str(), size) == 0) << name;
      const int index = mj_findFileVFS(vfs_.get(), name.c_str());
      CHECK(index >= 0) << name;
      std::memcpy(vfs_->filedata[index], file.text.data(), file.text.size());
    }
  }
  ~EmbeddedFolder() { mj_deleteVFS(vfs_.get()); }
  EmbeddedFolder(const EmbeddedFolder&) = delete;
  EmbeddedFolder& operator=(const EmbeddedFolder&) = delete;

  const mjVFS* get() const { return vfs_.get(); }

 private:
  std::unique_ptr<mjVFS> vfs_;  // megabytes: not on the stack
};

}  // namespace

void ModelDeleter::operator()(mjModel_* model) const { mj_deleteModel(model); }
void DataDeleter::operator()(mjData_* data) const { mj_deleteData(data); }

ModelHandle LoadModel(const std::string& name, const std::string& user_file) {
  InstallEngineCallbacks();
  char reason[kErrorBytes] = "";
  ModelHandle model;
  if (user_file.empty()) {
    model.reset(mj_loadXML(name.c_str(), EmbeddedFolder().get(), reason, kErrorBytes));
    CHECK(model != nullptr) << name << ": " << reason;
  } else {
    if (!std::filesystem::is_regular_file(user_file)) {
      throw UsageError("model file '{}' does not exist", user_file);
    }
    model.reset(mj_loadXML(user_file.c_str(), nullptr, reason, kErrorBytes));
    if (model == nullptr)
      throw RuntimeError("model file '{}' does not load: {}", user_file, reason);
  }
  return model;
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
