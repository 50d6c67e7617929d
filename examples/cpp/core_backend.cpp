// SPDX-License-Identifier: MIT
// core/core_backend.h: many grips on all threads. A backend delivers planes of numbers, one for each field, chunk by chunk.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "core/core_backend.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"

int main() {
  using namespace wholehand;
  const Scene scene = read_scene_file(find_scene("three_beakers"));
  const FieldSet fields = make_field_set({FIELD_SCORE}, scene);
  CoreBackend backend(make_core_evaluator(scene), scene, fields, Precision::full, 0);

  std::vector<double> scores;
  RunRequest request;
  request.last = 1000;
  request.best = 1;
  request.grips = [](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = GripInput();
      out[i].height = 30e-3 + 60e-3 * static_cast<double>(first + i) / 1000;
      out[i].obliquity = radians(-10);
      out[i].roll = radians(-58);
    }
  };
  request.sink = [&](const PlaneChunk& chunk) {
    for (std::size_t i = 0; i < chunk.count; ++i) scores.push_back(chunk.real(fields.plane[FIELD_SCORE], i));
  };
  const RunResult result = backend.run(request);
  std::printf("%s: %llu grips, the best is number %llu with a score of %.3f\n", backend.info().device.c_str(),
              static_cast<unsigned long long>(result.done), static_cast<unsigned long long>(result.best.at(0).index),
              result.best.at(0).score);
  return scores.size() == 1000 && result.best.at(0).score == *std::max_element(scores.begin(), scores.end()) ? 0 : 1;
}
