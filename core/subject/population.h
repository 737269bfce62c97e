#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/bounds.h"
#include "core/base/definition/schema_forward.h"

namespace haptrial::subject {

/// How a parameter varies over people: value = median · exp(spread · n), n normal. What can be
/// negative is `shifted`: value = median + spread · n.
struct Variation {
  double median{0.0};
  double spread{0.0};
  bool shifted{false};
};

/// Reads `key = { median = M, spread = S }` or `key = M`, which is the same for everybody.
/// @param bounds, unit  of the median; also of what is drawn
Variation read_variation(Table& table, std::string_view key, const Bounds& bounds,
                         std::string_view unit);
/// The same for a parameter that can be negative; the spread has its unit.
Variation read_shift(Table& table, std::string_view key, const Bounds& bounds,
                     std::string_view unit);

/// The value of one person, from the stream `name` of their seed, within `bounds`.
double draw(const Variation& variation, std::uint64_t seed, std::string_view name,
            const Bounds& bounds = {});

/// People whose parameters vary as a definition says.
template <class Person>
struct Population {
  /// A parameter that differs between people.
  struct Varying {
    double Person::*member;
    Variation variation;
    Bounds bounds;       // of a person's value
    std::string stream;  // of the person's seed
  };

  Person everybody{};  // parameters of a person from whom nobody differs
  std::vector<Varying> varying;

  /// The person of a seed; each parameter has its own stream.
  Person draw(std::uint64_t seed) const {
    Person person = everybody;
    for (const Varying& each : varying) {
      person.*each.member = subject::draw(each.variation, seed, each.stream, each.bounds);
    }
    return person;
  }
  bool varies() const {
    return std::ranges::any_of(varying,
                               [](const Varying& each) { return each.variation.spread > 0.0; });
  }
};

}  // namespace haptrial::subject
