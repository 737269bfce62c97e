#pragma once

#include "core/base/definition/schema_forward.h"

namespace haptrial::subject {

template <class Person>
struct Population;

/// One virtual person. No value belongs to a training condition: each describes a sense, the memory
/// or the hand, and what a condition gives follows from the senses it uses.
/// Sources of the values: docs/algorithms/virtual-subject.md.
struct SubjectParameters {
  double visual_weber{0.04};        // spread of a seen bar height, as a fraction of it
  double haptic_weber{0.08};        // spread of a felt force, as a fraction of it
  double visual_memory_noise{0.5};  // of a height kept in memory [N of the bar's scale]
  double haptic_memory_noise{1.5};  // of a force kept in memory [N]
  double haptic_bias{0.08};         // spread of the felt scale from pass to pass, log units
  double bar_misjudgement{0.3};    // spread of newtons per bar height before calibration, log units
  double calibration_loss{0.3};    // share of a calibration that is gone after a block
  double forgetting{0.3};          // drift of the memory between passes [N]
  double memory_correlation{0.5};  // time over which memory errors are alike [s]
  double production_bias{0.06};    // spread of the produced scale from recall to recall, log units
  double timing_error{0.15};       // spread of the time at which a remembered force comes [s]
  double timing_correlation{1.5};  // time over which timing errors are alike [s]
  double visual_delay{0.2};        // reaction to what is seen [s]
  double haptic_delay{0.1};        // reaction to what is felt [s]
  double force_noise{0.03};        // spread of a held force as a fraction of it
  double force_noise_time{0.1};    // its correlation time [s]
  double tremor{0.03};             // root mean square of the tremor force [N]
  double tremor_frequency{9.0};    // [Hz]
};

/// The keys of [subject], which say how each parameter varies over virtual people.
const Schema<Population<SubjectParameters>>& subject_schema();

}  // namespace haptrial::subject
