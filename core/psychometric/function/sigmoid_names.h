#pragma once

#include <span>
#include <string_view>

#include "core/psychometric/function/sigmoid.h"

namespace haptrial::psychometric {

/// Form of a psychometric function that a name stands for.
struct SigmoidForm {
  Sigmoid sigmoid{Sigmoid::kLogistic};
  bool logarithmic{false};  // acts on the logarithm of the level: weibull, logn
  bool falling{false};      // 1 - F
};

/// A name that psignifit 4 (Schütt et al. 2016) or QUEST+ (Watson 2017) gives to a sigmoid.
struct SigmoidName {
  std::string_view name;  // in small letters
  SigmoidForm form;
};

std::span<const SigmoidName> sigmoid_names();

/// The form by its name; capital and small letters are the same, and "neg_" before a name makes the
/// function fall.
/// @throws std::invalid_argument with the names that are allowed
SigmoidForm sigmoid_named(std::string_view name);

}  // namespace haptrial::psychometric
