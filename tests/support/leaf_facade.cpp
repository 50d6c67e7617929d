// SPDX-License-Identifier: MIT
#include "tests/support/leaf_facade.h"

#include <cmath>
#include <stdexcept>

#include "core/closure.h"
#include "core/contact.h"
#include "core/force.h"
#include "core/liquid.h"
#include "core/load.h"
#include "core/loop.h"
#include "core/prepare.h"
#include "core/projection.h"
#include "core/score.h"
#include "core/trig.h"
#include "tests/shaders/probe_table.h"

#ifndef MAKE_LEAVES
#define MAKE_LEAVES make_double_leaves
#endif

namespace CORE_NS {
namespace {

// One row, read and written as the probe shaders do.
struct Row {
  const double* from;
  double* to;

  Real given(int k) const { return static_cast<Real>(from[k]); }
  Vec3 given3(int k) const { return Vec3(given(k), given(k + 1), given(k + 2)); }
  Vec2 given2(int k) const { return Vec2(given(k), given(k + 1)); }
  int given_int(int k) const { return static_cast<int>(std::nearbyint(from[k])); }
  FingerFrame frame() const { return {given3(0), given3(3), given3(6)}; }
  Element element() const { return {given2(0), given2(2), given2(4), given(6), given_int(7)}; }
  void answer(int k, Real value) const { to[k] = static_cast<double>(value); }
  void answer3(int k, Vec3 value) const {
    for (int i = 0; i < 3; ++i) answer(k + i, value[i]);
  }
  void answer_slices(Slices slices) const {
    answer(0, slices.volume);
    answer(1, slices.lean);
    answer(2, slices.height);
    answer(3, slices.surface);
  }
  void answer_points(FingerPoints points) const {
    answer3(0, points.pip);
    answer3(3, points.dip);
    answer3(6, points.tip);
  }
};

class CoreLeaves final : public wholehand::Leaves {
 public:
  CoreLeaves(const wholehand::Scene& scene, std::size_t v, int grid_samples, int grid_bits)
      : hand_(load_hand(wholehand::prepare_hand(scene.hand), scene.hand)),
        quadrature_(load_quadrature(wholehand::prepare_quadrature(QUADRATURE_POINTS))) {
    const wholehand::VesselData& data = scene.vessels[v];
    const wholehand::PreparedVessel prepared = wholehand::prepare_vessel(data, data.wall > 0);
    vessel_ = load_vessel(prepared, data, quadrature_, scene.liquid.has_value(), scene.hand.handedness);
    if (grid_samples == 0) return;
    use_grid(vessel_, load_grid(wholehand::prepare_grid(prepared, grid_samples, grid_bits == 16, wholehand::grid_margin(scene))));
  }

  void evaluate(int probe, const double* given, double* answer) const override {
    const Row row{given, answer};
    if (probe < PROBE_SIGNED_DISTANCE) return probe < PROBE_TRAJECTORY ? trig(probe, row) : hand(probe, row);
    if (probe < PROBE_TRACE_TIP || probe == PROBE_DISTANCE_BEYOND) return sdf(probe, row);
    if (probe < PROBE_SEGMENT_RATES) return closure(probe, row);
    if (probe < PROBE_SEGMENT_AREA) return projection(probe, row);
    if (probe < PROBE_DIRECTIONS) return liquid(probe, row);
    if (probe < PROBE_PROPAGATOR) return force(probe, row);
    loop(probe, row);
  }

 private:
  static void unknown() { throw std::logic_error("no such probe"); }

  static void trig(int probe, const Row& row) {
    switch (probe) {
      case PROBE_SINE_COSINE: {
        Real s = 0, c = 0;
        sine_cosine(row.given(0), s, c);
        row.answer(0, s);
        row.answer(1, c);
        break;
      }
      case PROBE_ARC_COSINE:
        row.answer(0, arc_cosine(row.given(0)));
        break;
      case PROBE_ANGLE_BETWEEN:
        row.answer(0, angle_between(row.given3(0), row.given3(3)));
        break;
      default:
        unknown();
    }
  }

  void hand(int probe, const Row& row) const {
    switch (probe) {
      case PROBE_TRAJECTORY:
        row.answer3(0, thumb_angles(hand_, row.given(0)));
        row.answer3(3, finger_angles(hand_, row.given(0)));
        break;
      case PROBE_FINGER_POINTS:
        row.answer_points(finger_points(row.frame(), row.given3(9), row.given3(12), row.given3(15)));
        break;
      case PROBE_THUMB_POINTS:
        row.answer_points(thumb_points(row.frame(), row.given3(9), row.given3(12)));
        break;
      case PROBE_SEGMENT_END:
        row.answer3(0, segment_end(row.frame(), row.given3(9), row.given(12), row.given(13)));
        break;
      case PROBE_TIP_TO_TIP: {
        Vec3 slope{};
        row.answer3(0, tip_to_tip(hand_, row.given(0), slope));
        row.answer3(3, slope);
        row.answer(6, gap_at(hand_, row.given(0)));
        break;
      }
      case PROBE_CLOSURE_OF_GAP:
        row.answer(0, closure_of_gap(hand_, row.given(0), STOP_TOLERANCE));
        break;
      default:
        unknown();
    }
  }

  void sdf(int probe, const Row& row) const {
    switch (probe) {
      case PROBE_SIGNED_DISTANCE:
        row.answer(0, signed_distance(vessel_, row.given3(0)));
        break;
      case PROBE_GRADIENT: {
        int element = -1;
        row.answer3(0, distance_gradient(vessel_, row.given3(0), element));
        row.answer(3, Real(element));
        break;
      }
      case PROBE_SUPPORT: {
        const Support support = support_at(vessel_, row.given3(0));
        row.answer(0, support.distance);
        row.answer(1, support.other);
        row.answer3(2, support.normal);
        row.answer(5, Real(support.element));
        row.answer(6, Real(support.planar));
        break;
      }
      case PROBE_SAFE_STEP: {
        const Support support{row.given(0), row.given(1), row.given3(2), 0, row.given_int(5) != 0};
        row.answer(0, safe_step(support, row.given(6), row.given3(7), row.given(10), row.given(11)));
        break;
      }
      case PROBE_CONTACT: {
        const Contact contact = contact_at(vessel_, row.given3(0), row.given(3));
        row.answer(0, contact.separation);
        row.answer3(1, contact.proxy);
        row.answer(4, Real(contact.settled));
        break;
      }
      case PROBE_ELEMENT: {
        const Element element = row.element();
        const Vec2 q = row.given2(8);
        const Vec2 outward = element_outward(element, q, row.given(10));
        row.answer(0, std::sqrt(element_distance_squared(element, q)));
        row.answer(1, Real(element_crosses(element, q)));
        row.answer(2, Real(element_spans(element, q)));
        row.answer(3, Real(element_convex(element, q)));
        row.answer(4, outward.x);
        row.answer(5, outward.y);
        break;
      }
      case PROBE_PROXY: {
        bool settled = false;
        row.answer3(0, proxy_of(vessel_, row.given3(0), row.given(3), settled));
        row.answer(3, Real(settled));
        break;
      }
      case PROBE_LOCATE_CELL: {
        const Cell cell = locate_cell(vessel_, row.given3(0));
        row.answer3(0, Vec3(cell.i, cell.j, cell.k));
        row.answer3(3, cell.fraction);
        row.answer3(6, cell.outside);
        break;
      }
      case PROBE_GRID_SAMPLE:
        row.answer(0, grid_sample(vessel_, row.given_int(0), row.given_int(1), row.given_int(2)));
        break;
      case PROBE_DISTANCE_BEYOND:
        row.answer(0, distance_beyond(row.given(0), row.given3(1)));
        break;
      case PROBE_MIX_REALS:
        row.answer(0, mix_reals(row.given(0), row.given(1), row.given(2)));
        break;
      default:
        unknown();
    }
  }

  // 0 where the reason leaves a value open
  static void answer_closing(const Row& row, Closing closing) {
    const bool reached = closing.reason == REASON_NONE || closing.reason >= REASON_TOO_WIDE;
    const bool closed = closing.reason == REASON_NONE;
    row.answer(0, Real(closing.reason));
    row.answer3(1, closing.direction);
    row.answer(4, reached ? closing.t_index : Real(0));
    row.answer(5, reached ? closing.t_thumb : Real(0));
    row.answer(6, reached ? closing.gap : Real(0));
    row.answer3(7, reached ? closing.midpoint : Vec3(0));
    row.answer(10, closed ? closing.closure : Real(0));
    row.answer(11, closed ? closing.thumb_angle : Real(0));
    row.answer(12, closed ? closing.index_angle : Real(0));
    row.answer(13, closed ? Real(closing.grazing) : Real(0));
    for (int k = 0; k < 3; ++k) row.answer3(14 + 3 * k, closed ? closing.placement.rotation[k] : Vec3(0));
    row.answer3(23, closed ? closing.placement.translation : Vec3(0));
    row.answer(26, closed ? closing.placement.scale : Real(0));
  }

  void closure(int probe, const Row& row) const {
    switch (probe) {
      case PROBE_TRACE_TIP: {
        const Trace trace =
            trace_tip(vessel_, row.given3(0), grip_direction(row.given(3), row.given(4)), row.given(5), row.given(6));
        row.answer(0, trace.t);
        row.answer(1, Real(trace.reason));
        row.answer3(2, trace.normal);
        row.answer(5, Real(trace.element));
        break;
      }
      case PROBE_PLACE_HAND: {
        Real e1_x = 0;
        const Placement placement = place_hand(hand_, row.given(0), grip_direction(row.given(1), row.given(2)), row.given(3),
                                               row.given3(4), row.given(7), e1_x);
        for (int k = 0; k < 3; ++k) row.answer3(3 * k, placement.rotation[k]);
        row.answer3(9, placement.translation);
        row.answer(12, e1_x);
        const FingerFrame index = placed_frame(placement, hand_.frame[1]);
        row.answer3(13, index.base);
        row.answer3(16, index.forward);
        row.answer3(19, index.palmward);
        break;
      }
      case PROBE_CLOSE_FINGERS: {
        const Grip grip{row.given(0), row.given(1), row.given(2), row.given(3), row.given(4), row.given(5)};
        Hand hand = hand_;
        hand.radius[1][4] += row.given(6) / (hand.scale * grip.hand_scale);
        hand.radius[0][3] += row.given(7) / (hand.scale * grip.hand_scale);
        answer_closing(row, close_fingers(hand, vessel_, grip));
        break;
      }
      default:
        unknown();
    }
  }

  void projection(int probe, const Row& row) const {
    switch (probe) {
      case PROBE_SEGMENT_RATES:
        row.answer3(0, segment_rates(row.given3(0), row.given_int(3)));
        break;
      case PROBE_QUARTER_TURN:
        row.answer3(0, quarter_turn(row.frame(), row.given3(9)));
        break;
      case PROBE_NEAREST_POINT:
        row.answer(0, Real(nearest_point(row.given3(0), row.given_int(3))));
        break;
      case PROBE_FINGER_STEP: {
        const FingerPoints points = finger_points(row.frame(), row.given3(9), row.given3(12), row.given3(15));
        const Watch watch = watch_points(vessel_, points, row.given3(18));
        row.answer(0, finger_step(row.frame(), row.given3(9), points, watch, row.given3(12), row.given3(21)));
        break;
      }
      case PROBE_FINGER_MOTION: {
        FingerMotion motion = start_motion(hand_, row.given(18));
        while (motion.joint < 3) {
          const FingerPoints points = finger_points(row.frame(), row.given3(9), row.given3(12), motion.angles);
          const Watch watch = watch_points(vessel_, points, row.given3(15));
          motion = advance_finger(hand_, motion, row.frame(), row.given3(9), points, watch, row.given3(12));
        }
        row.answer3(0, motion.angles);
        row.answer(3, Real(motion.blocked));
        row.answer(4, Real(motion.unsettled));
        break;
      }
      case PROBE_PAPER_AXIS: {
        const PaperAxis axis = paper_axis(row.given3(0), row.given3(3), row.given3(6), row.given3(9));
        row.answer3(0, axis.direction);
        row.answer(3, Real(axis.exists));
        break;
      }
      case PROBE_TURNED_POINT:
        row.answer3(0, turned_point(row.given3(0), row.given3(3), row.given3(6), row.given(9)));
        break;
      case PROBE_PROJECT_POINT: {
        bool unsettled = false;
        row.answer3(0, project_point(vessel_, row.given3(0), row.given(3), row.given3(4), PaperAxis{row.given3(7), true},
                                     row.given(10), unsettled));
        row.answer(3, Real(unsettled));
        break;
      }
      case PROBE_TURN_JOINT: {
        const FingerMotion motion{row.given3(0),  row.given(3),           row.given(4),          row.given_int(5),
                                  row.given(6),   row.given(7),           row.given(8),          row.given_int(9),
                                  row.given3(10), row.given_int(13) != 0, row.given_int(14) != 0};
        const FingerMotion next = turn_joint(hand_, motion, row.given_int(15));
        row.answer3(0, next.angles);
        row.answer(3, next.closure);
        row.answer(4, next.limit);
        row.answer(5, Real(next.joint));
        row.answer(6, next.start);
        row.answer(7, next.turned);
        row.answer(8, next.room);
        row.answer(9, Real(next.steps));
        row.answer3(10, next.before);
        row.answer(13, Real(next.blocked));
        row.answer(14, Real(next.unsettled));
        break;
      }
      case PROBE_PROJECTION_ROLE:
        row.answer(0, Real(projection_role(row.given_int(0), row.given_int(1))));
        break;
      default:
        unknown();
    }
  }

  void liquid(int probe, const Row& row) const {
    switch (probe) {
      case PROBE_SEGMENT_AREA:
        row.answer(0, segment_area(row.given(0), row.given(1)));
        break;
      case PROBE_SEGMENT_MOMENT:
        row.answer(0, segment_moment(row.given(0), row.given(1)));
        break;
      case PROBE_ELEMENT_RADIUS:
        row.answer(0, element_radius(row.element(), row.given(8)));
        break;
      case PROBE_PLANE_CROSSINGS: {
        const Vec2 heights = plane_crossings(row.element(), row.given(8), row.given(9), row.given(10), row.given(11));
        row.answer(0, heights.x);
        row.answer(1, heights.y);
        break;
      }
      case PROBE_PIECE_BELOW:
        row.answer_slices(piece_below(quadrature_, row.element(), row.given(8), row.given(9), row.given(10)));
        break;
      case PROBE_INTEGRATE_SLICES:
        row.answer_slices(
            integrate_slices(quadrature_, row.element(), row.given(8), row.given(9), row.given(10), row.given(11), row.given(12)));
        break;
      case PROBE_LIQUID_BELOW:
        row.answer_slices(liquid_below(vessel_, quadrature_, row.given(0), row.given(1), row.given(2)));
        break;
      case PROBE_LIP_CAPACITY:
        row.answer(0, lip_level(vessel_, row.given(0), row.given(1)));
        row.answer(1, bottom_level(vessel_, row.given(0), row.given(1)));
        row.answer(2, lip_capacity(vessel_, quadrature_, row.given(0), row.given(1)));
        break;
      case PROBE_LIQUID_AT: {
        const LiquidState state = liquid_at(vessel_, quadrature_, row.given(0), row.given(1), row.given(2));
        row.answer(0, state.volume);
        row.answer(1, state.lean);
        row.answer(2, state.height);
        break;
      }
      case PROBE_REVOLVED: {
        const Slices slices = revolved_element(quadrature_, row.element());
        row.answer(0, slices.volume);
        row.answer(1, slices.height);
        break;
      }
      default:
        unknown();
    }
  }

  static void answer_motion(const Row& row, Motion motion) {
    row.answer(0, motion.place);
    row.answer(1, motion.speed);
  }

  static void loop(int probe, const Row& row) {
    const Plant plant{row.given(0), row.given(1), row.given(2)};
    switch (probe) {
      case PROBE_PROPAGATOR: {
        const Propagator by = propagator(plant, row.given(3));
        row.answer3(0, Vec3(by.place_place, by.place_speed, by.place_force));
        row.answer3(3, Vec3(by.speed_place, by.speed_speed, by.speed_force));
        break;
      }
      case PROBE_STEPPED: {
        const Propagator by = stepped_propagator(plant, row.given(3), row.given_int(4), row.given_int(5));
        row.answer3(0, Vec3(by.place_place, by.place_speed, by.place_force));
        row.answer3(3, Vec3(by.speed_place, by.speed_speed, by.speed_force));
        break;
      }
      case PROBE_LET_GO: {
        const Wall wall{row.given(0), row.given(1),     row.given(2),         row.given(3),
                        row.given(4), row.given_int(5), row.given_int(6) != 0};
        const LoopState state = let_go(wall, row.given(7));
        answer_motion(row, state.motion);
        row.answer(2, state.reading);
        for (int k = 0; k < LOOP_DELAYS; ++k) row.answer(3 + k, state.waiting[k]);
        break;
      }
      case PROBE_ADVANCE: {
        const Propagator by = propagator(plant, row.given(7));
        const Motion motion{row.given(3), row.given(4)};
        answer_motion(row, row.given(6) > 0 ? advance_with_friction(plant, by, motion, row.given(5), row.given(6), row.given(7))
                                            : advance(by, motion, row.given(5)));
        break;
      }
      case PROBE_WALL_FORCE: {
        const Wall wall{row.given(0), row.given(1), row.given(2), row.given(3), row.given(4), 0, row.given_int(5) != 0};
        const Real reading = read_encoder(row.given(6), wall.encoder_step);
        row.answer(0, reading);
        row.answer(1, wall_force(wall, reading, row.given(7)));
        break;
      }
      case PROBE_STEP_LOOP: {
        const Wall wall{row.given(3), row.given(4),     row.given(5),         row.given(6),
                        row.given(7), row.given_int(8), row.given_int(9) != 0};
        LoopState state;
        state.motion = {row.given(10), row.given(11)};
        state.reading = row.given(12);
        for (int k = 0; k < LOOP_DELAYS; ++k) state.waiting[k] = row.given(13 + k);
        state = step_loop(plant, propagator(plant, wall.period), wall, state, row.given(17), row.given(18));
        answer_motion(row, state.motion);
        row.answer(2, state.reading);
        for (int k = 0; k < LOOP_DELAYS; ++k) row.answer(3 + k, state.waiting[k]);
        break;
      }
      case PROBE_LOOP_ENERGY: {
        Wall wall;
        wall.stiffness = row.given(3);
        row.answer(0, loop_energy(plant, wall, {row.given(4), row.given(5)}, row.given(6)));
        break;
      }
      default:
        unknown();
    }
  }

  static void force(int probe, const Row& row) {
    switch (probe) {
      case PROBE_DIRECTIONS: {
        const Vec3 pour = pour_direction(row.given3(0), row.given(3));
        row.answer3(0, pour);
        row.answer3(3, up_direction(pour, row.given(4), row.given(5)));
        break;
      }
      case PROBE_LOAD_CENTER:
        row.answer3(0, load_center(Load{Real(1), row.given3(0), row.given(3), row.given(4)}, row.given3(5)));
        break;
      case PROBE_TORQUES:
        row.answer(0, pendulum_torque(row.given(0), row.given(1), row.given(2), row.given(9)));
        row.answer(1, exact_pendulum_torque(row.given(0), row.given(1), row.given3(3), row.given3(6), row.given(9), row.given(10)));
        row.answer(2, grip_reference(row.given(0), row.given(1), row.given(2)));
        break;
      case PROBE_FORCES: {
        const Real normal = normal_force(row.given(0), row.given(1), row.given(2), row.given(3));
        const Real opening = opening_force(row.given(4), row.given(5));
        row.answer(0, normal);
        row.answer(1, opening);
        row.answer(2, feedback_force(normal, opening, row.given(6)));
        break;
      }
      case PROBE_HOLD_FORCE:
        row.answer(
            0, hold_force(row.given(0), row.given(1), row.given3(2), row.given3(5), row.given3(8), row.given(11), row.given(12)));
        break;
      case PROBE_COUPLING_FORCE:
        row.answer3(0, coupling_force(row.given3(0), row.given3(3), row.given3(6), row.given3(9), row.given(12), row.given(13)));
        break;
      case PROBE_SCORE:
        row.answer(0, fingers_term(row.given_int(0)));
        row.answer(1, contacts_term(row.given_int(1)));
        row.answer(2, depth_term(row.given(2), row.given(3)));
        row.answer(3, posture_term(row.given(4)));
        row.answer(4, force_term(row.given(5), row.given(6)));
        row.answer(5, hold_term(row.given(7), row.given(8)));
        break;
      default:
        unknown();
    }
  }

  Hand hand_;
  Quadrature quadrature_;
  Vessel vessel_;
};

}  // namespace
}  // namespace CORE_NS

namespace wholehand {

std::unique_ptr<Leaves> MAKE_LEAVES(const Scene& scene, std::size_t vessel, int grid_samples, int grid_bits) {
  return std::make_unique<CORE_NS::CoreLeaves>(scene, vessel, grid_samples, grid_bits);
}

}  // namespace wholehand
