// SPDX-License-Identifier: MIT
// Files of another kind than the one that is asked for: whoever reads them says what they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "base/files/files.h"
#include "core/file_kind.h"
#include "core/meshes/mesh.h"
#include "core/reader/reader.h"
#include "device/recordings/recording.h"
#include "sweeps/result/sweep_result.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/program.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

using namespace std::string_literals;

struct Given {
  FileKind kind;
  std::string bytes;
};

std::vector<Given> files_of_all_kinds() {
  const TriangleMesh mesh = icosphere(0.05, 1);
  return {{FileKind::gltf, glb_text(mesh)},
          {FileKind::stl, stl_text(mesh)},
          {FileKind::stl, ascii_stl_text(mesh)},
          {FileKind::obj, obj_text(mesh)},
          {FileKind::ply, ply_text(mesh, PlyWriting::ascii)},
          {FileKind::off, off_text(mesh)},
          {FileKind::collada, collada_text(mesh)},
          {FileKind::result, std::string(NETCDF4_START) + "rest"},
          {FileKind::recording, "CDF\2\0\0\0\1rest"s},
          {FileKind::scene, "[[vessel]]\nname = \"v\"\n"},
          {FileKind::lfs_pointer, "version https://git-lfs.github.com/spec/v1\noid sha256:4d\nsize 1\n"},
          {FileKind::web_page, "<!doctype html><title>cup.stl</title>"},
          {FileKind::utf16, "\xFF\xFEv\0 \0000\0 \0000\0 \0000\0\n\0"s},
          {FileKind::archive, "PK\3\4rest"}};
}

TEST(WrongFiles, EachReaderSaysWhatItWasGiven) {
  struct Reader {
    const char* wanted;
    std::vector<FileKind> kinds;
    std::function<void(const std::string&)> read;
  };
  const auto read_as_mesh = [](const std::string& path) {
    MeshData data;
    data.file = path;
    read_mesh(data, "");
  };
  const std::vector<Reader> readers{
      {"a scene", {FileKind::scene}, [](const std::string& path) { read_scene_file(path); }},
      {"a mesh", {FileKind::gltf, FileKind::stl, FileKind::obj, FileKind::ply, FileKind::off, FileKind::collada}, read_as_mesh},
      {"a recording", {FileKind::recording}, [](const std::string& path) { device::read_recording(path); }},
      {"a result of a sweep", {FileKind::result}, [](const std::string& path) { sweeps::SweepResult result(path); }}};
  const TemporaryFolder folder;
  for (const Reader& reader : readers)
    for (const Given& given : files_of_all_kinds()) {
      if (std::find(reader.kinds.begin(), reader.kinds.end(), given.kind) != reader.kinds.end()) continue;
      write_file(folder / "file", given.bytes);
      const std::string line = refusal_line([&] { reader.read(folder / "file"); });
      EXPECT_TRUE(has(line, wrong_kind(given.kind, reader.wanted))) << reader.wanted << ": " << line;
      EXPECT_TRUE(has(line, folder / "file")) << line;
    }
}

// Whatever ending the file has.
TEST(WrongFiles, AMeshThatIsNoneIsNamedWithEveryEnding) {
  const TemporaryFolder folder;
  for (const char* ending : {"obj", "stl", "ply", "glb", "gltf", "off", "dae"}) {
    MeshData data;
    data.file = folder / ("cup."s + ending);
    for (const Given& given : files_of_all_kinds()) {
      if (given.kind < FileKind::lfs_pointer) continue;
      write_file(data.file, given.bytes);
      const std::string line = refusal_line([&] { read_mesh(data, ""); });
      EXPECT_EQ(line, data.file + ": " + wrong_kind(given.kind, "a mesh"));
    }
  }
}

TEST(WrongFiles, BackslashesInAPathAreNamed) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "meshes");
  write_file(folder / "meshes/bowl.obj", obj_text(icosphere(0.05, 1)));
  MeshData data;
  data.file = "meshes\\bowl.obj";
  const std::string line = refusal_line([&] { read_mesh(data, folder.path()); });
  EXPECT_TRUE(has(line, "there is no such file; write / in a path, and no backslash")) << line;
  data.file = "meshes/bowl.obj";
  EXPECT_EQ(refusal_line([&] { read_mesh(data, folder.path()); }), "");
  const auto scene_line = [&](const std::string& mesh) {
    return refusal_line([&] { parse_scene("[[vessel]]\nname = \"v\"\nmesh = " + mesh + "\n", "scene.toml"); });
  };
  for (const char* mesh :
       {"\"meshes\\cup.obj\"", "\"meshes\\bowl.obj\"", "\"meshes\\nose.obj\"", "\"C:\\Users\\me\\cup.obj\"", "\"meshes\\urn.obj\""})
    EXPECT_TRUE(has(scene_line(mesh), "; write / in a path, and no backslash")) << scene_line(mesh);
  EXPECT_EQ(scene_line("\"meshes/bowl.obj\""), "");
  EXPECT_TRUE(has(refusal_line([&] { read_scene_file("scenes\\cup.toml"); }), "; write / in a path, and no backslash"));
  const std::string name = refusal_line([&] { parse_scene("[scene]\nname = \"a\\tb\"\n", "scene.toml"); });
  EXPECT_TRUE(has(name, "without control characters")) << name;
  EXPECT_FALSE(has(name, "path")) << name;
}

#ifdef WHOLEHAND_PROGRAM

TEST(WrongFiles, CommandsSayWhatTheyWereGiven) {
  const TemporaryFolder folder;
  const std::string result = folder / "result.nc", recording = folder / "recording.nc", mesh = folder / "cup.stl",
                    scene = folder / "scene.toml", pointer = folder / "pointer.nc";
  write_file(result, std::string(NETCDF4_START) + "rest");
  write_file(recording, "CDF\2\0\0\0\1rest"s);
  write_file(mesh, stl_text(icosphere(0.05, 1)));
  write_file(scene, "[[vessel]]\nname = \"v\"\n");
  write_file(pointer, "version https://git-lfs.github.com/spec/v1\noid sha256:4d\nsize 1\n");
  const std::string classic = "is a NetCDF file of the classic format and not ", output = " -o " + (folder / "out");
  for (const char* command : {"sweep ", "check ", "live "}) {
    expect_error(command + result, 2, "is a NetCDF-4 file, as sweeps write them, and not a scene");
    expect_error(command + mesh, 2, "is a mesh (STL) and not a scene; a scene names it");
  }
  for (const std::string& command :
       {"sweep " + recording, "trials " + recording + output, "grip " + recording + " --vessel v --height-mm 9"})
    expect_error(command, 2, classic + "a scene; wholehand session and view read recordings");
  expect_error("session " + result, 2, "is a NetCDF-4 file, as sweeps write them, and not a recording");
  expect_error("session " + scene, 2, "is a scene file (TOML) and not a recording");
  expect_error("report " + recording, 2, classic + "a result of a sweep");
  expect_error("rank " + scene, 2, "is a scene file (TOML) and not a result of a sweep");
  expect_error("view " + pointer, 2, pointer + ": is a Git LFS pointer and not the file: git lfs pull");
  expect_error("view " + mesh, 2, "is a mesh (STL) and not a recording or a result; a scene names it");
  expect_error("view " + scene, 2, "is a scene file (TOML) and not a recording or a result");
  for (const char* command : {"rank 'a\\b.nc'", "session 'a\\b.rec'", "live three_beakers --device 'replay:a\\b.rec'"})
    expect_error(command, 2, "cannot be read: No such file or directory; write / in a path, and no backslash");
  expect_error("sweep 'scenes\\cup.toml'", 2, "no scene file 'scenes\\cup.toml'; write / in a path, and no backslash; give");
}

#endif

}  // namespace
}  // namespace wholehand
