// SPDX-License-Identifier: MIT
// Kernel 10: the smallest share of the hand's strength that balances a load, with a certificate.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "core/real.h"

namespace CORE_NS {

constexpr int DIGITS = FINGERS + 1;  // thumb, index, middle, ring, little, palm
constexpr int PALM = FINGERS;
constexpr int EFFORT_PIVOTS = 400;                                   // at most; then the bracket stays as it is
constexpr Real EFFORT_TOLERANCE = Real(1e-3);                        // of the bracket's width, relative
constexpr Real EFFORT_ROUNDING = SINGLE ? Real(1e-5) : Real(1e-11);  // of numbers of size 1 after the pivots of a solve
constexpr Real UNRESISTED_EFFORT =
    Real(1e6);  // a load that needs more than this many times its own size in normal forces counts as not resisted

// A digit's contact. Vessel frame, m.
struct ContactPoint {
  Vec3 place{};         // on the surface
  Vec3 normal{};        // unit, into the object
  int digit = 0;        // below DIGITS
  bool is_tip = false;  // of thumb or index finger: the two that pinch
};

// A force at the frame's origin and a moment about it, N and N m.
struct Wrench {
  Vec3 force{}, moment{};
  Vec3 place{};  // m, where the force acts; sets the scale for levers if contacts have no torsion
};
Wrench wrench_at(Vec3 place, Vec3 force);

// What all contacts and digits can do. A contact with the normal force N carries a tangential force f and a moment tau about the normal with (|f| /
// (mu N))^2 + (tau / (mu gamma N))^2 <= 1. The normal forces of a digit's contacts add up to its strength at most.
struct HandStrength {
  Real friction = 0;                  // mu
  Real torsion = 0;                   // gamma, m
  std::array<Real, DIGITS> digits{};  // N; 0: this digit does not press

  // The strength of the weaker of thumb and index finger, N: the hold force is the effort times this.
  Real weaker_tip() const { return digits[0] < digits[1] ? digits[0] : digits[1]; }
};

// One side of a finger's share: of the normal forces of the fingers other than the thumb, `digit` presses `share` at least or at most.
struct ShareBound {
  int digit = 1;  // index to little finger
  Real share = 0;
  bool is_least = true;
};

struct ContactForce {
  Vec3 force{};      // on the object, N
  Real torsion = 0;  // moment about the inward normal, N m
};

// The support of a contact with unit normal force in the direction (a, b): the largest a.f + b.m of the wrenches (f, m) in its cone. `arm` is from
// the solver's center; `arm` and `gamma` are in its unit of length.
Real press(Vec3 arm, Vec3 normal, Real friction, Real gamma, const std::array<Real, 6>& direction);
// The force that attains it, and its moment about the normal.
ContactForce pressing_force(Vec3 arm, Vec3 normal, Real friction, Real gamma, const std::array<Real, 6>& direction);
// The wrench of that force.
std::array<Real, 6> pressed(Vec3 arm, Vec3 normal, Real friction, Real gamma, const std::array<Real, 6>& direction);

// The least effort lies in [low, effort], and forces of `effort` balance the load. If no force resists it, both are infinite. `escape` is then the
// motion of the object (velocity of the solver's center, m/s, and angular velocity, rad/s, scaled together) along which the load pushes it unopposed:
// the support of -escape is small beside the load's power. `low` stays finite if EFFORT_PIVOTS or rounding ended the search before that was certain.
struct Effort {
  Real effort = 0, low = 0;
  std::array<Real, 6> escape{};
  int pivots = 0;
};

// The gauge of Z, the Minkowski sum over the digits of strength x conv({0} and the wrenches of its contacts at unit normal force), at the wrench that
// balances a load. Uses a revised simplex with six rows, whose columns are points of Z that its support function finds. Keeps its last basis as the
// start for the next load of the same contacts. Allocates nothing. `contacts` must outlive it.
class EffortSolver {
 public:
  // Moments are about `center`, and lengths in units of the furthest contact from it: both affect the path, not the answer. Without torsion, two tips
  // resist no moment about their line, and a load's lever about it counts as 0 up to longest_bare_lever.
  EffortSolver(std::span<const ContactPoint> contacts, const HandStrength& hand, Vec3 center);

  // Ends when effort - low <= tolerance x effort, or after EFFORT_PIVOTS. If rounding leaves forces that do not balance the load, it restarts with
  // the remaining pivots and four times the tolerance, until this is 0.1 or more. If another load's basis leaves the answer open, it searches from
  // the start, with as many pivots again. The effort is 0 for no load, or one whose square underflows beside the square of the strongest digit. A
  // caller who only compares the effort with a number sets `enough` and `too_much`: the search also ends, with its current bracket, when effort <=
  // enough or low > too_much (`effort` is then infinite).
  Effort solve(const Wrench& load, Real tolerance = EFFORT_TOLERANCE, Real enough = 0,
               Real too_much = std::numeric_limits<Real>::infinity());
  // From here on, the hand carries `alone` with all of its strength, and `solve` asks what is left: its answer for a load is 1 / the largest factor
  // of that load that the hand can carry too. `alone` must be held with an effort below 1. Such an answer has no forces.
  void displace(const Wrench& alone);
  // As friction grows the last basis stays valid: more friction carries whatever less does.
  void set_friction(Real friction);
  // From here on, only forces within this bound count. least_friction ignores it.
  void set_share(const ShareBound& bound);
  // The friction, up to `most`, at which the direction of the last solve's lower bound just allows a load: less does not hold it. Infinite: more is
  // needed.
  Real least_friction(const Wrench& load, Real most) const;
  // A lower bound of the effort for another load, from the direction of the last solve's lower bound. 0 before any solve.
  Real low(const Wrench& load) const;
  // An upper bound of the effort for this load from the last basis alone; infinite if this basis does not hold it, or there is none.
  Real bound(const Wrench& load) const;
  // The forces that balance the last solved load at its effort, one for each contact (`forces` has that length). Nothing if the load was not
  // resisted.
  void forces(std::span<ContactForce> forces) const;

 private:
  using Vec6 = std::array<Real, 6>;
  struct Column {
    Vec6 point{};      // of Z, or of an artificial direction
    Vec6 direction{};  // whose support it is
    bool is_artificial = false;
  };

  // Levels of the basis: what contacts and artificial columns carry, and the lowest level.
  struct Cost {
    Real real = 0, artificial = 0, least = 0;
  };
  // h(u) at a friction, and its derivative by friction.
  struct Reach {
    Real height = 0, slope = 0;
  };
  // What a search needs and has found.
  struct Search {
    Vec6 wanted{};
    Real size = 0;  // of `wanted`
    Real tolerance = 0, enough = 0, too_much = 0;
    int most_pivots = 0;
    Effort answer{};
    Vec6 best{};                                      // the direction of the greatest lower bound
    std::optional<std::array<Column, 6>> balanced{};  // the last basis whose levels are none below zero
    bool is_beyond = false;                           // the lower bound is beyond `too_much`
  };
  // How a digit presses in one point of Z: with one contact.
  struct Press {
    int contact = -1;  // none
    Real support = 0;  // of a unit normal force there
    Real force = 0;    // normal, N
  };
  using Presses = std::array<Press, DIGITS>;

  Effort search(const Wrench& load, Real tolerance, Real enough, Real too_much, int most_pivots);
  void narrow(Search& now);
  bool answer_with_basis(Search& now, bool& is_certain);
  Vec6 wanted_for(const Wrench& load) const;
  Presses presses(const Vec6& direction) const;
  void keep_share(Presses& all) const;
  Cost cost_of(const Vec6& levels) const;
  Vec3 arm(const ContactPoint& contact) const;
  Real gamma() const;
  Real support(const Vec6& direction, Vec6& point) const;
  Reach reach(const Vec6& direction, Real friction) const;
  Column priced(bool is_short) const;
  Vec6 levels(const Vec6& wanted) const;
  Real unbalanced(const Vec6& wanted) const;
  void begin(const Vec6& wanted);
  void restart(const Vec6& wanted);
  bool enter(const Column& column, const Vec6& wanted);
  bool invert();

  std::span<const ContactPoint> contacts_;
  HandStrength hand_;
  Vec3 center_;
  Real unit_force_ = 1, unit_length_ = 1;  // N, m
  Real dear_ = UNRESISTED_EFFORT;          // as a multiple of the load's size, the effort that counts as infinite
  Vec3 middle_{}, line_{};                 // of the two tips, m, and unit; without torsion
  std::array<Column, 6> columns_{};
  std::array<Vec6, 6> inverse_{};  // rows
  Vec6 displaced_{};               // by which points of Z are smaller
  std::optional<ShareBound> share_{};
  Vec6 last_{};          // levels of the last load
  Vec6 cut_{};           // u of the last lower bound
  Real cut_height_ = 1;  // h(u)
  bool has_basis_ = false;
};

}  // namespace CORE_NS
