// SPDX-License-Identifier: MIT
// sanitizers: none
// Kernel 10 against linear programs by CLP: every friction cone replaced by a polyhedral one inside of it, and by one around it.
// Fewer or more of them: WHOLEHAND_EFFORT_SETS of the environment.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <coin/ClpSimplex.hpp>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "core/effort.h"
#include "tests/support/contact_sets.h"
#include "tests/support/expect_forces.h"
#include "tests/support/special_values.h"

namespace wholehand {
namespace {

using core_f64::DIGITS;
using core_f64::EffortSolver;
using core_f64::Vec3;

// ---- what stands for the cone's section, a unit ball of (tangential force / mu N, moment / mu gamma N) ----

struct Section {
  std::vector<Vec3> corners;  // on the ball
  double inside = 1;          // the radius of the largest ball inside of the corners' hull
};

using Face = std::array<Vec3, 3>;

// A regular 64-gon: the ball inside has the radius cos(pi / 64) = 0.9988.
Section polygon() {
  constexpr int SIDES = 64;
  Section section;
  for (int k = 0; k < SIDES; ++k) section.corners.emplace_back(std::cos(2 * PI * k / SIDES), std::sin(2 * PI * k / SIDES), 0);
  section.inside = std::cos(PI / SIDES);
  return section;
}

// Golden rectangles have the corners of an icosahedron. Three corners at the least distance from each other are a face.
std::vector<Face> icosahedron() {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> corners;
  for (const double one : {-1.0, 1.0})
    for (const double two : {-golden, golden})
      corners.insert(corners.end(), {Vec3(0, one, two), Vec3(one, two, 0), Vec3(two, 0, one)});
  const auto is_edge = [](const Vec3& a, const Vec3& b) { return std::abs(glm::distance(a, b) - 2) < 1e-9; };
  std::vector<Face> faces;
  for (std::size_t a = 0; a < corners.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (std::size_t c = 0; c < b; ++c)
        if (is_edge(corners[a], corners[b]) && is_edge(corners[b], corners[c]) && is_edge(corners[c], corners[a]))
          faces.push_back({glm::normalize(corners[a]), glm::normalize(corners[b]), glm::normalize(corners[c])});
  return faces;
}

std::vector<Face> subdivided(const std::vector<Face>& faces) {
  std::vector<Face> finer;
  for (const auto& [a, b, c] : faces) {
    const Vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
    finer.insert(finer.end(), {Face{a, ab, ca}, Face{ab, b, bc}, Face{ca, bc, c}, Face{ab, bc, ca}});
  }
  return finer;
}

Vec3 outward(const Face& face) {
  const Vec3 normal = glm::normalize(glm::cross(face[1] - face[0], face[2] - face[0]));
  return glm::dot(normal, face[0]) < 0 ? -normal : normal;
}

// An icosahedron with its 20 faces in four, and those again, every corner on the ball: 162 corners. The hull's largest ball is as high as
// the lowest face, as no corner is beyond any face (SectionsAreConvex).
Section ball() {
  Section section;
  const std::vector<Face> faces = subdivided(subdivided(icosahedron()));
  for (const Face& face : faces) {
    section.inside = std::min(section.inside, glm::dot(outward(face), face[0]));
    for (const Vec3& corner : face) {
      const auto is_it = [&](const Vec3& known) { return glm::distance(known, corner) < 1e-9; };
      if (std::none_of(section.corners.begin(), section.corners.end(), is_it)) section.corners.push_back(corner);
    }
  }
  return section;
}

// ---- the linear program: columns are t, and for each contact and corner the share of normal force with this corner's friction ----

constexpr double UNIT_LENGTH = 0.05;  // m: moments are of the size of forces
constexpr double CLP_TOLERANCE = 1e-9;

struct Optimum {
  bool is_certain = false;
  double effort = INFINITE;
  double slack = 0;  // how far CLP's tolerances can move the effort
};

// Rows: balance of forces and moments about the origin, divided by the load's size; then for each digit its normal forces <= its
// strength times t. Columns: t, divided so that the greatest strength is 1; and for each contact and corner a normal force with the
// friction of this corner.
struct Column {
  std::vector<int> rows;
  std::vector<double> values;

  void add(int row, double value) {
    rows.push_back(row);
    values.push_back(value);
  }
};

struct Columns {
  std::vector<CoinBigIndex> starts{0};
  std::vector<int> rows;
  std::vector<double> values;

  void add(const Column& column) {
    rows.insert(rows.end(), column.rows.begin(), column.rows.end());
    values.insert(values.end(), column.values.begin(), column.values.end());
    starts.push_back(static_cast<CoinBigIndex>(rows.size()));
  }
  int count() const { return static_cast<int>(starts.size()) - 1; }
};

double greatest_strength(const ContactSet& set) { return *std::max_element(set.hand.digits.begin(), set.hand.digits.end()); }

struct ContactAxes {
  Vec3 n{}, a{}, b{};
};

ContactAxes axes_of(const core_f64::ContactPoint& contact) {
  const Vec3 n = contact.normal, a = glm::normalize(glm::cross(n, std::abs(n.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0)));
  return {n, a, glm::cross(n, a)};
}

Column column_of(const ContactSet& set, const core_f64::ContactPoint& contact, const Vec3& corner, double friction) {
  const auto [n, a, b] = axes_of(contact);
  const Vec3 force = n + friction * (corner.x * a + corner.y * b);
  const Vec3 moment = (glm::cross(contact.place, force) + friction * set.hand.torsion * corner.z * n) / UNIT_LENGTH;
  Column column;
  for (int k = 0; k < 3; ++k) column.add(k, force[k]);
  for (int k = 0; k < 3; ++k) column.add(3 + k, moment[k]);
  column.add(6 + contact.digit, 1);
  return column;
}

Columns columns_of(const ContactSet& set, const Section& section, double friction) {
  Column strengths;
  for (int digit = 0; digit < DIGITS; ++digit)
    strengths.add(6 + digit, -set.hand.digits[static_cast<std::size_t>(digit)] / greatest_strength(set));
  Columns columns;
  columns.add(strengths);
  for (const core_f64::ContactPoint& contact : set.contacts)
    for (const Vec3& corner : section.corners) columns.add(column_of(set, contact, corner, friction));
  return columns;
}

// CLP takes a row for balanced that is off by its tolerance: the effort moves by the row's price times that. And it takes a column for
// priced where a newton of it gains less than its tolerance: the normal forces are at most `DIGITS` times t.
double slack_of(const ClpSimplex& model) {
  double prices = 0;
  for (int row = 0; row < model.numberRows(); ++row) prices += std::abs(model.dualRowSolution()[row]);
  return CLP_TOLERANCE * (prices + (1 + DIGITS) * model.objectiveValue());
}

// The slope of a digit in the row of a bound: sum of slope x normal force >= 0.
double slope_of(const core_f64::ShareBound& bound, int digit) {
  if (digit < 1 || digit >= FINGER_COUNT) return 0;
  const double slope = (digit == bound.digit ? 1 : 0) - bound.share;
  return bound.is_least ? slope : -slope;
}

// `model` begins with the basis of the program before.
Optimum answer_of(ClpSimplex& model, const ContactSet& set, const Section& section, double friction,
                  const std::optional<core_f64::ShareBound>& bound = {}) {
  const Columns columns = columns_of(set, section, friction);
  const double size = wrench_size(set.load, Vec3(0), UNIT_LENGTH);
  std::array<double, 6 + DIGITS> least{}, most{};
  least.fill(-COIN_DBL_MAX);
  for (int k = 0; k < 3; ++k) {
    const auto row = static_cast<std::size_t>(k);
    least[row] = most[row] = -set.load.force[k] / size;
    least[3 + row] = most[3 + row] = -set.load.moment[k] / (size * UNIT_LENGTH);
  }
  std::vector<double> costs(static_cast<std::size_t>(columns.count()));
  costs[0] = 1;
  model.loadProblem(columns.count(), 6 + DIGITS, columns.starts.data(), columns.rows.data(), columns.values.data(), nullptr,
                    nullptr, costs.data(), least.data(), most.data());
  if (bound) {
    std::vector<int> places;
    std::vector<double> slopes;
    for (const core_f64::ContactPoint& contact : set.contacts)
      for (std::size_t corner = 0; corner < section.corners.size(); ++corner) {
        places.push_back(static_cast<int>(places.size()) + 1);
        slopes.push_back(slope_of(*bound, contact.digit));
      }
    model.addRow(static_cast<int>(places.size()), places.data(), slopes.data(), 0, COIN_DBL_MAX);
  }
  model.primal();
  Optimum answer;
  answer.is_certain = model.isProvenOptimal() || model.isProvenPrimalInfeasible();
  if (!model.isProvenOptimal()) return answer;
  answer.effort = size / greatest_strength(set) * model.objectiveValue();
  answer.slack = size / greatest_strength(set) * slack_of(model);
  return answer;
}

// A row of the balance for each of the six, in the program's units.
using Prices = std::array<double, 6>;

// What a contact's unit normal force is worth at the rows' prices: y.x = n.v + mu (corner.d), where v = y_force + y_moment x place and
// d = (a.v, b.v, gamma n.y_moment). The best corner of the ball is d / |d|.
struct Worth {
  Vec3 corner{};
  double most = 0;
};

Worth worth_of(const ContactSet& set, const core_f64::ContactPoint& contact, const Prices& y) {
  const auto [n, a, b] = axes_of(contact);
  const Vec3 turn = Vec3(y[3], y[4], y[5]) / UNIT_LENGTH, v = Vec3(y[0], y[1], y[2]) + glm::cross(turn, contact.place);
  const Vec3 d(glm::dot(a, v), glm::dot(b, v), set.hand.torsion * glm::dot(n, turn));
  const double size = glm::length(d);
  return {size > 0 ? d / size : Vec3(0), glm::dot(n, v) + set.hand.friction * size};
}

// What the rows' prices certify for the exact cones: weak duality, w.y / sum over digits of S max(0, most of its contacts).
double certified(const ContactSet& set, const Prices& y, double worth) {
  std::array<double, DIGITS> most{};
  for (const core_f64::ContactPoint& contact : set.contacts) {
    double& best = most[static_cast<std::size_t>(contact.digit)];
    best = std::max(best, worth_of(set, contact, y).most);
  }
  double height = 0;
  for (std::size_t digit = 0; digit < DIGITS; ++digit) height += set.hand.digits[digit] / greatest_strength(set) * most[digit];
  return height > 0 ? std::max(0.0, worth / height) : 0;
}

// The program of the last answer of `inside`, and corners of the exact cone that its prices ask for, one for each contact and round, until
// that bracket is `TIGHT`. Each round squares what was missing, about.
constexpr double TIGHT = 1e-6;
constexpr int TIGHT_ROUNDS = 12;

struct TightBracket {
  double low = 0, high = INFINITE, slack = 0;
};

TightBracket tightened(ClpSimplex& model, const ContactSet& set, const Optimum& inside) {
  const double unit = wrench_size(set.load, Vec3(0), UNIT_LENGTH) / greatest_strength(set);
  TightBracket bracket{0, inside.effort, inside.slack};
  for (int round = 0;; ++round) {
    Prices y{};
    for (std::size_t k = 0; k < 6; ++k) y[k] = model.dualRowSolution()[k];
    bracket.low = std::max(bracket.low, unit * certified(set, y, model.objectiveValue()));
    if (round == TIGHT_ROUNDS || bracket.high - bracket.low <= TIGHT * bracket.high) return bracket;
    for (const core_f64::ContactPoint& contact : set.contacts) {
      const Column column = column_of(set, contact, worth_of(set, contact, y).corner, set.hand.friction);
      model.addColumn(static_cast<int>(column.rows.size()), column.rows.data(), column.values.data());
    }
    model.primal();
    if (!model.isProvenOptimal()) return bracket;
    bracket.high = unit * model.objectiveValue();
    bracket.slack = unit * slack_of(model);
  }
}

ClpSimplex plain_model() {
  ClpSimplex model;
  model.setLogLevel(0);
  model.setPrimalTolerance(CLP_TOLERANCE);
  model.setDualTolerance(CLP_TOLERANCE);
  model.scaling(0);  // with either of these it stops short of the optimum
  model.setPerturbation(100);
  return model;
}

const Section& section_of(const ContactSet& set) {
  static const Section flat = polygon(), round = ball();
  return set.hand.torsion > 0 ? round : flat;
}

struct Reference {
  Optimum inside, around;
  double gap = 0;      // of the section: 1 - inside
  TightBracket tight;  // where inside is feasible
};

Reference reference_of(const ContactSet& set) {
  const Section& section = section_of(set);
  ClpSimplex model = plain_model();
  Reference reference;
  reference.around = answer_of(model, set, section, set.hand.friction / section.inside);
  reference.inside = answer_of(model, set, section, set.hand.friction);
  if (std::isfinite(reference.inside.effort)) reference.tight = tightened(model, set, reference.inside);
  reference.gap = 1 - section.inside;
  return reference;
}

std::size_t asked_reference_sets() {
  const char* asked = std::getenv("WHOLEHAND_EFFORT_SETS");
  return asked ? static_cast<std::size_t>(std::strtoull(asked, nullptr, 10)) : 2000;
}

std::string description(std::uint64_t seed, const ContactSet& set) {
  return "seed " + std::to_string(seed) + ", " + std::to_string(set.contacts.size()) + " contacts, mu " +
         std::to_string(set.hand.friction) + ", gamma " + std::to_string(set.hand.torsion);
}

TEST(EffortReference, SectionsAreConvex) {
  const Section round = ball();
  for (const Face& face : subdivided(subdivided(icosahedron()))) {
    const double height = glm::dot(outward(face), face[0]);
    for (const Vec3& corner : round.corners)
      EXPECT_LE(glm::dot(outward(face), corner), height + 1e-15);  // rounding of numbers up to 1
  }
  EXPECT_EQ(round.corners.size(), 162u);
  EXPECT_NEAR(round.inside, 0.98225, 1e-5);
  EXPECT_NEAR(polygon().inside, 0.99880, 1e-5);
}

struct Widths {
  std::vector<double> polyhedral, tight;  // in gaps; relative
  int finite = 0, infinite = 0;
};

void compare_with_programs(const ContactSet& set, const std::string& which, Widths& widths) {
  const Vec3 center(0.01, 0.05, 0);
  const auto& [inside, around, gap, tight] = reference_of(set);
  ASSERT_TRUE(inside.is_certain && around.is_certain) << which;
  for (const double tolerance : {core_f64::EFFORT_TOLERANCE, 1e-9}) {
    core_f64::EffortSolver solver(set.contacts, set.hand, center);
    const core_f64::Effort found = solver.solve(set.load, tolerance);
    EXPECT_LE(found.low, found.effort) << which;
    EXPECT_LE(found.low, inside.effort + inside.slack) << which;
    EXPECT_GE(found.effort, around.effort - around.slack) << which;
    EXPECT_LE(found.low, tight.high + tight.slack) << which;
    EXPECT_GE(found.effort, tight.low - tight.slack) << which;
    (std::isfinite(found.effort) ? widths.finite : widths.infinite) += 1;
    if (std::isfinite(found.effort)) expect_forces_hold(set, solver, found, center, which);
  }
  if (!std::isfinite(inside.effort)) return;
  widths.polyhedral.push_back((1 - around.effort / inside.effort) / gap);
  widths.tight.push_back(1 - tight.low / tight.high);
}

double reference_quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// The exact cone lies between the polyhedral ones, so the true effort lies between their efforts, and our bracket holds the true effort too:
// the two brackets overlap. Nothing is added but what CLP's tolerances move. An infinite effort is a bracket of infinities: the program
// around must be feasible where ours is finite, and the one inside infeasible where ours is infinite. No set comes near UNRESISTED_EFFORT.
//
// How wide the reference is: where all is held by friction, the effort goes as 1 / mu, and the bracket is `gap` of it wide: 0.12 % without
// torsion, 1.8 % with it. It is narrower where normal forces carry the load, and wider where friction only just suffices (between walls
// that lean by phi it goes as 1 / (mu - tan phi)). So the program inside goes on with the corners that its prices ask for. Of 2,000 sets
// that leaves 6e-7 in the median, 2e-6 in 19 of 20 and 0.7 % at most, where the rounds end. They take 13 s, nearly all of them CLP's.
TEST(EffortReference, BracketsOverlapLinearPrograms) {
  Widths widths;
  std::array<int, 25> counts{};
  for (std::uint64_t seed = 0; seed < asked_reference_sets(); ++seed) {
    const ContactSet set = vessel_contact_set(seed);
    ++counts[set.contacts.size()];
    ASSERT_NO_FATAL_FAILURE(compare_with_programs(set, description(seed, set), widths));
  }
  const auto sets = static_cast<int>(asked_reference_sets());
  EXPECT_GT(widths.finite, sets);  // of two for each set, as half of the loads are resisted by the way they are made
  EXPECT_GT(widths.infinite, sets / 10);
  for (std::size_t count = 2; count < counts.size(); ++count) EXPECT_GT(counts[count], sets / 100) << count << " contacts";
  EXPECT_LT(reference_quantile(widths.polyhedral, 0.5), 1);
  EXPECT_LT(reference_quantile(widths.polyhedral, 0.95), 3);
  EXPECT_LT(reference_quantile(widths.tight, 0.5), TIGHT);
  EXPECT_LT(reference_quantile(widths.tight, 0.95), 10 * TIGHT);
}

// Sets of few digits, of coincident contacts, and of one contact, on walls that are no vessel's.
TEST(EffortReference, BracketsOfFewContactsOverlapLinearPrograms) {
  Widths widths;
  const std::uint64_t sets = asked_reference_sets() / 3;
  for (std::uint64_t seed = 0; seed < sets; ++seed) {
    const ContactSet set = contact_set(seed);
    ASSERT_NO_FATAL_FAILURE(compare_with_programs(set, description(seed, set), widths));
  }
  EXPECT_GT(widths.finite, static_cast<int>(sets));
  EXPECT_GT(widths.infinite, static_cast<int>(sets / 5));
}

// Normal forces of the last solve, N, by digit.
std::array<double, DIGITS> pressed_by(const ContactSet& set, const EffortSolver& solver) {
  std::vector<core_f64::ContactForce> forces(set.contacts.size());
  solver.forces(forces);
  std::array<double, DIGITS> pressed{};
  for (std::size_t i = 0; i < forces.size(); ++i)
    pressed[static_cast<std::size_t>(set.contacts[i].digit)] += glm::dot(forces[i].force, set.contacts[i].normal);
  return pressed;
}

// The row of a bound, as a share of all forces: at least 0 within it.
double within(const core_f64::ShareBound& bound, const std::array<double, DIGITS>& pressed) {
  double row = 0, all = 0;
  for (int digit = 0; digit < DIGITS; ++digit) {
    row += slope_of(bound, digit) * pressed[static_cast<std::size_t>(digit)];
    all += pressed[static_cast<std::size_t>(digit)];
  }
  return row / all;
}

// The row of a bound makes the program's efforts those of the bound, and the forces keep to it. A bound on the other side of the share of the
// least effort changes nothing.
TEST(EffortReference, BracketsWithABoundOfAShareOverlapLinearPrograms) {
  int dearer = 0, impossible = 0, same = 0;
  const std::uint64_t sets = asked_reference_sets() / 10;
  for (std::uint64_t seed = 0; seed < sets; ++seed) {
    const ContactSet set = vessel_contact_set(seed);
    EffortSolver free(set.contacts, set.hand, Vec3(0.01, 0.05, 0));
    const core_f64::Effort least = free.solve(set.load, 1e-9);
    if (!std::isfinite(least.effort)) continue;
    const int digit = 1 + static_cast<int>(seed % 4);
    const std::array<double, DIGITS> freely = pressed_by(set, free);
    for (const core_f64::ShareBound& bound : {core_f64::ShareBound{digit, 0.15, false}, {digit, 0.15, true}, {digit, 0.6, true}}) {
      const std::string which = description(seed, set) + ", share " + std::to_string(bound.share) + (bound.is_least ? "+" : "-");
      EffortSolver solver(set.contacts, set.hand, Vec3(0.01, 0.05, 0));
      solver.set_share(bound);
      const core_f64::Effort found = solver.solve(set.load, 1e-9);
      const Section& section = section_of(set);
      ClpSimplex model = plain_model();
      const Optimum around = answer_of(model, set, section, set.hand.friction / section.inside, bound);
      const Optimum inside = answer_of(model, set, section, set.hand.friction, bound);
      ASSERT_TRUE(inside.is_certain && around.is_certain) << which;
      EXPECT_LE(found.low, inside.effort + inside.slack) << which;
      EXPECT_GE(found.effort, around.effort - around.slack) << which;
      EXPECT_GE(found.effort, least.low) << which;
      impossible += std::isinf(found.effort) ? 1 : 0;
      if (std::isinf(found.effort)) continue;
      expect_forces_hold(set, solver, found, Vec3(0.01, 0.05, 0), which);
      EXPECT_GE(within(bound, pressed_by(set, solver)), -FORCES_SUMMED) << which;
      const bool is_kept = within(bound, freely) >= 0;
      dearer += found.low > least.effort ? 1 : 0;
      same += is_kept ? 1 : 0;
      if (is_kept) {
        EXPECT_LE(found.low, least.effort * (1 + FORCES_SUMMED)) << which;
      }
    }
  }
  for (const int count : {dearer, impossible, same}) EXPECT_GT(count, static_cast<int>(sets / 10));
}

}  // namespace
}  // namespace wholehand
