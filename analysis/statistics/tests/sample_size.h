#pragma once

namespace haptrial::analysis {

/// A number of participants.
struct SampleSize {
  double exact{0.0};  // where the power is met, between whole numbers
  long n{0};          // the next whole number; at least the smallest that can be tested
  double power{0.0};  // with n
};

}  // namespace haptrial::analysis
