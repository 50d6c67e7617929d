// Files that are either whole or not there.
#pragma once

#include <cstdint>
#include <string>

namespace wholehand {

struct Scene;

// Where the files of a sweep lie: NAME.nc and its companions, from the name of the result file.
struct OutputNames {
  std::string result;   // NAME.nc as the user gave it
  std::string partial;  // NAME.nc.partial while it is being written
  std::string mark;     // NAME.nc.partial.mark: how far it is whole
  std::string best;     // NAME.best.csv
  std::string heat_map(const std::string& vessel_part) const { return stem + "." + vessel_part + ".svg"; }
  std::string grip_glb(const std::string& vessel_part, std::size_t rank) const {
    return stem + "." + vessel_part + "." + std::to_string(rank) + ".glb";
  }
  std::string stem;  // NAME
};

OutputNames output_names(const std::string& result);

// Throws Error (usage) where `path` cannot become a file: its folder is missing or cannot be written to, or it is there and is not a
// regular file (a directory, a device). `option` is the one that named it, for the message.
void check_output_path(const std::string& path, const char* option = "-o");

// Throws Error (usage) where `path` is the scene file itself or a mesh of it, by whatever name.
void check_not_the_scene(const std::string& path, const Scene& scene, const char* option = "-o");

// Throws Error (usage) where a file with something in it is there that does not begin with `start`: it is not overwritten. `what`: what begins
// so, for the message ("glTF binary").
void check_overwrites_kind(const std::string& path, const std::string& start, const char* what, const char* option);

// Throws Error (usage) where a file with something in it is there that is no result file (NetCDF-4, of any program): it is not overwritten.
void check_overwrites_result(const std::string& path);

// Makes the folder where it is missing. Throws Error: (usage) its parent is missing, or a file is there; (failure) no file can be made
// in it.
void make_output_folder(const std::string& path);

// Bytes free for this user on the disk that holds `path`'s folder; the file-size limit of the process if that is less.
double free_bytes(const std::string& path);

// Finds out whether `path` can be made with so many bytes, by making it, reserving them, and removing it. Throws Error (failure).
void check_room(const std::string& path, std::uint64_t bytes);

// Flushes a folder's entries, so that a rename in it outlives a power failure. Errors are not reported: some file systems cannot.
void sync_folder_of(const std::string& path);

// Writes `text` to `path` under a temporary name and renames it; `durable` syncs in between. Throws Error (failure).
void write_whole_file(const std::string& path, const std::string& text, bool durable);

// Renames over whatever is there. Throws Error (failure).
void rename_file(const std::string& from, const std::string& to);

}  // namespace wholehand
