#include "core/subject/perceiver/palpation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptrial::subject {
namespace {

constexpr double kRise = 0.5;  // of a press: the force rises
constexpr double kFall = 0.25;

}  // namespace

void check(const Palpate& palpate) {
  const auto require = [](bool good, const char* what) {
    if (!good) {
      throw std::invalid_argument(std::string("palpate: ") + what);
    }
  };
  require(palpate.count >= 1 && palpate.count <= Palpate::kMost, "at must have 1 to 16 places");
  for (std::size_t i = 0; i < std::min(palpate.count, Palpate::kMost); ++i) {
    require(palpate.places[i].allFinite(), "places must be finite");
  }
  require(palpate.direction.allFinite() && palpate.direction.norm() > 0.0,
          "direction must be finite and longer than 0");
  require(std::isfinite(palpate.force) && palpate.force > 0.0, "force must be above 0");
  require(std::isfinite(palpate.move) && palpate.move > 0.0, "move must be above 0");
  require(std::isfinite(palpate.press) && palpate.press > 0.0, "press must be above 0");
}

PalpationStep palpation_at(const Palpate& palpate, double time) noexcept {
  const double whole = palpate.move + palpate.press;
  const auto number = static_cast<std::size_t>(std::max(0.0, time) / whole);
  if (number >= palpate.count) {
    return {palpate.count - 1, 1.0, 0.0, false, true};
  }
  const double within = time - static_cast<double>(number) * whole;
  PalpationStep step;
  step.place = number;
  step.moved = std::min(1.0, within / palpate.move);
  if (within >= palpate.move) {
    const double part = (within - palpate.move) / palpate.press;
    step.pressing = true;
    step.pressed = std::min({1.0, part / kRise, (1.0 - part) / kFall});
  }
  return step;
}

}  // namespace haptrial::subject
