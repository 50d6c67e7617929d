// SPDX-License-Identifier: MIT
// Loads MuJoCo at run time if it is installed; the rest of the program needs nothing of it.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace wholehand {

extern const std::string MUJOCO_LIBRARY_NAME;  // "libmujoco.so.2.2.2": the release whose headers this is compiled with

// What the engine itself reports as wrong: an error that would have ended the process, a warning, a number that is not finite. One line.
class EngineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The calls in use, by MuJoCo's names without `mj_` or `mju_`.
struct MujocoLibrary {
  std::string path;  // as it was loaded
  std::string name;  // "MuJoCo 2.2.2"

  decltype(&::mj_version) version;
  decltype(&::mj_versionString) version_string;
  decltype(&::mj_defaultVFS) default_vfs;
  decltype(&::mj_makeEmptyFileVFS) make_empty_file_vfs;
  decltype(&::mj_findFileVFS) find_file_vfs;
  decltype(&::mj_deleteVFS) delete_vfs;
  decltype(&::mj_loadXML) load_xml;
  decltype(&::mj_deleteModel) delete_model;
  decltype(&::mj_makeData) make_data;
  decltype(&::mj_resetData) reset_data;
  decltype(&::mj_deleteData) delete_data;
  decltype(&::mj_setConst) set_const;
  decltype(&::mj_forward) forward;
  decltype(&::mj_step) step;
  decltype(&::mj_contactForce) contact_force;
  decltype(&::mj_name2id) name_to_id;
  decltype(&::mju_eig3) eig3;
};

// Loads `path` or, if it is empty, what the environment variable WHOLEHAND_MUJOCO_LIBRARY names, or else MUJOCO_LIBRARY_NAME. It stays loaded, with
// handlers for its errors and warnings: without them an error would end the process and a warning would be written to a file in the working folder.
// Thread-safe. Throws Error (failure): the loader's words and the package with the library; another version; the symbol that it lacks.
const MujocoLibrary& load_mujoco(const std::string& path = "");

// A model with one state of it. Not thread-safe; one a thread.
class Simulation {
 public:
  // Compiles a model from its XML text. mj_loadXML keeps a global last model, so one thread at a time is let in. Throws
  // EngineError where it takes none, or warns of the one that it took.
  Simulation(const MujocoLibrary& library, const std::string& xml);

  mjModel& model() { return *model_; }
  mjData& data() { return *data_; }
  const MujocoLibrary& library() const { return library_; }

  // One time step, or all that depends on the present state without one. Throws EngineError where the engine does, warns of
  // anything or has a number that is none: what it then holds is of no use until `reset`.
  void step();
  void forward();
  // Call after masses or inertias of the model change. Keeps the state. Throws as `step`.
  void set_constants();
  void reset();
  int id(mjtObj kind, const std::string& name) const;  // -1: none

 private:
  static void check_warnings(const mjData& data);
  void check() const;

  const MujocoLibrary& library_;
  std::unique_ptr<mjModel, decltype(&::mj_deleteModel)> model_;
  std::unique_ptr<mjData, decltype(&::mj_deleteData)> data_, scratch_;
};

}  // namespace wholehand
