#include "core/deformable/springs/constants_table.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>

#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

constexpr std::string_view kHead = "kind,number,constant_J";
constexpr std::string_view kShape = "# body: ";

struct KindOfSpring {
  std::string_view word;
  std::vector<double> SpringConstants::*list;
};
constexpr std::array kKinds{KindOfSpring{"length", &SpringConstants::length},
                            KindOfSpring{"area", &SpringConstants::area},
                            KindOfSpring{"volume", &SpringConstants::volume}};

/// Hands out lines without their ends.
class Lines {
 public:
  explicit Lines(std::string_view text) : left_(text) {}
  bool over() const { return left_.empty(); }
  std::size_t number() const { return number_; }
  std::string_view next() {
    const std::size_t end = std::min(left_.find('\n'), left_.size());
    std::string_view line = left_.substr(0, end);
    left_.remove_prefix(std::min(end + 1, left_.size()));
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    ++number_;
    return line;
  }

 private:
  std::string_view left_;
  std::size_t number_{0};
};

/// The constant of a row "kind,number,constant".
double constant_of(std::string_view line, const std::string& where, std::string_view kind,
                   std::size_t number, std::size_t count) {
  const std::string begin = fmt::format("{},{},", kind, number);
  if (!line.starts_with(begin)) {
    throw InputError(
        fmt::format("{}: '{}' stands where '{}' and a constant is expected; the body "
                    "has {} springs of {}",
                    where, line, begin, count, kind));
  }
  line.remove_prefix(begin.size());
  double value = 0.0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc() || end != line.data() + line.size()) {
    throw InputError(fmt::format("{}: '{}' is no number", where, line));
  }
  return value;
}

/// Measures of a body at rest that a shift or a turn keeps, and another size or shape changes.
struct RestShape {
  double volume{0.0};  // [m³]
  double edges{0.0};   // length of all [m]

  explicit RestShape(const SpringBody& body)
      : volume(std::accumulate(body.volumes.begin(), body.volumes.end(), 0.0)),
        edges(std::accumulate(body.lengths.begin(), body.lengths.end(), 0.0)) {}
};

std::string words_of(const RestShape& shape) {
  return fmt::format("volume {:.9g} m3, all edges {:.9g} m", shape.volume, shape.edges);
}

/// @param line  behind kShape
void check_shape(std::string_view line, const std::string& name, const SpringBody& body) {
  constexpr double kRounding = 1e-6;
  const RestShape own(body);
  RestShape theirs = own;
  const int read = std::sscanf(std::string(line).c_str(), "volume %lf m3, all edges %lf m",
                               &theirs.volume, &theirs.edges);
  const auto same = [](double a, double b) { return std::abs(a - b) <= kRounding * std::abs(a); };
  if (read != 2 || !same(own.volume, theirs.volume) || !same(own.edges, theirs.edges)) {
    throw InputError(
        fmt::format("{}: has the constants of a body of {}, and this one is of {}; calibrate this "
                    "one, too",
                    name, line, words_of(own)));
  }
}

}  // namespace

std::string constants_csv(const SpringBody& body, const SpringConstants& constants) {
  std::string text = fmt::format("{}{}\n{}\n", kShape, words_of(RestShape(body)), kHead);
  for (const KindOfSpring& kind : kKinds) {
    const std::vector<double>& list = constants.*kind.list;
    for (std::size_t i = 0; i < list.size(); ++i) {
      fmt::format_to(std::back_inserter(text), "{},{},{:.9g}\n", kind.word, i, list[i]);
    }
  }
  return text;
}

SpringConstants parse_constants(std::string_view text, const std::string& name,
                                const SpringBody& body) {
  Lines lines(text);
  std::string_view head = lines.next();
  if (head.starts_with(kShape)) {
    check_shape(head.substr(kShape.size()), name, body);
    head = lines.next();
  }
  if (head != kHead) {
    throw InputError(fmt::format("{}: begins with '{}'; a table of constants begins with '{}'",
                                 name, head, kHead));
  }
  SpringConstants constants;
  for (const KindOfSpring& kind : kKinds) {
    const std::size_t count = (body.constants.*kind.list).size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::string_view line = lines.next();
      (constants.*kind.list)
          .push_back(
              constant_of(line, fmt::format("{}:{}", name, lines.number()), kind.word, i, count));
    }
  }
  if (!lines.over()) {
    throw InputError(fmt::format("{}: goes on after line {}; the body has {} constants", name,
                                 lines.number(), lines.number() - 1));
  }
  check_constants(body, constants);
  return constants;
}

}  // namespace haptrial::deformable
