// SPDX-License-Identifier: MIT
// The layout of a recording's file: converts the session's description to a header, and back.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "device/recordings/classic_netcdf.h"
#include "device/recordings/recording.h"

namespace wholehand::device {

constexpr const char* TICK_DIMENSION = "tick";
constexpr const char* TIME_VARIABLE = "time";

// The header, laid out, with room behind it for the attributes written at the end; and the contents of its fixed variables, in the order of the file,
// from the first one's position on.
struct RecordingLayout {
  classic::Header header;
  std::string fixed;
};
RecordingLayout layout_recording(const RecordingInfo& info);

// Adds the attributes of the end, including the number of records. The header stays within its room.
void add_end(classic::Header& header, const RecordingEnd& end);

// Both throw Error (usage), without the file's name, if something is missing, impossible or not as it was written. `fixed_values` gives the bytes of
// a fixed variable.
using FixedValues = std::function<std::string(const classic::Variable&)>;
RecordingInfo recording_info(const classic::Header& header, const FixedValues& fixed_values);
std::optional<RecordingEnd> end_of(const classic::Header& header);

// The names of a variable's dimensions, in one line.
std::string dimension_names(const classic::Header& header, const classic::Variable& variable);

}  // namespace wholehand::device
