// SPDX-License-Identifier: MIT
#include "core/effort.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/force.h"

namespace CORE_NS {

namespace {

constexpr Real NEVER = std::numeric_limits<Real>::infinity();
constexpr Real ROUNDING = EFFORT_ROUNDING;
constexpr Real LEAST_PIVOT =
    SINGLE ? Real(1e-4) : Real(1e-9);      // of the largest of its column; if there is none, of the sum of its row
constexpr int FRESH_PIVOTS = 50;           // pivots after which the inverse is recomputed
constexpr Real LEAST_LENGTH = Real(1e-3);  // m: for a single contact, which has no extent
// Largest cost of a basis in units of an artificial column of the load's size: the first one costs sqrt 6 of them, and pivots lower it. A higher cost
// is rounding, for example with a friction of 1e-200.
constexpr Real FIRST_COST = Real(3);
constexpr Real MOST_TOLERANCE = Real(0.1), WIDER = 4;          // of the widest acceptable bracket, and from try to try
constexpr Real UNBALANCED = SINGLE ? Real(1e-2) : Real(1e-9);  // of a load: forces that leave more of it unbalanced are no answer

template <class Six>
Real dot6(const Six& a, const Six& b) {
  Real sum = 0;
  for (std::size_t k = 0; k < 6; ++k) sum += a[k] * b[k];
  return sum;
}

Vec3 first(const std::array<Real, 6>& six) { return Vec3(six[0], six[1], six[2]); }
Vec3 second(const std::array<Real, 6>& six) { return Vec3(six[3], six[4], six[5]); }
std::array<Real, 6> stack(Vec3 a, Vec3 b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }

// How a contact moves along a direction (a, b), b times the unit of length:
//   v = a + b x p,  s = sqrt(|v - (n.v) n|^2 + gamma^2 (b.n)^2)
struct Slip {
  Vec3 velocity{}, across{};
  Real spin = 0, root = 0;
};

Slip slip_of(Vec3 arm, Vec3 normal, Real gamma, const std::array<Real, 6>& direction) {
  Slip slip;
  const Vec3 turning = second(direction);
  slip.velocity = first(direction) + glm::cross(turning, arm);
  slip.spin = gamma * glm::dot(turning, normal);
  // perpendicular to n even if it is tiny beside n.v
  slip.across = glm::cross(glm::cross(normal, slip.velocity), normal);
  slip.root = std::sqrt(glm::dot(slip.across, slip.across) + slip.spin * slip.spin);
  return slip;
}

}  // namespace

Wrench wrench_at(Vec3 place, Vec3 force) { return {force, glm::cross(place, force), place}; }

// h = n.v + mu s, attained with the tangential force mu t / s and the moment mu gamma^2 (b.n) / s.
Real press(Vec3 arm, Vec3 normal, Real friction, Real gamma, const std::array<Real, 6>& direction) {
  const Slip slip = slip_of(arm, normal, gamma, direction);
  return glm::dot(normal, slip.velocity) + friction * slip.root;
}

ContactForce pressing_force(Vec3 arm, Vec3 normal, Real friction, Real gamma, const std::array<Real, 6>& direction) {
  const Slip slip = slip_of(arm, normal, gamma, direction);
  const Real share = slip.root > 0 ? friction / slip.root : Real(0);
  return {normal + share * slip.across, share * gamma * slip.spin};
}

std::array<Real, 6> pressed(Vec3 arm, Vec3 normal, Real friction, Real gamma, const std::array<Real, 6>& direction) {
  const ContactForce unit = pressing_force(arm, normal, friction, gamma, direction);
  return stack(unit.force, glm::cross(arm, unit.force) + unit.torsion * normal);
}

EffortSolver::EffortSolver(std::span<const ContactPoint> contacts, const HandStrength& hand, Vec3 center)
    : contacts_(contacts), hand_(hand), center_(center) {
  // only digits that press count: the strength of the others changes nothing
  Real strongest = 0, weakest = NEVER;
  for (const ContactPoint& contact : contacts) {
    const Real strength = hand.digits[static_cast<std::size_t>(contact.digit)];
    strongest = std::max(strongest, strength);
    if (strength > 0) weakest = std::min(weakest, strength);
  }
  unit_force_ = strongest > 0 ? strongest : Real(1);
  dear_ = UNRESISTED_EFFORT * (strongest > 0 ? strongest / weakest : Real(1));
  unit_length_ = std::max(LEAST_LENGTH, hand.torsion);
  for (const ContactPoint& contact : contacts) unit_length_ = std::max(unit_length_, glm::distance(contact.place, center));
  const ContactPoint* other = nullptr;
  for (const ContactPoint& contact : contacts) {
    if (!contact.is_tip || hand.torsion > 0) continue;
    if (other && contact.place != other->place) {
      middle_ = (contact.place + other->place) / Real(2);
      line_ = glm::normalize(contact.place - other->place);
    }
    other = &contact;
  }
}

// The wrench that balances a load, in the solver's units. A lever that two tips alone cannot hold is lengthened to the unit, because rounding would
// hide a shorter one.
EffortSolver::Vec6 EffortSolver::wanted_for(const Wrench& load) const {
  Vec3 moment = load.moment - glm::cross(center_, load.force);
  if (!(hand_.torsion > 0)) {
    const Real turn = glm::dot(line_, load.moment - glm::cross(middle_, load.force)), force = glm::length(load.force);
    const bool counts = std::abs(turn) > force * longest_bare_lever(glm::distance(load.place, middle_));
    const Real least = contacts_.size() == 2 ? force * unit_length_ : Real(0);
    const Real kept = counts ? std::max(std::abs(turn), least) : Real(0);
    moment += ((turn > 0 ? kept : -kept) - turn) * line_;
  }
  return stack(-load.force / unit_force_, -moment / (unit_force_ * unit_length_));
}

Vec3 EffortSolver::arm(const ContactPoint& contact) const { return (contact.place - center_) / unit_length_; }

Real EffortSolver::gamma() const { return hand_.torsion / unit_length_; }

// The point of Z farthest along a direction: each digit presses with all of its strength at the contact with the largest support, if this is positive.
EffortSolver::Presses EffortSolver::presses(const Vec6& direction) const {
  Presses all;
  if (share_)  // a finger may have to press against the direction, so that another one may press along it
    for (Press& one : all) one.support = -NEVER;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    Press& best = all[static_cast<std::size_t>(contacts_[i].digit)];
    const Real value = press(arm(contacts_[i]), contacts_[i].normal, hand_.friction, gamma(), direction);
    if (!(value > best.support)) continue;
    best.support = value;
    best.contact = static_cast<int>(i);
  }
  for (std::size_t digit = 0; digit < DIGITS; ++digit)
    if (all[digit].support > 0) all[digit].force = hand_.digits[digit];
  if (share_) keep_share(all);
  return all;
}

// The bound is one linear inequality, sum of slope x force >= 0, beside a range for each finger's force. The changes that bring the forces into the
// bound at the least cost in support come first.
void EffortSolver::keep_share(Presses& all) const {
  struct Change {
    std::size_t digit = 0;
    Real slope = 0, cost = 0;  // the cost of a unit of the sum
  };
  std::array<Change, FINGERS - 1> changes;
  std::size_t count = 0;
  Real sum = 0;
  for (std::size_t digit = 1; digit < FINGERS; ++digit) {
    const Press& one = all[digit];
    if (one.contact < 0) continue;
    const Real share = static_cast<int>(digit) == share_->digit ? 1 - share_->share : -share_->share;
    const Real slope = share_->is_least ? share : -share;
    sum += slope * one.force;
    if (one.force > 0 ? slope < 0 : slope > 0) changes[count++] = {digit, slope, std::abs(one.support / slope)};
  }
  std::sort(changes.begin(), changes.begin() + count, [](const Change& a, const Change& b) { return a.cost < b.cost; });
  for (std::size_t k = 0; k < count && sum < 0; ++k) {
    Real& force = all[changes[k].digit].force;
    const Real step = std::min(hand_.digits[changes[k].digit], -sum / std::abs(changes[k].slope));
    force += changes[k].slope > 0 ? step : -step;
    sum += std::abs(changes[k].slope) * step;
  }
}

// h(u), and the point of Z that attains it.
Real EffortSolver::support(const Vec6& direction, Vec6& point) const {
  for (std::size_t k = 0; k < 6; ++k) point[k] = -displaced_[k];
  for (const Press& one : presses(direction)) {
    if (!(one.force > 0)) continue;
    const ContactPoint& contact = contacts_[static_cast<std::size_t>(one.contact)];
    const Vec6 wrench = pressed(arm(contact), contact.normal, hand_.friction, gamma(), direction);
    for (std::size_t k = 0; k < 6; ++k) point[k] += one.force / unit_force_ * wrench[k];
  }
  return dot6(direction, point);
}

// The largest factor F with w + F d in Z is one over the gauge of Z - w at d.
void EffortSolver::displace(const Wrench& alone) {
  displaced_ = wanted_for(alone);
  has_basis_ = false;
}

void EffortSolver::set_friction(Real friction) {
  if (friction < hand_.friction) has_basis_ = false;
  hand_.friction = friction;
}

void EffortSolver::set_share(const ShareBound& bound) {
  share_ = bound;
  has_basis_ = false;
}

EffortSolver::Reach EffortSolver::reach(const Vec6& direction, Real friction) const {
  std::array<Reach, DIGITS> most{};
  for (const ContactPoint& contact : contacts_) {
    Reach& best = most[static_cast<std::size_t>(contact.digit)];
    const Real along = press(arm(contact), contact.normal, 0, gamma(), direction);
    const Real slope = press(arm(contact), contact.normal, 1, gamma(), direction) - along;
    const Real height = along + friction * slope;
    if (height > best.height) best = {height, slope};
  }
  Reach sum;
  for (std::size_t digit = 0; digit < DIGITS; ++digit) {
    sum.height += hand_.digits[digit] / unit_force_ * most[digit].height;
    sum.slope += hand_.digits[digit] / unit_force_ * most[digit].slope;
  }
  return sum;
}

// h(u) is convex and piecewise linear in the friction. From below, the first step of Newton's method leads beyond the root; from above, its steps
// descend to the root and end there.
Real EffortSolver::least_friction(const Wrench& load, Real most) const {
  const Real value = dot6(cut_, wanted_for(load));
  Real friction = hand_.friction;
  Reach now = reach(cut_, friction);
  if (now.height < value) {
    friction = now.slope > 0 ? std::min(most, friction + (value - now.height) / now.slope) : most;
    now = reach(cut_, friction);
    if (now.height < value && friction == most) return NEVER;
  }
  while (now.height > value && now.slope > 0) {
    const Real next = std::max(Real(0), friction - (now.height - value) / now.slope);
    if (!(next < friction)) break;
    friction = next;
    now = reach(cut_, friction);
  }
  return friction;
}

EffortSolver::Vec6 EffortSolver::levels(const Vec6& wanted) const {
  Vec6 levels{};
  for (std::size_t r = 0; r < 6; ++r) levels[r] = dot6(inverse_[r], wanted);
  return levels;
}

// Six artificial columns, which no contact carries, at right angles and with equal shares of `wanted`, because a basis with a level of 0 would be
// degenerate from the start. They are the columns of the reflection that takes (1, .., 1) / sqrt 6 to the unit vector along `wanted`.
void EffortSolver::begin(const Vec6& wanted) {
  const Real size = std::sqrt(dot6(wanted, wanted));
  Vec6 mirror{};
  Real square = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    mirror[k] = wanted[k] / size - std::sqrt(Real(1) / 6);
    square += mirror[k] * mirror[k];
  }
  for (std::size_t r = 0; r < 6; ++r) {
    for (std::size_t k = 0; k < 6; ++k) {
      const Real reflected = square > 0 ? 2 * mirror[r] * mirror[k] / square : Real(0);
      columns_[r].point[k] = (r == k ? Real(1) : Real(0)) - reflected;
    }
    columns_[r].is_artificial = true;
    inverse_[r] = columns_[r].point;  // the reflection is its own inverse
  }
  has_basis_ = true;
}

// The last basis for another load: a column whose level would be negative is replaced by an opposite artificial one of unit length.
void EffortSolver::restart(const Vec6& wanted) {
  const Vec6 now = levels(wanted);
  const Real rounding = ROUNDING * std::sqrt(dot6(wanted, wanted));
  for (std::size_t r = 0; r < 6; ++r) {
    if (!(now[r] < -rounding)) continue;
    const Real length = std::sqrt(dot6(columns_[r].point, columns_[r].point));
    for (Real& value : columns_[r].point) value /= -length;
    for (Real& value : inverse_[r]) value *= -length;
    columns_[r].is_artificial = true;
  }
}

// The column replaces the one whose level first reaches zero; in a tie, an artificial one. An artificial column that carries nothing leaves before
// any other, because it might carry something afterwards. False: there is none.
bool EffortSolver::enter(const Column& column, const Vec6& wanted) {
  const Vec6 turned = levels(column.point), now = levels(wanted);
  const Real rounding = ROUNDING * std::sqrt(dot6(wanted, wanted));
  Real largest = 0;
  for (const Real value : turned) largest = std::max(largest, std::abs(value));
  const auto is_idle = [&](std::size_t r, Real scale) {
    return columns_[r].is_artificial && now[r] <= rounding && turned[r] < -LEAST_PIVOT * scale;
  };
  const auto may_leave = [&](std::size_t r, Real scale) { return is_idle(r, scale) || turned[r] > LEAST_PIVOT * scale; };
  Vec6 scales{};
  scales.fill(largest);
  bool has_pivot = false;
  for (std::size_t r = 0; r < 6; ++r) has_pivot = has_pivot || may_leave(r, largest);
  if (!has_pivot) {  // a pivot that is small beside the others of its column still counts if it is large beside its own rounding
    scales.fill(0);
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t k = 0; k < 6; ++k) scales[r] += std::abs(inverse_[r][k] * column.point[k]);
  }
  std::size_t leaves = 6;
  Real least = NEVER;
  for (std::size_t r = 0; r < 6; ++r) {
    if (!may_leave(r, scales[r])) continue;
    const Real ratio = is_idle(r, scales[r]) ? Real(0) : std::max(Real(0), now[r]) / turned[r];
    const bool is_tie = leaves < 6 && std::abs(ratio - least) <= ROUNDING * least;
    const bool is_better = leaves < 6 && (columns_[r].is_artificial != columns_[leaves].is_artificial
                                              ? columns_[r].is_artificial
                                              : std::abs(turned[r]) > std::abs(turned[leaves]));
    if (is_tie ? is_better : ratio < least) {
      leaves = r;
      least = ratio;
    }
  }
  if (leaves == 6) return false;
  const Real pivot = turned[leaves];
  for (Real& value : inverse_[leaves]) value /= pivot;
  for (std::size_t r = 0; r < 6; ++r) {
    if (r == leaves) continue;
    for (std::size_t k = 0; k < 6; ++k) inverse_[r][k] -= turned[r] * inverse_[leaves][k];
  }
  columns_[leaves] = column;
  return true;
}

// Recomputes the inverse from the columns, by elimination with row pivots, because rank-one updates accumulate rounding. False: it is singular.
bool EffortSolver::invert() {
  std::array<std::array<Real, 12>, 6> rows{};
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t k = 0; k < 6; ++k) {
      rows[r][k] = columns_[k].point[r];
      rows[r][6 + k] = r == k ? Real(1) : Real(0);
    }
  for (std::size_t c = 0; c < 6; ++c) {
    std::size_t best = c;
    for (std::size_t r = c + 1; r < 6; ++r)
      if (std::abs(rows[r][c]) > std::abs(rows[best][c])) best = r;
    if (!(std::abs(rows[best][c]) > 0)) return false;
    std::swap(rows[c], rows[best]);
    const Real pivot = rows[c][c];
    for (Real& value : rows[c]) value /= pivot;
    for (std::size_t r = 0; r < 6; ++r) {
      if (r == c) continue;
      const Real factor = rows[r][c];
      for (std::size_t k = 0; k < 12; ++k) rows[r][k] -= factor * rows[c][k];
    }
  }
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t k = 0; k < 6; ++k) inverse_[r][k] = rows[r][6 + k];
  return true;
}

// Cost of the levels, and the part of them that no contact carries.
EffortSolver::Cost EffortSolver::cost_of(const Vec6& levels) const {
  Cost cost;
  for (std::size_t r = 0; r < 6; ++r) {
    const Real level = std::max(Real(0), levels[r]);
    (columns_[r].is_artificial ? cost.artificial : cost.real) += level;
    cost.least = std::min(cost.least, levels[r]);
  }
  return cost;
}

Real EffortSolver::bound(const Wrench& load) const {
  if (!has_basis_) return NEVER;
  const Vec6 wanted = wanted_for(load);
  const Real rounding = ROUNDING * std::sqrt(dot6(wanted, wanted));
  const Cost cost = cost_of(levels(wanted));
  return cost.least < -rounding || cost.artificial > rounding ? NEVER : cost.real;
}

// Length of a wrench's part that the last levels leave unbalanced; levels below zero count as 0.
Real EffortSolver::unbalanced(const Vec6& wanted) const {
  Vec6 rest = wanted;
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t k = 0; k < 6; ++k) rest[k] -= std::max(Real(0), last_[r]) * columns_[r].point[k];
  return std::sqrt(dot6(rest, rest));
}

// The basis's prices for a wrench: u = costs times inverse. While artificial columns carry something, costs are 1 for them and 0 for the others;
// after that the reverse. One large cost for the artificial columns would cost u as many digits.
EffortSolver::Column EffortSolver::priced(bool is_short) const {
  Column column;
  for (std::size_t r = 0; r < 6; ++r) {
    if (columns_[r].is_artificial != is_short) continue;
    for (std::size_t k = 0; k < 6; ++k) column.direction[k] += inverse_[r][k];
  }
  return column;
}

Effort EffortSolver::solve(const Wrench& load, Real tolerance, Real enough, Real too_much) {
  return search(load, tolerance, enough, too_much, EFFORT_PIVOTS);
}

// (-w).u / h(u) is a lower bound of the effort for any u, and the levels' sum an upper one once no artificial column carries anything. A point of Z
// with a higher price than the columns of the basis enters.
void EffortSolver::narrow(Search& now) {
  Effort& answer = now.answer;
  bool is_fresh = false;  // the inverse
  for (;; ++answer.pivots) {
    if (answer.pivots % FRESH_PIVOTS == FRESH_PIVOTS - 1 && !invert()) break;
    const Cost cost = cost_of(levels(now.wanted));
    const bool is_short = cost.artificial > ROUNDING * now.size;
    if (!is_short && cost.least >= -ROUNDING * cost.real) now.balanced = columns_;
    Column column = priced(is_short);
    const Real height = support(column.direction, column.point), value = dot6(column.direction, now.wanted);
    if (value > 0 && value > answer.low * height) {
      answer.low = height > 0 ? value / height : NEVER;
      now.best = column.direction;
      cut_ = now.best;
      cut_height_ = height;
    }
    if (answer.low > dear_ * now.size) answer.low = NEVER;
    if (!std::isfinite(answer.low)) break;
    if (!is_short && (cost.real <= now.enough || cost.real - answer.low <= now.tolerance * cost.real)) break;
    now.is_beyond = answer.low > now.too_much;
    if (now.is_beyond || answer.pivots == now.most_pivots) break;
    if (height > (is_short ? Real(0) : Real(1)) && enter(column, now.wanted)) {
      is_fresh = false;
    } else if (is_fresh || !invert()) {  // the end of the search may be due to accumulated rounding of the inverse
      break;
    } else {
      is_fresh = true;
    }
  }
}

// Takes the effort of the basis as the answer if its forces balance the load, and returns whether they do. `is_certain`: no force resists the load.
bool EffortSolver::answer_with_basis(Search& now, bool& is_certain) {
  if (!invert()) return false;
  last_ = levels(now.wanted);
  Vec6 rest = now.wanted;  // what rounding of the inverse leaves unbalanced, where columns are nearly parallel
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t k = 0; k < 6; ++k) rest[k] -= last_[r] * columns_[r].point[k];
  const Vec6 more = levels(rest);
  for (std::size_t r = 0; r < 6; ++r) last_[r] += more[r];
  const Cost cost = cost_of(last_);
  const bool is_carried = cost.artificial <= ROUNDING * now.size, is_dear = cost.real > FIRST_COST * dear_ * now.size;
  // Artificial columns carry only rounding here; otherwise the direction of an unresisted load would have shown it.
  is_certain = is_carried && is_dear;
  if (!is_carried || is_dear || !(unbalanced(now.wanted) <= UNBALANCED * now.size)) return false;
  now.answer.effort = cost.real;
  now.answer.low = std::min(now.answer.low, now.answer.effort);
  return true;
}

Effort EffortSolver::search(const Wrench& load, Real tolerance, Real enough, Real too_much, int most_pivots) {
  last_ = {};
  Search now{
      .wanted = wanted_for(load), .tolerance = tolerance, .enough = enough, .too_much = too_much, .most_pivots = most_pivots};
  Effort& answer = now.answer;
  const Real square = dot6(now.wanted, now.wanted);
  now.size = std::sqrt(square);
  if (!(square >= std::numeric_limits<Real>::min())) {
    has_basis_ = false;
    return answer;
  }
  const bool is_warm = has_basis_;
  if (is_warm) {
    restart(now.wanted);
  } else {
    begin(now.wanted);
  }
  narrow(now);
  bool is_certain = !std::isfinite(answer.low);
  if (!is_certain && answer_with_basis(now, is_certain)) return answer;
  // If the digits' strengths are far apart, or columns nearly parallel, the columns of the last part of the tolerance may leave forces that do not
  // balance. All tries together take no more pivots than one may. The last try answers with the previous ones.
  const bool is_last_try = !is_warm && (answer.pivots >= most_pivots || tolerance >= MOST_TOLERANCE);
  if (!is_certain && is_last_try && now.balanced) {
    columns_ = *now.balanced;
    if (answer_with_basis(now, is_certain)) return answer;
  }
  answer.effort = NEVER;
  if (now.is_beyond) return answer;
  has_basis_ = false;
  if (is_warm || !(is_certain || is_last_try)) {
    // A basis of another load may end in a corner; only a search from the start proves that nothing holds. A wider tolerance ends a search that
    // rounding keeps from ending.
    Effort other = is_warm ? search(load, tolerance, enough, too_much, EFFORT_PIVOTS)
                           : search(load, WIDER * tolerance, enough, too_much, most_pivots - answer.pivots);
    other.pivots += answer.pivots;
    return other;
  }
  if (is_certain) answer.low = NEVER;
  const Real largest = std::max(glm::length(first(now.best)), glm::length(second(now.best)));
  answer.escape = stack(-first(now.best) / largest, -second(now.best) / (largest * unit_length_));
  return answer;
}

// Subtracts the rounding of the product: for a direction with a tiny support that no contact opposes, it could produce any bound.
Real EffortSolver::low(const Wrench& load) const {
  const Vec6 wanted = wanted_for(load);
  const Real value = dot6(cut_, wanted) - ROUNDING * std::sqrt(dot6(cut_, cut_) * dot6(wanted, wanted));
  if (!(value > 0)) return 0;
  return cut_height_ > 0 ? value / cut_height_ : NEVER;
}

void EffortSolver::forces(std::span<ContactForce> forces) const {
  for (ContactForce& force : forces) force = {};
  if (!has_basis_) return;
  for (std::size_t r = 0; r < 6; ++r) {
    if (columns_[r].is_artificial || !(last_[r] > 0)) continue;
    for (const Press& one : presses(columns_[r].direction)) {
      if (!(one.force > 0)) continue;
      const auto at = static_cast<std::size_t>(one.contact);
      const ContactPoint& contact = contacts_[at];
      const ContactForce unit = pressing_force(arm(contact), contact.normal, hand_.friction, gamma(), columns_[r].direction);
      const Real size = last_[r] * one.force;
      forces[at].force += size * unit.force;
      forces[at].torsion += size * (unit.torsion * unit_length_);
    }
  }
}

}  // namespace CORE_NS
