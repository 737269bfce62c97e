#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/geometry/mesh/mesh.h"
#include "core/geometry/mesh/work.h"

/// Functions that the readers of mesh files share. Inside core/geometry only.
namespace haptrial::geometry::reading {

/// Text that came from a file, short and printable, in quotes.
std::string in_quotes(std::string_view text);

/// A text file word by word or line by line; every failure names the file and the line. A line ends
/// in a line feed, a carriage return, or both.
class Text {
 public:
  Text(std::string_view text, std::string_view name, const WorkReport& report);

  /// Goes to the next line that is not empty or only a comment. @returns false at the end.
  bool next_line();
  /// The next word of this line; empty at its end.
  std::string_view word();
  /// The next word of this line or of one below it. @param what  for the message at the file's end
  std::string_view word_below(std::string_view what);
  std::size_t bytes_left() const { return text_.size() - position_ + rest_.size(); }
  std::size_t line() const { return line_; }
  std::size_t position() const { return position_; }  // of the line below this

  double coordinate(std::string_view word, std::string_view what) const;
  std::int64_t whole(std::string_view word, std::string_view what) const;

  /// Says FILE:LINE: and then `sentence`. @throws InputError always.
  [[noreturn]] void fail(const std::string& sentence) const;
  [[noreturn]] void fail_at(std::size_t line, const std::string& sentence) const;

  /// A sign that begins a comment; 0: none does.
  void set_comment(char sign) { comment_ = sign; }
  /// A backslash at a line's end goes on with the next.
  void set_continuation(bool on) { continuation_ = on; }

 private:
  std::string_view raw_line();

  std::string_view text_;
  std::string name_;
  const WorkReport& report_;
  std::size_t position_{0};
  std::size_t line_{0};
  std::string_view rest_;
  std::string joined_;  // a line that was continued
  char comment_{'#'};
  bool continuation_{false};
};

/// A coordinate from outside. @returns what is wrong with it, empty where nothing is.
std::string coordinate_problem(double value);

/// Gathers vertices and faces; a vertex may come after its face.
class Gathering {
 public:
  void reserve(std::uint64_t vertices, std::uint64_t triangles);
  void add_vertex(const Eigen::Vector3d& point) { mesh_.vertices.push_back(point); }
  std::int64_t vertex_count() const { return static_cast<std::int64_t>(mesh_.vertices.size()); }
  /// Corners are indices from 0, checked by the caller. One or two corners bound no surface.
  void add_face(std::span<const std::int32_t> corners);
  bool full() const;  // no further vertex has an index
  /// Cuts the faces with more than three corners (FaceCutter).
  /// @throws InputError naming the file and the face that cannot be cut.
  Mesh take(std::string_view name) &&;

 private:
  /// A face with more than three corners, as the fan of triangles that keeps them.
  struct Polygon {
    std::size_t first;  // triangle
    std::size_t corners;
    std::size_t face;  // in the file, from 1
  };

  Mesh mesh_;
  std::vector<Polygon> polygons_;
  std::size_t faces_{0};
};

Mesh read_obj(std::string_view bytes, std::string_view name, const WorkReport& report);
Mesh read_ply(std::string_view bytes, std::string_view name, const WorkReport& report);
Mesh read_stl(std::string_view bytes, std::string_view name, const WorkReport& report);

}  // namespace haptrial::geometry::reading
