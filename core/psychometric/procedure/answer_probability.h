#pragma once

#include <functional>

namespace haptrial::psychometric {

/// Probability of a right answer at a level.
using AnswerProbability = std::function<double(double level)>;

}  // namespace haptrial::psychometric
