// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>

#include "base/files/files.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "device/recordings/fields.h"
#include "device/recordings/layout.h"
#include "device/recordings/recording.h"

namespace wholehand::device {
namespace {

std::string partial_recording(const std::string& path) { return followed(path) + ".partial"; }

Error is_in_the_way(const std::string& path, const std::string& partial, const char* option) {
  return usage_error(
      fmt::format("{} {}: {} exists, from a session that was killed or is still running; move it, remove it, or name another file",
                  option, path, partial));
}

void append_record(std::string& block, const Tick& tick, double rate, std::size_t vessels, RecordChecksums& checksums) {
  const std::size_t start = block.size();
  classic::append_real(block, static_cast<double>(tick.number) / rate);
  for (const RecordedField& field : recorded_fields()) append_field(block, field, tick, vessels);
  classic::append_32(block, 0);
  checksums.store(block.data() + start);
}

}  // namespace

void check_recording_path(const std::string& path, const char* option) {
  check_output_path(path, option);
  check_overwrites_nothing(path, option);
  const std::string partial = partial_recording(path);
  struct stat status {};
  if (lstat(partial.c_str(), &status) == 0) throw is_in_the_way(path, partial, option);
}

RecordingWriter::RecordingWriter(const std::string& path, const RecordingInfo& info, const char* option, const char* remedy)
    : path_(path), partial_(partial_recording(path)), place_(partial_), rate_(info.rate), vessels_(info.vessels.size()) {
  if (vessels_ < 1 || vessels_ > LIVE_VESSELS)
    throw usage_error(fmt::format("{}: a recording has 1 to {} vessels", path, LIVE_VESSELS));
  check_recording_path(path, option);
  std::signal(SIGXFSZ, SIG_IGN);
  RecordingLayout layout = layout_recording(info);
  header_ = std::move(layout.header);
  fixed_ = std::move(layout.fixed);
  checksums_.emplace(header_);
  // the room between the header and the first variable is written, too, so that the end needs no more of the disk
  std::string start = classic::encode_header(header_);
  start.resize(header_.record_begin - fixed_.size(), '\0');
  start += fixed_;
  file_ = open(partial_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file_ < 0 && errno == EEXIST) throw is_in_the_way(path, partial_, option);
  int error = file_ < 0 ? errno : 0;
  if (file_ >= 0 && put(start.data(), start.size(), 0, error) < start.size()) {
    close(file_);
    unlink(partial_.c_str());
    file_ = -1;
  }
  if (file_ < 0) throw failure_error(fmt::format("{}: cannot record: {}; {}", path, std::strerror(error), remedy));
}

RecordingWriter::~RecordingWriter() {
  if (file_ >= 0) close(file_);
}

// How many bytes the file took, and why not all of them.
std::uint64_t RecordingWriter::put(const char* data, std::uint64_t size, std::uint64_t place, int& error) {
  std::uint64_t done = 0;
  while (done < size) {
    const ssize_t written = pwrite(file_, data + done, size - done, static_cast<off_t>(place + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      error = written < 0 ? errno : EIO;
      break;
    }
    done += static_cast<std::uint64_t>(written);
  }
  return done;
}

void RecordingWriter::give_up(int error) {
  reason_ = error == 0 ? "it holds as many ticks as a file can" : std::strerror(error);
  last_error_ = fmt::format("{}: recording ended: {}; it is complete up to here", path_, reason_);
  is_whole_ = false;
}

std::uint64_t RecordingWriter::bytes() const { return header_.record_begin + header_.records * header_.record_size; }

bool RecordingWriter::append(std::span<const Tick> ticks) {
  if (file_ < 0 || !last_error_.empty()) return false;
  const std::size_t taken = std::min<std::size_t>(ticks.size(), classic::MOST_RECORDS - header_.records);
  try {
    block_.clear();
    block_.reserve(taken * header_.record_size);
    for (const Tick& tick : ticks.first(taken)) append_record(block_, tick, rate_, vessels_, *checksums_);
  } catch (const std::bad_alloc&) {
    give_up(ENOMEM);
    return false;
  }
  append_block();
  if (last_error_.empty() && taken < ticks.size()) give_up(0);
  return last_error_.empty();
}

// Writes the block down, or as many whole records of it as the disk still takes.
void RecordingWriter::append_block() {
  if (!is_all_there()) return;
  int error = 0;
  const std::uint64_t end = bytes(), written = put(block_.data(), block_.size(), end, error);
  const auto added = static_cast<std::uint32_t>(written / header_.record_size);
  if (written < block_.size()) {
    give_up(error);
    [[maybe_unused]] const int cut =
        ftruncate(file_, static_cast<off_t>(end + added * header_.record_size));  // a rest does no harm
  }
  // counted last: a process killed in between leaves a file without the block, but complete
  std::string count;
  classic::append_32(count, header_.records + added);
  if (put(count.data(), count.size(), classic::RECORD_COUNT_PLACE, error) == count.size()) {
    header_.records += added;
  } else if (last_error_.empty()) {
    give_up(error);
  }
}

// Whether the partial file has its name still.
bool RecordingWriter::is_in_place() const {
  struct stat open {
  }, named{};
  return fstat(file_, &open) == 0 && lstat(partial_.c_str(), &named) == 0 && named.st_dev == open.st_dev &&
         named.st_ino == open.st_ino;
}

// Whether the partial file is where it was made, with everything written to it: someone may have removed or cut it.
bool RecordingWriter::is_all_there() {
  struct stat open {};
  if (fstat(file_, &open) != 0 || !last_error_.empty()) return last_error_.empty();
  if (!is_in_place()) {
    place_.clear();
    reason_ = "its file was removed or renamed";
    last_error_ =
        fmt::format("{}: recording ended: {} was removed or renamed during the session, with all recorded ticks", path_, partial_);
  } else if (static_cast<std::uint64_t>(open.st_size) < bytes()) {
    reason_ = "its file was cut";
    last_error_ = fmt::format("{}: recording ended: {} was cut to {} of {} bytes during the session", path_, partial_,
                              readable_number(static_cast<std::uint64_t>(open.st_size)), readable_number(bytes()));
    // drops the remaining ticks, so that later ones do not follow a gap
    const std::uint64_t start = header_.record_begin, size = static_cast<std::uint64_t>(open.st_size);
    header_.records = size > start ? static_cast<std::uint32_t>((size - start) / header_.record_size) : 0;
  }
  is_whole_ = last_error_.empty();
  return is_whole_;
}

bool RecordingWriter::finish(RecordingEnd end) {
  if (file_ < 0) return false;
  is_all_there();
  if (end.early.empty()) end.early = reason_;
  add_end(header_, end);
  set_checksum(header_, fixed_);
  const std::string start = classic::encode_header(header_);
  int error = 0;
  // in place, over existing bytes, so that a full disk does not prevent it
  const bool is_ended = put(start.data(), start.size(), 0, error) == start.size() && fsync(file_) == 0;
  if (!is_ended && last_error_.empty()) give_up(error != 0 ? error : errno);
  const bool is_there = is_in_place();
  close(file_);
  file_ = -1;
  return is_there && publish() && is_ended;
}

// Renames the partial file; false: it stays where it is.
bool RecordingWriter::publish() {
  std::string refusal;
  try {
    if (rename_onto_nothing(partial_, followed(path_))) {
      sync_folder_of(followed(path_));
      place_ = path_;
      return true;
    }
    refusal = fmt::format("{}: another file appeared there during the session, and is not overwritten", path_);
  } catch (const Error& refused) {
    refusal = refused.what();
  }
  if (reason_.empty()) reason_ = refusal;
  last_error_ = fmt::format("{}; the {} recording is {}", refusal, is_whole_ ? "complete" : "incomplete", partial_);
  return false;
}

}  // namespace wholehand::device
