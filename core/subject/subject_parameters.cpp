#include "core/subject/subject_parameters.h"

#include <iterator>

#include "core/base/definition/table.h"

namespace haptrial::subject {
namespace {

struct Field {
  const char* key;
  double SubjectParameters::*value;
  Bounds bounds;  // of the median
  const char* unit;
};

constexpr Bounds kShare{0.0, 1.0};
constexpr Bounds kNewton{0.0, 100.0};
constexpr Bounds kSeconds{0.0, 60.0, true};
constexpr Bounds kDelay{0.0, 0.5};  // the virtual subject's delay line holds this at every rate

using S = SubjectParameters;
constexpr Field kFields[] = {
    {"visual_weber", &S::visual_weber, kShare, ""},
    {"haptic_weber", &S::haptic_weber, kShare, ""},
    {"visual_memory_noise", &S::visual_memory_noise, kNewton, "N"},
    {"haptic_memory_noise", &S::haptic_memory_noise, kNewton, "N"},
    {"haptic_bias", &S::haptic_bias, kShare, ""},
    {"bar_misjudgement", &S::bar_misjudgement, kShare, ""},
    {"calibration_loss", &S::calibration_loss, kShare, ""},
    {"forgetting", &S::forgetting, kNewton, "N"},
    {"memory_correlation", &S::memory_correlation, kSeconds, "s"},
    {"production_bias", &S::production_bias, kShare, ""},
    {"timing_error", &S::timing_error, {0.0, 10.0}, "s"},
    {"timing_correlation", &S::timing_correlation, kSeconds, "s"},
    {"visual_delay", &S::visual_delay, kDelay, "s"},
    {"haptic_delay", &S::haptic_delay, kDelay, "s"},
    {"force_noise", &S::force_noise, kShare, ""},
    {"force_noise_time", &S::force_noise_time, kSeconds, "s"},
    {"tremor", &S::tremor, {0.0, 5.0}, "N"},
    {"tremor_frequency", &S::tremor_frequency, {0.0, 50.0, true}, "Hz"},
};

}  // namespace

Population::Population(Table& table) {
  static_assert(std::size(kFields) == kCount);
  for (int i = 0; i < kCount; ++i) {
    const Field& field = kFields[i];
    variations_[i] = read_variation(table, field.key, field.bounds, field.unit);
  }
}

SubjectParameters Population::draw(std::uint64_t seed) const {
  SubjectParameters person;
  for (int i = 0; i < kCount; ++i) {
    const Bounds most{Bounds{}.low, kFields[i].bounds.high};
    person.*kFields[i].value = subject::draw(variations_[i], seed, kFields[i].key, most);
  }
  return person;
}

SubjectParameters noiseless_subject() {
  SubjectParameters person;
  for (const auto spread :
       {&S::visual_weber, &S::haptic_weber, &S::visual_memory_noise, &S::haptic_memory_noise,
        &S::haptic_bias, &S::bar_misjudgement, &S::calibration_loss, &S::forgetting,
        &S::production_bias, &S::timing_error, &S::force_noise, &S::tremor}) {
    person.*spread = 0.0;
  }
  return person;
}

}  // namespace haptrial::subject
