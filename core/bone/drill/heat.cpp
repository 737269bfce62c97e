#include "core/bone/drill/heat.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/definition/schema.h"

namespace haptrial::bone {

const Schema<HeatParameters>& heat_schema() {
  using P = HeatParameters;
  static const auto schema =
      Schema<P>()
          .number("turns", &P::turns, {1.0, 10'000.0}, "1/s",
                  "Turns of the burr at full power; without [heat] nothing warms up")
          .number("share", &P::share, {0.0, 1.0}, "",
                  "Share of the work of the burr's teeth that stays as heat")
          .number("capacity", &P::capacity, {1e-3, 1000.0}, "J/K",
                  "Heat capacity of the burr and the bone at its teeth; more of it warms up slower")
          .number("loss", &P::loss, {1e-4, 1000.0}, "W/K",
                  "Conductance of heat from the burr and its bone to their surroundings")
          .number("rinsed_loss", &P::rinsed_loss, {1e-4, 1000.0}, "W/K",
                  "Conductance of heat from the burr and its bone while water runs over them")
          .number("body", &P::body, {0.0, 45.0}, "degree C",
                  "Temperature of the surroundings, at which a burr begins")
          .number("harmful", &P::harmful, {0.0, 100.0}, "degree C",
                  "Temperature above which time at the burr is counted as harmful to bone")
          .check([](Table& table, P& p) {
            const auto at_least = [&](const char* key, double value, const char* other,
                                      double least, const char* unit) {
              if (table.has(key) && value < least) {
                table.reject(key, fmt::format("{}", value),
                             fmt::format("at least {}, {} [{}]", other, least, unit));
              }
            };
            at_least("rinsed_loss", p.rinsed_loss, "loss", p.loss, "W/K");
            at_least("harmful", p.harmful, "body", p.body, "degree C");
          });
  return schema;
}

void DrillHeat::tick(double drag, double radius, double power, bool rinsed, double dt) noexcept {
  const double speed = 2.0 * std::numbers::pi * p_.turns * power * radius;
  const double loss = rinsed ? p_.rinsed_loss : p_.loss;
  const double end = p_.body + p_.share * drag * speed / loss;
  temperature_ = end + (temperature_ - end) * std::exp(-loss * dt / p_.capacity);
  hottest_ = std::max(hottest_, temperature_);
  harmful_ += temperature_ > p_.harmful ? dt : 0.0;
}

}  // namespace haptrial::bone
