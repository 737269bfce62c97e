#pragma once

#include "core/subject/subject_parameters.h"

namespace haptrial::subject {

/// Everything at zero but delays and time constants: perceives, remembers and acts without error.
inline SubjectParameters noiseless_subject() {
  SubjectParameters person;
  for (const auto spread :
       {&SubjectParameters::visual_weber, &SubjectParameters::haptic_weber,
        &SubjectParameters::visual_memory_noise, &SubjectParameters::haptic_memory_noise,
        &SubjectParameters::haptic_bias, &SubjectParameters::bar_misjudgement,
        &SubjectParameters::calibration_loss, &SubjectParameters::forgetting,
        &SubjectParameters::production_bias, &SubjectParameters::timing_error,
        &SubjectParameters::force_noise, &SubjectParameters::tremor}) {
    person.*spread = 0.0;
  }
  return person;
}

}  // namespace haptrial::subject
