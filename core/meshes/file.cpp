// SPDX-License-Identifier: MIT
#include "core/meshes/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/file_kind.h"
#include "core/meshes/triangles.h"

namespace wholehand {
namespace {

constexpr std::size_t LONGEST_LINE = 600;
constexpr std::array<const char*, 6> FORMAT_NAMES{"glTF", "STL", "OBJ", "PLY", "OFF", "Collada"};

// A program, and endings of what it converts; a blank after each.
struct Converter {
  const char* program;
  std::string_view endings;
};
constexpr std::array CONVERTERS{Converter{"Blender", ".fbx .blend .abc .usd .usda .usdc .usdz "},
                                Converter{"FreeCAD", ".step .stp .iges .igs .brep .fcstd "},
                                Converter{"MeshLab", ".3mf .3ds .wrl .x3d "}};

// In small letters.
std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

std::optional<MeshFormat> format_of_name(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending == ".glb" || ending == ".gltf") return MeshFormat::gltf;
  if (ending == ".stl") return MeshFormat::stl;
  if (ending == ".obj") return MeshFormat::obj;
  if (ending == ".ply") return MeshFormat::ply;
  if (ending == ".off") return MeshFormat::off;
  if (ending == ".dae") return MeshFormat::collada;
  return {};
}

std::optional<MeshFormat> format_of(FileKind kind) {
  switch (kind) {
    case FileKind::gltf:
      return MeshFormat::gltf;
    case FileKind::stl:
      return MeshFormat::stl;
    case FileKind::obj:
      return MeshFormat::obj;
    case FileKind::ply:
      return MeshFormat::ply;
    case FileKind::off:
      return MeshFormat::off;
    case FileKind::collada:
      return MeshFormat::collada;
    default:
      return {};
  }
}

void refuse_convertible(const MeshFile& file) {
  const std::string ending = ending_of(file.path);
  for (const Converter& converter : CONVERTERS)
    if (ending.size() > 1 && converter.endings.find(ending + " ") != std::string_view::npos)
      file.refuse(
          fmt::format("is {}, which is not read: convert it to glTF or STL, for example with {}", ending, converter.program));
}

}  // namespace

void MeshFile::refuse(const std::string& message) const {
  std::string line = message.substr(0, LONGEST_LINE);
  while (!line.empty() && line.back() == '\n') line.pop_back();
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  throw usage_error(at_place(place, path + ": " + line));
}

void MeshFile::refuse_size() const {
  refuse(
      fmt::format("has more than {} million triangles, or three times as many vertices: simplify it", MOST_TRIANGLES / 1'000'000));
}

std::string read_mesh_bytes(const std::string& path, std::string& bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return "there is no such file" + backslash_note(path);
  if (!std::filesystem::is_regular_file(status)) return "is not a file";
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return "cannot be read: " + error.message();
  if (size > LARGEST_MESH_FILE)
    return fmt::format("is {} MB large, and at most {} MB are read", readable_number(size >> 20),
                       readable_number(LARGEST_MESH_FILE >> 20));
  bytes.resize(static_cast<std::size_t>(size));
  std::ifstream stream(path, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size))) return "cannot be read";
  return "";
}

std::string mesh_bytes(const MeshFile& file) {
  std::string bytes;
  const std::string refusal = read_mesh_bytes(file.path, bytes);
  if (!refusal.empty()) file.refuse(refusal);
  if (bytes.empty()) file.refuse("is empty");
  return bytes;
}

MeshFormat mesh_format(const MeshFile& file, std::string_view bytes) {
  const FileKind kind = file_kind(bytes, bytes.size());
  const std::optional<MeshFormat> named = format_of_name(file.path), seen = format_of(kind);
  // some are archives
  if (!seen && (kind == FileKind::unknown || kind == FileKind::archive)) refuse_convertible(file);
  if (!seen && kind != FileKind::unknown) file.refuse(wrong_kind(kind, "a mesh"));
  if (!named && !seen)
    file.refuse("is no mesh that is read: neither its name nor its first bytes are those of glTF, STL, OBJ, PLY, OFF or Collada");
  if (named && seen && *named != *seen)
    file.refuse(fmt::format("is named as {} and holds {}: give it the ending of what it holds",
                            FORMAT_NAMES[static_cast<int>(*named)], FORMAT_NAMES[static_cast<int>(*seen)]));
  return seen ? *seen : *named;
}

}  // namespace wholehand
