// SPDX-License-Identifier: MIT
#include "core/prepare.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text/error.h"
#include "core/hand.h"
#include "core/lattice.h"
#include "core/load.h"
#include "core/mesh_body.h"
#include "core/supports.h"

namespace wholehand {
namespace {

double angle_of(const std::array<double, 2>& p, const std::array<double, 2>& center) {
  return std::atan2(p[1] - center[1], p[0] - center[0]);
}

// An arc from a to b about center, the shorter way, split where it passes the top or the bottom of its circle.
void append_arc(std::vector<PreparedElement>& elements, std::array<double, 2> a, std::array<double, 2> b,
                std::array<double, 2> center) {
  const double radius = std::hypot(a[0] - center[0], a[1] - center[1]);
  const double from = angle_of(a, center);
  double sweep = std::remainder(angle_of(b, center) - from, 2 * PI);
  if (PI - std::abs(sweep) < 1e-9) {  // two equal ways: the one further from the axis
    sweep = std::cos(from + PI / 2) > 0 ? PI : -PI;
  }
  std::vector<double> poles;
  for (int k = -3; k <= 3; k += 1) {
    const double pole = PI / 2 + k * PI;
    const double along = (pole - from) / sweep;
    if (along > 1e-12 && along < 1 - 1e-12) poles.push_back(along);
  }
  std::sort(poles.begin(), poles.end());
  poles.push_back(1);
  double begin = 0;
  std::array<double, 2> start = a;
  for (const double end : poles) {
    const double middle = from + sweep * 0.5 * (begin + end);
    PreparedElement piece;
    piece.a = start;
    if (end == 1) {
      piece.b = b;
    } else {
      const double sign = std::sin(from + sweep * end) > 0 ? 1 : -1;
      piece.b = {center[0], center[1] + sign * radius};
    }
    piece.center = center;
    piece.radius = radius;
    piece.side = std::cos(middle) >= 0 ? 1 : -1;
    elements.push_back(piece);
    start = piece.b;
    begin = end;
  }
}

PreparedElement line(std::array<double, 2> a, std::array<double, 2> b) {
  PreparedElement element;
  element.a = a;
  element.b = b;
  const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
  element.center = {(b[1] - a[1]) / length, (a[0] - b[0]) / length};
  return element;
}

// Outer outline, rim, and the inner wall back down to the axis.
std::vector<PreparedElement> shell_outline(const std::vector<PreparedElement>& hull, const std::vector<PreparedElement>& cavity) {
  std::vector<PreparedElement> outline(hull.begin(), hull.end() - 1);
  std::array<double, 2> at = hull.back().a;
  const auto go_to = [&](std::array<double, 2> next) {
    if (std::abs(next[0] - at[0]) > 1e-12 || std::abs(next[1] - at[1]) > 1e-12) outline.push_back(line(at, next));
  };
  for (auto piece = cavity.rbegin(); piece != cavity.rend(); ++piece) {
    go_to(piece->b);
    PreparedElement reversed = *piece;
    if (piece->side == 0) {
      reversed = line(piece->b, piece->a);
    } else {
      std::swap(reversed.a, reversed.b);
    }
    outline.push_back(reversed);
    at = piece->a;
  }
  go_to({0, cavity.front().a[1]});
  return outline;
}

// The sphere about an arc is that of its whole circle: a bound may be wide, and changing it would change results' bits.
void set_bounds(PreparedVessel& prepared) {
  double low = 0, high = 0, widest = 0;
  for (const auto& e : prepared.hull) {
    for (const auto& end : {e.a, e.b}) {
      low = std::min(low, end[1]);
      high = std::max(high, end[1]);
      widest = std::max(widest, end[0]);
    }
    if (e.side > 0) widest = std::max(widest, e.center[0] + e.radius);
    prepared.largest_radius = std::max(prepared.largest_radius, widest_on(e));
  }
  prepared.bound_height = 0.5 * (low + high);
  prepared.bound_radius = std::hypot(widest, 0.5 * (high - low));
}

PreparedVessel prepare_mesh(const VesselData& vessel, bool needs_cavity) {
  if (!vessel.mesh->body) throw failure_error("vessel '" + vessel.name + "': its mesh has not been read");
  const MeshBody& body = *vessel.mesh->body;
  PreparedVessel prepared;
  prepared.mouth_height = vessel.height;
  if (needs_cavity) {
    prepared.cavity = prepare_cavity(vessel);
    prepared.floor_height = prepared.cavity.front().a[1];
    prepared.mouth_height = prepared.cavity.back().b[1];
    prepared.mouth_radius = prepared.cavity.back().b[0];
  }
  prepared.bound_height = 0.5 * (body.facts.low[1] + body.facts.high[1]);
  for (const Triple& p : body.vertices) {
    const double across = std::hypot(p[0], p[2]);
    prepared.largest_radius = std::max(prepared.largest_radius, across);
    prepared.bound_radius = std::max(prepared.bound_radius, std::hypot(across, p[1] - prepared.bound_height));
  }
  return prepared;
}

Triple rotate_x(double angle, const Triple& v) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {v[0], c * v[1] - s * v[2], s * v[1] + c * v[2]};
}

Triple rotate_y(double angle, const Triple& v) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v[0] + s * v[2], v[1], -s * v[0] + c * v[2]};
}

// Frames, lengths and angles: all but the gap.
PreparedHand prepare_fingers(const HandData& hand) {
  PreparedHand prepared;
  for (int f = 0; f < FINGER_COUNT; ++f) {
    const FingerData& finger = hand.fingers[f];
    auto& out = prepared.fingers[f];
    out.base = finger.base;
    out.length = finger.segments;
    out.radius = finger.radii;
    // thumb: Ry(splay), its abduction is part of the chain's angle; fingers: Ry(-splay) Rx(-arch)
    const double turn = f == 0 ? finger.splay : -finger.splay;
    const double arch = f == 0 ? 0 : -finger.arch;
    out.forward = rotate_y(turn, rotate_x(arch, {0, 0, -1}));
    out.palmward = rotate_y(turn, rotate_x(arch, {0, -1, 0}));
  }
  const auto swing = [](const AngleRange& range) { return range.closed - range.open; };
  prepared.thumb_open = {hand.thumb_abduction.open, hand.thumb_mcp.open, hand.thumb_ip.open};
  prepared.thumb_swing = {swing(hand.thumb_abduction), swing(hand.thumb_mcp), swing(hand.thumb_ip)};
  prepared.finger_open = {hand.mcp.open, hand.pip.open, hand.dip_per_pip * hand.pip.open};
  prepared.finger_swing = {swing(hand.mcp), swing(hand.pip), hand.dip_per_pip * swing(hand.pip)};
  return prepared;
}

constexpr int GAP_CHECKS = 1024;

double checked_gap(const core_f64::Hand& hand, int check) {
  return core_f64::gap_at(hand, static_cast<double>(check) / GAP_CHECKS);
}

// The first check at which the gap is not below the one before; one past the last where it falls all the way.
int gap_turns_at(const core_f64::Hand& hand) {
  double previous = checked_gap(hand, 0);
  for (int check = 1; check <= GAP_CHECKS; ++check) {
    const double gap = checked_gap(hand, check);
    if (!(gap < previous)) return check;
    previous = gap;
  }
  return GAP_CHECKS + 1;
}

// Makes closure_of_gap start its search at this place of the trajectory.
void solve_from(core_f64::Hand& hand, double closure, double gap) {
  hand.gap_open = gap;
  hand.gap_table = {closure, 1};
  hand.limits.gap_steps = 100;
}

// The closure of a gap to the last bit, by bisection: the gap is monotone. Where the solved closure is as near as expected it decides most halves,
// which changes no bit and is three times as fast.
double bisected_closure(const core_f64::Hand& hand, double gap) {
  constexpr double SOLVED = 1e-15;  // m: some roundings of a gap
  constexpr double NEAR = 1e-13;    // of a closure
  const double solved = core_f64::closure_of_gap(hand, gap, SOLVED), before = solved - NEAR, beyond = solved + NEAR;
  const bool is_near = before > 0 && beyond < 1 && core_f64::gap_at(hand, before) > gap && core_f64::gap_at(hand, beyond) < gap;
  double low = 0, high = 1;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    const bool is_before = is_near && middle < before   ? true
                           : is_near && middle > beyond ? false
                                                        : core_f64::gap_at(hand, middle) > gap;
    (is_before ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<PreparedElement> monotone_elements(const std::vector<OutlineElement>& outline) {
  std::vector<PreparedElement> elements;
  std::array<double, 2> at{0, 0};
  for (const auto& element : outline) {
    if (element.is_arc) {
      append_arc(elements, at, element.end, element.center);
    } else {
      elements.push_back(line(at, element.end));
    }
    at = element.end;
  }
  return elements;
}

std::vector<PreparedElement> inner_cavity(const std::vector<OutlineElement>& inner) {
  std::vector<PreparedElement> cavity = monotone_elements(inner);
  cavity.erase(cavity.begin());  // up the axis to the floor
  std::erase_if(cavity, [](const PreparedElement& e) { return e.a[1] == e.b[1]; });
  return cavity;
}

std::vector<PreparedElement> prepare_cavity(const VesselData& vessel) {
  if (!vessel.inner.empty()) return inner_cavity(vessel.inner);
  return inner_offset(monotone_elements(vessel.outline), vessel.wall, vessel);
}

PreparedVessel prepare_vessel(const VesselData& vessel, bool needs_cavity) {
  if (vessel.mesh) return prepare_mesh(vessel, needs_cavity);
  PreparedVessel prepared;
  prepared.hull = monotone_elements(vessel.outline);
  prepared.mouth_height = prepared.hull.back().a[1];
  if (needs_cavity) {
    prepared.cavity = prepare_cavity(vessel);
    prepared.floor_height = prepared.cavity.front().a[1];
    prepared.mouth_radius = prepared.cavity.back().b[0];
  }
  if (vessel.surface == Surface::shell) {
    prepared.outline = shell_outline(prepared.hull, prepared.cavity);
  } else {
    prepared.outline = prepared.hull;
    prepared.lid = static_cast<int>(prepared.hull.size()) - 1;
  }
  mark_supports(prepared.outline);
  set_bounds(prepared);
  return prepared;
}

PreparedHand prepare_hand(const HandData& hand, int gap_entries) {
  PreparedHand prepared = prepare_fingers(hand);
  core_f64::Hand kernel_hand = core_f64::load_hand(prepared, hand);
  if (const int turn = gap_turns_at(kernel_hand); turn <= GAP_CHECKS) {
    char closure_text[32];
    std::snprintf(closure_text, sizeof closure_text, "%.4f", static_cast<double>(turn - 1) / GAP_CHECKS);
    throw usage_error(at_place(
        hand.place, "[hand]: the gap between thumb and index tip must fall strictly as the hand closes; it turns at closure " +
                        std::string(closure_text) + " (" + std::to_string(checked_gap(kernel_hand, turn - 1) * 1e3) +
                        " mm); change the angles or segments"));
  }
  prepared.gap_open = checked_gap(kernel_hand, 0);
  prepared.gap_closed = checked_gap(kernel_hand, GAP_CHECKS);
  // closure at equal steps of the gap
  kernel_hand.gap_closed = prepared.gap_closed;
  solve_from(kernel_hand, 0, prepared.gap_open);
  for (int k = 0; k < gap_entries; ++k) {
    const double gap = prepared.gap_open + (prepared.gap_closed - prepared.gap_open) * k / (gap_entries - 1);
    prepared.gap_table.push_back(k == 0 ? 0 : k == gap_entries - 1 ? 1 : bisected_closure(kernel_hand, gap));
    if (k < gap_entries - 1) solve_from(kernel_hand, prepared.gap_table.back(), gap);
  }
  return prepared;
}

double gap_falls_until(const HandData& hand) {
  const int turn = gap_turns_at(core_f64::load_hand(prepare_fingers(hand), hand));
  // the least gap lies within a check on either side of the last one that fell
  return turn > GAP_CHECKS ? 1 : static_cast<double>(std::max(0, turn - 2)) / GAP_CHECKS;
}

PreparedLattice prepare_lattice(const PreparedVessel& prepared, int samples, bool halves, double margin) {
  core_f64::Vessel vessel;
  double widest = 0, low = 0, high = 0;
  for (const PreparedElement& e : prepared.outline) {
    vessel.outline.push_back(core_f64::load_element(e));
    widest = std::max({widest, e.a[0], e.b[0], e.side > 0 ? e.center[0] + e.radius : 0.0});
    low = std::min({low, e.a[1], e.b[1]});
    high = std::max({high, e.a[1], e.b[1]});
  }
  widest += margin;
  low -= margin;
  high += margin;
  PreparedLattice lattice;
  lattice.halves = halves;
  lattice.spacing = std::max(2 * widest, high - low) / (samples - 5);
  const auto count = [&](double length) { return static_cast<int>(std::ceil(length / lattice.spacing)) + 5; };
  lattice.nx = lattice.nz = count(2 * widest);
  lattice.ny = count(high - low);
  lattice.origin = {-widest - 2 * lattice.spacing, low - 2 * lattice.spacing, -widest - 2 * lattice.spacing};
  const std::size_t plane = static_cast<std::size_t>(lattice.nx) * lattice.ny, all = plane * lattice.nz;
  std::vector<std::uint32_t> words(lattice_words(all, halves));
  const auto store = [&](std::size_t at, float value) { words[word_index(at, halves)] |= sample_bits(value, at, halves); };
  const auto at_place = [&](int axis, int i) { return lattice.origin[axis] + lattice.spacing * i; };
  for (int k = 0; k < lattice.nz; ++k)
    for (int j = 0; j < lattice.ny; ++j)
      for (int i = 0; i <= k; ++i) {
        // a body of revolution, and so its lattice, is its own mirror image under exchange of x and z
        const double x = at_place(0, i), z = at_place(2, k);
        const float value = static_cast<float>(core_f64::profile_distance(vessel, {std::sqrt(x * x + z * z), at_place(1, j)}));
        store(k * plane + static_cast<std::size_t>(j) * lattice.nx + i, value);
        if (i != k) store(i * plane + static_cast<std::size_t>(j) * lattice.nx + k, value);
      }
  lattice.words = std::make_shared<const std::vector<std::uint32_t>>(std::move(words));
  return lattice;
}

double widest_on(const PreparedElement& element) {
  const double low = std::min(element.a[1], element.b[1]), high = std::max(element.a[1], element.b[1]);
  const bool is_widest_between = element.side > 0 && element.center[1] > low && element.center[1] < high;
  return std::max({element.a[0], element.b[0], is_widest_between ? element.center[0] + element.radius : 0.0});
}

double lattice_margin(const Scene& scene) {
  double radius = 0, scale = 0;
  for (const FingerData& finger : scene.hand.fingers)
    radius = std::max(radius, *std::max_element(finger.radii.begin(), finger.radii.end()));
  for (const double value : scene.grips.hand_scale.values) scale = std::max(scale, value);
  if (scene.robust) scale *= 1 + FURTHEST_DEVIATION * scene.robust->hand_scale;
  return scene.hand.scale * scale * radius + LATTICE_BAND;
}

// Newton on the Legendre polynomial from the usual cosine start.
PreparedQuadrature prepare_quadrature(int points) {
  PreparedQuadrature rule;
  for (int i = 0; i < points; ++i) {
    double x = std::cos(PI * (i + 0.75) / (points + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) {
      double p = 1, before = 0;
      for (int n = 1; n <= points; ++n) {
        const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
        before = p;
        p = next;
      }
      slope = points * (x * p - before) / (x * x - 1);
      const double move = p / slope;
      x -= move;
      if (std::abs(move) < 1e-16) break;
    }
    const double theta = 0.5 * PI * (1 + x);
    rule.cosine.push_back(std::cos(theta));
    rule.weight.push_back(2 / ((1 - x * x) * slope * slope) * std::sin(theta) * 0.5 * PI);
  }
  return rule;
}

}  // namespace wholehand
