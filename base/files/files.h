// SPDX-License-Identifier: MIT
// Files that are either whole or not there.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace wholehand {

// How NetCDF-4 files begin, of any program: by the signature of HDF5, which they are made of.
inline constexpr std::string_view NETCDF4_START{"\x89HDF\r\n\x1a\n", 8};

// The file that `path` is or, where it is a symbolic link, points to in the end; that need not be there. Links of the kernel's own
// (/proc/self/fd/1, and with it /dev/stdout and /dev/fd/1) are not followed.
std::string followed(const std::string& path);

// Throws Error (usage) where `path` cannot become a file: its folder is missing or cannot be written to, or it is there, or points to what is
// there, and is not a regular file (a directory, a device), or it is "-". `option` is the one that named it, for the message.
void check_output_path(const std::string& path, const char* option = "-o");

// Whether an open file has this name now. A link of that name is another file.
bool has_name(int file, const std::string& path);

// Whether both are there and are one file, by whatever names.
bool is_same_file(const std::string& a, const std::string& b);

// Throws Error (usage) where a file with something in it is there that does not begin with `start`: it is not overwritten. `what`: what begins
// so, for the message ("glTF binary").
void check_overwrites_kind(const std::string& path, std::string_view start, const char* what, const char* option);

// Throws Error (usage) where a file with something in it is there, whatever it is.
void check_overwrites_nothing(const std::string& path, const char* option);

// Whether a regular file is there that begins so.
bool begins_with(const std::string& path, std::string_view start);

// Whether a regular file is there with `mark` in its first 64 KiB.
bool has_mark(const std::string& path, std::string_view mark);

// Throws Error (usage) where something is there that is neither empty nor has such a mark: it is not overwritten.
void check_overwrites_marked(const std::string& path, std::string_view mark, const char* what, const char* option);

// Throws Error (usage) where a file with something in it is there that is no result file (NetCDF-4, of any program): it is not overwritten.
void check_overwrites_result(const std::string& path);

// Makes the folder where it is missing. Throws Error: (usage) its parent is missing, or a file is there; (failure) no file can be made
// in it.
void make_output_folder(const std::string& path);

// Bytes free for this user on the disk that holds `path`'s folder; the file-size limit of the process if that is less.
double free_bytes(const std::string& path);

// Finds out whether `path` can be made with so many bytes, by making it, reserving them, and removing it. Throws Error (failure)
// with the remedy.
void check_room(const std::string& path, std::uint64_t bytes, const char* remedy = "make room, or name another file with -o");

// Flushes a folder's entries, so that a rename in it outlives a power failure. Errors are not reported: some file systems cannot.
void sync_folder_of(const std::string& path);

// Where what becomes the file that `path` is or points to is written on the way: a name beside it, of this process alone.
std::string temporary_name(const std::string& path);

// Makes the file `path`, which must not be there, and writes `text` to it; `durable` syncs it. Returns 0, or the error's number;
// then no file is left.
int write_new_file(const std::string& path, const std::string& text, bool durable);

// Writes `text` to the file that `path` is or points to, under its temporary_name, and renames it; `durable` syncs in between.
// Throws Error (failure) with the remedy.
void write_whole_file(const std::string& path, const std::string& text, bool durable,
                      const char* remedy = "make room, or name another file");

// Renames over whatever is there. Throws Error (failure).
void rename_file(const std::string& from, const std::string& to);

// Renames onto nothing, or onto an empty file. False: something else is there, and stays. Throws Error (failure).
bool rename_onto_nothing(const std::string& from, const std::string& to);

}  // namespace wholehand
