// SPDX-License-Identifier: MIT
// Files that are either complete or absent.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace wholehand {

// The first bytes of every NetCDF-4 file, by any program: HDF5's signature.
inline constexpr std::string_view NETCDF4_START{"\x89HDF\r\n\x1a\n", 8};

// The file that `path` is or, if it is a symbolic link, finally points to; that file need not exist. The kernel's own links (/proc/self/fd/1, and
// with it /dev/stdout and /dev/fd/1) are not followed.
std::string followed(const std::string& path);

// Throws Error (usage) if `path` cannot become a file: its folder is missing or not writable; it is or points to something other than a regular file
// (a directory, a device); or it is "-". `option` names the option for the message.
void check_output_path(const std::string& path, const char* option = "-o");

// Whether an open file has this name now. A link of that name counts as another file.
bool has_name(int file, const std::string& path);

// Whether both exist and are the same file, under any names.
bool is_same_file(const std::string& a, const std::string& b);

// Throws Error (usage), to prevent overwriting, if a nonempty file exists that does not begin with `start`. `what` names such files in the message
// ("glTF binary").
void check_overwrites_kind(const std::string& path, std::string_view start, const char* what, const char* option);

// Throws Error (usage) if any nonempty file exists there.
void check_overwrites_nothing(const std::string& path, const char* option);

// Whether a regular file exists that begins with `start`.
bool begins_with(const std::string& path, std::string_view start);

// Whether a regular file exists with `mark` in its first 64 KiB.
bool has_mark(const std::string& path, std::string_view mark);

// Throws Error (usage), to prevent overwriting, if something exists that is neither empty nor has `mark`.
void check_overwrites_marked(const std::string& path, std::string_view mark, const char* what, const char* option);

// Throws Error (usage), to prevent overwriting, if a nonempty file exists that is not a result file (NetCDF-4, of any program).
void check_overwrites_result(const std::string& path);

// Makes the folder if it is missing. Throws Error: (usage) the parent is missing, or the path is a file; (failure) no file can be made in it.
void make_output_folder(const std::string& path);

// Bytes free for this user on the disk of `path`'s folder, or the process's file-size limit if that is less.
double free_bytes(const std::string& path);

// Tests whether `path` can be made with that many bytes: makes it, reserves the bytes, and removes it. Throws Error (failure) with the remedy.
void check_room(const std::string& path, std::uint64_t bytes, const char* remedy = "make room, or name another file with -o");

// Flushes a folder's entries, so that a rename in it survives a power failure. Errors are not reported, because some file systems cannot do it.
void sync_folder_of(const std::string& path);

// The temporary name for the file that `path` is or points to: beside it, and unique to this process.
std::string temporary_name(const std::string& path);

// Makes the file `path`, which must not exist, and writes `text`; `durable` syncs it. Returns 0, or an error number; then no file is left.
int write_new_file(const std::string& path, const std::string& text, bool durable);

// Adds `text` to the end of the file `path`, which need not exist. Returns 0, or an error number.
int append_to_file(const std::string& path, const std::string& text);

// Writes `text` to the file that `path` is or points to, under temporary_name, and renames it; `durable` syncs in between. Throws Error (failure)
// with the remedy.
void write_whole_file(const std::string& path, const std::string& text, bool durable,
                      const char* remedy = "make room, or name another file");

// Renames, replacing anything that exists. Throws Error (failure).
void rename_file(const std::string& from, const std::string& to);

// Renames onto nothing or onto an empty file. Returns false if something else exists, which stays. Throws Error (failure).
bool rename_onto_nothing(const std::string& from, const std::string& to);

}  // namespace wholehand
