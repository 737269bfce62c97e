#include "core/psychometric/function/sigmoid_names.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/nearest.h"

namespace haptrial::psychometric {
namespace {

constexpr std::string_view kFalling = "neg_";

constexpr std::array<SigmoidName, 13> kNames{{{"logistic", {Sigmoid::kLogistic}},
                                              {"cumulative_gaussian", {Sigmoid::kGaussian}},
                                              {"norm", {Sigmoid::kGaussian}},
                                              {"gauss", {Sigmoid::kGaussian}},
                                              {"norm_cdf", {Sigmoid::kGaussian}},
                                              {"gumbel", {Sigmoid::kGumbel}},
                                              {"reversed_gumbel", {Sigmoid::kReversedGumbel}},
                                              {"rgumbel", {Sigmoid::kReversedGumbel}},
                                              {"tdist", {Sigmoid::kCauchy}},
                                              {"weibull", {Sigmoid::kGumbel, true}},
                                              {"rweibull", {Sigmoid::kReversedGumbel, true}},
                                              {"log_normal", {Sigmoid::kGaussian, true}},
                                              {"logn", {Sigmoid::kGaussian, true}}}};

std::string in_small_letters(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return result;
}

}  // namespace

std::span<const SigmoidName> sigmoid_names() { return kNames; }

SigmoidForm sigmoid_named(std::string_view name) {
  const std::string small = in_small_letters(name);
  std::string_view plain = small;
  const bool falling = plain.starts_with(kFalling);
  plain.remove_prefix(falling ? kFalling.size() : 0);
  std::vector<std::string> allowed;
  for (const SigmoidName& known : kNames) {
    if (known.name == plain) {
      SigmoidForm form = known.form;
      form.falling = falling;
      return form;
    }
    allowed.emplace_back((falling ? std::string(kFalling) : "").append(known.name));
  }
  throw std::invalid_argument(
      not_allowed("the psychometric function", "'" + std::string(name) + "'", allowed) +
      (falling ? "" : ", and neg_ before each of these"));
}

}  // namespace haptrial::psychometric
