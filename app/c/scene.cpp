// SPDX-License-Identifier: MIT
#include "app/c/scene.h"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "app/c/status.h"
#include "core/joints.h"
#include "core/meshes/vessel.h"
#include "core/planes.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "core/vectors.h"

using namespace wholehand;

namespace {

wh_status make_scene(Scene scene, wh_scene** out) {
  MeshOptions quiet;
  quiet.is_quiet = true;
  quiet.most_bytes = largest_lattice(std::numeric_limits<std::uint64_t>::max());
  load_meshes(scene, quiet);
  const AskedGrips allowed(scene);
  const auto ready = std::make_shared<ReadyScene>(ReadyScene{std::move(scene), nullptr, allowed});
  ready->core = make_core_evaluator(ready->scene);
  *out = new wh_scene{ready};
  return WH_OK;
}

wh_status give_numbers(const std::vector<double>& numbers, double* values, size_t room, size_t* count, const char* call) {
  *count = numbers.size();
  if (!values) return WH_OK;
  if (room < numbers.size())
    return fail(WH_ARGUMENT, std::string(call) + ": there are " + std::to_string(numbers.size()) + " values, and room for " +
                                 std::to_string(room));
  std::copy(numbers.begin(), numbers.end(), values);
  return WH_OK;
}

}  // namespace

wh_status wholehand::check_grip(const AskedGrips& allowed, const GripInput& grip, const char* place) noexcept {
  const std::optional<std::size_t> at = grip_fault(allowed, grip);
  if (!at) return WH_OK;
  return fail(WH_INPUT, "%s: %s %g; allowed: a number, %g to %g (%s)", place, GRIP_NUMBER_NAMES[*at], grip_numbers(grip)[*at],
              allowed.low[*at], allowed.high[*at], GRIP_NUMBER_UNITS[*at]);
}

wh_status wh_scene_open(const char* path_or_name, wh_scene** scene) {
  if (!path_or_name || !scene) return fail(WH_ARGUMENT, "wh_scene_open: a pointer is null");
  *scene = nullptr;
  if (path_or_name[0] == 0)
    return fail(WH_INPUT, "wh_scene_open: the path is empty; give a scene file or the name of a shipped scene");
  return guarded([&] { return make_scene(read_scene_file(find_scene(path_or_name)), scene); });
}

wh_status wh_scene_parse(const char* text, size_t length, const char* name, wh_scene** scene) {
  if (!text || !scene) return fail(WH_ARGUMENT, "wh_scene_parse: a pointer is null");
  *scene = nullptr;
  return guarded([&] { return make_scene(parse_scene(std::string_view(text, length), name ? name : "text"), scene); });
}

void wh_scene_free(wh_scene** scene) {
  if (!scene) return;
  delete *scene;
  *scene = nullptr;
}

wh_status wh_scene_vessels(const wh_scene* scene, size_t* count) {
  if (!scene || !count) return fail(WH_ARGUMENT, "wh_scene_vessels: a pointer is null");
  *count = scene->ready->scene.vessels.size();
  return WH_OK;
}

wh_status wh_scene_vessel(const wh_scene* scene, size_t index, wh_vessel* vessel) {
  if (const wh_status status = check_vessel(scene, index, "wh_scene_vessel"); status != WH_OK) return status;
  if (const wh_status status = check_answer(vessel, "wh_scene_vessel: the vessel's struct"); status != WH_OK) return status;
  return guarded([&] {
    const VesselData& known = scene->ready->scene.vessels[index];
    const VesselConstants constants = scene->ready->core->constants(index);
    wh_vessel own{};
    own.name = known.name.c_str();
    own.lowest = known.base;
    own.highest = known.height;
    own.capacity = constants.capacity;
    own.mass = constants.mass;
    std::copy(constants.center_of_mass.begin(), constants.center_of_mass.end(), own.center_of_mass);
    std::copy(known.place.begin(), known.place.end(), own.place);
    give_back(own, vessel);
    return WH_OK;
  });
}

wh_status wh_scene_find_vessel(const wh_scene* scene, const char* name, size_t* vessel) {
  if (!scene || !name || !vessel) return fail(WH_ARGUMENT, "wh_scene_find_vessel: a pointer is null");
  return guarded([&] {
    std::string known;
    const std::vector<VesselData>& vessels = scene->ready->scene.vessels;
    for (std::size_t v = 0; v < vessels.size(); ++v) {
      if (vessels[v].name == name) {
        *vessel = v;
        return WH_OK;
      }
      known += (v == 0 ? "" : ", ") + vessels[v].name;
    }
    return fail(WH_INPUT, std::string("no vessel '") + name + "'; the scene has " + known);
  });
}

wh_status wh_scene_fills(const wh_scene* scene, size_t vessel, double* values, size_t room, size_t* count) {
  if (const wh_status status = check_vessel(scene, vessel, "wh_scene_fills"); status != WH_OK) return status;
  if (!count) return fail(WH_ARGUMENT, "wh_scene_fills: the count is null");
  return guarded([&] {
    const Scene& own = scene->ready->scene;
    const std::vector<double> fills = own.liquid ? vessel_fills(own, own.vessels[vessel]) : std::vector<double>{0};
    return give_numbers(fills, values, room, count, "wh_scene_fills");
  });
}

wh_status wh_scene_tilts(const wh_scene* scene, double* values, size_t room, size_t* count) {
  if (!scene || !count) return fail(WH_ARGUMENT, "wh_scene_tilts: a pointer is null");
  return guarded([&] { return give_numbers(scene->ready->scene.tilts, values, room, count, "wh_scene_tilts"); });
}

const char* wh_reason_name(int reason) {
  return reason >= 0 && reason < static_cast<int>(REASON_NAMES.size()) ? REASON_NAMES[static_cast<std::size_t>(reason)] : nullptr;
}

const char* wh_joint_name(int joint) { return joint >= 0 && joint < JOINT_COUNT ? JOINT_NAMES[joint].openxr : nullptr; }
