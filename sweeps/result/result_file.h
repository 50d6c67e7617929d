// SPDX-License-Identifier: MIT
// The result file of a sweep during writing: chunk by chunk, complete or absent, and readable at any time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/files/checksum.h"
#include "core/planes.h"
#include "sweeps/lists/best.h"
#include "sweeps/result/mark.h"
#include "sweeps/result/output_bytes.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/result_checksums.h"
#include "sweeps/result/result_contents.h"
#include "sweeps/result/run_layout.h"

namespace wholehand::sweeps {

// Where the values lie in the file, bytes from its start.
struct FilePlaces {
  std::vector<std::uint64_t> variables;  // in the order of the contents
  std::vector<std::uint64_t> axes;       // the axes' values at Sobol points; empty for a grid
  std::optional<std::uint64_t> height;   // the vessels' heights in m at Sobol points, if their axis has fractions
  std::vector<std::uint64_t> best;       // best_grip, best_score, axes; refined score, axes; robust scores
  FileRange checksums;                   // known only to the process that made the file
};

// How a file begins: new, with room for everything; new, if other files take most of the values; or as an earlier sweep left it.
enum class FileStart { reserved, sparse, resumed };

// NetCDF defines the file once (result_contents.h) and closes it. From then on only the values change, and they go straight to the
// places in the file that HDF5 gave to them: every variable is one contiguous block in native byte order, and a plane of a chunk is
// one contiguous run of it. This has three reasons. A process that is killed, or a disk that fills up, cannot leave HDF5's own
// structures half written: the file can always be opened, and a resumed sweep goes on in it. The whole size is reserved before the
// first grip. And a write costs a system call, not a walk through two libraries.
//
// All methods throw Error (failure) with the file, the reason and what to do.
class ResultFile {
 public:
  // Creates NAME.nc.partial, or, to resume, opens the existing one unchanged. Only the holder of the result's lock (base/files/output_lock.h) may do
  // that. Contents must outlive the object, and be the same for a resumed file.
  ResultFile(const OutputNames& names, const ResultContents& contents, const FieldSet& fields, FileStart start,
             const OpenOutput& open_output = {});
  // Opens the file of another process, with its places, to add grips beside that process; or a shard (sweeps/result/shard.h).
  ResultFile(const OutputNames& names, const ResultContents& contents, const FieldSet& fields, const FilePlaces& places,
             const OpenOutput& open_output = {});
  ~ResultFile();
  ResultFile(const ResultFile&) = delete;
  ResultFile& operator=(const ResultFile&) = delete;

  // Puts a chunk in its place, once per azimuth for which it stands.
  void write(const PlaneChunk& chunk);

  // The grips written since the last end_stretch, all of one vessel and in order, and their checksum. Other grips begin their own stretch.
  Stretch stretch() const;
  void end_stretch();
  // Whether the file holds grips with this checksum: reads them back.
  bool holds(std::size_t vessel, const Stretch& stretch);
  const FilePlaces& places() const { return places_; }
  const RunLayout& layout() const { return layout_; }
  const std::string& path() const { return names_.partial; }
  std::uint64_t inode() const;  // distinguishes the file from others of its name on other machines
  // Throws if another file, or none, has the name now: another job took it that no lock kept away. Call before doing anything under that name, such
  // as saving a mark.
  void check_own() const;
  // Whether the file keeps what decides which grips may be listed; and those data of the grips [first, last) of a vessel, from the present file,
  // whoever wrote it.
  bool has_eligible() const;
  std::vector<Candidate> eligible(std::size_t vessel, std::uint64_t first, std::uint64_t last) const;
  // Whether the file holds any data of the grips.
  bool has_grips() const { return !blocks_.empty(); }

  // Adds to a mark what else it vouches for; write_ending changes it.
  void vouch_for_structure(SweepMark& mark);

  // The first returns when everything written is on the disk; start_sync only starts that, so that other work continues meanwhile.
  void sync();
  void start_sync();

  // Writes the places and scores of the best grips (missing ranks are filled), and the times.
  void write_ending(const BestLists& best, double wall_seconds, double kernel_seconds);

  // From now on reads of a synced file come from the disk.
  void drop_cached();
  // The checksum of a block of it (sweeps/result/result_checksums.h).
  std::string block_checksum(const ChecksumPart& part, std::uint64_t block) const {
    return wholehand::sweeps::block_checksum(file_, part, block);
  }
  // Syncs, has the NetCDF library read the structure of the file, writes the checksums (parts with some known may be given), renames NAME.nc.partial
  // to NAME.nc, closes it and removes the mark. The last call.
  void finish(ChecksumParts parts = {});

  std::uint64_t bytes() const { return bytes_; }  // of values written by this process
  double seconds() const { return seconds_; }     // time for writing and syncing; the definition does not grow with the grips

 private:
  struct Block : LayoutBlock {
    const Variable* variable = nullptr;
    int plane = 0;  // first plane of the chunk
  };

  const Block* block_of(const char* variable) const;
  void create(FileStart start);
  void open_values(const OpenOutput& open_output);
  FilePlaces find_places() const;
  void set_blocks();
  std::vector<FileRange> written_in_place() const;
  void put(const void* data, std::size_t size, std::uint64_t offset);
  const void* plane_values(const Block& block, std::size_t plane, const PlaneChunk& chunk);
  [[noreturn]] void fail(const char* what, int error) const;

  OutputNames names_;
  const ResultContents& contents_;
  FieldSet fields_;
  int file_ = -1;
  std::vector<Block> blocks_;
  FilePlaces places_;
  RunLayout layout_;
  std::unique_ptr<OutputBytes> output_;  // null: the system's own calls
  std::vector<unsigned char> buffer_;    // values of one plane that need conversion
  RunsChecksum checksum_;                // of the stretch that is being written
  Stretch stretch_;
  std::size_t stretch_vessel_ = 0;
  std::string structure_;
  int sync_error_ = 0;  // sticky: the system reports lost values once
  std::uint64_t bytes_ = 0;
  double seconds_ = 0;
};

// The last steps of a result whose values are on the disk: the first has the NetCDF library read the structure of NAME.nc.partial, the second renames
// it to NAME.nc and removes the mark. Both throw Error (failure).
void check_readable(const OutputNames& names);
void name_result(const OutputNames& names);

}  // namespace wholehand::sweeps
