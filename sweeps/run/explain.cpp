// SPDX-License-Identifier: MIT
#include "sweeps/run/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/system/clock.h"
#include "base/system/progress.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/core_backend.h"
#include "core/counted_tilts.h"
#include "core/gather.h"
#include "host/grip_backend.h"
#include "sweeps/grips/holding.h"
#include "sweeps/grips/report.h"
#include "sweeps/lists/robust.h"
#include "sweeps/plan/variables.h"

namespace wholehand::sweeps {
namespace {

constexpr std::uint64_t RUNS = 6;           // of each way; the first makes ready
constexpr std::size_t SEARCHED_GRIPS = 64;  // for the figures of the search, at most

// A way to evaluate the sample: its time and its memory for each grip.
struct Measured {
  double seconds = 0;
  std::size_t bytes = 0;
  double noise = 0;  // s, between the shortest runs
};

std::string us(double microseconds) { return fixed_text(microseconds, 3); }

// Additional memory of a grip over the other way, B.
std::string more_bytes(const Measured& way, const Measured& other) {
  return fixed_text(static_cast<double>(way.bytes) - static_cast<double>(other.bytes), 0);
}

class Explainer {
 public:
  Explainer(const Scene& scene, const Plan& plan, const FieldSet& fields, const ExplainOptions& options)
      : scene_(scene), plan_(plan), fields_(fields), options_(options), on_core_(options.on == "core") {
    const std::uint64_t all = plan.grips();
    for (std::uint64_t i = 0; i < options.grips; ++i) sample_.push_back(plan.grip(0, i * all / options.grips % all));
  }

  // Counts the ways first, so that the total time is known when the first is measured.
  std::string run() {
    is_counting_ = true;
    explain();
    progress_.emplace(RUNS * std::exchange(measured_, 0), 0, "runs");
    is_counting_ = false;
    text_.clear();
    return explain();
  }

 private:
  std::string explain() {
    const Measured as_is = measure(scene_, fields_, OUTLINE_COPIED);
    say("what the sweep leaves out, and what this saves per grip (both ways ran on {} of {}; this sweep: {} us, {} B)\n",
        counted(sample_.size(), "grip"), scene_.vessels[0].name, us(microseconds(as_is)), readable_number(as_is.bytes));
    if (!on_core_) {
      if (scene_.vessels[0].mesh) {
        say("  nothing of the outline: the distance comes from the mesh's lattice\n");
      } else if (!host::is_llvmpipe(host::choose_device(host::list_devices(), options_.on))) {
        say("  nothing of the outline: it is read from a buffer\n");
      } else if (longest_outline() <= MAX_OUTLINE) {
        row("reading the outline: copied once a grip", measure(scene_, fields_, OUTLINE_BUFFER), as_is, "from a buffer");
      } else {
        say("  nothing of the outline: it has more than {} elements, so it is read from a buffer or evaluated on the core\n",
            MAX_OUTLINE);
      }
    }
    planes(as_is);
    pose(as_is);
    surface(as_is);
    force(as_is);
    liquid(as_is);
    table(as_is);
    arm(as_is);
    body(as_is);
    efforts(as_is);
    robust();
    poured();
    azimuth();
    return text_;
  }

  template <class... Args>
  void say(fmt::format_string<Args...> format, Args&&... args) {
    append_formatted(text_, format, std::forward<Args>(args)...);
  }

  double microseconds(const Measured& m) const { return m.seconds * 1e6 / static_cast<double>(sample_.size()); }

  void row(const std::string& what, const Measured& with, const Measured& without, const std::string& variant) {
    say("  {:<64} {:>8} us {:>5} B  {}{}\n", what, us(microseconds(with) - microseconds(without)), more_bytes(with, without),
        variant, noise_note(with, without));
  }

  static const char* noise_note(const Measured& with, const Measured& without) {
    return with.seconds - without.seconds < std::max(with.noise, without.noise) ? " (within the noise of these runs)" : "";
  }

  int longest_outline() const {
    std::size_t longest = 0;
    for (const VesselData& vessel : scene_.vessels) longest = std::max(longest, vessel.outline.size());
    return static_cast<int>(longest);
  }

  Measured measure(const Scene& scene, const FieldSet& fields, OutlineSource outline) {
    return measure(scene, fields, outline, on_core_, options_.precision);
  }

  Measured measure(const Scene& scene, const FieldSet& fields, OutlineSource outline, bool on_core, Precision precision) {
    ++measured_;
    if (is_counting_) return {1, 0, 0};
    const double began = monotonic_now();
    std::unique_ptr<Backend> backend;
    Measured result;
    if (on_core) {
      auto core = precision == Precision::full ? make_core_evaluator(scene) : make_core_float_evaluator(scene);
      backend = std::make_unique<CoreBackend>(std::move(core), scene, fields, precision, options_.threads);
      result.bytes = fields.real_planes * sizeof(double) + fields.uint_planes * sizeof(std::uint32_t);
    } else {
      host::GripBackendOptions options;
      options.precision = precision;
      options.outline = outline;
      auto device = std::make_unique<host::GripBackend>(scene, make_core_evaluator(scene), fields, options_.on, options);
      result.bytes = device->bytes_per_grip();
      backend = std::move(device);
    }
    std::vector<double> runs;
    for (std::uint64_t run = 0; run < RUNS; ++run) {
      RunRequest request;
      request.last = sample_.size();
      request.grips = [this](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
        std::copy_n(sample_.begin() + static_cast<std::ptrdiff_t>(first), count, out);
      };
      const double start = monotonic_now();
      backend->run(request);
      const double seconds = monotonic_now() - start;
      progress_->update("explaining", RUNS * (measured_ - 1) + run + 1);
      if (run > 0) runs.push_back(seconds);  // the first compiles
    }
    if (measured_ == 1) announce_time("explaining", (monotonic_now() - began) * static_cast<double>(progress_->total() / RUNS));
    std::sort(runs.begin(), runs.end());
    result.seconds = runs[0];
    result.noise = runs[2] - runs[0];
    return result;
  }

  void planes(const Measured& as_is) {
    const FieldSet every = all_fields(scene_);
    const int computed = fields_.real_planes + fields_.uint_planes, all = every.real_planes + every.uint_planes;
    const int kept = fields_.real_kept + fields_.uint_kept;
    row(fmt::format("{} of {} result planes not computed, {} more not read back", all - computed, all, computed - kept),
        measure(scene_, every, OUTLINE_COPIED), as_is, "every plane kept");
  }

  void pose(const Measured& as_is) {
    if (scene_.pose != Pose::rigged) return;
    Scene other = scene_;
    other.pose = Pose::articulated;
    row("projection of the fingers: the pose is rigged", measure(other, fields_, OUTLINE_COPIED), as_is, "articulated");
  }

  void surface(const Measured& as_is) {
    const VesselData& vessel = scene_.vessels[0];
    if (vessel.mesh || vessel.surface != Surface::solid || !(vessel.wall > 0)) return;
    Scene other = scene_;
    other.vessels[0].surface = Surface::shell;
    row("the inner wall: the vessel is solid to the fingers", measure(other, fields_, OUTLINE_COPIED), as_is, "a shell");
  }

  void force(const Measured& as_is) {
    if (!scene_.tilts.empty()) return;
    Scene other = scene_;
    other.tilts = some_tilts();
    row("the force kernel: the scene has no tilts", measure(other, make_field_set(kept_fields(), other), OUTLINE_COPIED), as_is,
        "31 tilts");
  }

  void liquid(const Measured& as_is) {
    if (scene_.liquid) return;
    if (std::any_of(scene_.vessels.begin(), scene_.vessels.end(), [](const VesselData& v) { return !v.has_cavity(); })) {
      say("  the liquid: a vessel without a wall and a mesh without an inner outline hold no liquid\n");
      return;
    }
    // its forces need tilts: both ways have those of the row above where the scene has none
    Scene dry = scene_;
    if (dry.tilts.empty()) dry.tilts = some_tilts();
    Scene wet = dry;
    wet.liquid = LiquidData{};
    wet.liquid->fills = {0, 0.25, 0.5, 0.75, 1};
    row("the liquid: its states at four of five fills", measure(wet, make_field_set(kept_fields(), wet), OUTLINE_COPIED),
        scene_.tilts.empty() ? measure(dry, make_field_set(kept_fields(), dry), OUTLINE_COPIED) : as_is,
        scene_.tilts.empty() ? "5 fills and 31 tilts" : "5 fills");
  }

  // The cost of keeping the hand above the table: saved in a scene without one, paid in a scene with one. Both ways leave out efforts, because only
  // plausible grips have them, and a table leaves fewer.
  void table(const Measured& as_is) {
    part(as_is, &Scene::table, "the table", "keeping the hand above a table: the scene has no table", "a table");
  }

  // The same of the arm.
  void arm(const Measured& as_is) {
    part(as_is, &Scene::arm, "the arm", "what the wrist has to do: the scene has no arm", "an arm");
  }

  template <class Part>
  void part(Measured as_is, std::optional<Part> Scene::*one, const char* name, const char* lacked, const char* with) {
    Scene other = scene_;
    if (scene_.strength) {
      other.strength.reset();
      as_is = measure(other, make_field_set(kept_fields(), other), OUTLINE_COPIED);
    }
    if (scene_.*one) {
      (other.*one).reset();
      const Measured without = measure(other, make_field_set(kept_fields(), other), OUTLINE_COPIED);
      say("  not left out: {}, which costs {} us and {} B per grip{}\n", name, us(microseconds(as_is) - microseconds(without)),
          more_bytes(as_is, without), noise_note(as_is, without));
      return;
    }
    (other.*one).emplace();
    row(lacked, measure(other, make_field_set(kept_fields(), other), OUTLINE_COPIED), as_is, with);
  }

  // The same for the spheres between the joints. With strengths they press too, and the hand rests elsewhere, so efforts are left out here.
  void body(Measured as_is) {
    Scene other = scene_;
    if (scene_.strength) {
      other.strength.reset();
      as_is = measure(other, make_field_set(kept_fields(), other), OUTLINE_COPIED);
    }
    const int between = scene_.hand.between;
    other.hand.between = between > 0 ? 0 : 2;
    const Measured changed = measure(other, make_field_set(kept_fields(), other), OUTLINE_COPIED);
    if (between == 0) {
      row("spheres between the joints, and fingers in each other", changed, as_is, "2 on a bone");
    } else {
      say("  not left out: {} spheres on each bone, which cost {} us and {} B per grip ({:.2f} x without them)\n", between,
          us(microseconds(as_is) - microseconds(changed)), more_bytes(as_is, changed), as_is.seconds / changed.seconds);
    }
    gaps();
  }

  // How far the skin of a bone is outside of its spheres, where two that are h apart meet.
  void gaps() {
    const HandData& hand = scene_.hand;
    double deepest = 0, length = 0;
    int apart = 0, bones = 0;
    for (int f = 0; f < FINGER_COUNT; ++f) {
      const FingerData& finger = hand.fingers[static_cast<std::size_t>(f)];
      for (std::size_t bone = 0; bone < (f == 0 ? 3u : 4u); ++bone) {
        const double half = hand.scale * finger.segments[bone] / (hand.between + 1) / 2;
        const double radius = hand.scale * std::min(finger.radii[bone], finger.radii[bone + 1]);
        ++bones;
        if (half >= radius) {
          ++apart;
        } else if (const double gap = radius - std::sqrt(radius * radius - half * half); gap > deepest) {
          deepest = gap;
          length = hand.scale * finger.segments[bone];
        }
      }
    }
    if (apart < bones) {
      say("    between two spheres the skin of a bone lies up to {:.2f} mm outside of both (a bone of {:.1f} mm)", deepest * 1e3,
          length * 1e3);
      if (apart > 0) say("; on {} of {} bones the spheres do not meet", apart, bones);
      say("\n");
    } else {
      say("    on none of the bones the spheres meet\n");
    }
  }

  // The same for efforts, and the cost of the search for the worst of them.
  void efforts(const Measured& as_is) {
    if (scene_.tilts.empty()) return;
    Scene other = scene_;
    if (!scene_.strength) {
      other.strength.emplace();
      row("the efforts: the scene has no strengths", measure(other, make_field_set(kept_fields(), other), OUTLINE_COPIED), as_is,
          "[strength]");
      return;
    }
    other.strength.reset();
    const Measured without = measure(other, make_field_set(kept_fields(), other), OUTLINE_COPIED);
    say("  not left out: the efforts, which cost {} us and {} B per grip\n", us(microseconds(as_is) - microseconds(without)),
        more_bytes(as_is, without));
    searches();
  }

  // Plausible grips of the sample, SEARCHED_GRIPS at most.
  std::vector<GripInput> plausible_grips(const Evaluator& core) const {
    std::vector<GripInput> grips;
    for (std::size_t i = 0; i < sample_.size() && grips.size() < SEARCHED_GRIPS;
         i += std::max<std::size_t>(1, sample_.size() / (8 * SEARCHED_GRIPS))) {
      GripResult result;
      core.grip(0, sample_[i], result);
      if (result.reason == Reason::none && result.plausible) grips.push_back(sample_[i]);
    }
    return grips;
  }

  void searches() {
    if (is_counting_) return;
    const auto core = make_core_evaluator(scene_);
    long long states = 0, skipped = 0, pivots = 0, unheld = 0;
    const std::vector<GripInput> grips = plausible_grips(*core);
    for (const GripInput& grip : grips) {
      GripResult result;
      core->grip(0, grip, result);
      const Holding holding(scene_, *core, 0, result, pour_direction(scene_, grip));
      const std::optional<GripHold> hold = holding.over_states();
      states += hold->states;
      skipped += hold->skipped;
      pivots += hold->pivots;
      unheld += hold->worst > 1 ? 1 : 0;
    }
    if (states == 0) return;
    say("    of {} plausible grips the core's search for the worst effort takes {:.2f} pivots a state; {:.0f} % of the states are "
        "passed by once the worst is known\n",
        grips.size(), static_cast<double>(pivots) / static_cast<double>(states),
        100 * static_cast<double>(skipped) / static_cast<double>(states));
    say("    the gate reads the worst effort and costs nothing more: {} of these grips are not held, and nothing judges them "
        "further\n",
        unheld);
  }

  // The core's time for one of some plausible grips of the sample, us; for any grips if none is plausible. Candidates are plausible, and so are
  // nearly all of their deviations.
  double plausible_grip() {
    const FieldSet fields = make_field_set({FIELD_SCORE, FIELD_STATUS}, scene_);
    if (is_counting_) return microseconds(measure(scene_, fields, OUTLINE_COPIED, true, Precision::full));
    const std::shared_ptr<const Evaluator> core = make_core_evaluator(scene_);
    std::vector<GripInput> grips = plausible_grips(*core);
    if (grips.empty()) grips = sample_;
    RunRequest request;
    request.last = grips.size();
    request.grips = [&](std::size_t, std::uint64_t first, std::size_t count, GripInput* out) {
      std::copy_n(grips.begin() + static_cast<std::ptrdiff_t>(first), count, out);
    };
    return CoreBackend(core, scene_, fields, Precision::full, 1).run(request).kernel_seconds * 1e6 /
           static_cast<double>(grips.size());
  }

  // Once a sweep, whatever its grips: the listed ones, each with its deviations.
  void robust() {
    if (!scene_.robust || options_.best == 0) return;
    const std::size_t lists = scene_.vessels.size() * plan_.hand_scales(), count = static_cast<std::size_t>(scene_.robust->count);
    const std::size_t listed = lists * std::min(options_.best, MOST_ROBUST), judged = lists * judged_grips(options_.best);
    const double each = plausible_grip();
    // every candidate is judged at the first part of the deviations
    const double first = 1.0 / FRICTION_LEVELS;
    const auto cost = [&](double grips) { return grips * static_cast<double>(count) * each * 1e-6; };
    const double all = cost(static_cast<double>(judged)), least = first * all + (1 - first) * cost(static_cast<double>(listed));
    say("  not left out: the robust scores by the core, {} us for each deviation. An eighth of {} deviations of {} candidates and "
        "the rest for the {} listed cost about {:.3g} s of processor time a sweep; all would cost {:.3g} s\n",
        us(each), readable_number(count), readable_number(judged), readable_number(listed), least, all);
  }

  // Counted, not measured: a device goes through these states all the same.
  void poured() {
    if (!scene_.until_poured) return;
    const std::size_t tilts = scene_.tilts.size();
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      const std::vector<std::size_t> counted = counted_tilts(scene_, v);
      std::size_t left_out = 0;
      for (const std::size_t count : counted) left_out += tilts - count;
      say("  {} of {} states of {}: their tilts are beyond the one at which {:.6g} of the fill has poured (until_poured)\n",
          readable_number(left_out), readable_number(counted.size() * tilts), scene_.vessels[v].name, *scene_.until_poured);
    }
  }

  static std::vector<double> some_tilts() {
    std::vector<double> tilts;
    for (int k = 0; k <= 30; ++k) tilts.push_back(radians(5.0 * k));
    return tilts;
  }

  std::vector<int> kept_fields() const {
    std::vector<int> kept;
    for (int field = 0; field < FIELDS; ++field)
      if (is_kept(fields_, field)) kept.push_back(field);
    return kept;
  }

  // The number of grips in the sample if every azimuth of the scene were computed.
  void azimuth() {
    if (plan_.copies() < 2) return;
    std::vector<GripInput> turned = sample_;
    const auto& azimuths = scene_.grips.azimuth.values;
    for (std::size_t i = 0; i < turned.size(); ++i) turned[i].azimuth = azimuths[i % azimuths.size()];
    sample_.swap(turned);
    const Measured every = measure(scene_, fields_, OUTLINE_COPIED);
    sample_.swap(turned);
    const std::size_t others = plan_.copies() - 1;
    row(fmt::format("{} of {} azimuths: the vessels are round, so one is enough", readable_number(others),
                    readable_number(plan_.copies())),
        {every.seconds * static_cast<double>(others), every.bytes * others}, {}, "every azimuth");
  }

  const Scene& scene_;
  const Plan& plan_;
  const FieldSet& fields_;
  const ExplainOptions& options_;
  bool on_core_;
  std::vector<GripInput> sample_;
  std::string text_;
  bool is_counting_ = false;    // the ways that explain measures; nothing is measured then
  std::uint64_t measured_ = 0;  // ways
  std::optional<Progress> progress_;
};

}  // namespace

std::string explain_sweep(const Scene& scene, const Plan& plan, const FieldSet& fields, const ExplainOptions& options) {
  return Explainer(scene, plan, fields, options).run();
}

}  // namespace wholehand::sweeps
