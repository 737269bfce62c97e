#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>

#include "core/geometry/files/mesh_text_internal.h"
#include "core/geometry/mesh/point_index.h"

namespace haptrial::geometry::reading {
namespace {

static_assert(std::endian::native == std::endian::little);  // as binary STL is

constexpr std::size_t kHead = 84;      // 80 bytes of anything, the number of triangles
constexpr std::size_t kTriangle = 50;  // normal, three corners, two bytes of anything
constexpr std::size_t kNormal = 12;

bool same_word(std::string_view word, std::string_view lower_case) {
  return std::equal(
      word.begin(), word.end(), lower_case.begin(), lower_case.end(),
      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

Mesh read_binary(std::string_view bytes, std::string_view name, std::uint32_t count) {
  PointIndex points(count / 2);
  Mesh mesh;
  mesh.triangles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const char* at = bytes.data() + kHead + kTriangle * i + kNormal;
    Triangle triangle{};
    for (std::int32_t& corner : triangle) {
      std::array<float, 3> xyz;
      std::memcpy(xyz.data(), at, sizeof xyz);
      at += sizeof xyz;
      const Eigen::Vector3d point(xyz[0], xyz[1], xyz[2]);
      for (const double value : point) {
        if (const std::string problem = coordinate_problem(value); !problem.empty()) {
          throw InputError(fmt::format("{}: triangle {}: {}", name, i + 1, problem));
        }
      }
      corner = points.number(point);
    }
    mesh.triangles.push_back(triangle);
  }
  mesh.vertices = std::move(points).take();
  return mesh;
}

class StlText {
 public:
  StlText(std::string_view bytes, std::string_view name, const WorkReport& report)
      : text_(bytes, name, report) {
    text_.set_comment(0);
  }

  Mesh read() && {
    for (std::string_view word = next_word(); !word.empty(); word = next_word()) {
      if (same_word(word, "facet")) {
        read_facet();
      } else if (same_word(word, "solid") || same_word(word, "endsolid")) {
        pass_name();
      } else {
        text_.fail(fmt::format("found {}; allowed: solid, facet, endsolid", in_quotes(word)));
      }
    }
    mesh_.vertices = std::move(points_).take();
    return std::move(mesh_);
  }

 private:
  /// @returns the next word of this line or of the next one; empty at the file's end.
  std::string_view next_word() {
    const std::string_view word = text_.word();
    return word.empty() && text_.next_line() ? text_.word() : word;
  }

  /// The name of a solid is the rest of its line, or ends where a facet begins in it.
  void pass_name() {
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
      if (same_word(word, "facet") && same_word(text_.word(), "normal")) {
        read_facet();
        return;
      }
    }
  }

  void read_facet() {
    std::string_view word = text_.word();
    while (!word.empty() && !same_word(word, "outer")) {  // the normal
      word = text_.word();
    }
    expect("outer", word.empty() ? next_word() : word);
    expect("loop", text_.word());
    Triangle triangle{};
    for (std::int32_t& corner : triangle) {
      expect("vertex", text_.word_below("a vertex"));
      Eigen::Vector3d point;
      for (double& coordinate : point) {
        coordinate = text_.coordinate(text_.word(), "a coordinate of a vertex");
      }
      corner = points_.number(point);
    }
    expect("endloop", text_.word_below("endloop"));
    expect("endfacet", text_.word_below("endfacet"));
    mesh_.triangles.push_back(triangle);
  }

  void expect(std::string_view word, std::string_view found) {
    if (!same_word(found, word)) {
      text_.fail(fmt::format("found {}; allowed here: {}",
                             found.empty() ? "the file's end" : in_quotes(found), word));
    }
  }

  Text text_;
  PointIndex points_;
  Mesh mesh_;
};

}  // namespace

Mesh read_stl(std::string_view bytes, std::string_view name, const WorkReport& report) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHead) {
    std::memcpy(&count, bytes.data() + kHead - sizeof count, sizeof count);
    // Four characters of text would count more triangles than any file of text has bytes.
    if (bytes.size() >= kHead + kTriangle * count) {
      return read_binary(bytes, name, count);
    }
  }
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  const bool text = bytes.substr(0, kHead).find('\0') == std::string_view::npos;
  if (text && start != std::string_view::npos && same_word(bytes.substr(start, 5), "solid")) {
    return StlText(bytes, name, report).read();
  }
  if (bytes.size() < kHead) {
    throw InputError(fmt::format(
        "{}: has {} bytes and does not begin with solid; a binary STL file has {} or more", name,
        bytes.size(), kHead));
  }
  throw InputError(fmt::format(
      "{}: is a binary STL file with {} triangles by its header, which take {} bytes; it has {}",
      name, count, kHead + kTriangle * count, bytes.size()));
}

}  // namespace haptrial::geometry::reading
