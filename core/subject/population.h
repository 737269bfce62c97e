#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/definition/bounds.h"
#include "core/subject/variation.h"

namespace haptrial::subject {

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
