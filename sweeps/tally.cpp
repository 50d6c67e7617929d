// SPDX-License-Identifier: MIT
#include "sweeps/tally.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/result.h"
#include "shaders/status.h"
#include "sweeps/variables.h"
#include "system/readable.h"

namespace wholehand {

void count_grips(const PlaneChunk& chunk, const FieldSet& fields, GripCounts& counts) {
  counts.grips += chunk.count;
  if (!is_kept(fields, FIELD_STATUS)) return;
  const auto known = [&](int field, std::size_t i) {
    return is_kept(fields, field) ? chunk.real(fields.plane[field], i) : LeastBad::ENDLESS;
  };
  for (std::size_t i = 0; i < chunk.count; ++i) {
    const std::uint32_t status = chunk.uint(fields.plane[FIELD_STATUS], i);
    const std::uint32_t reason = status & STATUS_REASON_MASK;
    if (reason < counts.by_reason.size()) ++counts.by_reason[reason];
    if (reason != REASON_NONE) continue;
    if ((status & STATUS_PLAUSIBLE) == 0) {
      ++counts.implausible;
      counts.through_table += (status & STATUS_THROUGH_TABLE) != 0;
      counts.self_overlap += (status & STATUS_SELF_OVERLAP) != 0;
      counts.beyond_wrist += (status & STATUS_BEYOND_WRIST) != 0;
      counts.only_deep += (status & (STATUS_THROUGH_TABLE | STATUS_SELF_OVERLAP | STATUS_BEYOND_WRIST)) == 0;
    }
    counts.not_held += (status & STATUS_NOT_HELD) != 0;
    if (is_plausible(status) && is_kept(fields, FIELD_WORST_EFFORT)) {
      const LeastBad one{known(FIELD_WORST_EFFORT, i), known(FIELD_FRICTION_NEEDED, i), chunk.first + i};
      counts.least_bad = std::min(counts.least_bad, one);
    }
    counts.antipodal += (status & STATUS_ANTIPODAL) != 0;
    counts.blocked += ((status >> STATUS_BLOCKED_SHIFT) & 0x1F) != 0;
  }
}

namespace {

// " (200 through the table, 90 only too deep)"; empty where nothing is known of them.
std::string implausible_parts(const GripCounts& counts) {
  std::string parts;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", readable_number(count), what);
  };
  add(counts.through_table, "through the table");
  add(counts.self_overlap, "with fingers in each other");
  add(counts.beyond_wrist, "beyond the wrist");
  add(counts.only_deep, "only too deep");
  return parts.empty() ? "" : " (" + parts + ")";
}

}  // namespace

std::string counts_line(const GripCounts& counts, bool reasons_known, std::uint64_t azimuths) {
  const std::string at = azimuths > 1 ? fmt::format(" (each at {} azimuths)", readable_number(azimuths)) : "";
  if (!reasons_known) return counted(counts.grips, "grip") + at;
  std::string line = fmt::format("{} of {}{} feasible", readable_number(counts.by_reason[0]), counted(counts.grips, "grip"), at);
  std::string reasons;
  for (std::size_t reason = 1; reason < counts.by_reason.size(); ++reason) {
    if (counts.by_reason[reason] == 0) continue;
    std::string name = REASON_NAMES[reason];
    for (char& c : name) c = c == '_' ? ' ' : c;
    reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", readable_number(counts.by_reason[reason]), name);
  }
  if (!reasons.empty()) line += " (" + reasons + ")";
  if (counts.by_reason[0] == 0) return line;
  line += fmt::format("; of these {} implausible{}", readable_number(counts.implausible), implausible_parts(counts));
  if (counts.not_held > 0) line += fmt::format(", {} not held", readable_number(counts.not_held));
  line += fmt::format(", {} antipodal", readable_number(counts.antipodal));
  if (counts.blocked > 0) line += fmt::format(", {} with a blocked finger", readable_number(counts.blocked));
  return line;
}

}  // namespace wholehand
