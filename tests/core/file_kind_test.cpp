// SPDX-License-Identifier: MIT
// Kinds of files, recognized by their first bytes.
#include "core/file_kind.h"

#include <gtest/gtest.h>

#include "base/files/files.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

using namespace std::string_literals;

FileKind kind_of(const std::string& bytes) { return file_kind(bytes, bytes.size()); }

std::string in_utf16(const std::string& text) {
  std::string wide;
  for (const char c : text) wide += {c, '\0'};
  return wide;
}

TEST(FileKind, FirstBytesTellIt) {
  const TriangleMesh mesh = icosphere(0.05, 0);
  const std::string lfs = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2146\nsize 12345\n", obj = obj_text(mesh);
  const std::vector<std::pair<std::string, FileKind>> cases{
      {"", FileKind::unknown},
      {"what is this", FileKind::unknown},
      {"Name:\tbash\n", FileKind::unknown},
      {std::string(1000, '\0'), FileKind::unknown},
      {"{\"a\": 1}", FileKind::unknown},
      {" {\"asset\": {\"version\": \"2.0\"}}", FileKind::gltf},
      {glb_text(mesh), FileKind::gltf},
      {stl_text(mesh), FileKind::stl},
      {"PK\3\4" + stl_text(mesh).substr(4), FileKind::archive},
      {ascii_stl_text(mesh), FileKind::stl},
      {obj, FileKind::obj},
      {"\xEF\xBB\xBF# by an editor\r\n\r\nmtllib a.mtl\r\n" + obj, FileKind::obj},
      {ply_text(mesh, PlyWriting::ascii), FileKind::ply},
      {ply_text(mesh, PlyWriting::big_endian), FileKind::ply},
      {off_text(mesh), FileKind::off},
      {"# cups\nCOFF 4 4 0\n", FileKind::off},
      {"OFF490 518 0\n", FileKind::off},
      {"OFFICE 490\n", FileKind::unknown},
      {"TAKEOFF 8\n", FileKind::unknown},
      {collada_text(mesh), FileKind::collada},
      {"<?xml version=\"1.0\"?><svg/>", FileKind::unknown},
      {std::string(NETCDF4_START) + "..", FileKind::result},
      {"CDF\2\0\0\0\1"s, FileKind::recording},
      {"CDF\5\0\0\0\1"s, FileKind::recording},
      {"# cups\n\n[[vessel]]\nname = \"v\"\n", FileKind::scene},
      {"[scene]\n", FileKind::scene},
      {"\xEF\xBB\xBFscene.name = 'a'\n", FileKind::scene},
      {"v = 1\n", FileKind::scene},
      {"[1, 2]", FileKind::unknown},
      {lfs, FileKind::lfs_pointer},
      {"\n<!DOCTYPE html>\n<html>", FileKind::web_page},
      {"<HTML lang=\"en\">", FileKind::web_page},
      {"\xFF\xFE" + in_utf16(obj), FileKind::utf16},
      {in_utf16(obj), FileKind::utf16},
      {"\x1F\x8B\x08", FileKind::archive},
  };
  for (const auto& [bytes, kind] : cases) EXPECT_EQ(kind_of(bytes), kind) << bytes.substr(0, 60);
}

TEST(FileKind, ABinaryStlIsKnownByItsLengthThoughOnlyItsStartIsRead) {
  const std::string bytes = std::string(80, ' ') + stl_text(icosphere(0.05, 2)).substr(80);
  EXPECT_EQ(file_kind(bytes.substr(0, 84), bytes.size()), FileKind::stl);
  EXPECT_EQ(file_kind(bytes.substr(0, 84), bytes.size() - 1), FileKind::unknown);
}

TEST(FileKind, OneLineSaysWhatItIsAndWhatHelps) {
  EXPECT_EQ(wrong_kind(FileKind::lfs_pointer, "a mesh"), "is a Git LFS pointer and not the file: git lfs pull");
  EXPECT_EQ(wrong_kind(FileKind::utf16, "a mesh"), "is text in UTF-16 and not the file: save it as UTF-8");
  EXPECT_EQ(wrong_kind(FileKind::stl, "a scene"), "is a mesh (STL) and not a scene; a scene names it: mesh = \"FILE\"");
  EXPECT_EQ(wrong_kind(FileKind::result, "a scene"),
            "is a NetCDF-4 file, as sweeps write them, and not a scene; wholehand rank, report and view read results of sweeps");
  EXPECT_EQ(wrong_kind(FileKind::unknown, "a scene"), "");
}

}  // namespace
}  // namespace wholehand
