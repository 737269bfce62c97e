#include "core/subject/population.h"

#include <cmath>

#include "core/base/definition/table.h"
#include "core/base/random.h"

namespace haptrial::subject {
namespace {

Variation read_either(Table& table, std::string_view key, const Bounds& bounds,
                      std::string_view unit, bool shifted) {
  Variation v;
  v.shifted = shifted;
  if (table.has(key) && !table.is_table(key)) {
    v.median = table.number(key, bounds, unit);
    return v;
  }
  Table entry = table.table(key);
  v.median = entry.number("median", bounds, unit);
  v.spread =
      shifted ? entry.number("spread", kNonNegative, unit) : entry.number("spread", {0.0, 2.0}, "");
  return v;
}

}  // namespace

Variation read_variation(Table& table, std::string_view key, const Bounds& bounds,
                         std::string_view unit) {
  return read_either(table, key, bounds, unit, false);
}

Variation read_shift(Table& table, std::string_view key, const Bounds& bounds,
                     std::string_view unit) {
  return read_either(table, key, bounds, unit, true);
}

double draw(const Variation& v, std::uint64_t seed, std::string_view name, const Bounds& bounds) {
  RandomStream stream(seed, name);
  const double n = stream.normal();
  const double value = v.shifted ? v.median + v.spread * n : v.median * std::exp(v.spread * n);
  return std::clamp(value, bounds.low, bounds.high);
}

}  // namespace haptrial::subject
