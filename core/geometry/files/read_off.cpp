#include <vector>

#include "core/geometry/files/mesh_text_internal.h"

namespace haptrial::geometry::reading {
namespace {

class Off {
 public:
  Off(std::string_view bytes, std::string_view name, const WorkReport& report)
      : text_(bytes, name, report), name_(name) {}

  Mesh read() && {
    read_head();
    for (std::int64_t i = 0; i < vertices_; ++i) {
      read_vertex();
    }
    for (std::int64_t i = 0; i < faces_; ++i) {
      read_face();
    }
    return std::move(mesh_).take(name_);
  }

 private:
  void read_head() {
    const std::string_view magic = text_.word_below("OFF");
    // Colours, normals and texture coordinates stand behind the position, so they do no harm.
    if (magic != "OFF" && magic != "COFF" && magic != "NOFF" && magic != "CNOFF" &&
        magic != "STOFF" && magic != "STCOFF" && magic != "STNOFF" && magic != "STCNOFF") {
      text_.fail(fmt::format("the file begins with {}; allowed: OFF", in_quotes(magic)));
    }
    const std::string_view first = text_.word_below("the number of vertices");
    if (first == "BINARY") {
      text_.fail("this is a binary OFF file; convert it to text");
    }
    vertices_ = count(first, "vertices");
    faces_ = count(text_.word_below("the number of faces"), "faces");
    mesh_.reserve(vertices_, faces_);
    while (!text_.word().empty()) {  // the number of edges
    }
  }

  std::int64_t count(std::string_view word, const char* what) {
    const std::int64_t number = text_.whole(word, fmt::format("the number of {}", what));
    // A vertex or face takes four bytes at the least, "3 1 2"; the last may lack its line end.
    const auto most = static_cast<std::int64_t>(text_.bytes_left() / 4 + 1);
    if (number < 0 || number > most || number > std::numeric_limits<std::int32_t>::max()) {
      text_.fail(fmt::format("the header states {} {}; the file has bytes for {} at most", number,
                             what, most));
    }
    return number;
  }

  void next_line(const char* what, std::int64_t count) {
    if (!text_.next_line()) {
      text_.fail(fmt::format("the file ends before the last of its {} {}", count, what));
    }
  }

  void read_vertex() {
    next_line("vertices", vertices_);
    Eigen::Vector3d point;
    for (double& coordinate : point) {
      coordinate = text_.coordinate(text_.word(), "a coordinate of a vertex");
    }
    mesh_.add_vertex(point);
  }

  void read_face() {
    next_line("faces", faces_);
    const std::int64_t corners = text_.whole(text_.word(), "the number of a face's corners");
    if (corners < 1 || corners > static_cast<std::int64_t>(text_.bytes_left())) {
      text_.fail(fmt::format("a face has {} corners; allowed: 3 or more", corners));
    }
    corners_.clear();
    for (std::int64_t i = 0; i < corners; ++i) {
      const std::int64_t index = text_.whole(text_.word_below("a corner of a face"), "a corner of a face");
      if (index < 0 || index >= vertices_) {
        text_.fail(fmt::format("a face has the corner {}; allowed: 0 to {}", index, vertices_ - 1));
      }
      corners_.push_back(static_cast<std::int32_t>(index));
    }
    mesh_.add_face(corners_);
  }

  Text text_;
  std::string_view name_;
  Gathering mesh_;
  std::int64_t vertices_{0};
  std::int64_t faces_{0};
  std::vector<std::int32_t> corners_;
};

}  // namespace

Mesh read_off(std::string_view bytes, std::string_view name, const WorkReport& report) {
  return Off(bytes, name, report).read();
}

}  // namespace haptrial::geometry::reading
