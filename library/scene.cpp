// SPDX-License-Identifier: MIT
#include "library/scene.h"

#include <string_view>
#include <vector>

#include "core/planes.h"
#include "library/status.h"
#include "objects/vessel.h"
#include "scene/reader.h"
#include "scene/shipped.h"

using namespace wholehand;

namespace {

wh_status make_scene(Scene scene, wh_scene** out) {
  load_meshes(scene);
  auto made = std::make_unique<wh_scene>();
  made->scene = std::move(scene);
  made->core = make_core_evaluator(made->scene);
  *out = made.release();
  return WH_OK;
}

wh_status give_numbers(const std::vector<double>& numbers, double* values, size_t room, size_t* count) {
  *count = numbers.size();
  if (!values) return WH_OK;
  if (room < numbers.size()) return fail(WH_ARGUMENT, "there is too little room for the values; ask for their count first");
  std::copy(numbers.begin(), numbers.end(), values);
  return WH_OK;
}

}  // namespace

wh_status wh_scene_open(const char* path_or_name, wh_scene** scene) {
  if (!path_or_name || !scene) return fail(WH_ARGUMENT, "wh_scene_open: a pointer is null");
  *scene = nullptr;
  return guarded([&] { return make_scene(read_scene_file(find_scene(path_or_name)), scene); });
}

wh_status wh_scene_parse(const char* text, size_t length, const char* name, wh_scene** scene) {
  if (!text || !scene) return fail(WH_ARGUMENT, "wh_scene_parse: a pointer is null");
  *scene = nullptr;
  return guarded([&] { return make_scene(parse_scene(std::string_view(text, length), name ? name : "text"), scene); });
}

void wh_scene_free(wh_scene* scene) { delete scene; }

wh_status wh_scene_vessels(const wh_scene* scene, size_t* count) {
  if (!scene || !count) return fail(WH_ARGUMENT, "wh_scene_vessels: a pointer is null");
  *count = scene->scene.vessels.size();
  return WH_OK;
}

wh_status wh_scene_vessel_name(const wh_scene* scene, size_t vessel, const char** name) {
  if (!scene || !name) return fail(WH_ARGUMENT, "wh_scene_vessel_name: a pointer is null");
  if (vessel >= scene->scene.vessels.size())
    return fail(WH_ARGUMENT, "wh_scene_vessel_name: the scene has no vessel of this number");
  *name = scene->scene.vessels[vessel].name.c_str();
  return WH_OK;
}

wh_status wh_scene_find_vessel(const wh_scene* scene, const char* name, size_t* vessel) {
  if (!scene || !name || !vessel) return fail(WH_ARGUMENT, "wh_scene_find_vessel: a pointer is null");
  return guarded([&] {
    std::string known;
    for (std::size_t v = 0; v < scene->scene.vessels.size(); ++v) {
      if (scene->scene.vessels[v].name == name) {
        *vessel = v;
        return WH_OK;
      }
      known += (v == 0 ? "" : ", ") + scene->scene.vessels[v].name;
    }
    return fail(WH_INPUT, (std::string("no vessel '") + name + "'; the scene has " + known).c_str());
  });
}

wh_status wh_scene_fills(const wh_scene* scene, size_t vessel, double* values, size_t room, size_t* count) {
  if (!scene || !count) return fail(WH_ARGUMENT, "wh_scene_fills: a pointer is null");
  if (vessel >= scene->scene.vessels.size()) return fail(WH_ARGUMENT, "wh_scene_fills: the scene has no vessel of this number");
  return guarded([&] {
    const Scene& own = scene->scene;
    return give_numbers(own.liquid ? vessel_fills(own, own.vessels[vessel]) : std::vector<double>{0}, values, room, count);
  });
}

wh_status wh_scene_tilts(const wh_scene* scene, double* values, size_t room, size_t* count) {
  if (!scene || !count) return fail(WH_ARGUMENT, "wh_scene_tilts: a pointer is null");
  return guarded([&] { return give_numbers(scene->scene.tilts, values, room, count); });
}
