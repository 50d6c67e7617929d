// SPDX-License-Identifier: MIT
#include "core/file_kind.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace wholehand {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view BLANKS = " \t\r\n\v\f";

struct Signature {
  std::string_view start;
  FileKind kind;
};

constexpr std::array SIGNATURES{
    Signature{"glTF", FileKind::gltf},
    Signature{"ply\n", FileKind::ply},
    Signature{"ply\r", FileKind::ply},
    Signature{"\x89HDF\r\n\x1a\n", FileKind::result},  // NetCDF-4
    Signature{"CDF\1", FileKind::recording},           // NetCDF's classic formats
    Signature{"CDF\2", FileKind::recording},
    Signature{"CDF\5", FileKind::recording},
    Signature{"version https://git-lfs.github.com/", FileKind::lfs_pointer},
    Signature{"\xFF\xFE", FileKind::utf16},
    Signature{"\xFE\xFF", FileKind::utf16},
    Signature{"PK\3\4", FileKind::archive},
    Signature{"\x1F\x8B", FileKind::archive},
    Signature{"7z\xBC\xAF\x27\x1C", FileKind::archive},
};

struct Words {
  FileKind kind;
  std::string_view what, remedy;
};

constexpr std::array WORDS{
    Words{FileKind::gltf, "a mesh (glTF)", "a scene names it: mesh = \"FILE\""},
    Words{FileKind::stl, "a mesh (STL)", "a scene names it: mesh = \"FILE\""},
    Words{FileKind::obj, "a mesh (OBJ)", "a scene names it: mesh = \"FILE\""},
    Words{FileKind::ply, "a mesh (PLY)", "a scene names it: mesh = \"FILE\""},
    Words{FileKind::off, "a mesh (OFF)", "a scene names it: mesh = \"FILE\""},
    Words{FileKind::collada, "a mesh (Collada)", "a scene names it: mesh = \"FILE\""},
    Words{FileKind::result, "a NetCDF-4 file, as sweeps write them,", "wholehand rank, report and view read results of sweeps"},
    Words{FileKind::recording, "a NetCDF file of the classic format", "wholehand session and view read recordings"},
    Words{FileKind::scene, "a scene file (TOML)", "wholehand sweep, grip and live read scenes"},
    Words{FileKind::lfs_pointer, "a Git LFS pointer", "git lfs pull"},
    Words{FileKind::web_page, "a web page (HTML)", "download what the page offers"},
    Words{FileKind::utf16, "text in UTF-16", "save it as UTF-8"},
    Words{FileKind::archive, "a compressed archive", "unpack it"},
};

std::string_view from_first_word(std::string_view text) {
  while (true) {
    const std::size_t start = text.find_first_not_of(BLANKS);
    if (start == text.npos) return {};
    text.remove_prefix(start);
    if (text[0] != '#') return text;
    const std::size_t end = text.find_first_of("\r\n");
    if (end == text.npos) return {};
    text.remove_prefix(end);
  }
}

bool begins_like(std::string_view text, std::string_view lower) {
  return text.size() >= lower.size() && std::equal(lower.begin(), lower.end(), text.begin(),
                                                   [](char a, char b) { return a == b || (b >= 'A' && b <= 'Z' && a == b + 32); });
}

bool is_key_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
}

// [header], [[header]] or key = value.
bool is_toml(std::string_view text) {
  const bool is_header = text.starts_with('[');
  while (text.starts_with('[')) text.remove_prefix(1);
  const std::string_view rest = text.substr(std::min<std::size_t>(
      text.size(), static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_key_letter) - text.begin())));
  if (rest.size() == text.size() || rest.empty()) return false;
  const std::size_t next = rest.find_first_not_of(" \t");
  return next != rest.npos && rest[next] == (is_header ? ']' : '=');
}

FileKind kind_of_text(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::string_view body = from_first_word(text), word = first_word(text);
  if (body.starts_with('{')) return text.find("\"asset\"") != text.npos ? FileKind::gltf : FileKind::unknown;
  if (begins_like(body, "<!doctype html") || begins_like(body, "<html")) return FileKind::web_page;
  if (is_toml(body)) return FileKind::scene;
  if (word == "solid") return FileKind::stl;
  if (off_head(word) > 0) return FileKind::off;
  if (body.starts_with("<?xml") || body.starts_with("<COLLADA"))
    return text.find("<COLLADA") != text.npos ? FileKind::collada : FileKind::unknown;
  constexpr std::array OBJ_WORDS{"v"sv, "vn"sv, "vt"sv, "f"sv, "o"sv, "g"sv, "s"sv, "mtllib"sv, "usemtl"sv};
  if (std::find(OBJ_WORDS.begin(), OBJ_WORDS.end(), word) != OBJ_WORDS.end()) return FileKind::obj;
  return FileKind::unknown;
}

// Without a mark at its start: each other byte of the first characters is 0.
bool is_utf16(std::string_view start) {
  constexpr std::size_t SEEN = 16;
  if (start.size() < SEEN) return false;
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < SEEN; ++i)
    if (start[i] == '\0') ++zeros[i % 2];
  return std::max(zeros[0], zeros[1]) == SEEN / 2 && std::min(zeros[0], zeros[1]) == 0;
}

}  // namespace

std::string_view first_word(std::string_view text) {
  const std::string_view body = from_first_word(text);
  return body.substr(0, body.find_first_of(BLANKS));
}

std::size_t off_head(std::string_view word) {
  const std::size_t end = word.find("OFF") + 3;
  const bool is_head = word.find("OFF") < word.npos && word.substr(0, end - 3).find_first_not_of("STCN4n") == word.npos;
  return is_head && word.find_first_not_of("0123456789", end) == word.npos ? end : 0;
}

bool is_binary_stl(std::string_view start, std::uint64_t size) {
  if (start.size() < 84) return false;
  std::uint64_t count = 0;
  for (int i = 3; i >= 0; --i) count = count << 8 | static_cast<unsigned char>(start[80 + i]);
  return size == 84 + 50 * count;
}

FileKind file_kind(std::string_view start, std::uint64_t size) {
  for (const Signature& signature : SIGNATURES)
    if (start.starts_with(signature.start)) return signature.kind;
  if (is_binary_stl(start, size)) return FileKind::stl;
  if (is_utf16(start)) return FileKind::utf16;
  return kind_of_text(start.substr(0, 64 << 10));
}

FileKind file_kind_at(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return FileKind::unknown;
  std::string head(64 << 10, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  return file_kind(head, failed ? head.size() : size);
}

std::string wrong_kind(FileKind kind, std::string_view wanted) {
  const auto* words = std::find_if(WORDS.begin(), WORDS.end(), [&](const Words& each) { return each.kind == kind; });
  if (words == WORDS.end()) return "";
  std::string text = "is ";
  text += words->what;
  text += " and not ";
  text += is_wrapping(kind) ? "the file" : wanted;
  text += is_wrapping(kind) ? ": " : "; ";
  return text += words->remedy;
}

std::string backslash_note(std::string_view path) { return path.find('\\') == path.npos ? "" : "; " + std::string(WRITE_SLASHES); }

}  // namespace wholehand
