#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/geometry/files/cut_face.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/files/mesh_text_internal.h"

namespace haptrial::geometry::reading {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 32;
  std::string out = "'";
  for (const char c : text.substr(0, kLongest)) {
    out += c >= ' ' && c <= '~' ? c : '?';
  }
  return out + (text.size() > kLongest ? "...'" : "'");
}

std::string coordinate_problem(double value) {
  if (!std::isfinite(value)) {
    return fmt::format("a coordinate is {}; allowed: finite numbers", value);
  }
  if (std::abs(value) > kMaxCoordinate) {
    return fmt::format("a coordinate is {:g}; allowed: {:g} to {:g}", value, -kMaxCoordinate,
                       kMaxCoordinate);
  }
  return {};
}

Text::Text(std::string_view text, std::string_view name, const WorkReport& report)
    : text_(text), name_(name), report_(report) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of UTF-8
  if (text_.starts_with(kMark)) {
    position_ = kMark.size();
  }
}

std::string_view Text::raw_line() {
  constexpr std::size_t kLinesBetweenReports = 1 << 16;
  const std::string_view below = text_.substr(position_);
  const auto end = std::ranges::find_if(below, [](char c) { return c == '\n' || c == '\r'; });
  std::string_view line(below.begin(), end);
  const std::size_t mark = below.substr(line.size()).starts_with("\r\n") ? 2 : 1;
  position_ = std::min(position_ + line.size() + mark, text_.size());
  if (++line_ % kLinesBetweenReports == 0) {
    report_share(report_, static_cast<double>(position_) / static_cast<double>(text_.size()));
  }
  if (comment_ != 0) {
    line = line.substr(0, line.find(comment_));
  }
  while (!line.empty() && is_blank(line.back())) {
    line.remove_suffix(1);
  }
  return line;
}

bool Text::next_line() {
  while (position_ < text_.size()) {
    rest_ = raw_line();
    if (continuation_ && rest_.ends_with('\\')) {
      joined_.clear();
      while (rest_.ends_with('\\') && position_ < text_.size()) {
        joined_.append(rest_.substr(0, rest_.size() - 1)).append(" ");
        rest_ = raw_line();
      }
      joined_.append(rest_);
      rest_ = joined_;
    }
    if (!std::all_of(rest_.begin(), rest_.end(), is_blank)) {
      return true;
    }
  }
  rest_ = {};
  return false;
}

std::string_view Text::word() {
  std::size_t start = 0;
  while (start < rest_.size() && is_blank(rest_[start])) {
    ++start;
  }
  std::size_t end = start;
  while (end < rest_.size() && !is_blank(rest_[end])) {
    ++end;
  }
  const std::string_view found = rest_.substr(start, end - start);
  rest_.remove_prefix(end);
  return found;
}

std::string_view Text::word_below(std::string_view what) {
  std::string_view found = word();
  while (found.empty()) {
    if (!next_line()) {
      fail(fmt::format("the file ends where {} should stand", what));
    }
    found = word();
  }
  return found;
}

double Text::coordinate(std::string_view word, std::string_view what) const {
  const std::string_view digits = without_plus(word);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range && end == digits.data() + digits.size()) {
    // A number that is too small for a double is 0 to us; one that is too large is not.
    value =
        digits.find("e-") == std::string_view::npos && digits.find("E-") == std::string_view::npos
            ? std::numeric_limits<double>::infinity()
            : 0.0;
  } else if (error != std::errc{} || end != digits.data() + digits.size()) {
    fail(word.empty() ? fmt::format("the line ends where {} should stand", what)
                      : fmt::format("{} is {}; allowed: a number", what, in_quotes(word)));
  }
  if (const std::string problem = coordinate_problem(value); !problem.empty()) {
    fail(problem);
  }
  return value;
}

std::int64_t Text::whole(std::string_view word, std::string_view what) const {
  const std::string_view digits = without_plus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size()) {
    fail(word.empty() ? fmt::format("the line ends where {} should stand", what)
                      : fmt::format("{} is {}; allowed: a whole number that 64 bits hold", what,
                                    in_quotes(word)));
  }
  return value;
}

void Text::fail(const std::string& sentence) const { fail_at(line_, sentence); }

void Text::fail_at(std::size_t line, const std::string& sentence) const {
  throw InputError(fmt::format("{}:{}: {}", name_, std::max<std::size_t>(line, 1), sentence));
}

void Gathering::reserve(std::uint64_t vertices, std::uint64_t triangles) {
  mesh_.vertices.reserve(vertices);
  mesh_.triangles.reserve(triangles);
}

void Gathering::add_face(std::span<const std::int32_t> corners) {
  ++faces_;
  if (corners.size() > 3) {
    polygons_.push_back({mesh_.triangles.size(), corners.size(), faces_});
  }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh_.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

Mesh Gathering::take(std::string_view name) && {
  FaceCutter cutter;
  std::vector<std::int32_t> corners;
  for (const Polygon& polygon : polygons_) {
    const std::span<Triangle> fan(mesh_.triangles.data() + polygon.first, polygon.corners - 2);
    corners.assign({fan[0][0], fan[0][1]});
    for (const Triangle& triangle : fan) {
      corners.push_back(triangle[2]);
    }
    if (const std::string_view problem = cutter.cut(mesh_.vertices, corners, fan);
        !problem.empty()) {
      throw InputError(fmt::format("{}: face {} with {} corners {}", name, polygon.face,
                                   corners.size(), problem));
    }
  }
  return std::move(mesh_);
}

bool Gathering::full() const {
  return mesh_.vertices.size() >=
         static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
}

}  // namespace haptrial::geometry::reading
