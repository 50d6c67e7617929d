// SPDX-License-Identifier: MIT
// Recordings whose bytes were changed on purpose, with the checksums that they should have.
#pragma once

#include <cstdint>
#include <string>

#include "base/text/error.h"
#include "device/recordings/checksums.h"
#include "device/recordings/classic_netcdf.h"

namespace wholehand {

// Lets the reader come as far as what was changed. What is no recording any more stays.
inline void renew_checksums(std::string& bytes) {
  try {
    device::classic::Header header = device::classic::parse_header(bytes, bytes.size());
    std::string fixed;
    for (const device::classic::Variable& variable : header.variables)
      if (!variable.is_record) fixed += bytes.substr(variable.begin, variable.size);
    device::set_checksum(header, fixed);
    const std::string start = device::classic::encode_header(header);
    device::RecordChecksums checksums(header);
    bytes.replace(0, start.size(), start);
    for (std::uint64_t k = 0; header.record_begin + (k + 1) * header.record_size <= bytes.size(); ++k)
      checksums.store(bytes.data() + header.record_begin + k * header.record_size);
  } catch (const Error&) {
  }
}

}  // namespace wholehand
