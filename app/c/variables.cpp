// SPDX-License-Identifier: MIT
#include <map>
#include <mutex>
#include <string>

#include "app/c/scene.h"
#include "app/c/status.h"
#include "base/text/text.h"
#include "sweeps/plan/variables.h"

using namespace wholehand;

namespace {

// "fill tilt": texts that live as long as the library.
const char* dims_text(const sweeps::Variable& variable) {
  static std::mutex mutex;
  static std::map<std::string, std::string> texts;
  const std::lock_guard lock(mutex);
  const auto found = texts.find(variable.name);
  if (found != texts.end()) return found->second.c_str();
  return texts.emplace(variable.name, joined(variable.dims, " ")).first->second.c_str();
}

}  // namespace

size_t wh_variables(void) {
  size_t count = 0;
  guarded([&] {
    count = sweeps::variable_catalogue().size();
    return WH_OK;
  });
  return count;
}

wh_status wh_variable_at(size_t index, wh_variable* variable) {
  if (const wh_status status = check_answer(variable, "wh_variable_at: the variable's struct"); status != WH_OK) return status;
  return guarded([&] {
    const auto catalogue = sweeps::variable_catalogue();
    if (index >= catalogue.size())
      return fail(WH_ARGUMENT, "wh_variable_at: there are %zu variables, and none of number %zu", catalogue.size(), index);
    const sweeps::Variable& known = catalogue[index];
    wh_variable own{};
    own.name = known.name;
    own.unit = known.units;
    own.long_name = known.long_name;
    own.comment = known.comment;
    own.dims = dims_text(known);
    own.is_integer = known.type == sweeps::NumberType::real ? 0 : 1;
    give_back(own, variable);
    return WH_OK;
  });
}

wh_status wh_variable_values(const wh_scene* scene, const char* name, size_t* values) {
  if (!scene || !name || !values) return fail(WH_ARGUMENT, "wh_variable_values: a pointer is null");
  return guarded([&] {
    for (const sweeps::Variable& variable : sweeps::variable_catalogue()) {
      if (std::string(variable.name) != name) continue;
      const Scene& own = scene->ready->scene;
      *values = sweeps::missing_need(variable, own) ? 0 : sweeps::variable_planes(variable, own);
      return WH_OK;
    }
    return fail(WH_INPUT, std::string("no variable '") + name + "'; wh_variable_at names all");
  });
}
