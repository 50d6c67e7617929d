// SPDX-License-Identifier: MIT
// How a recording's file is laid out: from what is known about the session to a header, and back.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "device/recordings/classic_netcdf.h"
#include "device/recordings/recording.h"

namespace wholehand {

constexpr const char* TICK_DIMENSION = "tick";
constexpr const char* TIME_VARIABLE = "time";

// The header, laid out, with room behind it for the end's attributes; and what its fixed variables hold, in the order of the file, from the
// first one's place on.
struct RecordingLayout {
  classic::Header header;
  std::string fixed;
};
RecordingLayout layout_recording(const RecordingInfo& info);

// Adds the end's attributes, among them how many records there are. The header stays within its room.
void add_end(classic::Header& header, const RecordingEnd& end);

// Both throw Error (usage), without the file's name, where something is missing, cannot be or is not what was written. `fixed_values` gives the
// bytes of a fixed variable.
using FixedValues = std::function<std::string(const classic::Variable&)>;
RecordingInfo recording_info(const classic::Header& header, const FixedValues& fixed_values);
std::optional<RecordingEnd> end_of(const classic::Header& header);

// The names of a variable's dimensions, in one line.
std::string dimension_names(const classic::Header& header, const classic::Variable& variable);

}  // namespace wholehand
