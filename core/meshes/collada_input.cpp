// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <limits>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/text/readable.h"
#include "core/meshes/assimp_input.h"
#include "core/meshes/triangles.h"
#include "core/meshes/words.h"

namespace wholehand {
namespace {

constexpr std::ptrdiff_t MOST_TAGS = 4'000'000;    // of the file: each takes some 100 bytes once it is parsed
constexpr std::size_t MOST_NODE_VISITS = 100'000;  // nodes may show each other, and so a few of them make many

// The polygons of a geometry, in its own frame.
struct ColladaShape {
  std::vector<Triple> points;
  std::vector<std::size_t> corners;  // points, of one polygon after the other
  std::vector<std::size_t> counts;   // corners of each polygon
  std::uint64_t triangles = 0;
};

// Remembers the elements that have an id.
struct IdWalker : pugi::xml_tree_walker {
  bool for_each(pugi::xml_node& node) override {
    const pugi::xml_attribute id = node.attribute("id");
    if (id) ids.try_emplace(id.value(), node);
    return true;
  }
  std::unordered_map<std::string_view, pugi::xml_node> ids;
};

// Reads a Collada file's scene into the text of an OBJ. assimp 5.2 has a reader of its own, which is not safe: a node that shows itself overflows the
// stack, a skew aborts the program, nodes that multiply never end, and a wrong count takes all memory. That reader also accepts negative indices,
// gets triangle fans wrong, and leaves mirrored geometries inside out. A check of all that would parse the file just as this does.
class ColladaScene {
 public:
  ColladaScene(const MeshFile& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  std::string read() {
    if (std::count(bytes_.begin(), bytes_.end(), '<') > MOST_TAGS)
      file_.refuse("has more than four million tags of XML: cut its polygons into triangles, or simplify it");
    const pugi::xml_parse_result parsed = document_.load_buffer(bytes_.data(), bytes_.size());
    if (!parsed) file_.refuse(fmt::format("is damaged: {} in line {}", parsed.description(), line_at(parsed.offset)));
    document_.traverse(walker_);
    root_ = document_.child("COLLADA");
    if (!root_) file_.refuse("is no Collada file: it has no COLLADA");
    walk(scene(), frame());
    if (faces_.empty()) file_.refuse("has no mesh in its scene");
    return points_ + faces_;
  }

 private:
  struct Visit {
    pugi::xml_node node;
    glm::dmat4 placed;
  };

  std::size_t line_at(std::ptrdiff_t offset) const {
    const std::size_t end = std::min(bytes_.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    return 1 + static_cast<std::size_t>(std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
  }

  [[noreturn]] void refuse(pugi::xml_node at, const std::string& message) const {
    file_.refuse(fmt::format("line {}: {} {}", line_at(at.offset_debug()), MeshWords::shown(at.name()), message));
  }

  // ---- elements ----

  // The element of that kind that an attribute such as url="#cup" names.
  pugi::xml_node named(pugi::xml_node by, const char* attribute, const char* kind) const {
    const std::string_view name = by.attribute(attribute).value();
    const auto found = name.starts_with('#') ? walker_.ids.find(name.substr(1)) : walker_.ids.end();
    if (found == walker_.ids.end() || found->second.name() != std::string_view(kind))
      refuse(by, fmt::format("names '{}', which is no {} of this file", MeshWords::shown(name), kind));
    return found->second;
  }

  // The numbers in an element's text: as many as that, or any if `count` is 0.
  std::vector<double> numbers(pugi::xml_node node, std::size_t count = 0) const {
    constexpr std::string_view GAPS = " \t\r\n";
    std::vector<double> found;
    std::string_view text = node.text().get();
    for (std::size_t start = text.find_first_not_of(GAPS); start != text.npos; start = text.find_first_not_of(GAPS)) {
      text.remove_prefix(start);
      const std::string_view word = text.substr(0, text.find_first_of(GAPS));
      text.remove_prefix(word.size());
      found.push_back(number(node, word));
    }
    if (count > 0 && found.size() != count) refuse(node, fmt::format("has {} numbers in place of {}", found.size(), count));
    return found;
  }

  double number(pugi::xml_node node, std::string_view word) const {
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool is_tiny = error == std::errc::result_out_of_range && std::abs(value) < 1;
    if ((error != std::errc() && !is_tiny) || end != digits.data() + digits.size() ||
        !(std::abs(value) <= std::numeric_limits<float>::max()))
      refuse(node, fmt::format("has '{}', which is no finite number", MeshWords::shown(word)));
    return value;
  }

  // An attribute that counts, up to 2^31.
  std::size_t whole(pugi::xml_node node, const char* attribute, double otherwise) const {
    const pugi::xml_attribute found = node.attribute(attribute);
    return found ? index(node, number(node, found.value())) : static_cast<std::size_t>(otherwise);
  }

  std::size_t index(pugi::xml_node node, double value) const {
    if (!(value >= 0 && value <= std::numeric_limits<std::int32_t>::max()) || value != std::floor(value))
      refuse(node, fmt::format("has {}, which is no count or index", value));
    return static_cast<std::size_t>(value);
  }

  // ---- geometries ----

  // The points of <vertices>.
  std::vector<Triple> positions(pugi::xml_node vertices) const {
    const pugi::xml_node input = vertices.find_child_by_attribute("input", "semantic", "POSITION");
    if (!input) refuse(vertices, "has no POSITION");
    const pugi::xml_node source = named(input, "source", "source"), accessor = source.child("technique_common").child("accessor");
    if (!accessor) refuse(source, "has no accessor");
    const std::vector<double> values = numbers(named(accessor, "source", "float_array"));
    const std::size_t count = whole(accessor, "count", 0), stride = whole(accessor, "stride", 1),
                      offset = whole(accessor, "offset", 0);
    if (stride < 3) refuse(accessor, "has fewer than three coordinates a point");
    if (count > 0 && offset + (count - 1) * stride + 3 > values.size())  // each below 2^31: no overflow
      refuse(accessor, fmt::format("reaches beyond its {} numbers", readable_number(values.size())));
    std::vector<Triple> points(count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < 3; ++k) points[i][k] = values[offset + i * stride + k];
    return points;
  }

  // Points of a shape that belong to one <vertices>.
  struct PointRange {
    std::size_t first = 0, count = 0;
  };

  // The points that one <p> names.
  std::vector<std::size_t> corners_of(pugi::xml_node p, std::size_t stride, std::size_t offset, const PointRange& points) const {
    const std::vector<double> values = numbers(p);
    if (values.size() % stride != 0) refuse(p, fmt::format("has {} indices, which is no multiple of {}", values.size(), stride));
    std::vector<std::size_t> corners;
    for (std::size_t i = offset; i < values.size(); i += stride) {
      const std::size_t corner = index(p, values[i]);
      if (corner >= points.count)
        refuse(p, fmt::format("has the index {} and {} points", readable_number(corner), readable_number(points.count)));
      corners.push_back(points.first + corner);
    }
    return corners;
  }

  static void add_polygon(ColladaShape& shape, const std::vector<std::size_t>& corners) {
    shape.corners.insert(shape.corners.end(), corners.begin(), corners.end());
    shape.counts.push_back(corners.size());
    shape.triangles += corners.size() - 2;
  }

  // Adds the polygons of <triangles>, <polylist>, <polygons>, <tristrips> or <trifans>.
  void add_polygons(ColladaShape& shape, pugi::xml_node part, pugi::xml_node vertex, const PointRange& points) const {
    const std::string_view kind = part.name();
    std::size_t stride = 1;
    for (const pugi::xml_node input : part.children("input")) stride = std::max(stride, whole(input, "offset", 0) + 1);
    if (part.child("ph")) refuse(part, "has polygons with holes: export triangles");
    std::vector<double> counts;
    if (kind == "polylist") counts = numbers(part.child("vcount"));
    for (const pugi::xml_node p : part.children("p")) {
      const std::vector<std::size_t> corners = corners_of(p, stride, whole(vertex, "offset", 0), points);
      if (kind == "polygons") counts = {static_cast<double>(corners.size())};
      if (kind == "triangles") counts.assign(corners.size() / 3, 3);
      if (kind == "tristrips" || kind == "trifans") {
        for (std::size_t i = 0; i + 2 < corners.size(); ++i)
          add_polygon(shape, kind == "trifans" ? std::vector{corners[0], corners[i + 1], corners[i + 2]}
                             : i % 2 == 0      ? std::vector{corners[i], corners[i + 1], corners[i + 2]}
                                               : std::vector{corners[i], corners[i + 2], corners[i + 1]});
        continue;
      }
      std::size_t at = 0;
      for (const double number_of : counts) {
        const std::size_t count = index(part, number_of);
        if (count < 3 || count > MOST_CORNERS)
          refuse(part, fmt::format("has a polygon of {} corners; 3 to {} are read", readable_number(count),
                                   readable_number(MOST_CORNERS)));
        if (count > corners.size() - at) refuse(p, "ends within a polygon");
        add_polygon(shape,
                    {corners.begin() + static_cast<std::ptrdiff_t>(at), corners.begin() + static_cast<std::ptrdiff_t>(at + count)});
        at += count;
      }
      if (at != corners.size()) refuse(p, "goes on after the last polygon");
    }
    if (shape.triangles > MOST_TRIANGLES) file_.refuse_size();
  }

  ColladaShape read_shape(pugi::xml_node geometry) const {
    const pugi::xml_node mesh = geometry.child("mesh");
    if (!mesh) refuse(geometry, "has no mesh: convert it to polygons");
    ColladaShape shape;
    std::map<std::string, PointRange> ranges;  // of each <vertices>
    for (const pugi::xml_node part : mesh.children()) {
      const std::string_view kind = part.name();
      const bool is_read =
          kind == "triangles" || kind == "polylist" || kind == "polygons" || kind == "tristrips" || kind == "trifans";
      const pugi::xml_node vertex = part.find_child_by_attribute("input", "semantic", "VERTEX");
      if (!is_read || !part.child("p")) continue;
      if (!vertex) refuse(part, "has no VERTEX");
      const std::string source = vertex.attribute("source").value();
      if (!ranges.contains(source)) {
        const std::vector<Triple> points = positions(named(vertex, "source", "vertices"));
        ranges[source] = {shape.points.size(), points.size()};
        shape.points.insert(shape.points.end(), points.begin(), points.end());
      }
      add_polygons(shape, part, vertex, ranges[source]);
    }
    return shape;
  }

  // ---- nodes ----

  // From the file's frame to meters with +y up.
  glm::dmat4 frame() const {
    const pugi::xml_node asset = root_.child("asset"), unit = asset.child("unit"), up = asset.child("up_axis");
    const double meters = unit.attribute("meter") ? number(unit, unit.attribute("meter").value()) : 1;
    if (!(meters > 0)) refuse(unit, "has no length");
    const glm::dmat4 scaled = glm::scale(glm::dmat4(1), glm::dvec3(meters));
    std::string_view axis = up ? up.text().get() : "Y_UP";
    axis = axis.substr(std::min(axis.size(), axis.find_first_not_of(" \t\r\n")));
    if (axis.starts_with("Y_UP")) return scaled;
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    if (axis.starts_with("Z_UP")) return glm::dmat4(glm::dmat3(x, -z, y)) * scaled;
    if (axis.starts_with("X_UP")) return glm::dmat4(glm::dmat3(y, -x, z)) * scaled;
    refuse(up, fmt::format("is '{}'; allowed: X_UP, Y_UP or Z_UP", MeshWords::shown(axis)));
  }

  pugi::xml_node scene() const {
    const pugi::xml_node shown = root_.child("scene").child("instance_visual_scene");
    if (shown) return named(shown, "url", "visual_scene");
    return root_.child("library_visual_scenes").child("visual_scene");
  }

  glm::dmat4 moved(const glm::dmat4& placed, pugi::xml_node step) const {
    const std::string_view kind = step.name();
    if (kind == "lookat" || kind == "skew") refuse(step, "is not read: bake the transforms before exporting");
    if (kind == "matrix") {
      const std::vector<double> rows = numbers(step, 16);
      if (rows[12] != 0 || rows[13] != 0 || rows[14] != 0 || rows[15] != 1) refuse(step, "has another last row than 0 0 0 1");
      glm::dmat4 matrix(1);
      for (int i = 0; i < 12; ++i) matrix[i % 4][i / 4] = rows[static_cast<std::size_t>(i)];
      return placed * matrix;
    }
    if (kind == "rotate") {
      const std::vector<double> turn = numbers(step, 4);
      return glm::rotate(placed, radians(turn[3]), glm::dvec3(turn[0], turn[1], turn[2]));
    }
    if (kind != "translate" && kind != "scale") return placed;
    const std::vector<double> by = numbers(step, 3);
    const glm::dvec3 vector(by[0], by[1], by[2]);
    return kind == "scale" ? glm::scale(placed, vector) : glm::translate(placed, vector);
  }

  void walk(pugi::xml_node scene, const glm::dmat4& frame) {
    std::vector<Visit> waiting{{scene, frame}};
    for (std::size_t visits = 0; !waiting.empty(); ++visits) {
      if (visits > MOST_NODE_VISITS) file_.refuse("shows nodes more than 100,000 times, or one shows itself");
      Visit visit = waiting.back();
      waiting.pop_back();
      for (const pugi::xml_node child : visit.node.children()) visit.placed = moved(visit.placed, child);
      for (const pugi::xml_node child : visit.node.children()) {
        const std::string_view kind = child.name();
        if (kind == "instance_controller") refuse(child, "is a skin, which is not read: apply the armature before exporting");
        if (kind == "node") waiting.push_back({child, visit.placed});
        if (kind == "instance_node") waiting.push_back({named(child, "url", "node"), visit.placed});
        if (kind == "instance_geometry") add_shape(named(child, "url", "geometry"), visit.placed);
      }
    }
  }

  void add_shape(pugi::xml_node geometry, const glm::dmat4& placed) {
    auto place = shapes_.find(geometry.hash_value());
    if (place == shapes_.end()) place = shapes_.emplace(geometry.hash_value(), read_shape(geometry)).first;
    const ColladaShape& shape = place->second;
    triangles_ += shape.triangles;
    const std::size_t base = vertices_ + 1;  // an OBJ counts from 1
    vertices_ += shape.points.size();
    if (triangles_ > MOST_TRIANGLES || vertices_ > MOST_MESH_VERTICES || points_.size() + faces_.size() > LARGEST_MESH_FILE)
      file_.refuse_size();
    for (const Triple& point : shape.points) {
      const glm::dvec4 at = placed * glm::dvec4(point[0], point[1], point[2], 1);
      for (int k = 0; k < 3; ++k)
        if (!(std::abs(at[k]) <= std::numeric_limits<float>::max())) refuse(geometry, "has a vertex that is not a finite number");
      points_ += fmt::format("v {} {} {}\n", static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z));
    }
    const bool mirrors = glm::determinant(glm::dmat3(placed)) < 0;  // which turns each polygon round
    auto corner = shape.corners.begin();
    for (const std::size_t count : shape.counts) {
      faces_ += "f";
      for (std::size_t k = 0; k < count; ++k)
        faces_ += fmt::format(" {}", base + *(corner + static_cast<std::ptrdiff_t>(mirrors ? count - 1 - k : k)));
      faces_ += "\n";
      corner += static_cast<std::ptrdiff_t>(count);
    }
  }

  const MeshFile& file_;
  std::string_view bytes_;
  pugi::xml_document document_;
  IdWalker walker_;
  pugi::xml_node root_;
  std::unordered_map<std::size_t, ColladaShape> shapes_;  // by their geometries
  std::string points_, faces_;
  std::uint64_t triangles_ = 0;
  std::size_t vertices_ = 0;
};

}  // namespace

std::string collada_input(const MeshFile& file, std::string_view bytes) { return ColladaScene(file, bytes).read(); }

}  // namespace wholehand
