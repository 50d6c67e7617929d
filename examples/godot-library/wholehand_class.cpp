// SPDX-License-Identifier: MIT
// The class `Wholehand` for GDScript, on the C interface of libwholehand. main.gd shows its use, and docs/engines.md lists its methods. A refused
// method prints the line as an error, keeps it for message(), and returns null.
#include <wholehand/wholehand.h>

#include <cmath>
#include <cstring>
#include <exception>
#include <iterator>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "godot_api.h"
#include "godot_values.h"
#include "session_thread.h"

namespace values = godot_values;
using godot_api::Variant;

namespace {

struct Refused {
  std::string line;
};

void check(wh_status status) {
  if (status != WH_OK) throw Refused{wh_message()};
}

// Row by row, of a unit quaternion.
void rotation_of(const double* q, double* m) {
  const double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], s = n > 0 ? 2 / n : 0;
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double rows[3][3] = {{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)},
                             {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)},
                             {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)}};
  std::memcpy(m, rows, sizeof rows);
}

// The largest of the four numbers comes first, so that nothing is divided by a small one.
void quaternion_of(const double* m, double* q) {
  const double squares[4] = {1 + m[0] - m[4] - m[8], 1 - m[0] + m[4] - m[8], 1 - m[0] - m[4] + m[8], 1 + m[0] + m[4] + m[8]};
  int largest = 3;
  for (int k = 0; k < 3; ++k)
    if (squares[k] > squares[largest]) largest = k;
  const double products[4][4] = {{squares[0], m[1] + m[3], m[2] + m[6], m[7] - m[5]},
                                 {m[1] + m[3], squares[1], m[5] + m[7], m[2] - m[6]},
                                 {m[2] + m[6], m[5] + m[7], squares[2], m[3] - m[1]},
                                 {m[7] - m[5], m[2] - m[6], m[3] - m[1], squares[3]}};
  for (int k = 0; k < 4; ++k) q[k] = products[largest][k] / (2 * std::sqrt(squares[largest]));
}

// ---- the arguments of a call ----

class Arguments {
 public:
  Arguments(const char* method, Variant** all) : method_(method), all_(all) {}
  double real(int k) const { return values::real(expect(k, values::is_real(*all_[k]), "a number")); }
  std::int64_t whole(int k) const { return values::whole(expect(k, is(k, godot_api::INT), "a whole number")); }
  std::string text(int k) const { return values::text(expect(k, is(k, godot_api::STRING), "a String")); }
  void place(int k, double* xyz) const { values::place(expect(k, is(k, godot_api::VECTOR3), "a Vector3"), xyz); }
  void turn(int k, double* xyzw) const { values::turn(expect(k, is(k, godot_api::QUATERNION), "a Quat"), xyzw); }
  const Variant& dictionary(int k) const { return expect(k, is(k, godot_api::DICTIONARY), "a Dictionary"); }

 private:
  bool is(int k, godot_api::VariantType type) const { return values::is_of(*all_[k], type); }
  const Variant& expect(int k, bool is_so, const char* type) const {
    if (!is_so) throw Refused{std::string(method_) + ": argument " + std::to_string(k + 1) + " must be " + type};
    return *all_[k];
  }
  const char* method_;
  Variant** all_;
};

// ---- the class ----

class Wholehand {
 public:
  ~Wholehand() { close(); }

  // A scene file, or the name of a shipped scene.
  Variant open(const Arguments& in) {
    close();
    check(wh_scene_open(in.text(0).c_str(), &scene_));
    return values::of(true);
  }

  Variant message(const Arguments&) { return values::of(message_); }
  Variant version(const Arguments&) { return values::of(std::string(wh_version())); }

  Variant joint_names(const Arguments&) {
    values::Listed names;
    for (int j = 0; j < WH_JOINTS; ++j) names.add(values::of(std::string(wh_joint_name(j))));
    return names.take();
  }

  Variant vessels(const Arguments&) {
    std::size_t count = 0;
    check(wh_scene_vessels(scene_, &count));
    values::Listed all;
    for (std::size_t v = 0; v < count; ++v) {
      wh_vessel vessel;
      WH_INIT(&vessel);
      check(wh_scene_vessel(scene_, v, &vessel));
      values::Made made;
      made.set("name", values::of(std::string(vessel.name))).set("place", values::place(vessel.place));
      made.set("lowest", values::of(vessel.lowest)).set("highest", values::of(vessel.highest));
      made.set("capacity", values::of(vessel.capacity)).set("mass", values::of(vessel.mass));
      all.add(made.take());
    }
    return all.take();
  }

  // The posed hand of one grip, in the vessel's frame.
  Variant grip(const Arguments& in) {
    wh_grip grip = grip_of(in);
    wh_grip_result result;
    WH_INIT(&result);
    check(wh_grip_evaluate(scene_, vessel_of(in), &grip, &result));
    values::Made made;
    made.set("reason", values::of(std::string(result.reason))).set("feasible", values::of(result.is_feasible != 0));
    made.set("plausible", values::of(result.is_plausible != 0))
        .set("not_held", values::of(result.is_not_held != 0))
        .set("closure", values::of(result.closure));
    made.set("gap", values::of(result.gap)).set("score", values::of(result.score));
    made.set("touch_mask", values::of(static_cast<int>(result.touch_mask)));
    made.set("joints", values::places(result.posed, WH_JOINTS));
    return made.take();
  }

  // All that `wholehand grip --json` prints of it.
  Variant grip_json(const Arguments& in) {
    wh_grip grip = grip_of(in);
    char* text = nullptr;
    check(wh_grip_json(scene_, vessel_of(in), &grip, &text));
    const std::string own = text;
    wh_text_free(&text);
    return values::of(own);
  }

  Variant session_open(const Arguments& in) {
    thread_.reset();
    wh_session_free(&session_);
    check(wh_session_open(scene_, in.real(0), in.real(1), &session_));
    return values::of(true);
  }

  Variant session_period(const Arguments&) {
    double seconds = 0;
    check(wh_session_period(session_, &seconds));
    return values::of(seconds);
  }

  // One step by the caller's own clock: tick, position, turn, gap.
  Variant session_step(const Arguments& in) {
    refuse_thread("session_step");
    wh_measurement measurement = measurement_of(in, 1);
    measurement.tick = in.whole(0);
    wh_session_output output;
    WH_INIT(&output);
    check(wh_session_step(session_, &measurement, &output));
    return output_values(output, measurement.tick);
  }

  // The whole hand of the last step, in the world.
  Variant session_hand(const Arguments&) {
    wh_hand hand;
    WH_INIT(&hand);
    if (!thread_) {
      check(wh_session_hand(session_, &hand));
    } else {
      wh_session_output output;
      std::int64_t tick = 0;
      if (!newest(output, hand, tick)) return values::nil();
    }
    values::Listed turns;
    for (const double* turn : hand.quaternions) turns.add(values::turn(turn));
    values::Made made;
    made.set("joints", values::places(hand.joints, WH_JOINTS)).set("turns", turns.take());
    made.set("wrist", values::place(hand.wrist)).set("wrist_turn", values::turn(hand.wrist_quaternion));
    return made.take();
  }

  // From now on a thread steps the session, beginning with this position, turn and gap.
  Variant session_start(const Arguments& in) {
    refuse_thread("session_start");
    if (!session_) throw Refused{"session_start: there is no session; call session_open first"};
    thread_ = std::make_unique<SessionThread>(session_, measurement_of(in, 0));
    return values::of(true);
  }

  Variant session_move(const Arguments& in) {
    if (!thread_) throw Refused{"session_move: no thread steps the session; call session_start first"};
    thread_->move(measurement_of(in, 0));
    return values::of(true);
  }

  // What the thread's newest tick gave; null before the first one.
  Variant session_newest(const Arguments&) {
    if (!thread_) throw Refused{"session_newest: no thread steps the session; call session_start first"};
    wh_session_output output;
    wh_hand hand;
    std::int64_t tick = 0;
    return newest(output, hand, tick) ? output_values(output, tick) : values::nil();
  }

  Variant session_stop(const Arguments&) {
    thread_.reset();
    return values::of(true);
  }

  std::string message_;

 private:
  void close() {
    thread_.reset();
    wh_session_free(&session_);
    wh_scene_free(&scene_);
  }

  bool newest(wh_session_output& output, wh_hand& hand, std::int64_t& tick) {
    const std::string failure = thread_->failure();
    if (!failure.empty()) throw Refused{failure};
    return thread_->newest(output, hand, tick);
  }

  void refuse_thread(const char* method) const {
    if (thread_) throw Refused{std::string(method) + ": a thread steps the session; call session_stop first"};
  }

  std::size_t vessel_of(const Arguments& in) const {
    std::size_t index = 0;
    check(wh_scene_find_vessel(scene_, in.text(0).c_str(), &index));
    return index;
  }

  // Reads a grip from a Dictionary with any of these keys: m and rad.
  static wh_grip grip_of(const Arguments& in) {
    wh_grip grip;
    WH_INIT(&grip);
    const values::Sent sent(in.dictionary(1));
    int known = 0;
    const std::pair<const char*, double*> keys[] = {{"height", &grip.height},       {"azimuth", &grip.azimuth},
                                                    {"obliquity", &grip.obliquity}, {"roll", &grip.roll},
                                                    {"offset", &grip.offset},       {"hand_scale", &grip.hand_scale}};
    for (const auto& [key, number] : keys) known += sent.number(key, *number) ? 1 : 0;
    if (known != sent.size())
      throw Refused{"grip: a key is unknown; allowed: height, azimuth, obliquity, roll, offset, hand_scale"};
    return grip;
  }

  static wh_measurement measurement_of(const Arguments& in, int first) {
    wh_measurement measurement;
    WH_INIT(&measurement);
    double turn[4];
    in.place(first, measurement.position);
    in.turn(first + 1, turn);
    rotation_of(turn, measurement.rotation);
    measurement.gap = in.real(first + 2);
    return measurement;
  }

  static Variant output_values(const wh_session_output& out, std::int64_t tick) {
    static const char* const names[] = {"free", "touching", "lift", "tilt", "maintain", "slipped", "released", "let go"};
    // a later library may know more states
    const auto state = static_cast<std::size_t>(out.state);
    const char* name = state < std::size(names) ? names[state] : "other";
    double turn[4];
    quaternion_of(out.vessel_rotation, turn);
    values::Made made;
    made.set("tick", values::of(static_cast<double>(tick))).set("state", values::of(std::string(name)));
    made.set("vessel", values::of(static_cast<int>(out.vessel))).set("arm_force", values::place(out.arm_force));
    made.set("grip_force", values::of(out.grip_force)).set("weight", values::of(out.weight));
    made.set("tilt", values::of(out.tilt)).set("flow", values::of(out.flow)).set("closure", values::of(out.closure));
    made.set("thumb", values::place(out.tips[0])).set("index", values::place(out.tips[1]));
    made.set("grasps", values::of(static_cast<int>(out.grasps))).set("lost", values::of(static_cast<int>(out.lost)));
    if (out.vessel >= 0) made.set("vessel_place", values::place(out.vessel_place)).set("vessel_turn", values::turn(turn));
    return made.take();
  }

  wh_scene* scene_ = nullptr;
  wh_session* session_ = nullptr;
  std::unique_ptr<SessionThread> thread_;  // before the session it steps goes
};

// ---- how Godot calls it ----

struct Entry {
  const char* name;
  int arguments;
  Variant (Wholehand::*call)(const Arguments&);
};

const Entry entries[] = {
    {"open", 1, &Wholehand::open},
    {"message", 0, &Wholehand::message},
    {"version", 0, &Wholehand::version},
    {"joint_names", 0, &Wholehand::joint_names},
    {"vessels", 0, &Wholehand::vessels},
    {"grip", 2, &Wholehand::grip},
    {"grip_json", 2, &Wholehand::grip_json},
    {"session_open", 2, &Wholehand::session_open},
    {"session_period", 0, &Wholehand::session_period},
    {"session_step", 4, &Wholehand::session_step},
    {"session_hand", 0, &Wholehand::session_hand},
    {"session_start", 3, &Wholehand::session_start},
    {"session_move", 3, &Wholehand::session_move},
    {"session_newest", 0, &Wholehand::session_newest},
    {"session_stop", 0, &Wholehand::session_stop},
};

// Nothing that is thrown may reach Godot.
Variant call(godot_api::Object*, void* data, void* user, int count, Variant** all) {
  const Entry& entry = *static_cast<const Entry*>(data);
  auto& self = *static_cast<Wholehand*>(user);
  try {
    if (count != entry.arguments)
      throw Refused{std::string(entry.name) + " takes " + std::to_string(entry.arguments) + " arguments, and got " +
                    std::to_string(count)};
    return (self.*entry.call)(Arguments(entry.name, all));
  } catch (const Refused& refused) {
    self.message_ = refused.line;
  } catch (const std::exception& failure) {
    self.message_ = failure.what();
  }
  values::print_error(self.message_, entry.name);
  return values::nil();
}

const godot_api::NativeScript* native_script = nullptr;

const char* find_script_api(const godot_api::Core& core) {
  for (unsigned k = 0; k < core.extension_count; ++k)
    if (core.extensions[k]->type == godot_api::NATIVESCRIPT && core.extensions[k]->version.major == godot_api::WANTED.major)
      native_script = reinterpret_cast<const godot_api::NativeScript*>(core.extensions[k]);
  return native_script ? nullptr : "this Godot has no NativeScript 1";
}

}  // namespace

#define EXPORTED __attribute__((visibility("default")))

extern "C" {

// Refuses what it was not made for, before it calls any function by its position.
EXPORTED void godot_gdnative_init(const godot_api::InitOptions* options) {
  const godot_api::Core& core = *options->core;
  if (core.head.type != godot_api::CORE || core.head.version.major != godot_api::WANTED.major ||
      core.head.version.minor < godot_api::WANTED.minor) {
    options->report_version_mismatch(options->library, "core", godot_api::WANTED, core.head.version);
    return;
  }
  if (wh_abi() != WH_ABI) {
    options->report_loading_error(options->library, "libwholehand is of another ABI than the plugin was compiled for");
    return;
  }
  if (const char* wrong = find_script_api(core)) {
    options->report_loading_error(options->library, wrong);
    return;
  }
  values::use(godot_api::functions_of(core));
}

EXPORTED void godot_gdnative_terminate(void*) {}

EXPORTED void godot_nativescript_init(void* handle) {
  if (!native_script) return;
  const auto create = [](godot_api::Object*, void*) -> void* { return new (std::nothrow) Wholehand; };
  const auto destroy = [](godot_api::Object*, void*, void* user) { delete static_cast<Wholehand*>(user); };
  native_script->register_class(handle, "Wholehand", "Reference", {create, nullptr, nullptr}, {destroy, nullptr, nullptr});
  for (const Entry& entry : entries)
    native_script->register_method(handle, "Wholehand", entry.name, {0}, {&call, const_cast<Entry*>(&entry), nullptr});
}

}  // extern "C"
