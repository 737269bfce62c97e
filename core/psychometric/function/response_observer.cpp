#include "core/psychometric/function/response_observer.h"

#include <cmath>
#include <stdexcept>

namespace haptrial::psychometric {

ResponseObserver::ResponseObserver(const ObserverParameters& parameters, std::uint64_t seed,
                                   std::string_view name)
    : function_(parameters.function),
      repetition_(parameters.repetition),
      drift_(parameters.drift),
      random_(seed, name) {
  if (!std::isfinite(parameters.repetition)) {
    throw std::invalid_argument("ResponseObserver: repetition must be finite");
  }
  if (!std::isfinite(parameters.drift)) {
    throw std::invalid_argument("ResponseObserver: drift must be finite");
  }
}

double ResponseObserver::probability(double level) const noexcept {
  const auto& p = function_.parameters();
  const double pull = p.falling ? -repetition_ : repetition_;
  return function_.at(p.axis.at(level) + pull * before_ - drift_ * static_cast<double>(trials_));
}

int ResponseObserver::answer(double level) noexcept {
  const int answer = random_.uniform() < probability(level) ? 1 : 0;
  before_ = answer == 1 ? 1 : -1;
  ++trials_;
  return answer;
}

}  // namespace haptrial::psychometric
