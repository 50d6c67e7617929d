// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/file_kind.h"
#include "device/recordings/fields.h"
#include "device/recordings/layout.h"
#include "device/recordings/recording.h"

namespace wholehand::device {
namespace {

constexpr std::uint64_t READ_AT_ONCE = 1 << 20;  // bytes

// An open file that is only read; its length is what it was when it was opened.
class RecordedFile {
 public:
  explicit RecordedFile(const std::string& path) : path_(path) {
    // a pipe must not make it wait
    file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat status {};
    if (file_ < 0 || fstat(file_, &status) != 0) {
      const int error = errno;
      if (file_ >= 0) close(file_);
      throw usage_error(fmt::format("{}: cannot be read: {}{}", path, std::strerror(error), backslash_note(path)));
    }
    if (!S_ISREG(status.st_mode)) {
      close(file_);
      throw usage_error(
          fmt::format("{}: is a {}; name a recording", path, S_ISDIR(status.st_mode) ? "directory" : "device or pipe"));
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
  }
  ~RecordedFile() { close(file_); }
  RecordedFile(const RecordedFile&) = delete;
  RecordedFile& operator=(const RecordedFile&) = delete;

  std::uint64_t size() const { return size_; }

  void read(std::string& bytes, std::uint64_t count, std::uint64_t place) const {
    bytes.resize(count);
    for (std::uint64_t done = 0; done < count;) {
      const ssize_t got = pread(file_, bytes.data() + done, count - done, static_cast<off_t>(place + done));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {
        throw usage_error(fmt::format("{}: cannot be read: {}", path_,
                                      got < 0 ? std::strerror(errno) : "the file became shorter while it was read"));
      }
      done += static_cast<std::uint64_t>(got);
    }
  }

 private:
  std::string path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

// A field and where it lies in a record.
struct PlacedField {
  const RecordedField* field;
  std::uint64_t place;
};

std::vector<PlacedField> place_fields(const classic::Header& header, std::size_t vessels) {
  std::vector<PlacedField> places;
  for (const RecordedField& field : recorded_fields()) {
    const bool is_real = field.as == RecordedAs::real || field.as == RecordedAs::number;
    const classic::Type type = is_real                        ? classic::Type::float64
                               : field.as == RecordedAs::flag ? classic::Type::byte
                                                              : classic::Type::int32;
    const std::string dimensions = std::string(TICK_DIMENSION) + (*field.dimensions ? " " : "") + field.dimensions;
    const classic::Variable* variable = header.variable(field.name);
    if (!variable || !variable->is_record || variable->type != type || dimension_names(header, *variable) != dimensions ||
        variable->values != recorded_values(field, vessels)) {
      throw usage_error(
          fmt::format("is not a recording of a session: it lacks the variable {}({}) of the right type", field.name, dimensions));
    }
    places.push_back({&field, variable->begin - header.record_begin});
  }
  return places;
}

// `counted` of the `records` are known to be whole; the ticks end before the first of the others that is not.
std::vector<Tick> read_ticks(const RecordedFile& file, const classic::Header& header, std::uint64_t records, std::uint64_t counted,
                             std::size_t vessels) {
  const std::vector<PlacedField> places = place_fields(header, vessels);
  RecordChecksums checksums(header);
  std::vector<Tick> ticks(records);
  const std::uint64_t at_once = std::max<std::uint64_t>(1, READ_AT_ONCE / header.record_size);
  std::string block;
  for (std::uint64_t first = 0; first < records; first += at_once) {
    const std::uint64_t count = std::min(at_once, records - first);
    file.read(block, count * header.record_size, header.record_begin + first * header.record_size);
    for (std::uint64_t k = 0; k < count; ++k) {
      const char* record = block.data() + k * header.record_size;
      if (!checksums.is_next(record)) {
        if (first + k < counted)
          throw usage_error(fmt::format("record {} is damaged: its checksum is wrong; use a copy that is not damaged", first + k));
        ticks.resize(first + k);
        return ticks;
      }
      Tick& tick = ticks[first + k];
      for (const auto& [field, place] : places) {
        if (!load_field(record + place, *field, tick, vessels))
          throw usage_error(fmt::format("record {}: {} has an impossible value", first + k, field->name));
      }
      if (tick.vessel >= static_cast<int>(vessels))
        throw usage_error(fmt::format("record {}: vessel_index {} of {} vessels", first + k, tick.vessel, vessels));
      if (first + k > 0 && tick.number <= ticks[first + k - 1].number)
        throw usage_error(fmt::format("record {}: tick {} follows tick {}, and ticks must ascend", first + k, tick.number,
                                      ticks[first + k - 1].number));
    }
  }
  return ticks;
}

// What the user should know of the file's end; empty: nothing.
std::string note_of(const Recording& recording, const classic::Header& header) {
  if (header.records <= classic::MOST_RECORDS && recording.ticks.size() < header.records)
    return fmt::format("is cut off: {} of {} ticks are there", readable_number(recording.ticks.size()),
                       readable_number(header.records));
  if (!recording.end) return "was not finished: the session was killed, or is still running";
  return recording.end->early.empty() ? "" : "ended before the session: " + recording.end->early;
}

Recording read_recorded_file(const RecordedFile& file) {
  std::string start;
  file.read(start, std::min(file.size(), classic::LARGEST_HEADER), 0);
  const FileKind kind = file_kind(start, file.size());
  if (kind == FileKind::result)
    throw usage_error(wrong_kind(kind, "a recording") +
                      "; if another program has rewritten a recording, convert it by nccopy -k 64-bit-offset");
  if (kind != FileKind::recording && kind != FileKind::unknown) throw usage_error(wrong_kind(kind, "a recording"));
  const classic::Header header = classic::parse_header(start, file.size());
  Recording recording;
  recording.info = recording_info(header, [&file](const classic::Variable& variable) {
    std::string bytes;
    file.read(bytes, variable.size, variable.begin);
    return bytes;
  });
  recording.end = end_of(header);
  const std::size_t vessels = recording.info.vessels.size();
  // no record size: place_fields refuses it, without any ticks
  const bool has_records = header.record_size > 0 && file.size() > header.record_begin;
  const std::uint64_t there = has_records ? (file.size() - header.record_begin) / header.record_size : 0;
  // a session that did not end has not counted its last block, or its count is damaged
  const std::uint64_t counted = std::min<std::uint64_t>(there, header.records);
  recording.ticks = read_ticks(file, header, recording.end ? counted : there, counted, vessels);
  recording.note = note_of(recording, header);
  return recording;
}

}  // namespace

Recording read_recording(const std::string& path) {
  const RecordedFile file(path);
  try {
    Recording recording = read_recorded_file(file);
    if (!recording.note.empty()) recording.note = path + " " + recording.note;
    return recording;
  } catch (const Error& error) {
    const std::string line = error.what();
    throw line.starts_with(path) ? error : usage_error(path + ": " + line);
  }
}

}  // namespace wholehand::device
