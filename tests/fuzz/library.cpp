// SPDX-License-Identifier: MIT
// Bytes become calls of the C face, in any order and with any arguments that a C program can give: handles that are open, closed or null, structs of
// any size, numbers of any bits, arrays with strides. Whatever comes: a status that the header names, one line where it is not WH_OK, and
// finite forces where it is.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "app/c/wholehand/wholehand.h"
#include "tests/fuzz/must.h"

namespace {

using wholehand::must;

constexpr int CALLS = 24;
constexpr std::ptrdiff_t ODD_STRIDES[] = {8, PTRDIFF_MAX, PTRDIFF_MIN};
constexpr std::size_t MOST_GRIPS = 6;

constexpr std::string_view TEXTS[] = {
    "[[vessel]]\nname = \"a\"\nshape = \"cylinder\"\ndiameter_mm = 70\nheight_mm = 100\nwall_mm = 2\n"
    "liquid = { name = \"w\", fill = 0.5 }\n[liquid]\nfills = [0, 0.5]\n[grips]\nheight_mm = [50]\n[tilts]\ndeg = [0, 90]\n"
    "[strength]\n[device]\ngap_mm = [0, 25]\n",
    "[scene]\npose = \"paper\"\n[hand]\nhandedness = \"left\"\n[[vessel]]\nname = \"a\"\nshape = \"flask\"\ndiameter_mm = 85\n"
    "neck_mm = 34\nheight_mm = 140\nwall_mm = 1.5\n[[vessel]]\nname = \"b\"\nshape = \"cylinder\"\ndiameter_mm = 30\nheight_mm = "
    "90\n"
    "wall_mm = 1\nplace_mm = [300, 0, 0]\n[grips]\nheight_mm = [50]\n",
};

// Bytes as arguments; past their end all are 0.
class Arguments {
 public:
  Arguments(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }
  int of(int count) { return byte() % count; }
  bool rarely() { return byte() > 247; }

  double number(double low, double high) {
    static constexpr double ODD[] = {0.0, -0.0, 1e-300, -1e300, 1e17, 5e-324, INFINITY, -INFINITY, NAN};
    if (rarely()) return ODD[of(9)];
    if (rarely()) {
      std::uint8_t bytes[8];
      for (std::uint8_t& b : bytes) b = byte();
      double value = 0;
      std::memcpy(&value, bytes, sizeof value);
      return value;
    }
    return low + (high - low) * (byte() + 256 * byte()) / 65535.0;
  }

  // What a struct says its size is.
  std::size_t size(std::size_t own) { return rarely() ? static_cast<std::size_t>(of(3)) * own + byte() : own; }

  // A text of the bytes.
  std::string text(std::size_t most) {
    std::string text;
    for (std::size_t k = byte() % (most + 1); k > 0; --k) text += static_cast<char>(byte());
    return text;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

wh_status said(wh_status status) {
  must(status == WH_OK || status == WH_INPUT || status == WH_SYSTEM || status == WH_ARGUMENT, "a status that cannot be here");
  if (status == WH_OK) return status;
  const std::string_view line = wh_message();
  must(!line.empty() && line.size() < 2048, "a failure without a line");
  must(line.find('\n') == std::string_view::npos, "a line that is two");
  return status;
}

// A struct at the end of a page of its own size and not more: sanitizers see what is written beyond the size that it says.
template <class Struct>
class Sized {
 public:
  Sized(Arguments& take, bool may_be_short) : bytes_(sizeof(Struct)), is_null_(take.rarely()) {
    const std::size_t size = take.size(sizeof(Struct));
    // a size that is too large must be refused before anything is read
    if (size < bytes_.size() && may_be_short) bytes_.resize(std::max(size, sizeof(std::size_t)));
    bytes_.shrink_to_fit();
    std::memcpy(bytes_.data(), &size, sizeof size);
  }
  Struct* get() { return is_null_ ? nullptr : reinterpret_cast<Struct*>(bytes_.data()); }
  bool is_whole() const { return bytes_.size() == sizeof(Struct); }
  Struct value() const {
    Struct whole{};
    std::memcpy(&whole, bytes_.data(), bytes_.size());
    return whole;
  }
  template <class Member>
  void set(std::size_t offset, Member value) {
    if (offset + sizeof value <= bytes_.size()) std::memcpy(bytes_.data() + offset, &value, sizeof value);
  }

 private:
  std::vector<std::uint8_t> bytes_;
  bool is_null_;
};

class Program {
 public:
  explicit Program(Arguments& take) : take_(take) {}
  ~Program() {
    for (auto& scene : scenes_) wh_scene_free(&scene);
    for (auto& batch : batches_) wh_batch_free(&batch.handle);
    for (auto& session : sessions_) wh_session_free(&session);
  }

  void call() {
    switch (take_.of(11)) {
      case 0:
        return parse();
      case 1:
        return ask_scene();
      case 2:
        return open_batch();
      case 3:
      case 4:
        return run_batch();
      case 5:
        return ask_grip();
      case 6:
        return open_session();
      case 7:
      case 8:
      case 9:
        return step();
      default:
        return close();
    }
  }

 private:
  struct Batch {
    wh_batch* handle = nullptr;
    std::vector<std::size_t> values;  // of each variable
  };

  wh_scene*& scene() { return scenes_[static_cast<std::size_t>(take_.of(3))]; }

  void parse() {
    wh_scene*& place = scene();
    wh_scene_free(&place);
    std::string text(TEXTS[take_.of(2)]);
    if (take_.rarely()) text = take_.text(200);
    if (take_.rarely()) text.insert(take_.byte() % (text.size() + 1), take_.text(40));
    if (take_.rarely()) text.resize(take_.byte() % (text.size() + 1));
    said(wh_scene_parse(take_.rarely() ? nullptr : text.data(), text.size(), take_.rarely() ? "name" : nullptr, &place));
  }

  void ask_scene() {
    const wh_scene* one = scene();
    std::size_t count = 0;
    said(wh_scene_vessels(one, &count));
    Sized<wh_vessel> vessel(take_, true);
    said(wh_scene_vessel(one, take_.byte(), vessel.get()));
    said(wh_scene_vessel(one, 0, vessel.get()));
    const std::string name = take_.text(6);
    said(wh_scene_find_vessel(one, take_.rarely() ? nullptr : name.c_str(), take_.rarely() ? nullptr : &count));
    std::vector<double> room(take_.byte() % 4);
    room.shrink_to_fit();
    said(wh_scene_fills(one, take_.byte() % 3, room.data(), room.size(), &count));
    said(wh_scene_tilts(one, room.data(), room.size(), take_.rarely() ? nullptr : &count));
    said(wh_variable_values(one, name.c_str(), &count));
    Sized<wh_variable> variable(take_, true);
    said(wh_variable_at(take_.byte(), variable.get()));
    wh_joint_name(static_cast<std::int8_t>(take_.byte()));
  }

  void open_batch() {
    Batch& batch = batches_[static_cast<std::size_t>(take_.of(2))];
    wh_batch_free(&batch.handle);
    batch.values.clear();
    const wh_scene* one = scene();
    std::vector<std::string> names;
    for (int k = take_.of(5); k > 0; --k) {
      wh_variable variable;
      WH_INIT(&variable);
      const bool is_known = !take_.rarely() && wh_variable_at(take_.byte() % wh_variables(), &variable) == WH_OK;
      names.push_back(is_known ? variable.name : take_.text(8));
    }
    std::vector<const char*> pointers;
    for (const std::string& name : names) pointers.push_back(name.c_str());
    if (take_.rarely() && !pointers.empty()) pointers[0] = nullptr;
    const char* on = take_.of(2) ? "core" : nullptr;  // another name would load every driver
    if (said(wh_batch_open(one, pointers.data(), pointers.size(), on, take_.of(2), take_.rarely() ? -1 : 1, &batch.handle)) !=
        WH_OK) {
      must(!batch.handle, "a batch that could not be opened");
      return;
    }
    for (const std::string& name : names) {
      std::size_t values = 0;
      must(wh_variable_values(one, name.c_str(), &values) == WH_OK && values > 0, "a variable of a batch that the scene lacks");
      batch.values.push_back(values);
    }
  }

  std::array<double, WH_GRIP_COLUMNS> numbers() {
    return {take_.number(-0.05, 0.2), take_.number(-7, 7),       take_.number(-1.6, 1.6),
            take_.number(-7, 7),      take_.number(-0.05, 0.05), take_.of(2) ? 1 : take_.number(0, 3)};
  }

  void run_batch() {
    Batch& batch = batches_[static_cast<std::size_t>(take_.of(2))];
    const std::size_t count = take_.byte() % (MOST_GRIPS + 1), stride = WH_GRIP_COLUMNS + static_cast<std::size_t>(take_.of(2));
    std::vector<double> grips(count * stride);
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = numbers();
      std::copy(row.begin(), row.end(), grips.begin() + static_cast<std::ptrdiff_t>(i * stride));
    }
    std::vector<std::vector<std::uint8_t>> rooms;
    std::vector<wh_output> outputs;
    for (const std::size_t values : batch.values) {
      wh_output output;
      WH_INIT(&output);
      output.type = take_.rarely() ? static_cast<std::int8_t>(take_.byte()) : take_.of(3);
      const std::size_t size = output.type == WH_DOUBLE ? 8 : 4;
      // packed, plane after plane, or with a gap
      const int order = take_.of(3);
      const std::size_t grip = order == 1 ? size : size * values + (order == 2 ? 3 : 0), value = order == 1 ? size * count : size;
      rooms.emplace_back(count * values == 0 ? 0 : (count - 1) * grip + (values - 1) * value + size);
      rooms.back().shrink_to_fit();
      if (order != 0) {
        output.grip_stride = static_cast<std::ptrdiff_t>(grip);
        output.value_stride = static_cast<std::ptrdiff_t>(value);
      }
      output.data = take_.rarely() ? nullptr : rooms.back().data();
      output.size = take_.size(sizeof output);
      outputs.push_back(output);
    }
    const std::size_t given = outputs.size() - (take_.rarely() && !outputs.empty() ? 1 : 0);
    said(wh_batch_run(batch.handle, take_.rarely() ? take_.byte() : 0, take_.rarely() ? nullptr : grips.data(), count,
                      take_.rarely() ? ODD_STRIDES[take_.of(3)] : static_cast<std::ptrdiff_t>(stride * sizeof(double)),
                      outputs.data(), given));
    const char* device = nullptr;
    said(wh_batch_notes(batch.handle, &device));
    said(wh_batch_device(batch.handle, &device));
  }

  void ask_grip() {
    const wh_scene* one = scene();
    Sized<wh_grip> grip(take_, true);
    const auto row = numbers();
    for (std::size_t k = 0; k < row.size(); ++k) grip.set(offsetof(wh_grip, height) + k * sizeof(double), row[k]);
    Sized<wh_grip_result> result(take_, true);
    const std::size_t vessel = take_.rarely() ? take_.byte() : 0;
    const wh_status status = said(wh_grip_evaluate(one, vessel, grip.get(), result.get()));
    if (status == WH_OK && result.is_whole()) {
      const wh_grip_result found = result.value();
      must(found.score >= 0 && found.score <= 1, "a score out of its range");
      for (const auto& point : found.proxies)
        must(std::isfinite(point[0]) == (found.is_feasible == 1), "a joint that should not be");
    }
    Sized<wh_grip_state> state(take_, true);
    said(wh_grip_hold(one, vessel, grip.get(), take_.number(0, 1), take_.number(0, 3.2), state.get()));
    char* text = nullptr;
    if (take_.of(4) > 0) return;
    const bool has_text = said(wh_grip_json(one, vessel, grip.get(), &text)) == WH_OK;
    must(has_text == (text != nullptr) && (!text || std::strlen(text) > 100), "a text that is missing");
    wh_text_free(&text);
  }

  void open_session() {
    wh_session*& place = sessions_[static_cast<std::size_t>(take_.of(2))];
    wh_session_free(&place);
    tick_ = 0;
    said(wh_session_open(scene(), take_.number(0, 0.01), take_.number(0.02, 0.2), &place));
    double period = 0;
    if (said(wh_session_period(place, &period)) == WH_OK) must(period > 0 && period < 0.01, "a period out of its range");
  }

  void step() {
    wh_session* session = sessions_[static_cast<std::size_t>(take_.of(2))];
    for (int k = take_.of(8); k >= 0; --k) {
      Sized<wh_measurement> in(take_, true);
      tick_ += take_.rarely() ? static_cast<std::int8_t>(take_.byte()) : 1 + 100 * static_cast<std::int64_t>(take_.rarely());
      in.set(offsetof(wh_measurement, tick), take_.rarely() ? INT64_MAX : tick_);
      for (std::size_t c = 0; c < 3; ++c)
        in.set(offsetof(wh_measurement, position) + c * sizeof(double), take_.number(c == 1 ? 0 : -0.1, 0.1));
      if (take_.rarely())
        for (std::size_t c = 0; c < 9; ++c) in.set(offsetof(wh_measurement, rotation) + c * sizeof(double), take_.number(-1, 1));
      in.set(offsetof(wh_measurement, gap), take_.number(0, 0.1));
      Sized<wh_session_output> out(take_, true);
      if (said(wh_session_step(session, in.get(), out.get())) != WH_OK || !out.is_whole()) continue;
      const wh_session_output reported = out.value();
      for (const double force :
           {reported.arm_force[0], reported.arm_force[1], reported.arm_force[2], reported.grip_force, reported.weight})
        must(std::isfinite(force), "a force that is not finite");
      must(reported.state >= WH_FREE && reported.state <= WH_LET_GO, "a state that cannot be");
    }
    Sized<wh_hand> hand(take_, true);
    if (said(wh_session_hand(session, hand.get())) == WH_OK && hand.is_whole()) {
      const wh_hand seen = hand.value();
      for (const auto& joint : seen.joints)
        for (const double x : joint) must(std::isfinite(x), "a joint that is not finite");
    }
    Sized<wh_session_vessel> vessel(take_, true);
    said(wh_session_vessel_at(session, take_.byte() % 3, vessel.get()));
  }

  void close() {
    switch (take_.of(3)) {
      case 0:
        return wh_scene_free(take_.rarely() ? nullptr : &scene());
      case 1:
        return wh_batch_free(&batches_[static_cast<std::size_t>(take_.of(2))].handle);
      default:
        return wh_session_free(&sessions_[static_cast<std::size_t>(take_.of(2))]);
    }
  }

  Arguments& take_;
  std::array<wh_scene*, 3> scenes_{};
  std::array<Batch, 2> batches_{};
  std::array<wh_session*, 2> sessions_{};
  std::int64_t tick_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Arguments take(data, size);
  Program program(take);
  for (int k = 0; k < CALLS; ++k) program.call();
  return 0;
}
