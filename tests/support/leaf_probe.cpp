// SPDX-License-Identifier: MIT
#include "tests/support/leaf_probe.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/touch.h"
#include "tests/shaders/probe_shaders.h"
#include "tests/shaders/probe_table.h"

namespace wholehand {
namespace {

host::Buffer upload(const host::Device& device, Precision precision, std::vector<double> values, std::size_t least = 4) {
  values.resize(std::max(values.size(), least));  // a binding that a shader names must be there
  if (precision == Precision::full) return host::Buffer::of(device, values);
  return host::Buffer::of(device, std::vector<float>(values.begin(), values.end()));
}

std::span<const std::uint32_t> find_probe(std::string_view name, Precision precision, OutlineSource source) {
  for (const EmbeddedShader& shader : probe_shaders())
    if (shader.name == name && shader.precision == (precision == Precision::full ? 1 : 0) &&
        (shader.outline_source == OUTLINE_NONE || shader.outline_source == source))
      return shader.words;
  throw std::runtime_error("no probe " + std::string(name));
}

}  // namespace

LeafProbe::LeafProbe(const host::Device& device, const Scene& scene, std::size_t v, Precision precision, OutlineSource source,
                     int lattice_samples, int lattice_bits)
    : device_(device), precision_(precision), source_(source) {
  EvaluatorOptions options;
  options.lattice_samples = lattice_samples;
  options.lattice_bits = lattice_bits;
  const auto core = make_core_evaluator(scene, options);
  const host::SceneArrays arrays = host::make_scene_arrays(scene, *core, options);
  const host::VesselArrays& vessel = arrays.vessels[v];
  if (precision == Precision::full) {
    parameters_ = host::Buffer::of(device, std::vector<Parameters<double>>{vessel.parameters});
  } else {
    parameters_ = host::Buffer::of(device, std::vector<Parameters<float>>{host::convert<float>(vessel.parameters)});
  }
  hand_ = upload(device, precision, arrays.hand);
  outline_ = upload(device, precision, vessel.outline, std::size_t(OUTLINE_STRIDE) * MAX_OUTLINE);
  lattice_ = host::Buffer::of(device, vessel.lattice ? *vessel.lattice : std::vector<std::uint32_t>(4));
  constants_ = {{CONST_SDF_KIND, std::int32_t(vessel.lattice ? SDF_LATTICE : SDF_OUTLINE)},
                {CONST_LATTICE_BITS, std::int32_t(lattice_bits)},
                {CONST_OUTLINE_COUNT, std::int32_t(vessel.outline_count)},
                {CONST_TABLE, std::int32_t(scene.table ? 1 : 0)},
                {CONST_ARM, std::int32_t(arm_azimuths(scene, scene.vessels[v]))}};
}

std::vector<double> LeafProbe::run(std::string_view shader, int probe, const std::vector<double>& given, std::size_t rows,
                                   int inputs, int outputs) const {
  std::vector<host::Constant> constants = constants_;
  constants.push_back({CONST_PROBE, std::int32_t(probe)});
  const host::Kernel kernel(device_, find_probe(shader, precision_, source_), constants, std::string(shader));
  const std::size_t numbers = rows * static_cast<std::size_t>(outputs);
  const host::Buffer in = upload(device_, precision_, given),
                     out = upload(device_, precision_, std::vector<double>(numbers, -1e30));
  host::Commands commands;
  commands.bind(BINDING_PARAMETERS, parameters_);
  commands.bind(BINDING_HAND, hand_);
  commands.bind(BINDING_OUTLINE, outline_);
  commands.bind(BINDING_LATTICE, lattice_);
  commands.bind(BINDING_GRIPS, in);
  commands.bind(BINDING_REAL_OUT, out);
  commands.dispatch(
      kernel, host::groups_for(device_, kernel, rows),
      Push{static_cast<std::uint32_t>(rows), static_cast<std::uint32_t>(inputs), 0, static_cast<std::uint32_t>(outputs)});
  host::run_once(device_, commands);
  if (precision_ == Precision::full) return out.read_as<double>(numbers);
  const auto values = out.read_as<float>(numbers);
  return {values.begin(), values.end()};
}

}  // namespace wholehand
