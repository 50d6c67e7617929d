// SPDX-License-Identifier: MIT
#include "core/meshes/vessel.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <istream>
#include <limits>
#include <optional>
#include <sstream>

#include "base/files/cache_folder.h"
#include "base/system/output.h"
#include "base/system/progress.h"
#include "base/text/error.h"
#include "base/text/readable.h"
#include "core/load.h"
#include "core/meshes/cache.h"
#include "core/meshes/cavity_finder.h"
#include "core/meshes/check.h"
#include "core/meshes/hints.h"
#include "core/meshes/mesh.h"
#include "core/meshes/sheet.h"

namespace wholehand {
namespace {

// Within how much of the mesh's box a cavity must lie, m: an inner outline is written in rounded millimeters.
constexpr double ROUNDED_OUTLINE = 0.1e-3;

constexpr double OTHER_VOLUME = 0.05;  // of the mesh's: the lattice's volume is then another one, not a coarse one

constexpr double OFF_AXIS = 0.1e-3;  // m: a cavity is about the vessel's axis, to the tenths in which outlines are written

constexpr std::size_t OFF_SCALE_LATTICE = 4u << 20;   // bytes
constexpr double LONG_WORK = 10, LONG_OPEN_WORK = 3;  // s

// Share of the points between axis and wall of a cavity that may be on the other side than the rest, for example where a fillet was left out.
constexpr double OTHER_SIDE = 0.05;
// How far a cavity's wall may be from that of a hollow mesh: m, or a share of its radius if that is more. Cups are drawn with
// rounded numbers.
constexpr double OFF_WALL = 3e-3, OFF_WALL_SHARE = 0.1;
// How far such a wall may be in the glass, m, for the same reason: the liquid would weigh more than there is room for.
constexpr double MOST_IN_WALL = 1e-3;

// A place of a cavity's wall, m, and how far it is from where it should be.
struct WallPlace {
  double off = 0, radius = 0, height = 0;

  void keep_farthest(double away, double r, double y) {
    if (away > off) *this = {away, r, y};
  }
};

std::string place_text(const WallPlace& place) {
  return fmt::format("at a height of {:.4g} mm and a radius of {:.4g} mm", 1e3 * place.height, 1e3 * place.radius);
}

// Calls `visit(radius, height)` at some heights of each piece of a cavity's wall.
template <class Visit>
void for_each_height(const std::vector<PreparedElement>& cavity, const Visit& visit) {
  constexpr int HEIGHTS = 16;
  for (const PreparedElement& piece : cavity)
    for (int h = 0; h < HEIGHTS; ++h) {
      const double y = piece.a[1] + (piece.b[1] - piece.a[1]) * (h + 0.5) / HEIGHTS;
      visit(core_f64::element_radius(core_f64::load_element(piece), y), y);
    }
}

bool is_far(double distance, double radius) { return distance > std::max(OFF_WALL, OFF_WALL_SHARE * radius); }

// How many of the points between axis and wall of a cavity lie within the mesh, by its lattice, and the worst places of the wall.
struct CavityPoints {
  int inside = 0, all = 0;
  int far = 0, wall = 0;  // points of the wall: further from the glass than its inner wall may be; all
  WallPlace deepest;      // in the glass, of the wall and what is within it
  WallPlace farthest;     // from the glass, of the wall
};

CavityPoints count_cavity_points(const PreparedLattice& prepared, const std::vector<PreparedElement>& cavity) {
  const core_f64::Lattice lattice = core_f64::load_lattice(prepared);
  CavityPoints points;
  for_each_height(cavity, [&](double wall, double y) {
    constexpr int AZIMUTHS = 8;
    for (int k = 0; k < AZIMUTHS; ++k) {
      const double azimuth = 2 * PI * (k + 0.5) / AZIMUTHS;
      for (const double share : {0.5, 0.9, 1.0}) {
        const double r = share * wall;
        const double distance = core_f64::lattice_distance(lattice, {r * std::cos(azimuth), y, r * std::sin(azimuth)});
        points.deepest.keep_farthest(-distance, r, y);
        if (share < 1) {
          points.inside += distance < 0;
          continue;
        }
        points.far += is_far(distance, wall);
        points.farthest.keep_farthest(distance, r, y);
      }
      points.all += 2;
      ++points.wall;
    }
  });
  return points;
}

// A hollow mesh's own cavity beside an inner outline that may not be its.
struct OwnCavity {
  CavitySearch search;
  bool is_on_axis = false;  // of the vessel
  WallPlace deepest;        // of the outline, beyond the cavity's profile
  WallPlace farthest;       // from it
  int far = 0, wall = 0;    // heights: where the outline is further from the profile than it may be; all

  // The remedy for an outline that does not fit.
  std::string offer() const {
    if (!search.cavity) return "the mesh itself " + search.refusal;
    const FoundCavity& cavity = *search.cavity;
    if (is_on_axis) return "the mesh's own is inner_outline = " + outline_text(cavity.outline.elements);
    return fmt::format(
        "the mesh has a cavity about another axis, x = {:.4g} and z = {:.4g} mm: `wholehand mesh` finds the keys for it",
        1e3 * cavity.axis[0], std::round(1e7 * cavity.axis[2]) / 1e4 + 0.0);
  }
};

OwnCavity own_cavity(const MeshBody& body, const std::vector<PreparedElement>& outline) {
  OwnCavity own;
  own.search = find_cavity({{body.vertices, body.triangles}, body.facts});
  if (!own.search.cavity) return own;
  const FoundCavity& cavity = *own.search.cavity;
  own.is_on_axis = std::hypot(cavity.axis[0], cavity.axis[2]) <= OFF_AXIS;
  for_each_height(outline, [&](double r, double y) {
    own.deepest.keep_farthest(depth_beyond(cavity.profile, {r, y}), r, y);
    const double away = distance_from(cavity.profile, {r, y});
    own.farthest.keep_farthest(away, r, y);
    own.far += is_far(away, r);
    ++own.wall;
  });
  return own;
}

// Returns a likely mistake in the inner outline although it fits; "" for none.
std::string place_cavity(const VesselData& vessel, MeshBody& body) {
  const std::vector<PreparedElement> cavity = prepare_cavity(vessel);
  double widest = 0, reach = 0;
  for (const PreparedElement& e : cavity) widest = std::max(widest, widest_on(e));
  for (const int k : {0, 2}) reach = std::max({reach, std::abs(body.facts.low[k]), std::abs(body.facts.high[k])});
  const double floor = cavity.front().a[1], mouth = cavity.back().b[1];
  const std::string hint = inner_outline_hint(mouth - floor, widest, body.facts.high[1] - body.facts.low[1], reach);
  const auto refuse = [&](const std::string& what, const OwnCavity& own) {
    throw usage_error(at_place(
        vessel.mesh->place, fmt::format("vessel '{}': {}{}; {}", vessel.name, what, hint.empty() ? "" : "; " + hint, own.offer())));
  };
  if (floor < body.facts.low[1] - ROUNDED_OUTLINE || mouth > body.facts.high[1] + ROUNDED_OUTLINE ||
      widest > reach + ROUNDED_OUTLINE) {
    refuse(fmt::format(
               "the inner outline (heights {:.4g} to {:.4g} mm, radius {:.4g}) reaches beyond the mesh (heights {:.4g} to {:.4g} "
               "mm, {:.4g} from the axis); give it in the vessel's frame",
               1e3 * floor, 1e3 * mouth, 1e3 * widest, 1e3 * body.facts.low[1], 1e3 * body.facts.high[1], 1e3 * reach),
           own_cavity(body, cavity));
  }
  const CavityPoints points = count_cavity_points(body.lattice, cavity);
  const double share = static_cast<double>(points.inside) / points.all;
  if (std::min(share, 1 - share) > OTHER_SIDE) {
    refuse(fmt::format(
               "the inner outline passes through the mesh: {} of {} points well within it are glass, the deepest by {:.3g} mm, {}; "
               "move it where the mesh is hollow, or make the mesh its hull",
               readable_number(points.inside), readable_number(points.all), 1e3 * points.deepest.off, place_text(points.deepest)),
           own_cavity(body, cavity));
  }
  body.holds_cavity = share > 0.5;
  const bool is_far_off = points.far > OTHER_SIDE * points.wall;
  if (!is_far_off && (body.holds_cavity || points.deepest.off <= OUTLINE_TOLERANCE + body.lattice_error)) return hint;
  const OwnCavity own = own_cavity(body, cavity);
  const bool is_known = own.search.cavity && own.is_on_axis;
  if (is_known && own.deepest.off > MOST_IN_WALL)
    refuse(fmt::format("the inner outline reaches {:.3g} mm into the glass, {}", 1e3 * own.deepest.off, place_text(own.deepest)),
           own);
  if (is_known ? own.far > OTHER_SIDE * own.wall : is_far_off) {
    const WallPlace& worst = is_known ? own.farthest : points.farthest;
    refuse(fmt::format(
               "the inner outline is not that of the mesh: it is up to {:.3g} mm from the glass, {}; it is turned about the axis "
               "x = z = 0, which is the middle of the mesh's bounding box unless origin = \"as_is\"",
               1e3 * worst.off, place_text(worst)),
           own);
  }
  return hint;
}

LatticeSpec lattice_spec(const Scene& scene, const MeshData& data, bool is_off_scale, const MeshOptions& options) {
  LatticeSpec spec;
  spec.spacing = data.lattice_spacing;
  spec.margin = lattice_margin(scene);
  // what no hand holds is most likely in another unit: an answer soon, not a fine one
  spec.most_bytes = data.lattice_spacing || !is_off_scale ? options.most_bytes : std::min(options.most_bytes, OFF_SCALE_LATTICE);
  spec.threads = options.threads;
  return spec;
}

int bits_of(const PreparedLattice& lattice) { return lattice.halves ? 16 : 32; }

std::string lattice_text(const MeshBody& body) {
  const double tolerance = LatticeSpec{}.tolerance;
  const PreparedLattice& lattice = body.lattice;
  std::string text = fmt::format(
      "lattice of {:.4g} mm, {} x {} x {} samples of {} bits; at {} points of the surface distances are within {:.2g} mm",
      1e3 * lattice.spacing, lattice.nx, lattice.ny, lattice.nz, bits_of(lattice), readable_number(SURFACE_SAMPLES),
      1e3 * body.lattice_error);
  if (body.lattice_error > tolerance)
    text += fmt::format(", more than the {:.2g} mm aimed at: a smaller grid_mm is more exact, as far as memory allows",
                        1e3 * tolerance);
  return text;
}

// What weighs, and what it holds.
std::string mass_text(const VesselData& vessel, const MeshBody& body) {
  std::string text = vessel.mass ? fmt::format("mass {} g as given", plain_text(1e3 * *vessel.mass, 4))
                                 : fmt::format("mass of its volume{} at {} kg/m3", body.holds_cavity ? ", less the cavity," : "",
                                               plain_text(vessel.density));
  return text + (vessel.has_cavity() ? "; holds liquid in its inner outline"
                                     : "; a solid object, without liquid: it has no inner_outline");
}

// Takes volume and center of mass from the mesh, or from its lattice if triangles do not determine them: they cannot all face outward, a wall ends
// within the body, or bodies overlap, so that the sum over triangles counts some parts twice.
void set_volume(const std::string& name, MeshBody& body) {
  const MeshFacts& facts = body.facts;
  body.volume = facts.volume;
  body.center_of_mass = facts.center_of_mass;
  const EnclosedVolume enclosed = enclosed_volume(body.lattice, facts.area);
  const double off = enclosed.volume - facts.volume;
  if (facts.has_sure_volume() && !(std::abs(off) > OTHER_VOLUME * facts.volume + enclosed.doubt)) return;
  if (enclosed.is_empty)
    throw usage_error(name + ": encloses no place of its lattice, so it has no inside: make one closed body of it");
  body.volume = enclosed.volume;
  body.center_of_mass = enclosed.center;
  body.has_lattice_volume = true;
}

// Why volume and center of mass are those of the lattice.
std::string lattice_volume_text(const VesselData& vessel, const MeshBody& body) {
  const MeshFacts& facts = body.facts;
  const char* cause = !facts.oriented        ? "its triangles cannot all face outward"
                      : facts.odd_edges > 0  ? "a wall or a fin ends on it"
                      : facts.open_edges > 0 ? "its holes leave open what is inside"
                                             : "its bodies overlap";
  return fmt::format("{}: inside it are {}, by the lattice, and these are taken; make one closed body of it{}", cause,
                     filled_text(body.volume, body.center_of_mass), vessel.mass ? "" : ", or give mass_kg");
}

// Shows a status while work runs, and clears it at the end, even after an error.
class StatusLine {
 public:
  explicit StatusLine(bool is_quiet) : is_quiet_(is_quiet) {}
  ~StatusLine() { show(""); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void show(const std::string& line) const {
    if (!is_quiet_) show_status(line);
  }

 private:
  bool is_quiet_;
};

// The scene's reader checks a shape or an outline.
void check_above_table(const Scene& scene, const MeshData& data, const std::string& name, double height) {
  constexpr double ROUNDING = 1e-6;  // of a height, whose vertices were floats
  if (!scene.table || scene.table->clearance < height * (1 - ROUNDING)) return;
  throw usage_error(
      at_place(data.place, fmt::format("{}: its mesh is {:.6g} mm high, and clearance_mm = {:.6g} reaches its top; allowed: "
                                       "a clearance of less than this height",
                                       name, 1e3 * height, 1e3 * scene.table->clearance)));
}

// The lattice of a mesh, with progress, and an announcement of long work.
MeshLattice take_lattice(const CheckedMesh& mesh, const LatticeSpec& spec, const std::string& name, const MeshOptions& options,
                         const StatusLine& status) {
  std::optional<Progress> samples;  // once it is known how many
  const auto progress = [&](double share) {
    const std::string what = name + ": distances to its mesh";
    if (!samples) return status.show(fmt::format("{}  {:.0f} %", what, 100 * share));
    samples->update(what, static_cast<std::uint64_t>(share * static_cast<double>(samples->total())));
  };
  const auto announce = [&](const LatticePlan& plan) {
    if (!options.is_quiet) samples.emplace(std::uint64_t(plan.lattice.nx) * plan.lattice.ny * plan.lattice.nz, 0, "samples");
    if (!plan.finer && !is_long(plan.seconds, mesh.facts.closed)) return;
    status.show("");
    const auto& print_line = options.say ? options.say : options.forecast;
    if (print_line) print_line(name + ": " + forecast_text(plan, mesh.facts.closed));
  };
  return cached_lattice(mesh, spec, options.cache_folder, progress, {announce, options.clock, MOST_LATTICE_SECONDS});
}

void load_mesh(const Scene& scene, VesselData& vessel, const std::string& folder, const MeshOptions& options,
               std::istream& lattices) {
  const MeshData& data = *vessel.mesh;
  const std::string name = fmt::format("vessel '{}'", vessel.name);
  const auto say = [&](const std::string& line) {
    if (options.say && !line.empty()) options.say(name + ": " + line);
  };
  const StatusLine status(options.is_quiet);
  status.show(fmt::format("{}: reading {}", name, data.file));
  TriangleMesh read = read_mesh(data, folder);
  CheckedMesh checked = check_mesh(read, at_place(data.place, data.file), data.close_holes);
  if (data.thickness) checked = thickened(checked, *data.thickness, at_place(data.place, data.file));
  const bool says_what_is_up = read.says_what_is_up;
  read = {};
  status.show("");
  const MeshFacts& facts = checked.facts;
  say(data.file + ": " + mesh_check_text(facts));
  const SizeHint size = mesh_size_hint(facts.size(), data.scale);
  const bool is_turned = says_what_is_up || data.says_up || data.rotate != Triple{};
  say(size.text);
  if (!is_turned) say(posture_hint(checked.mesh, facts));
  check_above_table(scene, data, name, facts.high[1] - facts.low[1]);
  auto body = std::make_shared<MeshBody>();
  LatticeSpec spec = lattice_spec(scene, data, size.is_other_unit, options);
  double spacing = 0;
  int bits = 0;
  if (lattices >> spacing >> bits && spacing > 0 && (bits == 16 || bits == 32)) {
    spec.spacing = spacing;
    spec.bits = bits;
    spec.most_bytes = options.most_bytes;
  }
  cache_limit();  // throws here: a wrong limit is not the fault of grid_mm
  try {
    MeshLattice made = take_lattice(checked, spec, name, options, status);
    status.show("");
    body->lattice = std::move(made.lattice);
    body->lattice_error = made.error;
    body->key = mesh_key(checked, body->lattice);
  } catch (const Error& error) {
    if (error.code != ExitCode::usage) throw;
    throw usage_error(at_place(data.place, name + ": grid_mm: " + error.what()));
  }
  body->facts = facts;
  set_volume(at_place(data.place, data.file), *body);
  if (body->has_lattice_volume) say(lattice_volume_text(vessel, *body));
  body->vertices = std::move(checked.mesh.vertices);
  body->triangles = std::move(checked.mesh.triangles);
  if (vessel.has_cavity()) say(place_cavity(vessel, *body));
  say(lattice_text(*body));
  say(mass_text(vessel, *body));
  vessel.base = facts.low[1];
  vessel.height = facts.high[1];
  vessel.mesh->body = std::move(body);
}

// The file of that name beside `kept_in`; the file itself where nothing keeps it.
std::string beside_of(const std::string& kept_in, const std::string& file) {
  if (kept_in.empty()) return file;
  return (std::filesystem::path(kept_in).parent_path() / std::filesystem::path(file).filename()).string();
}

// The first mesh that is not there, seen from that scene file; "" where all are.
std::string missing_mesh(const Scene& scene, const std::string& scene_file) {
  const std::filesystem::path folder = std::filesystem::path(scene_file).parent_path();
  std::error_code failed;
  for (const VesselData& vessel : scene.vessels)
    if (vessel.mesh && !std::filesystem::exists(folder / vessel.mesh->file, failed)) return (folder / vessel.mesh->file).string();
  return "";
}

// As reload_meshes, from where scene.file says.
std::string load_same_meshes(Scene& scene, const std::string& keys, const std::string& lattices, bool is_quiet) {
  MeshOptions options;
  options.lattices = lattices;
  options.is_quiet = is_quiet;
  if (!is_quiet) options.forecast = print_note;
  Scene read = scene;
  try {
    load_meshes(read, options);
  } catch (const Error& error) {
    return error.what();
  }
  if (mesh_lattices(read) != lattices) return "the result does not say by which lattices the meshes were read";
  if (mesh_keys(read) != keys) return "the mesh files are not what they were when the sweep ran";
  scene.vessels = read.vessels;
  return "";
}

}  // namespace

bool is_long(double seconds, bool is_closed) { return seconds > (is_closed ? LONG_WORK : LONG_OPEN_WORK); }

std::string forecast_text(const LatticePlan& plan, bool is_closed) {
  const auto lattice_time = [](const PreparedLattice& lattice, double seconds) {
    return fmt::format("its lattice of {:.4g} mm has {} samples, which take about {}", 1e3 * lattice.spacing,
                       readable_count(static_cast<double>(lattice.nx) * lattice.ny * lattice.nz), readable_duration(seconds));
  };
  if (plan.finer)
    return fmt::format("{}; one of {:.4g} mm, which takes about {}, is taken instead: grid_mm = {:.4g} asks for the finer one",
                       lattice_time(*plan.finer, plan.finer_seconds), 1e3 * plan.lattice.spacing, readable_duration(plan.seconds),
                       1e3 * plan.finer->spacing);
  return lattice_time(plan.lattice, plan.seconds) +
         (is_closed ? "; a larger grid_mm takes less" : ", as the mesh is open; a closed one, or a larger grid_mm, takes less");
}

bool has_meshes(const Scene& scene) {
  return std::any_of(scene.vessels.begin(), scene.vessels.end(), [](const VesselData& vessel) { return vessel.mesh.has_value(); });
}

std::string mesh_lines(const Scene& scene) {
  std::string lines;
  for (const VesselData& vessel : scene.vessels) {
    if (!vessel.mesh || !vessel.mesh->body) continue;
    const MeshBody& body = *vessel.mesh->body;
    const std::string but = body.has_lattice_volume ? " But " + lattice_volume_text(vessel, body) + "." : "";
    for (const std::string& part :
         {vessel.mesh->file + ": " + mesh_check_text(body.facts) + but, lattice_text(body), mass_text(vessel, body)})
      lines += fmt::format("{}vessel '{}': {}", lines.empty() ? "" : "\n", vessel.name, part);
  }
  return lines;
}

std::string mesh_keys(const Scene& scene) {
  std::string keys;
  for (const VesselData& vessel : scene.vessels)
    if (vessel.mesh && vessel.mesh->body) keys += (keys.empty() ? "" : " ") + vessel.mesh->body->key;
  return keys;
}

std::string mesh_lattices(const Scene& scene) {
  std::string lattices;
  for (const VesselData& vessel : scene.vessels) {
    if (!vessel.mesh || !vessel.mesh->body) continue;
    const PreparedLattice& lattice = vessel.mesh->body->lattice;
    lattices += fmt::format("{}{} {}", lattices.empty() ? "" : " ", lattice.spacing, bits_of(lattice));
  }
  return lattices;
}

std::size_t largest_lattice(std::uint64_t device_bytes) {
  const auto memory = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return std::min(std::min<std::uint64_t>(LARGEST_LATTICE, memory / 8), device_bytes);
}

void load_meshes(Scene& scene, const MeshOptions& options) {
  const std::string folder = std::filesystem::path(scene.file).parent_path().string();
  std::istringstream lattices(options.lattices);
  for (VesselData& vessel : scene.vessels)
    if (vessel.mesh && !vessel.mesh->body) load_mesh(scene, vessel, folder, options, lattices);
}

void follow_moved_scene(Scene& scene, const std::string& kept_in) {
  const std::string beside = beside_of(kept_in, scene.file);
  if (!has_meshes(scene)) return;
  const std::string here = missing_mesh(scene, beside), there = missing_mesh(scene, scene.file);
  if (here.empty()) {
    scene.file = beside;
  } else if (here != there && !there.empty()) {
    throw usage_error(fmt::format("{}: a mesh of its scene is missing: neither {} nor {} exists", kept_in, here, there));
  }
}

std::string reload_meshes(Scene& scene, const std::string& kept_in, const std::string& keys, const std::string& lattices,
                          bool is_quiet) {
  if (!has_meshes(scene)) return "";
  const std::string lay = scene.file;
  try {
    follow_moved_scene(scene, kept_in);
  } catch (const Error& error) {
    return error.what();
  }
  const std::string refusal = load_same_meshes(scene, keys, lattices, is_quiet);
  if (refusal.empty() || scene.file == lay) return refusal;
  scene.file = lay;
  return missing_mesh(scene, lay).empty() ? load_same_meshes(scene, keys, lattices, is_quiet) : refusal;
}

void load_meshes(Scene& scene, const std::function<std::uint64_t()>& device_bytes) {
  if (!has_meshes(scene)) return;
  MeshOptions options;
  options.most_bytes = largest_lattice(device_bytes ? device_bytes() : std::numeric_limits<std::uint64_t>::max());
  options.say = print_note;
  load_meshes(scene, options);
}

}  // namespace wholehand
