// SPDX-License-Identifier: MIT
#include "tests/support/fake_backend.h"

#include <algorithm>
#include <bit>

#include "base/numbers/random_bits.h"
#include "core/candidates.h"
#include "tests/support/special_values.h"

namespace wholehand {
namespace {

std::uint64_t hash(std::size_t vessel, const GripInput& grip, int salt) {
  std::uint64_t h = mixed_bits(SPLIT_MIX_STEP * (vessel + 1) + static_cast<std::uint64_t>(salt));
  for (const double value : {grip.height, grip.azimuth, grip.obliquity, grip.roll, grip.offset, grip.hand_scale}) {
    h = mixed_bits(h ^ std::bit_cast<std::uint64_t>(value));
  }
  return h;
}

std::uint32_t fake_reason(std::size_t vessel, const GripInput& grip) {
  const std::uint64_t h = hash(vessel, grip, 1000);
  return h % 5 == 0 ? REASON_DEGENERATE + static_cast<std::uint32_t>(h / 5 % 6) : REASON_NONE;
}

}  // namespace

Axis range_axis(double from, double to, int count) {
  Axis axis{{}, true};
  for (int i = 0; i < count; ++i) axis.values.push_back(count > 1 ? from + (to - from) * i / (count - 1) : from);
  return axis;
}

Scene fake_scene() {
  Scene scene;
  scene.name = "fake";
  scene.file = "fake.toml";
  scene.text = "# not read\nname = \"fake\"\n";
  for (const char* name : {"first vessel", "second"}) {
    VesselData vessel;
    vessel.name = name;
    vessel.height = scene.vessels.empty() ? 0.11 : 0.14;
    vessel.outline.resize(3);
    scene.vessels.push_back(vessel);
  }
  scene.liquid = LiquidData{};
  scene.liquid->fills = {0, 0.5};
  scene.tilts = {0, radians(30), radians(60), radians(90)};
  scene.grips.azimuth = range_axis(0, radians(90), 3);
  scene.grips.height = range_axis(0.1, 0.9, 7);
  scene.grips.obliquity = range_axis(radians(-20), radians(20), 5);
  scene.grips.roll = range_axis(radians(-90), radians(30), 4);
  scene.grips.offset.values = {0, 5e-3};
  scene.output.best = 6;
  scene.output.apart = 0;
  return scene;
}

double fake_real(std::size_t vessel, const GripInput& grip, int field, int plane) {
  const bool feasible = fake_reason(vessel, grip) == REASON_NONE;
  if (field == FIELD_SCORE || field == FIELD_TERMS) {
    if (!feasible) return 0;
    if (field == FIELD_SCORE && (fake_uint(vessel, grip, FIELD_STATUS) & STATUS_PLAUSIBLE) == 0) return 0;
  } else if (!feasible) {
    return NOT_A_NUMBER;
  }
  // 24 bits: the same in both precisions
  return static_cast<double>(hash(vessel, grip, field * 512 + plane) >> 40) * 0x1p-24;
}

std::uint32_t fake_uint(std::size_t vessel, const GripInput& grip, int field) {
  const std::uint64_t h = hash(vessel, grip, field * 512);
  const std::uint32_t reason = fake_reason(vessel, grip);
  if (field == FIELD_STATUS) {
    if (reason != REASON_NONE) return reason;
    return (h % 4 != 0 ? STATUS_PLAUSIBLE : 0u) | (h % 3 != 0 ? STATUS_ANTIPODAL : 0u) |
           (static_cast<std::uint32_t>(h >> 32) & 0x1Fu) << STATUS_BLOCKED_SHIFT;
  }
  if (reason != REASON_NONE) return 0;
  return static_cast<std::uint32_t>(h) & (field == FIELD_USED_MASK ? 0x1Fu : 0xFFFFFFu);
}

std::optional<PosedHand> fake_hand(std::size_t vessel, const GripInput& grip) {
  if (fake_reason(vessel, grip) != REASON_NONE) return std::nullopt;
  PosedHand hand;
  for (int j = 0; j < JOINT_COUNT; ++j) hand[j] = {grip.height + grip.offset + 0.01 * j, grip.obliquity, grip.roll};
  return hand;
}

std::optional<PosedHand> FakeEvaluator::posed(std::size_t vessel, const GripInput& grip) const { return fake_hand(vessel, grip); }

LiquidResult FakeEvaluator::liquid(std::size_t vessel, double fill, double tilt) const {
  const double volume = fill * capacity(vessel) * (1 - tilt / 10);
  return {volume, volume * 1000, 0.01 * tilt, 0.02 + fill, fill * capacity(vessel) - volume};
}

double FakeEvaluator::pouring_tilt(std::size_t, double fill) const { return fill > 0 ? 1 - fill / 2 : NOT_A_NUMBER; }

void FakeEvaluator::planes(std::size_t vessel, const GripInput* grips, std::size_t count, const FieldSet& fields,
                           std::size_t stride, double* reals, std::uint32_t* uints, double) const {
  if (before_chunk) before_chunk();
  for (int field = 0; field < FIELDS; ++field) {
    if (!fields.has(field)) continue;
    const int planes = field_planes(field, scene_fills(scene_), scene_.tilts.size());
    for (std::size_t i = 0; i < count; ++i) {
      for (int p = 0; p < planes; ++p) {
        const std::size_t at = static_cast<std::size_t>(fields.plane[field] + p) * stride + i;
        if (field < REAL_FIELDS) {
          reals[at] = fake_real(vessel, grips[i], field, p);
        } else {
          uints[at] = fake_uint(vessel, grips[i], field);
        }
      }
    }
  }
}

FakeBackend::FakeBackend(const Scene& scene, const FieldSet& fields, Precision precision, std::size_t chunk)
    : info_{"fake", "fake device", "fake driver 1", precision, true},
      scene_(scene),
      fields_(fields),
      chunk_(chunk),
      evaluator_(scene) {}

RunResult FakeBackend::run(const RunRequest& request) {
  if (before_run) before_run();
  RunResult result;
  BestCandidates best(request.best);
  const std::size_t stride = chunk_ + 3;  // not the count
  std::vector<GripInput> grips(chunk_);
  std::vector<double> reals(fields_.real_planes * stride);
  std::vector<std::uint32_t> uints(fields_.uint_planes * stride);
  for (std::uint64_t first = request.first; first < request.last; first += chunk_) {
    if (request.stop && request.stop->load()) break;
    if (before_chunk) before_chunk();
    const std::size_t count = std::min<std::uint64_t>(chunk_, request.last - first);
    request.grips(request.vessel, first, count, grips.data());
    evaluator_.planes(request.vessel, grips.data(), count, fields_, stride, reals.data(), uints.data(), NO_LEAST_SCORE);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t status = fake_uint(request.vessel, grips[i], FIELD_STATUS);
      const bool eligible = (status & STATUS_REASON_MASK) == REASON_NONE && (status & STATUS_PLAUSIBLE) != 0;
      if (eligible) best.offer({fake_real(request.vessel, grips[i], FIELD_SCORE, 0), first + i});
    }
    // the kept planes alone, in memory of their own size
    const std::vector<std::uint32_t> kept_uints(uints.begin(),
                                                uints.begin() + static_cast<std::ptrdiff_t>(fields_.uint_kept * stride));
    const std::vector<double> kept(reals.begin(), reals.begin() + static_cast<std::ptrdiff_t>(fields_.real_kept * stride));
    const std::vector<float> floats(kept.begin(), kept.end());
    PlaneChunk chunk{request.vessel, first, count, stride, nullptr, nullptr, kept_uints.data()};
    if (info_.precision == Precision::single) {
      chunk.floats = floats.data();
    } else {
      chunk.doubles = kept.data();
    }
    if (request.sink) request.sink(chunk);
    result.done += count;
    ++result.chunks;
    evaluated += count;
  }
  result.best = best.sorted();
  return result;
}

std::vector<LiquidResult> FakeBackend::liquid(std::size_t vessel) {
  std::vector<LiquidResult> table;
  if (!scene_.liquid) return table;
  for (const double fill : vessel_fills(scene_, scene_.vessels[vessel])) {
    for (const double tilt : scene_.tilts) table.push_back(evaluator_.liquid(vessel, fill, tilt));
  }
  return table;
}

}  // namespace wholehand
