// SPDX-License-Identifier: MIT
#include "evidence/check/error_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/effort.h"
#include "core/planes.h"

namespace wholehand {
namespace {

constexpr double LARGEST_LATTICES = 1 << 30;  // bytes of all vessels' lattices, were they cubes
constexpr const char* VARIANT_POSES[] = {"articulated", "paper", "rigged"};

// A backend in a precision, with what it is called.
struct VariantSide {
  bool on_core = true;
  Precision precision = Precision::full;
  int threads = 0;
  std::string name;
};

class VariantList {
 public:
  VariantList(const Scene& scene, const VariantChoice& choice) : scene_(scene), choice_(choice) {
    const auto threads = [](int n) { return fmt::format("{} thread{}", n, n == 1 ? "" : "s"); };
    core_ = {true, Precision::full, choice.threads, "core double"};
    core_float_ = {true, Precision::single, choice.threads, "core float"};
    const auto add_side = [&](const VariantSide& side, int n) {
      VariantSide one = side;
      one.threads = n;
      add(one, one.on_core ? threads(n) : "");
    };
    add_side(core_, choice.threads);
    if (choice.threads > 1) add_side(core_, 1);
    add_side(core_float_, choice.threads);
    if (choice.threads > 1 && !choice.quick) add_side(core_float_, 1);
    if (choice.device) {
      device_.push_back({false, Precision::single, 0, "Vulkan float"});
      if (choice.device_double) device_.push_back({false, Precision::full, 0, "Vulkan double"});
    }
    for (const VariantSide& side : device_)
      if (choice.device_outlines) add_side(side, 0);
    tolerances();
    steps();
    gap_tables();
    points();
    effort_tolerances();
    lattices();
    pipelines();
    questions();
  }

  std::vector<ErrorVariant> take() { return std::move(variants_); }

 private:
  bool quick() const { return choice_.quick; }
  bool has_states() const { return scene_.liquid.has_value() && !scene_.tilts.empty(); }

  // The sides that read outlines.
  std::vector<VariantSide> with_outlines(bool with_core_float, bool with_device_double) const {
    std::vector<VariantSide> sides{core_};
    if (with_core_float) sides.push_back(core_float_);
    for (const VariantSide& side : device_)
      if (choice_.device_outlines && (with_device_double || side.precision == Precision::single)) sides.push_back(side);
    return sides;
  }

  ErrorVariant& add(const VariantSide& side, const std::string& what) {
    ErrorVariant variant;
    variant.name = what.empty() ? side.name : side.name + ": " + what;
    variant.on_core = side.on_core;
    variant.precision = side.precision;
    variant.threads = side.threads;
    variants_.push_back(variant);
    return variants_.back();
  }

  void tolerances() {
    for (const VariantSide& side : with_outlines(!quick(), !quick())) {
      for (int digits = 3; digits <= 9; ++digits) {
        const bool single = side.precision == Precision::single;
        // the named one is the default; float distances of 0.1 m are 7 nm apart
        if (digits == (single ? 6 : 9) || (single && digits > 7)) continue;
        if (quick() && (digits % 2 == 0 || (!side.on_core && digits != 5))) continue;
        ErrorVariant& variant = add(side, fmt::format("tolerance 1e-{} m", digits));
        variant.options.stop_tolerance = std::stod(fmt::format("1e-{}", digits));
        variant.axis = SweptAxis::tolerance;
        variant.step = variant.options.stop_tolerance;
      }
    }
  }

  void steps() {
    for (const VariantSide& side : with_outlines(false, false)) {
      for (const int steps : {8, 16, 32, 64, 256}) {
        const bool wanted = quick() ? side.on_core && (steps == 16 || steps == 64) : side.on_core || steps == 16 || steps == 64;
        if (!wanted) continue;
        ErrorVariant& variant = add(side, fmt::format("{} steps", steps));
        variant.options.trace_steps = variant.options.advance_steps = steps;
      }
    }
  }

  void gap_tables() {
    for (const VariantSide& side : with_outlines(false, false)) {
      for (const int entries : {17, 65, 257, 1025}) {
        const bool wanted = quick() ? side.on_core && (entries == 65 || entries == 257) : side.on_core || entries == 257;
        if (!wanted) continue;
        ErrorVariant& variant = add(side, fmt::format("gap table {}", entries));
        variant.options.gap_table = entries;
        variant.axis = SweptAxis::gap_table;
        variant.step = 1.0 / (entries - 1);
      }
    }
  }

  void points() {
    if (!has_states()) return;
    for (const VariantSide& side : with_outlines(false, false)) {
      for (const int points : {2, 4, 8, 16, 64}) {
        const bool wanted = quick() ? side.on_core && points != 2 : side.on_core || points == 4 || points == 8 || points == 64;
        if (!wanted) continue;
        ErrorVariant& variant = add(side, fmt::format("liquid {} points", points));
        variant.options.quadrature_points = points;
        variant.axis = SweptAxis::points;
        variant.step = 1.0 / points;
      }
    }
  }

  // The tolerance of the efforts, 1e-3 among them: the others are read beside it. Rounding of single precision is beyond 1e-5.
  void effort_tolerances() {
    if (!has_effort(scene_)) return;
    for (const VariantSide& side : with_outlines(false, !quick())) {
      for (const int digits : {1, 2, 3, 5}) {
        if ((digits == 5 && side.precision == Precision::single) || (quick() && !side.on_core && digits != 1)) continue;
        ErrorVariant& variant = add(side, fmt::format("effort tolerance 1e-{}", digits));
        variant.options.effort_tolerance = std::stod(fmt::format("1e-{}", digits));
        variant.axis = SweptAxis::effort;
        variant.step = variant.options.effort_tolerance;
      }
    }
  }

  void lattices() {
    std::vector<VariantSide> sides{core_};
    for (const VariantSide& side : device_)
      if (side.precision == Precision::single || !quick()) sides.push_back(side);
    for (const int samples : {32, 64, 128, 256}) {
      if (quick() && samples > 128) continue;
      for (const int bits : {32, 16}) {
        if (static_cast<double>(scene_.vessels.size()) * std::pow(samples, 3) * bits / 8 > LARGEST_LATTICES) continue;
        for (const VariantSide& side : sides) {
          if (quick() && bits == 16 && (!side.on_core || samples != 64)) continue;
          if (quick() && !side.on_core && samples == 32) continue;
          ErrorVariant& variant = add(side, fmt::format("grid {}^3 x {} bits", samples, bits));
          variant.options.lattice_samples = samples;
          variant.options.lattice_bits = bits;
          variant.axis = bits == 32 ? SweptAxis::lattice : SweptAxis::none;
          variant.step = 1.0 / (samples - 5);  // cells between the lattice's margins
        }
      }
    }
  }

  // What the device's pipelines carry of the outline.
  void pipelines() {
    if (!choice_.device_outlines || !choice_.outline_copies) return;
    for (const VariantSide& side : device_) {
      if (quick() && side.precision == Precision::full) continue;
      ErrorVariant& buffer = add(side, "outline from a buffer");
      buffer.outline = OUTLINE_BUFFER;
      buffer.left_out = "the copied outline";
    }
  }

  void question(const Scene& scene, const std::string& what, const std::string& left_out, Comparable comparable) {
    const auto shared = std::make_shared<const Scene>(scene);
    for (const VariantSide& side : with_outlines(false, false)) {
      if (quick() && !side.on_core && !comparable.pose) continue;  // their pipelines compile for seconds
      ErrorVariant& variant = add(side, what);
      variant.scene = shared;
      variant.left_out = left_out;
      variant.comparable = comparable;
    }
  }

  // Other questions to the same grips: what the parts of a scene cost in time.
  void questions() {
    for (const Pose pose : {Pose::articulated, Pose::paper, Pose::rigged}) {
      if (pose == scene_.pose || (quick() && pose == Pose::paper)) continue;
      Scene other = scene_;
      other.pose = pose;
      const std::string name = VARIANT_POSES[static_cast<int>(pose)];
      question(other, "pose " + name, pose == Pose::rigged ? "projection" : "+ pose " + name, {false, true, true});
    }
    const bool walled = std::all_of(scene_.vessels.begin(), scene_.vessels.end(), [](const VesselData& v) { return v.wall > 0; });
    const bool solid =
        std::any_of(scene_.vessels.begin(), scene_.vessels.end(), [](const VesselData& v) { return v.surface == Surface::solid; });
    if (walled) {
      Scene other = scene_;
      for (VesselData& vessel : other.vessels) vessel.surface = solid ? Surface::shell : Surface::solid;
      question(other, solid ? "shell" : "solid", solid ? "+ inner wall" : "inner wall", {false, true, false});
    }
    if (scene_.tilts.empty()) return;
    if (scene_.liquid) {
      Scene other = scene_;
      other.liquid.reset();
      question(other, "without liquid", "liquid", {true, false, true});
      if (quick()) return;
      other.tilts.clear();
      question(other, "without tilts", "liquid, tilts and forces", {true, false, true});
    } else if (walled) {
      Scene other = scene_;
      other.liquid = LiquidData{};
      other.liquid->fills = {0, 0.25, 0.5, 0.75, 1};
      question(other, "with liquid", "+ liquid", {true, false, true});
    }
  }

  const Scene& scene_;
  const VariantChoice& choice_;
  VariantSide core_, core_float_;
  std::vector<VariantSide> device_;
  std::vector<ErrorVariant> variants_;
};

}  // namespace

double ErrorVariant::stop_tolerance() const {
  if (options.stop_tolerance > 0) return options.stop_tolerance;
  return precision == Precision::single ? STOP_TOLERANCE_F32 : STOP_TOLERANCE_F64;
}

double ErrorVariant::effort_tolerance() const {
  return options.effort_tolerance > 0 ? options.effort_tolerance : core_f64::EFFORT_TOLERANCE;
}

EvaluatorOptions reference_options() {
  EvaluatorOptions options;
  options.quadrature_points = 64;
  options.stop_tolerance = 1e-12;  // a few thousand roundings of a distance
  options.trace_steps = options.advance_steps = 100000;
  options.effort_tolerance = 1e-7;  // a hundredth of the finest variant's
  return options;
}

std::vector<ErrorVariant> error_variants(const Scene& scene, const VariantChoice& choice) {
  return VariantList(scene, choice).take();
}

}  // namespace wholehand
