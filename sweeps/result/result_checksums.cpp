// SPDX-License-Identifier: MIT
#include "sweeps/result/result_checksums.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "base/text/error.h"
#include "base/text/text.h"
#include "sweeps/result/hdf5_file.h"

namespace wholehand::sweeps {
namespace {

constexpr std::string_view START = "wholehand checksums 1 ";  // then the length and the checksum of what follows its line
constexpr std::uint64_t NUMBER_LENGTH = 20;
constexpr const char* NO_VESSEL = "-";

herr_t add_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

std::vector<hsize_t> lengths_of(hid_t dataset) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  std::vector<hsize_t> lengths(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  H5Sget_simple_extent_dims(space, lengths.data(), nullptr);
  return lengths;
}

// Checksum of all bytes that are neither values of a part nor checksums.
std::optional<std::string> rest_checksum(int file, const FileRange& room, const std::vector<ChecksumPart>& parts) {
  std::vector<FileRange> ranges{room};
  for (const ChecksumPart& part : parts) ranges.push_back(part.range);
  std::sort(ranges.begin(), ranges.end(), [](const FileRange& a, const FileRange& b) { return a.offset < b.offset; });
  return checksum_without(file, ranges);
}

std::string checksums_text(const ChecksumParts& all, const std::string& rest) {
  std::string text = fmt::format("{} {} {}\n", all.room.offset, all.room.size, rest);
  for (const ChecksumPart& part : all.parts)
    text += fmt::format("{} {} {} {} {}\n", part.variable, part.vessel ? std::to_string(*part.vessel) : NO_VESSEL,
                        part.range.offset, part.range.size, joined(part.blocks, " "));
  return fmt::format("{}{} {}\n{}", START, text.size(), checksum_text(text.data(), text.size()), text);
}

// Reads that text. False: checksums_text never wrote it.
bool read_checksums(const std::string& text, FileRange& room, std::string& rest, std::vector<ChecksumPart>& parts) {
  const std::size_t end = text.find('\n');
  if (!text.starts_with(START) || end == std::string::npos) return false;
  std::istringstream first(text.substr(START.size(), end - START.size()));
  std::uint64_t length = 0;
  std::string checksum;
  if (!(first >> length >> checksum) || length > text.size() - end - 1) return false;
  const std::string body = text.substr(end + 1, length);
  if (checksum_text(body.data(), body.size()) != checksum) return false;
  std::istringstream lines(body);
  if (!(lines >> room.offset >> room.size >> rest)) return false;
  ChecksumPart part;
  for (std::string vessel; lines >> part.variable >> vessel >> part.range.offset >> part.range.size; parts.push_back(part)) {
    part.vessel.reset();
    if (vessel != NO_VESSEL) part.vessel = std::strtoull(vessel.c_str(), nullptr, 10);
    if (part.range.size / CHECKSUM_BLOCK > length) return false;
    part.blocks.resize(part.block_count());
    for (std::string& block : part.blocks)
      if (!(lines >> block)) return false;
  }
  return true;
}

}  // namespace

std::uint64_t checksum_room(const std::string& variable, std::uint64_t vessels, std::uint64_t bytes) {
  const std::uint64_t lines = std::max<std::uint64_t>(1, vessels);
  return lines * (variable.size() + 3 * (NUMBER_LENGTH + 1) + 2) + (bytes / CHECKSUM_BLOCK + lines) * (CHECKSUM_LENGTH + 1);
}

ChecksumParts checksum_parts(const std::string& path) {
  const Hdf5Handle file(open_hdf5(path, H5F_ACC_RDONLY), H5Fclose);
  std::vector<std::string> names;
  if (file < 0 || H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names) < 0)
    throw failure_error(path + ": cannot be read as a result file");
  const Hdf5Handle vessel(H5Dopen2(file, "vessel", H5P_DEFAULT), H5Dclose);
  const std::vector<hsize_t> vessels = vessel >= 0 ? lengths_of(vessel) : std::vector<hsize_t>{};
  ChecksumParts all;
  for (const std::string& name : names) {
    const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (dataset < 0) continue;
    const haddr_t offset = H5Dget_offset(dataset);
    const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
    const H5T_class_t kind = H5Tget_class(type);
    if (offset == HADDR_UNDEF) continue;
    const FileRange range{offset, H5Dget_storage_size(dataset)};
    if (name == CHECKSUMS) all.room = range;
    if (kind != H5T_INTEGER && kind != H5T_FLOAT) continue;
    const std::vector<hsize_t> lengths = lengths_of(dataset);
    if (lengths.size() < 2 || vessels.size() != 1 || lengths[0] != vessels[0]) {
      all.parts.push_back({name, {}, range, {}});
      continue;
    }
    const std::uint64_t size = range.size / lengths[0];
    for (std::uint64_t v = 0; v < lengths[0]; ++v) all.parts.push_back({name, v, {range.offset + v * size, size}, {}});
  }
  if (all.room.size == 0) throw failure_error(path + ": has no room for checksums");
  return all;
}

std::string block_checksum(int file, const ChecksumPart& part, std::uint64_t block) {
  std::vector<char> bytes(std::min(CHECKSUM_BLOCK, part.range.size - block * CHECKSUM_BLOCK));
  for (std::size_t done = 0; done < bytes.size();) {
    const auto place = static_cast<off_t>(part.range.offset + block * CHECKSUM_BLOCK + done);
    const ssize_t got = pread(file, bytes.data() + done, bytes.size() - done, place);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0)
      throw failure_error(fmt::format("{} cannot be read: {}", part.variable, got < 0 ? std::strerror(errno) : "is cut off"));
    done += static_cast<std::size_t>(got);
  }
  return checksum_text(bytes.data(), bytes.size());
}

void write_checksums(int file, const std::string& path, ChecksumParts all) {
  for (ChecksumPart& part : all.parts)
    for (std::uint64_t block = part.blocks.size(); block < part.block_count(); ++block)
      part.blocks.push_back(block_checksum(file, part, block));
  const std::optional<std::string> rest = rest_checksum(file, all.room, all.parts);
  if (!rest) throw failure_error(fmt::format("{}: cannot read it: {}", path, std::strerror(errno)));
  std::string text = checksums_text(all, *rest);
  if (text.size() > all.room.size) throw failure_error(path + ": has no room for all of its checksums");
  text.resize(all.room.size, '\n');
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t put = pwrite(file, text.data() + done, text.size() - done, static_cast<off_t>(all.room.offset + done));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) throw failure_error(fmt::format("{}: cannot write it: {}", path, std::strerror(put < 0 ? errno : EIO)));
    done += static_cast<std::size_t>(put);
  }
  if (fsync(file) != 0) throw failure_error(fmt::format("{}: cannot write it: {}", path, std::strerror(errno)));
}

ResultChecksums::ResultChecksums(const std::string& path, const std::string& text) : path_(path) {
  if (text.find_first_not_of('\0') == std::string::npos)
    throw usage_error(path + ": is of a sweep that was not finished; finish it with wholehand sweep --resume");
  FileRange room;
  std::string rest;
  std::vector<ChecksumPart> parts;
  if (!read_checksums(text, room, rest, parts))
    throw usage_error(path + ": is damaged: its checksums are not as a sweep wrote them" + SWEEP_AGAIN);
  file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file_ < 0) throw usage_error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  if (rest_checksum(file_, room, parts) != rest) {
    close(file_);
    throw usage_error(path + ": is damaged: its attributes or its structure are not as the sweep wrote them" + SWEEP_AGAIN);
  }
  for (ChecksumPart& part : parts) parts_[part.variable].push_back(std::move(part));
}

ResultChecksums::~ResultChecksums() { close(file_); }

void ResultChecksums::check(const std::string& variable, std::uint64_t first, std::uint64_t last, std::uint64_t count) {
  const auto found = parts_.find(variable);
  if (found == parts_.end() || count == 0) return;
  std::uint64_t bytes = 0, start = 0;
  for (const ChecksumPart& part : found->second) bytes += part.range.size;
  for (ChecksumPart& part : found->second) {
    const std::uint64_t from = std::max(first * (bytes / count), start),
                        to = std::min(last * (bytes / count), start + part.range.size);
    for (std::uint64_t block = from < to ? (from - start) / CHECKSUM_BLOCK : part.blocks.size();
         block < part.blocks.size() && start + block * CHECKSUM_BLOCK < to; ++block)
      check_block(part, block);
    start += part.range.size;
  }
}

void ResultChecksums::check_all() {
  for (auto& [variable, parts] : parts_)
    for (ChecksumPart& part : parts)
      for (std::uint64_t block = 0; block < part.blocks.size(); ++block) check_block(part, block);
}

void ResultChecksums::check_block(ChecksumPart& part, std::uint64_t block) {
  std::string& checksum = part.blocks[block];
  if (checksum.empty()) return;
  std::string found;
  try {
    found = block_checksum(file_, part, block);
  } catch (const Error&) {
    // the file is cut off
  }
  if (found != checksum)
    throw usage_error(fmt::format("{}: is damaged: the values of {}{} are not those that the sweep wrote{}", path_, part.variable,
                                  part.vessel ? fmt::format(" of vessel {}", *part.vessel + 1) : "", SWEEP_AGAIN));
  checksum.clear();
}

}  // namespace wholehand::sweeps
