// SPDX-License-Identifier: MIT
#include "evidence/trials/mujoco.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>

#include "base/text/error.h"

namespace wholehand {

const std::string MUJOCO_LIBRARY_NAME = "libmujoco.so.2.2.2";

namespace {

const char* const HOW_TO_GET_MUJOCO = "install Debian's package libmujoco2.2.2, or name the library in WHOLEHAND_MUJOCO_LIBRARY";

// The last warning of this thread's engine, which counts warnings but keeps no words.
thread_local std::string last_warning;

std::string engine_words(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

// MuJoCo's error handler must not return. Its library has unwind tables, so an exception can leave it; the state left behind is discarded.
void on_engine_error(const char* words) { throw EngineError(engine_words(words)); }
void on_engine_warning(const char* words) { last_warning = engine_words(words); }

template <class Function>
void need_mujoco_symbol(void* handle, const std::string& path, const char* symbol, Function& function) {
  function = reinterpret_cast<Function>(dlsym(handle, symbol));
  if (!function)
    throw failure_error(fmt::format("{} lacks the function {}: it is not MuJoCo 2.2.2; {}", path, symbol, HOW_TO_GET_MUJOCO));
}

struct CloseLibrary {
  void operator()(void* handle) const { dlclose(handle); }
};

MujocoLibrary open_mujoco(const std::string& path) {
  std::unique_ptr<void, CloseLibrary> opened(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL));
  void* const handle = opened.get();
  if (!handle) {
    const char* words = dlerror();
    throw failure_error(
        fmt::format("cannot load MuJoCo: {}; {}", engine_words(words ? words : "no reason given"), HOW_TO_GET_MUJOCO));
  }
  MujocoLibrary mujoco{};
  mujoco.path = path;
  need_mujoco_symbol(handle, path, "mj_version", mujoco.version);
  need_mujoco_symbol(handle, path, "mj_versionString", mujoco.version_string);
  if (mujoco.version() != mjVERSION_HEADER) {
    throw failure_error(
        fmt::format("{} is MuJoCo {}, and this program is made for 2.2.2; {}", path, mujoco.version_string(), HOW_TO_GET_MUJOCO));
  }
  mujoco.name = fmt::format("MuJoCo {}", mujoco.version_string());
  need_mujoco_symbol(handle, path, "mj_defaultVFS", mujoco.default_vfs);
  need_mujoco_symbol(handle, path, "mj_makeEmptyFileVFS", mujoco.make_empty_file_vfs);
  need_mujoco_symbol(handle, path, "mj_findFileVFS", mujoco.find_file_vfs);
  need_mujoco_symbol(handle, path, "mj_deleteVFS", mujoco.delete_vfs);
  need_mujoco_symbol(handle, path, "mj_loadXML", mujoco.load_xml);
  need_mujoco_symbol(handle, path, "mj_deleteModel", mujoco.delete_model);
  need_mujoco_symbol(handle, path, "mj_makeData", mujoco.make_data);
  need_mujoco_symbol(handle, path, "mj_resetData", mujoco.reset_data);
  need_mujoco_symbol(handle, path, "mj_deleteData", mujoco.delete_data);
  need_mujoco_symbol(handle, path, "mj_setConst", mujoco.set_const);
  need_mujoco_symbol(handle, path, "mj_forward", mujoco.forward);
  need_mujoco_symbol(handle, path, "mj_step", mujoco.step);
  need_mujoco_symbol(handle, path, "mj_contactForce", mujoco.contact_force);
  need_mujoco_symbol(handle, path, "mj_name2id", mujoco.name_to_id);
  need_mujoco_symbol(handle, path, "mju_eig3", mujoco.eig3);
  void (**error_handler)(const char*) = nullptr;
  void (**warning_handler)(const char*) = nullptr;
  need_mujoco_symbol(handle, path, "mju_user_error", error_handler);
  need_mujoco_symbol(handle, path, "mju_user_warning", warning_handler);
  *error_handler = on_engine_error;
  *warning_handler = on_engine_warning;
  opened.release();  // it stays loaded
  return mujoco;
}

// The text of a model as a file of MuJoCo's own file system in memory.
class ModelFile {
 public:
  ModelFile(const MujocoLibrary& library, const std::string& text) : library_(library), files_(std::make_unique<mjVFS>()) {
    library_.default_vfs(files_.get());
    if (library_.make_empty_file_vfs(files_.get(), NAME, static_cast<int>(text.size())) != 0)
      throw EngineError("no room for the text of a model");
    std::memcpy(files_->filedata[library_.find_file_vfs(files_.get(), NAME)], text.data(), text.size());
  }
  ~ModelFile() { library_.delete_vfs(files_.get()); }
  ModelFile(const ModelFile&) = delete;
  ModelFile& operator=(const ModelFile&) = delete;

  static constexpr const char* NAME = "model.xml";
  const mjVFS* get() const { return files_.get(); }

 private:
  const MujocoLibrary& library_;
  std::unique_ptr<mjVFS> files_;  // of some MB: not for the stack
};

mjModel* compiled_model(const MujocoLibrary& library, const std::string& xml) {
  static std::mutex one_at_a_time;  // a global last model, and handlers that are exchanged meanwhile
  const std::lock_guard guard(one_at_a_time);
  const ModelFile file(library, xml);
  std::array<char, 1000> words{};
  last_warning.clear();
  mjModel* model = library.load_xml(ModelFile::NAME, file.get(), words.data(), static_cast<int>(words.size()));
  // a model that it warns of comes with words too
  if (!model || words[0] != '\0') {
    if (model) library.delete_model(model);
    throw EngineError(engine_words(words.data()));
  }
  return model;
}

}  // namespace

const MujocoLibrary& load_mujoco(const std::string& path) {
  static std::mutex one_at_a_time;
  static std::map<std::string, MujocoLibrary> loaded;
  const char* variable = std::getenv("WHOLEHAND_MUJOCO_LIBRARY");
  const std::string wanted = !path.empty() ? path : variable && *variable ? variable : MUJOCO_LIBRARY_NAME;
  const std::lock_guard guard(one_at_a_time);
  const auto found = loaded.find(wanted);
  return found != loaded.end() ? found->second : loaded.emplace(wanted, open_mujoco(wanted)).first->second;
}

Simulation::Simulation(const MujocoLibrary& library, const std::string& xml)
    : library_(library),
      model_(compiled_model(library, xml), library.delete_model),
      data_(library.make_data(model_.get()), library.delete_data),
      scratch_(library.make_data(model_.get()), library.delete_data) {
  if (!data_ || !scratch_) throw EngineError("no memory for the state of a model");
}

void Simulation::check_warnings(const mjData& data) {
  for (int kind = 0; kind < mjNWARNING; ++kind)
    if (data.warning[kind].number > 0) throw EngineError(last_warning.empty() ? fmt::format("warning {}", kind) : last_warning);
}

void Simulation::check() const {
  check_warnings(*data_);
  // it checks whether the integrated numbers are finite, but not what follows from the last step
  for (int i = 0; i < model_->nq; ++i)
    if (!std::isfinite(data_->qpos[i])) throw EngineError(fmt::format("position {} is no number", i));
  for (int i = 0; i < model_->nv; ++i)
    if (!std::isfinite(data_->qvel[i])) throw EngineError(fmt::format("velocity {} is no number", i));
}

void Simulation::step() {
  library_.step(model_.get(), data_.get());
  check();
}

void Simulation::forward() {
  library_.forward(model_.get(), data_.get());
  check();
}

void Simulation::set_constants() {
  library_.set_const(model_.get(), scratch_.get());
  check_warnings(*scratch_);
}

void Simulation::reset() {
  library_.reset_data(model_.get(), data_.get());
  library_.reset_data(model_.get(), scratch_.get());
  last_warning.clear();
}

int Simulation::id(mjtObj kind, const std::string& name) const { return library_.name_to_id(model_.get(), kind, name.c_str()); }

}  // namespace wholehand
