#include "protocols/psychophysics/definition/moving_target.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "core/base/definition/number_source.h"
#include "core/base/definition/schema.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"

namespace haptrial::protocols {
namespace {

constexpr Bounds kTargetPlace{-1.0, 1.0};

/// A list of numbers and formulas.
std::vector<double> read_list(Table& table, const std::string& key, const Bounds& bounds,
                              const char* unit) {
  const std::string allowed = fmt::format("a list of numbers or formulas from {:g} to {:g} [{}]",
                                          bounds.low, bounds.high, unit);
  std::vector<double> list;
  const auto rows = table.rows(key, allowed);
  if (rows.size() != 1) {
    table.reject(key, "another list", allowed);
    return list;
  }
  for (const NumberOrText& each : rows.front()) {
    std::optional<double> value = each.number;
    try {
      value = value || table.numbers() == nullptr ? value : table.numbers()->value_of(each.text);
    } catch (const InputError& error) {
      table.reject(key, fmt::format("has \"{}\": {}", each.text, error.what()));
    }
    if (!value || *value < bounds.low || *value > bounds.high) {
      table.reject(key,
                   fmt::format("a list with {}",
                               value ? fmt::format("{:g}", *value) : '"' + each.text + '"'),
                   allowed);
      return list;
    }
    list.push_back(*value);
  }
  return list;
}

const Schema<MovingTarget>& moving_target_schema() {
  using T = MovingTarget;
  static const auto schema =
      Schema<T>()
          .vector("centre", &T::centre, kTargetPlace, "m", "Place about which the target moves")
          .otherwise("0, 0, 0")
          .vector("velocity", &T::velocity, kTargetPlace, "m/s",
                  "Velocity of the target beside its swings")
          .otherwise("0, 0, 0")
          .direction("direction", &T::direction, "Direction in which the target swings")
          .otherwise("1, 0, 0")
          .custom("frequencies", "Frequencies of the sines whose sum is the target's swing",
                  [](Table& table, const std::string& key, T& target) {
                    target.frequencies = read_list(table, key, {0.001, 20.0}, "Hz");
                  })
          .otherwise("it does not swing")
          .custom("amplitudes", "Amplitudes of the sines, one for each frequency",
                  [](Table& table, const std::string& key, T& target) {
                    target.amplitudes = read_list(table, key, {-1.0, 1.0}, "m");
                  })
          .otherwise("needed with frequencies")
          .custom("phases", "Phases of the sines, one for each frequency",
                  [](Table& table, const std::string& key, T& target) {
                    target.phases = read_list(table, key, {-100.0, 100.0}, "rad");
                  })
          .otherwise("0")
          .number("radius", &T::radius, {0.0, 0.5}, "m",
                  "Radius of the circle that is the target; 0: a dot")
          .check([](Table& table, T& target) {
            if (target.phases.empty()) {
              target.phases.resize(target.frequencies.size(), 0.0);
            }
            for (const auto& [key, size] : {std::pair{"amplitudes", target.amplitudes.size()},
                                            std::pair{"phases", target.phases.size()}}) {
              if (size != target.frequencies.size()) {
                table.reject(key, fmt::format("a list of {}", size),
                             fmt::format("one number for each of the {} frequencies",
                                         target.frequencies.size()));
              }
            }
            target.amplitudes.resize(target.frequencies.size(), 0.0);
            target.phases.resize(target.frequencies.size(), 0.0);
          });
  return schema;
}

}  // namespace

Eigen::Vector3d MovingTarget::at(double t) const noexcept {
  double swing = 0.0;
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    swing += amplitudes[i] * std::sin(2.0 * M_PI * frequencies[i] * t + phases[i]);
  }
  return centre + t * velocity + swing * direction;
}

std::vector<MovingTarget> read_moving_targets(Table& targets) {
  std::vector<MovingTarget> all;
  for (const std::string& name : targets.keys()) {
    Table table = targets.table(name);
    all.push_back(moving_target_schema().read(table));
    all.back().name = name;
  }
  return all;
}

}  // namespace haptrial::protocols
