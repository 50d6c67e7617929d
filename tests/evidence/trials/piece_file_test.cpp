// SPDX-License-Identifier: MIT
// A file of convex pieces beside a mesh.
// sanitizers: none
#include "evidence/trials/piece_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/vectors.h"
#include "evidence/trials/vessel_body.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

// As CoACD writes it: one object a part.
std::string objects_text(const std::vector<TriangleMesh>& parts) {
  std::string text;
  std::size_t base = 1;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    text += fmt::format("o convex_{}\n", k);
    for (const Triple& p : parts[k].vertices) text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", p[0], p[1], p[2]);
    for (const auto& [a, b, c] : parts[k].triangles) text += fmt::format("f {} {} {}\n", base + a, base + b, base + c);
    base += parts[k].vertices.size();
  }
  return text;
}

const TriangleMesh TRUNK = box_mesh({0.1, 0.2, 0.1}, {0.14, 0.25, 0.14}), ARM = box_mesh({0.14, 0.21, 0.11}, {0.19, 0.23, 0.13});

class PieceFile : public testing::Test {
 protected:
  PieceFile() {
    write_file(folder_ / "part.glb", glb_text(joined(TRUNK, ARM)));
    vessel_ = vessel_of_mesh("part", placed_mesh(joined(TRUNK, ARM), {}, {-0.145, -0.2, -0.12}), 0);
    vessel_.mesh->place = "scene.toml:3:8";
  }

  VesselForm form_with(const std::vector<TriangleMesh>& parts) {
    write_file(folder_ / "part.pieces.obj", objects_text(parts));
    return vessel_form(vessel_, folder_.path());
  }
  std::string refusal_with(const std::vector<TriangleMesh>& parts) {
    return refusal_line([&] { form_with(parts); });
  }
  void expect_refusal(const std::vector<TriangleMesh>& parts, const std::string& words) {
    const std::string line = refusal_with(parts);
    EXPECT_TRUE(line.starts_with("scene.toml:3:8: vessel 'part': part.pieces.obj: ")) << line;
    EXPECT_NE(line.find(words), std::string::npos) << line;
  }

  TemporaryFolder folder_;
  VesselData vessel_;
};

// In the mesh's own frame: shifted to the base as the mesh is, not as the pieces alone would be.
TEST_F(PieceFile, IsTakenWhereTheMeshLies) {
  const VesselForm own = vessel_form(vessel_, folder_.path());
  EXPECT_EQ(own.file, "");
  // the trunk is 0.3 mm too low, which would be the base of the pieces alone
  const VesselForm form = form_with({placed_mesh(TRUNK, {}, {0, -0.3e-3, 0}), ARM});
  EXPECT_EQ(form.file, "part.pieces.obj");
  ASSERT_EQ(form.pieces.size(), 2u);
  double lowest = 1;
  for (const Triple& p : form.pieces[0].vertices) lowest = std::min(lowest, p[1]);
  EXPECT_NEAR(lowest, -0.3e-3, 1e-7);
  EXPECT_GE(form.error, 0.299e-3);
  EXPECT_LE(form.error, 0.35e-3);
  EXPECT_NE(form_text(form).find("2 convex pieces, which leave the mesh by at most 0.3"), std::string::npos) << form_text(form);
  EXPECT_NE(form_text(form).find(", from part.pieces.obj"), std::string::npos) << form_text(form);
}

TEST_F(PieceFile, OtherFormatsAreReadToo) {
  write_file(folder_ / "part.pieces.stl", stl_text(joined(TRUNK, ARM)));
  EXPECT_EQ(vessel_form(vessel_, folder_.path()).pieces.size(), 2u);
  EXPECT_EQ(piece_file_of(*vessel_.mesh, folder_.path()), "part.pieces.stl");
}

TEST_F(PieceFile, WrongPiecesAreRefusedWithTheNumber) {
  expect_refusal({TRUNK, placed_mesh(ARM, {}, {2e-3, 0, 0})}, "its pieces reach 2.0");
  expect_refusal({TRUNK}, "the mesh reaches 5");
  expect_refusal({TRUNK, placed_mesh(ARM, {}, {-1.5e-3, 0, 0})}, "the mesh reaches 1.5");
  TriangleMesh open = ARM;
  open.triangles.pop_back();
  expect_refusal({TRUNK, open}, "piece 2 is not closed");
}

TEST_F(PieceFile, APieceThatIsNotConvexIsRefused) {
  // a dent in one side
  TriangleMesh dented = TRUNK;
  const auto [a, b, c] = dented.triangles.front();
  const auto middle = static_cast<std::uint32_t>(dented.vertices.size());
  dented.vertices.push_back({0.12, 0.225, 0.12});
  dented.triangles.front() = {a, b, middle};
  dented.triangles.push_back({b, c, middle});
  dented.triangles.push_back({c, a, middle});
  expect_refusal({dented, ARM}, "piece 1 of 2 is not convex");
  EXPECT_NE(refusal_with({dented, ARM}).find("allowed: 0.5 mm; make convex parts of this mesh, as CoACD does, or remove the file"),
            std::string::npos);
}

}  // namespace
}  // namespace wholehand
