#include "core/subject/perceiver/sense.h"

namespace haptrial::subject {

Sense::Sense(const SenseParameters& senses, Quantity quantity)
    : senses_(senses), quantity_(quantity), episodes_(senses) {
  check(senses);
}

void Sense::begin(RandomStream& random) noexcept {
  noise_ = draw_noise(random);
  episodes_.begin();
}

double Sense::percept() const noexcept { return felt(senses_, quantity_, met(), noise_); }

}  // namespace haptrial::subject
