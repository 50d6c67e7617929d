// SPDX-License-Identifier: MIT
// Tells what a file is by its first bytes, whatever its name, to help users who give a wrong one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace wholehand {

enum class FileKind { unknown, gltf, stl, obj, ply, off, collada, result, recording, scene, lfs_pointer, web_page, utf16, archive };

// `start`: the first bytes, of which 64 KiB are examined; `size`: bytes of the whole file.
FileKind file_kind(std::string_view start, std::uint64_t size);

// The length of an OFF's first word up to its last F, with what its vertices have besides coordinates: 3 of "OFF", 4 of "COFF", 3 of "OFF8", where a
// count follows without a blank; 0 if the word is none of these.
std::size_t off_head(std::string_view word);

// What a file is. Unknown if there is no readable regular file. Does not wait on a pipe.
FileKind file_kind_at(const std::string& path);

// The first word of the first line that is neither empty nor a comment.
std::string_view first_word(std::string_view text);

// 84 bytes, and 50 for each of as many triangles as bytes 80 to 83 say.
bool is_binary_stl(std::string_view start, std::uint64_t size);

// "is a Git LFS pointer and not the file: git lfs pull", "is a mesh (STL) and not a scene; ...", for a file that should be `wanted` ("a scene");
// "" where the kind is unknown.
std::string wrong_kind(FileKind kind, std::string_view wanted);

// Whether such a file wraps the wanted one or stands in its place.
constexpr bool is_wrapping(FileKind kind) { return kind >= FileKind::lfs_pointer; }

// A hint for a path with backslashes, as on Windows.
inline constexpr std::string_view WRITE_SLASHES = "write / in a path, and no backslash";
// "; " and that hint for such a path, else "".
std::string backslash_note(std::string_view path);

}  // namespace wholehand
