#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "core/geometry/files/mesh_text_internal.h"

namespace haptrial::geometry::reading {
namespace {

/// Statements that say nothing about where the surface is.
constexpr std::array<std::string_view, 21> kPassedOver{
    "vt",     "vn",       "vp",       "g",          "o",         "s",    "mg",
    "usemtl", "mtllib",   "usemap",   "maplib",     "l",         "p",    "bevel",
    "lod",    "c_interp", "d_interp", "shadow_obj", "trace_obj", "call", "csh"};

class Obj {
 public:
  Obj(std::string_view bytes, std::string_view name, const WorkReport& report)
      : text_(bytes, name, report), name_(name) {
    text_.set_continuation(true);
  }

  Mesh read() && {
    while (text_.next_line()) {
      const std::string_view statement = text_.word();
      if (statement == "v") {
        read_vertex();
      } else if (statement == "f" || statement == "fo") {
        read_face();
      } else if (std::find(kPassedOver.begin(), kPassedOver.end(), statement) ==
                 kPassedOver.end()) {
        text_.fail(
            fmt::format("{} is no statement of a polygon mesh in OBJ; allowed: v, f and others of "
                        "polygons",
                        in_quotes(statement)));
      }
    }
    if (largest_ >= mesh_.vertex_count()) {
      text_.fail_at(largest_line_, fmt::format("a face has the corner {}; allowed: 1 to {}",
                                               largest_ + 1, mesh_.vertex_count()));
    }
    return std::move(mesh_).take(name_);
  }

 private:
  void read_vertex() {
    if (mesh_.full()) {
      text_.fail("the file has more vertices than 32 bits count");
    }
    Eigen::Vector3d point;
    for (double& coordinate : point) {
      coordinate = text_.coordinate(text_.word(), "a coordinate of a vertex");
    }
    mesh_.add_vertex(point);
  }

  void read_face() {
    corners_.clear();
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
      corners_.push_back(corner(word));
    }
    if (corners_.empty()) {
      text_.fail("a face has no corner; allowed: 3 or more");
    }
    mesh_.add_face(corners_);
  }

  /// "7", "7/1", "7//2", "7/1/2": the vertex from 1, or from the last one backwards where negative.
  std::int32_t corner(std::string_view word) {
    const std::int64_t number = text_.whole(word.substr(0, word.find('/')), "a corner of a face");
    const std::int64_t count = mesh_.vertex_count();
    const std::int64_t index = number < 0 ? count + number : number - 1;
    if (number == 0 || index < 0 || index > std::numeric_limits<std::int32_t>::max()) {
      text_.fail(fmt::format("a face has the corner {}; allowed: 1 to {}, or -{} to -1", number,
                             count, count));
    }
    if (index > largest_) {  // a vertex may come after its face
      largest_ = index;
      largest_line_ = text_.line();
    }
    return static_cast<std::int32_t>(index);
  }

  Text text_;
  std::string_view name_;
  Gathering mesh_;
  std::vector<std::int32_t> corners_;
  std::int64_t largest_{-1};
  std::size_t largest_line_{0};
};

}  // namespace

Mesh read_obj(std::string_view bytes, std::string_view name, const WorkReport& report) {
  return Obj(bytes, name, report).read();
}

}  // namespace haptrial::geometry::reading
