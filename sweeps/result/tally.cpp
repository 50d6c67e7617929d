// SPDX-License-Identifier: MIT
#include "sweeps/result/tally.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/readable.h"
#include "core/result.h"
#include "core/tolerances.h"
#include "shaders/status.h"
#include "sweeps/plan/variables.h"

namespace wholehand::sweeps {

void count_grips(const PlaneChunk& chunk, const FieldSet& fields, double gate, GripCounts& counts) {
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
    counts.unjudged += (status & STATUS_UNJUDGED) != 0;
    if (is_judged(status) && is_kept(fields, FIELD_WORST_EFFORT)) {
      const LeastBad one{known(FIELD_WORST_EFFORT, i), known(FIELD_FRICTION_NEEDED, i), chunk.first + i};
      counts.least_bad = std::min(counts.least_bad, one);
      counts.at_gate += is_at_gate(one.effort, gate);
    }
    counts.antipodal += (status & STATUS_ANTIPODAL) != 0;
    counts.blocked += ((status >> STATUS_BLOCKED_SHIFT) & 0x1F) != 0;
  }
}

namespace {

constexpr const char* UNJUDGED = "not judged (out of reach of the list)";

// Parts of a line that count something, with commas between.
class Counted {
 public:
  void add(std::uint64_t count, const std::string& what) {
    if (count > 0) text_ += fmt::format("{}{} {}", text_.empty() ? "" : ", ", readable_number(count), what);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void add_reasons(const GripCounts& counts, Counted& parts) {
  for (std::size_t reason = 1; reason < counts.by_reason.size(); ++reason) {
    std::string name = REASON_NAMES[reason];
    for (char& c : name) c = c == '_' ? ' ' : c;
    parts.add(counts.by_reason[reason], name);
  }
}

std::string all_grips(const GripCounts& counts, std::uint64_t azimuths) {
  return counted(counts.grips, "grip") + (azimuths > 1 ? fmt::format(" (each at {} azimuths)", readable_number(azimuths)) : "");
}

}  // namespace

std::string counts_line(const GripCounts& counts, bool reasons_known, std::uint64_t azimuths) {
  if (!reasons_known) return all_grips(counts, azimuths);
  Counted reasons, parts;
  add_reasons(counts, reasons);
  std::string line = fmt::format("{} of {} feasible", readable_number(counts.by_reason[0]), all_grips(counts, azimuths));
  if (!reasons.text().empty()) line += " (" + reasons.text() + ")";
  if (counts.by_reason[0] == 0) return line;
  parts.add(counts.through_table, "through the table");
  parts.add(counts.self_overlap, "with fingers in each other");
  parts.add(counts.beyond_wrist, "beyond the wrist");
  parts.add(counts.only_deep, "only too deep");
  line += fmt::format("; of these {} implausible{}", readable_number(counts.implausible),
                      parts.text().empty() ? "" : " (" + parts.text() + ")");
  if (counts.not_held > 0) line += fmt::format(", {} not held", readable_number(counts.not_held));
  if (counts.unjudged > 0) line += fmt::format(", {} {}", readable_number(counts.unjudged), UNJUDGED);
  line += fmt::format(", {} antipodal", readable_number(counts.antipodal));
  if (counts.blocked > 0) line += fmt::format(", {} with a blocked finger", readable_number(counts.blocked));
  return line;
}

std::string short_counts_line(const GripCounts& counts, bool reasons_known, std::uint64_t azimuths, bool judges_holding) {
  if (!reasons_known) return all_grips(counts, azimuths);
  Counted parts;
  parts.add(counts.not_held, "not held");
  parts.add(counts.unjudged, UNJUDGED);
  parts.add(counts.through_table, "through the table");
  parts.add(counts.self_overlap, "with fingers in each other");
  parts.add(counts.beyond_wrist, "beyond the wrist");
  parts.add(counts.only_deep, "too deep");
  add_reasons(counts, parts);
  return fmt::format("{} of {} {}{}{}", readable_number(counts.plausible() - counts.not_held - counts.unjudged),
                     all_grips(counts, azimuths),
                     judges_holding ? counts.unjudged > 0 ? "are judged and hold" : "hold" : "are plausible",
                     parts.text().empty() ? "" : "; ", parts.text());
}

}  // namespace wholehand::sweeps
