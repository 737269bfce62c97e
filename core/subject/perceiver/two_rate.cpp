#include "core/subject/perceiver/two_rate.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "core/base/definition/schema.h"

namespace haptrial::subject {
namespace {

void require_rate(const LearningRate& rate, const char* name) {
  if (!(rate.retention >= 0.0 && rate.retention <= 1.0)) {
    throw std::invalid_argument(std::string("TwoRate: ") + name + ".retention must be 0 to 1");
  }
  if (!(rate.learning >= 0.0 && rate.learning <= 1.0)) {
    throw std::invalid_argument(std::string("TwoRate: ") + name + ".learning must be 0 to 1");
  }
}

/// @param process  "fast"; @param usual  rates if its table is left out
Schema<LearningRate> make_rate_schema(const char* process, const LearningRate& usual) {
  using R = LearningRate;
  return Schema<R>()
      .number("retention", &R::retention, kFraction, "1",
              fmt::format("Share of what the {} process of adaptation knows that it keeps from "
                          "trial to trial; without the table {}",
                          process, usual.retention))
      .required()
      .number("learning", &R::learning, kFraction, "1",
              fmt::format("Share of an error that the {} process of adaptation learns; without "
                          "the table {}",
                          process, usual.learning))
      .required();
}

}  // namespace

const Schema<TwoRateParameters>& two_rate_schema() {
  using P = TwoRateParameters;
  static const auto fast = make_rate_schema("fast", P{}.fast);
  static const auto slow = make_rate_schema("slow", P{}.slow);
  static const auto schema =
      Schema<P>()
          .table("fast", &P::fast, fast, "Process of adaptation that learns and forgets fast")
          .table("slow", &P::slow, slow, "Process of adaptation that learns and forgets slowly");
  return schema;
}

TwoRate::TwoRate(const TwoRateParameters& parameters) : parameters_(parameters) {
  require_rate(parameters.fast, "fast");
  require_rate(parameters.slow, "slow");
}

void TwoRate::learn(double error) noexcept {
  fast_ = parameters_.fast.retention * fast_ + parameters_.fast.learning * error;
  slow_ = parameters_.slow.retention * slow_ + parameters_.slow.learning * error;
}

Eigen::Vector3d TwoRate::compensation(const Eigen::Matrix3d& field,
                                      const Eigen::Vector3d& velocity) const noexcept {
  return -state() * (field * velocity);
}

void FieldError::feel(const Eigen::Vector3d& force, const Eigen::Vector3d& compensation,
                      const Eigen::Vector3d& velocity) noexcept {
  const Eigen::Vector3d unit = field_ * velocity;
  product_ += (force + compensation).dot(unit);
  square_ += unit.squaredNorm();
}

double FieldError::error() const noexcept { return square_ > 0.0 ? product_ / square_ : 0.0; }

}  // namespace haptrial::subject
