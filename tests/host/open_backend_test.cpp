// SPDX-License-Identifier: MIT
#include "host/open_backend.h"

#include <gtest/gtest.h>

#include "base/text/error.h"
#include "tests/support/fake_backend.h"

namespace wholehand {
namespace {

// A scene that the real core can prepare: a cylinder of 60 x 100 mm.
Scene cylinder_scene() {
  Scene scene = fake_scene();
  scene.vessels.resize(1);
  VesselData& vessel = scene.vessels[0];
  vessel.height = 0.1;
  vessel.wall = 1.5e-3;
  vessel.outline = {{false, {0.03, 0}, {}, 0, 0}, {false, {0.03, 0.1}, {}, 0, 0}, {false, {0, 0.1}, {}, 0, 0}};
  return scene;
}

TEST(OpenBackend, CoreIsAlwaysThere) {
  const Scene scene = cylinder_scene();
  const FieldSet fields = make_field_set({FIELD_SCORE}, scene);
  for (const Precision precision : {Precision::single, Precision::full}) {
    const auto backend = open_backend(scene, fields, "core", precision, 2);
    EXPECT_EQ(backend->info().backend, "core");
    EXPECT_EQ(backend->info().precision, precision);
    EXPECT_EQ(backend->fields().real_kept, 1);
  }
}

TEST(OpenBackend, UnknownDeviceIsRefused) {
  const Scene scene = cylinder_scene();
  try {
    open_backend(scene, make_field_set({}, scene), "no such device", Precision::single, 0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace wholehand
