#include "core/bone/drill/heat.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/definition/table.h"

namespace haptrial::bone {

HeatParameters read_heat_parameters(Table& table) {
  HeatParameters p;
  p.turns = table.number_or("turns", p.turns, {1.0, 10'000.0}, "1/s");
  p.share = table.number_or("share", p.share, {0.0, 1.0}, "");
  p.capacity = table.number_or("capacity", p.capacity, {1e-3, 1000.0}, "J/K");
  p.loss = table.number_or("loss", p.loss, {1e-4, 1000.0}, "W/K");
  p.rinsed_loss = table.number_or("rinsed_loss", p.rinsed_loss, {p.loss, 1000.0}, "W/K");
  p.body = table.number_or("body", p.body, {0.0, 45.0}, "degree C");
  p.harmful = table.number_or("harmful", p.harmful, {p.body, 100.0}, "degree C");
  return p;
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
