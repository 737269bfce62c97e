#include "core/subject/subject_parameters.h"

#include "core/subject/population_schema.h"

namespace haptrial::subject {
namespace {

using S = SubjectParameters;

constexpr Bounds kShare{0.0, 1.0};
constexpr Bounds kNewton{0.0, 100.0};
constexpr Bounds kSeconds{0.0, 60.0, true};
constexpr Bounds kDelay{0.0, 0.5};  // the virtual subject's delay line holds this at every rate

}  // namespace

const Schema<Population<SubjectParameters>>& subject_schema() {
  static const auto schema = make_population_schema<S>(
      "", true,
      {{"visual_weber", &S::visual_weber, kShare, "",
        "Standard deviation of a seen bar height, as a share of the height"},
       {"haptic_weber", &S::haptic_weber, kShare, "",
        "Standard deviation of a felt force, as a share of the force"},
       {"visual_memory_noise", &S::visual_memory_noise, kNewton, "N",
        "Standard deviation of a seen bar height that is kept in memory, as a force"},
       {"haptic_memory_noise", &S::haptic_memory_noise, kNewton, "N",
        "Standard deviation of a felt force that is kept in memory"},
       {"haptic_bias", &S::haptic_bias, kShare, "",
        "Standard deviation of the felt scale of forces from pass to pass, as a logarithm"},
       {"bar_misjudgement", &S::bar_misjudgement, kShare, "",
        "Standard deviation of the force that a bar height is taken for before any calibration, "
        "as a logarithm"},
       {"calibration_loss", &S::calibration_loss, kShare, "",
        "Share of the calibration of bar heights to forces that is lost after a block"},
       {"forgetting", &S::forgetting, kNewton, "N", "Drift of remembered forces between passes"},
       {"memory_correlation", &S::memory_correlation, kSeconds, "s",
        "Time over which errors of remembered forces are alike"},
       {"production_bias", &S::production_bias, kShare, "",
        "Standard deviation of the scale of produced forces from recall to recall, as a "
        "logarithm"},
       {"timing_error",
        &S::timing_error,
        {0.0, 10.0},
        "s",
        "Standard deviation of the time at which a remembered force is produced"},
       {"timing_correlation", &S::timing_correlation, kSeconds, "s",
        "Time over which errors of the timing of forces are alike"},
       {"visual_delay", &S::visual_delay, kDelay, "s", "Delay of reactions to what is seen"},
       {"haptic_delay", &S::haptic_delay, kDelay, "s", "Delay of reactions to what is felt"},
       {"force_noise", &S::force_noise, kShare, "",
        "Standard deviation of a held force, as a share of the force"},
       {"force_noise_time", &S::force_noise_time, kSeconds, "s",
        "Correlation time of the noise of a held force"},
       {"tremor", &S::tremor, {0.0, 5.0}, "N", "Root mean square of the force of the tremor"},
       {"tremor_frequency",
        &S::tremor_frequency,
        {0.0, 50.0, true},
        "Hz",
        "Frequency of the tremor"}});
  return schema;
}

}  // namespace haptrial::subject
